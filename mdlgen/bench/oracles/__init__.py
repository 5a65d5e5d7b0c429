"""Closed forms and independent solutions that results are measured against."""

"""Figures of a run, for print and notebooks."""

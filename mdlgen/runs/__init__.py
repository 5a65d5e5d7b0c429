"""Runs as such: what they can be gone on with, and what their bits follow from."""

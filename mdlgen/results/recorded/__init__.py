"""Recordings of the same scene by another program: reading their files, and comparing a run with them."""

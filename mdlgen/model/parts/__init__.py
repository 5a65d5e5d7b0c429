"""Kinds of parts of a machine: a file for each, listed in `kinds`."""

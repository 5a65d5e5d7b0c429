"""Shapes that contacts of a script act on: a file for each class."""

"""Checks of an MDL file or a deck beyond its numbers: statements, labels, keywords, elements."""

"""Reads an MDL file, its script or a deck back, as tables like the expected ones."""

"""A run for other programs to draw."""

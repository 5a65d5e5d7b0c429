"""The Model as a script."""

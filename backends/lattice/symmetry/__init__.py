"""Scenes that are their own mirror image, of which one half is solved."""

"""Scenes that are their own mirror image, solved by one half."""

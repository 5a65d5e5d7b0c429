"""Pressed parts: where their springs bring them to touch, and where they stand in equilibrium at the
start."""

"""Shapes and places, without a scene: triangles of solids, rods and blocks."""

"""How finely MotionSolve meshes graphics, whose contacts it computes on meshes.

Every pair but of two spheres, or a sphere and a mesh, is meshed (help on contact, 2021), so these levels
decide the force. No document gives the mesh of a level: 3 is what MotionView writes by itself.
"""

from __future__ import annotations

BOX = 3
"""MotionView's own: the faces of a box are flat at any level, and its corners are nodes."""
CYLINDER = 6
"""Finer, since a cylinder is the master surface, with forces at its nodes (paper, 3.1), and is round only as
far as its mesh is. Raise it until contact forces no longer change."""
GRAPHICS = {"refinement_box": BOX, "refinement_cylinder": CYLINDER}
"""For templates."""

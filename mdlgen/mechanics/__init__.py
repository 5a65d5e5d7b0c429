"""Compiled force laws shared by the solvers. They hold in any consistent set of units.

Vectors are tuples of three floats, rotation matrices tuples of nine in row order: they live in registers,
so that a law costs no allocation. Every law writes forces and torques about the bodies' centres.
"""

"""Scenes of parts that turn about a pivot or slide."""

from __future__ import annotations

import numpy as np

from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.results.gates import place
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

SOLVERS = ("lattice", "exudyn")
G = 9.81e-3  # mm/ms^2
HEAD = """
name: gate
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {paper: {E_md: 3000 MPa, E_cd: 3000 MPa, D_md: 1 N*mm, D_cd: 1 N*mm}}
sheets:
  block: {material: paper, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 0.497873 mm]}
"""
# k z^1.5 = m g: a block of 1 g lies 2.1 um deep on a plane of 100 N/mm^1.5
FLOOR = """
contacts:
  floor: {between: [block, PLATE], stiffness: 100 N/mm^1.5, restitution: 0.3, friction: 0.3,
    smoothing: 1 mm/s}
"""
LIFT = (
    HEAD
    + """
planes:
  lift: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [100 mm, 100 mm, 10 mm], slide: {direction: z,
    positions: {up: 10 mm}, profile: [[0 ms, 0 mm], [5 ms, 0 mm], [105 ms, up]]}}
"""
    + FLOOR.replace("PLATE", "lift")
    + "run: {duration: 40 ms, step: 0.5 ms, print_step: 5 ms}\n"
)
GUIDE = """
guides:
  flap: {line: {from: [0 mm, 0 mm, 0 mm], to: [60 mm, 0 mm, 0 mm], axis: -y, side: left}, width: 40 mm,
    thickness: 2 mm, mass: 4 g, pivot: {at: [0 mm, 0 mm, 0 mm], axis: y, inertia: 4800 g*mm^2,
      stiffness: 30 N*mm/rad}}
"""


def model(text: str, *overrides: str) -> Model:
    return lower(loads(text, overrides=overrides))


def angle(result: Result, index: int = 0) -> np.ndarray:
    """Place of a moving part over time."""
    part, _ = result.model.gates[index]
    found = place(result, part)
    assert found is not None
    return found


def ease(t: np.ndarray, way: float, begin: float, span: float) -> tuple[np.ndarray, np.ndarray]:
    """Place and acceleration of the law between two corners."""
    s = np.clip((t - begin) / span, 0.0, 1.0)
    inside = (t >= begin) & (t <= begin + span)
    return way * s * s * (3.0 - 2.0 * s), np.where(inside, way / span**2 * (6.0 - 12.0 * s), 0.0)

"""Scenes with meshes, and the files that these are of."""

from __future__ import annotations

import math

import numpy as np
from papers import on_paper
from solids import ascii_stl, binary, cylinder, obj, prism

from mdlgen.spec.load import loads

SHAPES = on_paper("""
name: shapes
materials: {m: PLATE_PAPER}
sheets: {note: {material: m, size: [40 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [2, 2]}}
rollers:
  r: {center: [0 mm, 0 mm, -8 mm], axis: y, radius: 7.5 mm, width: 5 mm, mass: 1 g, drive: {speed: 100 rad/s}}
  c: {center: [0 mm, 0 mm, 6 mm], axis: y, radius: 5 mm, width: 5 mm, mass: 1 g,
      press: {direction: -z, stiffness: 0.3 N/mm, preload: 2 N}}
meshes:
  one: {file: round.stl, center: [0 mm, 0 mm, -8 mm], on: r, mass: 2 g, rotation: [0 deg, 5 deg, 0 deg]}
  two: {file: small.obj, units: cm, center: [0 mm, 0 mm, 6 mm], on: c, density: 1.2 g/cm^3, at: centres}
  three: {file: wedge.stl, center: [1 mm, 2 mm, -30 mm], rotation: [10 deg, 20 deg, 30 deg]}
contacts:
- {between: [r, c], stiffness: 30 N/mm^1.5, friction: 0}
- {between: [note, "t*"], stiffness: 30 N/mm^1.5, friction: 0}
- {between: [note, one], stiffness: 30 N/mm^1.5, friction: 0.2}
run: {duration: 1 ms}
""")
WEDGE = prism([(0, -1), (30, -1), (30, 3), (0, 0)], 30)


def solids_in(folder):
    """The files that SHAPES names, in a folder."""
    (folder / "round.stl").write_bytes(binary(*cylinder(7.5, 5.0, 64)))
    (folder / "small.obj").write_text(obj(*cylinder(0.5, 0.5, 24)))
    (folder / "wedge.stl").write_text(ascii_stl(*WEDGE))
    return folder


def scene_of(folder, *changes, text=SHAPES):
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return loads(text, folder=folder)


def turn(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    rows = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]]}
    return np.array(rows[axis])

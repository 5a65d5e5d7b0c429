"""Runs of scenes by Exudyn."""

from __future__ import annotations

import ran

from mdlgen.model.lower import lower
from mdlgen.spec.load import load, loads

CANTILEVER = "samples/cantilever.yaml"


def run(path, *overrides):
    return ran.solved(lower(load(path, overrides)), "exudyn")


def run_text(text, *overrides):
    return ran.solved(lower(loads(text, overrides=overrides)), "exudyn")


POST = """
name: post
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {s: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  block: {material: s, size: [20 mm, 20 mm], thickness: 2 mm, mass: 2 g, boxes: [1, 1],
          velocity: [1 m/s, 0 m/s, 0 m/s]}
rollers:
  post: {center: [30 mm, 0 mm, 0 mm], axis: z, radius: 5 mm, width: 20 mm, mass: 10 g}
contacts: [{between: [block, post], stiffness: 300 N/mm^1.5, restitution: 1.0, friction: 0}]
run: {duration: 30 ms}
"""

"""Rollers that turn by motors, limiters and bearings alone, and a note in a nip with a retard roller."""

from __future__ import annotations

from papers import on_paper

from mdlgen.model.lower import lower
from mdlgen.model.tables import Floats, Model
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

ALONE = on_paper("""
name: alone
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {paper: HINGED_PAPER}
sheets:
  note: {material: paper, size: [20 mm, 20 mm], thickness: 0.1 mm, mass: 0.05 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 50 mm]}
rollers:
  feed: {center: [0 mm, 0 mm, 0 mm], axis: y, radius: 10 mm, width: 20 mm, mass: 20 g}
  other: {center: [60 mm, 0 mm, 0 mm], axis: y, radius: 10 mm, width: 20 mm, mass: 10 g}
run: {duration: 10 ms, print_step: 1 ms, step: 0.1 ms}
""")
FEED, OTHER = 1000.0, 500.0  # inertia of a cylinder, m r^2 / 2 [g mm^2]
STEPS_ON = "rollers.feed.drive={speed: 300 rad/s, ramp: 5 ms, motor: {torque: 20 N*mm, steps: {}}}"
CONTROLLED = (
    "rollers.other.drive={speed: 100 rad/s, motor: {torque: 20 N*mm, speed: 200 rad/s, "
    "control: {proportional: 400 N*mm*ms/rad, integral: 40 N*mm/rad}}}"
)

# Between a roller that feeds and one on a limiter whose shaft stands; a note that goes through.
RETARD = on_paper("""
name: retarded
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {paper: HINGED_PAPER}
sheets:
  note: {material: paper, size: [60 mm, 20 mm], thickness: 0.1 mm, mass: 0.12 g, boxes: [6, 1],
    center: [-15 mm, 0 mm, 0 mm]}
rollers:
  feed: {center: [0 mm, 0 mm, 10.05 mm], axis: y, radius: 10 mm, width: 16 mm, mass: 10 g,
    drive: {speed: -20 rad/s, ramp: 4 ms}}
  retard: {center: [0 mm, 0 mm, -10.05 mm], axis: y, radius: 10 mm, width: 16 mm, mass: 10 g,
    limiter: {torque: 5 N*mm}, press: {direction: z, stiffness: 0.1 N/mm, preload: 2 N, damping_ratio: 0.3}}
contacts: [{between: [note, [feed, retard]], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 2 mm/s}]
run: {duration: 20 ms, print_step: 0.5 ms}
""")


def alone(*overrides: str) -> Model:
    return lower(loads(ALONE, "alone", overrides))


def retarded(*overrides: str) -> Model:
    return lower(loads(RETARD, "retarded", overrides))


def spin(result: Result, name: str) -> Floats:
    """Of a roller about its axis [rad/ms], (t,)."""
    roller = result.model.roller(name)
    return result.spin[:, roller.body] @ roller.axis

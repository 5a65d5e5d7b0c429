"""Scenes of machines that more than one file of tests runs."""

from __future__ import annotations

from papers import on_paper

MACHINE = on_paper("""
name: machine
materials:
  paper: HINGED_PAPER
sheets:
  note: {material: paper, size: [40 mm, 48 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [6, 10],
    center: [0 mm, 3 mm, 0 mm], velocity: [200 mm/s, 0 mm/s, 0 mm/s]}
rollers:
  motor_left: {center: [0 mm, -9 mm, -7.5 mm], axis: y, radius: 7.5 mm, width: 10 mm, mass: 1 g,
    drive: {speed: 100 rad/s}}
  motor_right: {center: [0 mm, 15 mm, -7.5 mm], axis: y, radius: 7.5 mm, width: 10 mm, mass: 1 g,
    drive: {speed: 100 rad/s}}
  idler_left: {center: [0 mm, -9 mm, 5 mm], axis: y, radius: 5 mm, width: 10 mm, mass: 1 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 1 N}}
  idler_right: {center: [0 mm, 15 mm, 5 mm], axis: y, radius: 5 mm, width: 10 mm, mass: 1 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 1 N}}
  middle: {center: [12 mm, 3 mm, 6 mm], axis: y, radius: 5 mm, width: 12 mm, mass: 1 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 0.2 N}}
planes: {table: {center: [0 mm, 3 mm, -30 mm], normal: z, size: [200 mm, 200 mm, 1 mm], mass: 1 g}}
contacts:
  - {between: [note, "*"], stiffness: 300 N/mm^1.5, restitution: 0.4, friction: 0.8, smoothing: 10 mm/s}
  - {between: [motor_left, idler_left], stiffness: 300 N/mm^1.5, friction: 0.5}
  - {between: [motor_right, idler_right], stiffness: 300 N/mm^1.5, friction: 0.5}
run: {duration: 3 ms, step: 0.02 ms, tolerance: 1e-6, print_step: 0.5 ms}
""")
# the idler is driven, first slower than the motor's shaft, then faster, then slower again
WAY = "{direction: %d, torque: 40 N*mm, creep: 0.1 rad/s}"
OVERRUN = (
    "rollers.motor.drive={speed: 50 rad/s, ramp: 2 ms}",
    f"rollers.motor.one_way={WAY % 1}",
    "rollers.idler.drive={profile: [[0 ms, 0 rad/s], [10 ms, -100 rad/s], [15 ms, -30 rad/s]]}",
)

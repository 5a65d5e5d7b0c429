"""A note in one nip whose motor drives it forth and back."""

from __future__ import annotations

from papers import on_paper

FORTH_AND_BACK = on_paper("""
name: nip
materials:
  paper: HINGED_PAPER
sheets:
  note: {material: paper, size: [67 mm, 30 mm], thickness: 0.1 mm, mass: 0.17 g, boxes: [6, 3]}
rollers:
  motor: {center: [0 mm, 0 mm, -7.5 mm], axis: y, radius: 7.5 mm, width: 20 mm, mass: 10 g,
    drive: {profile: [[0 ms, 0 rad/s], [5 ms, 100 rad/s], [8 ms, 100 rad/s], [12 ms, -60 rad/s]]}}
  idler: {center: [0 mm, 0 mm, 5 mm], axis: y, radius: 5 mm, width: 20 mm, mass: 5 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}
contacts: [{between: [note, "*r"], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s}]
run: {duration: 20 ms, print_step: 0.1 ms}
""")

"""A scene of one nip."""

from __future__ import annotations

# the sheet, square to the nip: at is on its middle plane
SHEET = """name: s
materials: {p: {E_md: 3.5 GPa, E_cd: 1.1 GPa, k_tx: 0.15 N*mm/rad, k_ty: 0.2 N*mm/rad}}
sheets: {note: {material: p, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [6, 4]}}
"""


ONE = (
    SHEET
    + """nips:
  entry:
    at: [0 mm, 0 mm, 0 mm]
    force: 3 N
    lower: {diameter: 15 mm, width: 8 mm, mass: 1 g, contact: {stiffness: 300 N/mm^1.5, friction: 1}}
    upper:
      {radius: 5 mm, width: 6 mm, mass: 4 g, press: {stiffness: 0.3 N/mm}, contact: CONTACT}
    contact: {stiffness: 30 N/mm^1.5, friction: 1}
"""
)


ONE = ONE.replace("CONTACT", "{stiffness: 200 N/mm^1.5, friction: 0}")

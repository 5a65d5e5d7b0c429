"""Stacks of notes, and runs of them."""

from __future__ import annotations

from asked import as_asked
from papers import HINGED_PAPER

import mdlgen
from mdlgen.model.tables import Model
from mdlgen.results.result import Result


def stack(notes: int, boxes: str) -> str:
    """Notes on a table, as they lie before they have weight."""
    sheets = "\n".join(
        f"  note_{k}: {{material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, "
        f"boxes: {boxes}, center: [0 mm, 0 mm, {0.05 + 0.1 * k:g} mm]}}"
        for k in range(notes)
    )
    pairs = "\n".join(
        f"  - {{between: [note_{k}, note_{k + 1}], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3}}"
        for k in range(notes - 1)
    )
    return f"""
name: stack
materials:
  paper: {HINGED_PAPER}
sheets:
{sheets}
planes:
  table: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [227 mm, 300 mm, 10 mm], mass: 681 g}}
contacts:
{pairs}
  - {{between: [note_0, table], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3}}
run: {{duration: 20 ms, print_step: 1 ms}}
"""


def ran(model: Model, solver: str) -> Result:
    result = mdlgen.solve(model, solver)
    assert as_asked(result), result.status
    return result

"""Head of a script: how to run it, what MotionSolve computes itself, and which features are omitted."""

from __future__ import annotations

from mdlgen.altair.edges import edge_note
from mdlgen.altair.margin import margin_note
from mdlgen.altair.reactions import sensor_note
from mdlgen.altair.recorded import MOST_SUMMED, unrecorded
from mdlgen.model.tables import Model

_RUNS = (
    "Run it with MotionSolve's Python. It writes NAME.plt and NAME_requests.csv: mdlgen compare reads both.",
    "No MotionSolve was at hand when it was written: each class and keyword is from Altair's help, or from a",
    "script that ran (docs/motionview/script.md).",
)
_FRAME = (
    "Bushings: MotionSolve has displacement and force in the axes of marker J; the local run of mdlgen has",
    "the frame halfway between the two bodies. Both agree where the angle between these is small.",
)


def banner(model: Model) -> list[str]:
    """The lines of the head."""
    lines = [*_RUNS]
    for sheet in model.sheets:
        lines.append(
            f"Sheet {sheet.name}: {sheet.n_x} x {sheet.n_y} boxes, {sheet.layout}, {sheet.grid} grid."
        )
    if len(model.bushings):
        lines += _FRAME
    if len(model.pairs):
        lines += _contacts(model)
    lines += [
        f"Left out: the deformable surface of {sheet.name}, which is for pictures only."
        for sheet in model.sheets
        if sheet.surface
    ]
    return [*lines, *sensor_note(model)]


def _contacts(model: Model) -> list[str]:
    speeds = sorted(
        {float(f"{v * 1000:.6g}") for v in model.contacts.smoothing[model.pairs.contact].tolist()}
    )
    shown = ", ".join(f"{v:g}" for v in speeds)
    lines = [
        "Contacts: MotionSolve gives each pair of boxes and parts the full stiffness. Left to MotionSolve is",
        f"normal_trans_vel, which no keyword of Contact is known to set; the local run has {shown} mm/s.",
        *(line.strip() for line in (*edge_note(model), *margin_note(model))),
    ]
    for row in unrecorded(model):
        by, on = model.contacts.part_a[row], model.contacts.part_b[row]
        lines.append(f"Not recorded: the force of {by} on {on}, of more than {MOST_SUMMED} pairs.")
    return lines

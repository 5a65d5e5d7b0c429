"""The comment at the head of a deck: units, contacts, what nobody has seen a real MotionSolve read."""

from __future__ import annotations

from itertools import groupby

from mdlgen.altair.edges import edge_note
from mdlgen.altair.margin import margin_note
from mdlgen.altair.reactions import sensor_note
from mdlgen.altair.recorded import MOST_SUMMED, unrecorded
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.backends.motionsolve.writer.units import number
from mdlgen.model.curves import limit
from mdlgen.model.tables import SUPPORT, Model

FRAME = (
    "Bushings : MotionSolve has displacement and force in the axes of marker J; the local run of mdlgen has",
    "  the frame halfway between the two bodies. Both agree where the angle between these is small.",
)


def banner(model: Model, deck: Deck) -> list[str]:
    """The lines of the comment."""
    lines = [
        f"{model.name}: MotionSolve deck, written by mdlgen",
        "",
        "Units : mm, N, kg, s, rad",
        f"Gravity : {', '.join(deck.gravity)} mm/s2",
    ]
    for k, sheet in enumerate(model.sheets):
        joints = int(((model.bushings.sheet == k) & (model.bushings.kind != SUPPORT)).sum())
        lines.append(
            f"Sheet : {sheet.name}, {sheet.n_x} x {sheet.n_y} boxes, {sheet.layout}, {sheet.grid} grid, "
            f"{joints} bushings"
        )
    if len(model.bushings):
        lines += FRAME
    lines += _curves(model)
    lines += _contacts(model)
    lines += sensor_note(model)
    lines += ["", "Not yet read by a real MotionSolve; look at these first if it complains :"]
    return lines + [f"  {form}" for form in unverified(model, deck)]


def _curves(model: Model) -> list[str]:
    curves = model.curves
    lines = []
    for index, name in enumerate(curves.name):
        beyond = (
            "straight on beyond" if curves.linear[index] else "where the local run ends; MotionSolve does not"
        )
        lines.append(f"Curve : crv_{name}, to a strain of {number(limit(curves, index))}, {beyond}")
    return lines


def _contacts(model: Model) -> list[str]:
    table, pairs = model.contacts, model.pairs
    if not len(table):
        return []
    lines = [
        f"Contacts : {pairs.possible} pairs possible, {len(pairs)} kept: those that can meet in the run, "
        f"with a margin of {number(pairs.margin)} mm",
        *margin_note(model),
        "  MotionSolve gives every pair the full stiffness. In the local run of mdlgen, share width lets",
        "  the boxes under one part share it by the width that each covers; share pair gives it to each too.",
        *edge_note(model),
    ]
    for row in unrecorded(model):
        parts = f"{table.part_a[row]} on {table.part_b[row]}"
        lines.append(f"  Not recorded: the force of {parts}, of more than {MOST_SUMMED} pairs.")
    for entry, group in groupby(range(len(table)), key=lambda row: int(table.entry[row])):
        first, *others = group
        more = f" and {len(others)} more" if others else ""
        parts = f"{table.part_a[first]} / {table.part_b[first]}{more}"
        lines.append(f"  contact {entry} : share {table.share[first]}, {parts}")
    for kind, parts in (("rollers", model.rollers), ("plates", model.planes)):
        if any(part.press is not None for part in parts):
            lines.append(f"  Pressed {kind} start in equilibrium with the sheets.")
    return lines


def unverified(model: Model, deck: Deck) -> list[str]:
    """One line for each form in this deck that is documented only, or concluded from a similar one."""
    supports = bool((model.bushings.kind == SUPPORT).any())
    supports |= any(r.arm is not None and r.arm.sprung for r in model.rollers)
    rows = (
        (
            True,
            "h_max and h_min of Param_Transient (seen with other values; the rest is as MotionView has it)",
        ),
        (bool(deck.motions), "Motion_Joint by an expression of the speed (seen in a command, documented)"),
        (supports, "Force_Bushing with zero stiffness in some directions (seen with positive ones)"),
        (
            bool(deck.curved),
            "Force_Vector_TwoBody with LINSPL, for bushings with a curve (the element seen with another "
            "force; LINSPL documented)",
        ),
        (bool(deck.curved), "Force_Bushing with zero stiffness along a curve (seen with positive ones)"),
        (
            any(body.velocity for body in deck.bodies),
            "Body_Rigid with velocities (seen with zeros; vm_id and wm_id, for global axes, documented)",
        ),
        (
            bool(deck.loads),
            "Force_Vector_OneBody with forces and torques (seen with torques alone, documented)",
        ),
        (bool(deck.contacts), "Force_Contact (documented, not seen in a deck)"),
        (
            any("CONTACT(" in request.expressions[0] for request in deck.requests),
            "Post_Request with sums of CONTACT (the function documented; how long a sum may be is not known)",
        ),
        (
            deck.run.static and deck.run.method == "MKEAM",
            "Param_Static by MKEAM, since no other static method takes contacts (documented)",
        ),
        (bool(deck.surfaces), "Reference_DeformSurface (documented, not seen in a deck)"),
        (
            bool(deck.surfaces),
            "Post_Graphic of a DeformSurface (names of attributes guessed; only the picture hangs on it)",
        ),
    )
    return [line for needed, line in rows if needed]

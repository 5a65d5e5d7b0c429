"""The notes above the text: units, contacts, what to check. MotionView ignores all before BeginMDL."""

from __future__ import annotations

import math

from mdlgen.altair.curves import TEXT_BEYOND
from mdlgen.altair.edges import edge_note
from mdlgen.altair.margin import margin_note
from mdlgen.altair.reactions import sensor_note
from mdlgen.backends.motionview.writer import script
from mdlgen.backends.motionview.writer.forms import unverified
from mdlgen.backends.motionview.writer.scene_rows import SceneView
from mdlgen.backends.motionview.writer.units import mdl_value, number
from mdlgen.model.curves import limit
from mdlgen.model.tables import Model

SHARE = (
    "  MotionSolve gives every pair the full stiffness. In the local run of mdlgen, share width lets",
    "  the boxes under one part share it by the width that each covers; share pair gives it to each too.",
)


COMMANDED = (
    "  Solver commands of tmplt_run give their numbers by keyword, from the data sets, and make a cylinder",
    "  the master surface (paper, 3.1). Panels of contacts show other numbers, which these commands replace.",
    "  That forces act at nodes, as in the paper, no command says : choose it in the panels, or run the",
    "  script that mdlgen mdl --script writes.",
)

FRAME = (
    "Bushings : MotionSolve has displacement and force in the axes of marker J; the local run of mdlgen has",
    "  the frame halfway between the two bodies. Both agree where the angle between these is small.",
)


def banner(model: Model, scene: SceneView) -> list[str]:
    """The lines of the header, without slashes."""
    gravity = ", ".join(number(mdl_value(g, "mm/ms^2")) for g in model.gravity.tolist())
    reasons = script.reasons(model, scene.set_contact)
    lines = [
        f"{model.name}: MotionView model, written by mdlgen",
        "",
        target_line(scene),
        "Units : mm, N, kg, s, rad; angles in data sets in degrees",
        f"Gravity : {gravity} mm/s2, set in ds_run, as the times and the longest step of the solver",
    ]
    lines += sheet_lines(model, scene)
    lines += curve_lines(model)
    lines += _contacts(model, scene)
    if reasons:
        lines += ["", "Companion script : run it once in the Python window after loading, because of"]
        lines += [f"  {reason}" for reason in reasons]
    return lines + unverified(scene)


def target_line(scene: SceneView) -> str:
    """For which version the text is."""
    other = "2025" if scene.target == "2021" else "2021"
    has = "with" if scene.target == "2021" else "without"
    return (
        f"Target : MotionView {scene.target}, Contact {has} words for flipped normals; else --target {other}"
    )


def sheet_lines(model: Model, scene: SceneView) -> list[str]:
    """One line for each sheet, and in which frame its bushings act."""
    lines = []
    for sheet, part in zip(scene.sheets, model.sheets, strict=True):
        joints = sum(len(group.bushes) for group in sheet.joints)
        lines.append(
            f"Sheet : {sheet.name}, {part.n_x} x {part.n_y} boxes, {part.layout}, {part.grid} grid, "
            f"{joints} bushings; its values are in ds_{sheet.name}"
        )
    return [*lines, *sensor_note(model), *(FRAME if len(model.bushings) else ())]


def curve_lines(model: Model) -> list[str]:
    """Lines that describe the measured curves of an MDL file."""
    curves = model.curves
    if not len(curves):
        return []
    lines = [
        "Curves : straight lines, within 1e-6 of the greatest force of the monotone cubics of the local run"
    ]
    for index, name in enumerate(curves.name):
        end = f"crv_{name} : measured to a strain of {number(limit(curves, index))}; "
        if curves.linear[index]:
            lines += [f"  {end}straight on to {number(TEXT_BEYOND)} times that"]
        else:
            lines += [f"  {end}the local run ends there,", "  MotionSolve does not : look at the elongations"]
    return lines


def share_lines(scene: SceneView) -> list[str]:
    """One line for each entry of the contacts."""
    found = []
    for contact in scene.contacts:
        parts = contact.label.partition(": ")[2]
        found.append(f"  ds_{contact.data_set} : share {contact.share}, {parts}")
    return found


def _contacts(model: Model, scene: SceneView) -> list[str]:
    if not scene.contacts:
        return []
    pairs = model.pairs
    lines = [
        f"Contacts : {pairs.possible} pairs possible, {len(pairs)} kept: those that can meet in the run, "
        f"with a margin of {number(pairs.margin)} mm",
        *(COMMANDED if scene.laws else ()),
        *SHARE,
        *edge_note(model),
    ]
    if len(pairs) < pairs.possible:
        lines += [
            "  Pairs are kept for the sheets where they start : to move or turn one beyond the margin,",
            "  write the text again, or write it with prune: false in the run, which keeps every pair.",
            *margin_note(model),
        ]
    for kind, parts in (("rollers", scene.rollers), ("plates", scene.planes)):
        if any(part.pressed for part in parts):
            lines.append(f"  Pressed {kind} start in equilibrium with the sheets as written, at real_start.")
    for roller in (part for part in model.rollers if part.rim is not None):
        assert roller.rim is not None
        lines += [
            f"  Rim of {roller.name} : each sector is shown by boxes, and has a contact of its own.",
            f"  The local run goes from one to the next over {number(math.degrees(roller.rim.blend))} deg; "
            "MotionSolve has both there.",
        ]
    return lines + share_lines(scene)

"""The notes above a system definition: how to bring it into a model, what is in it and what is not."""

from __future__ import annotations

from mdlgen.altair.edges import edge_note
from mdlgen.altair.margin import margin_note
from mdlgen.backends.motionview.writer import script
from mdlgen.backends.motionview.writer.banner import SHARE, curve_lines, share_lines, sheet_lines, target_line
from mdlgen.backends.motionview.writer.forms import unverified_system
from mdlgen.backends.motionview.writer.scene_rows import SystemView
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.tables import BOX_BOX, Model


def notes(model: Model, system: SystemView) -> list[str]:
    """The lines of the header, without slashes."""
    reasons = script.reasons(model, system.scene.set_contact, only="sheets")
    lines = [
        f"{system.name}: the sheets as a MotionView system definition, written by mdlgen",
        "",
        target_line(system.scene),
        "Units : mm, N, kg, s, rad; angles in data sets in degrees",
        *sheet_lines(model, system.scene),
        *curve_lines(model),
        *_way_in(system),
        *_left_out(model),
        *_contacts(model, system),
    ]
    if reasons:
        lines += ["", "Companion script : run it once with the system in place, because of"]
        lines += [f"  {reason}" for reason in reasons]
    return lines + unverified_system(system)


def _way_in(system: SystemView) -> list[str]:
    given = "".join(f", {a.given}" for a in system.attachments)
    lines = [
        "",
        "Into a model : add a system from this file in MotionView and pick its attachments there,",
        "  or write into the model, with the name of this file and the variables of your own bodies",
        f'  *Include("{system.name}_sheets.mdl")',
        f'  *System( {system.variable}, "{system.name}", {system.definition}{given} )',
    ]
    if system.attachments:
        lines.append("Attachments, with the variables that the scene or its whole text has for them :")
    return lines + [f"  {a.name} : {a.label}, {a.given}" for a in system.attachments]


def _left_out(model: Model) -> list[str]:
    own = model.contacts.of_machine
    between = [f"{model.contacts.part_a[k]} / {model.contacts.part_b[k]}" for k in own.nonzero()[0]]
    lines = ["", "Left out, as the business of your model : the machine, gravity, run settings"]
    if between:
        lines.append("  and the contacts between parts of the machine :")
        lines += [f"  {pair}" for pair in between]
    return lines


def _contacts(model: Model, system: SystemView) -> list[str]:
    scene, table, pairs = system.scene, model.contacts, model.pairs
    if not scene.contacts:
        return []
    external = len(model.external_pairs)
    possible = pairs.possible - int(table.of_machine.sum())
    meets = ", or of boxes of two sheets" if bool((table.kind == BOX_BOX).any()) else ""
    lines = ["", f"Contacts : {len(scene.pairs)} pairs of a box and a part of the machine{meets}"]
    if possible:
        lines += [
            f"  With parts of the scene {len(scene.pairs) - external} of {possible} are kept: those that can",
            f"  meet in its run, with a margin of {number(pairs.margin)} mm; prune: false keeps every pair.",
            *margin_note(model),
        ]
    if external:
        lines.append(f"  With bodies of your model all {external} stand here: where those are is not known.")
    return [*lines, *SHARE, *edge_note(model), *share_lines(scene)]

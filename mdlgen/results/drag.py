"""Drag of the machine on sheets: the friction that planes, guides and fixed meshes take from them.

Rollers, and meshes that turn with them, have a traction instead, see `results.torques`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mdlgen.model.tables import Floats, MachinePart, MeshPart, RollerPart
from mdlgen.results.result import RUBS

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def drags(result: Result, part: MachinePart) -> dict[str, Floats]:
    """Friction on each sheet that a part touches, summed over the contact points by its size [N], (t,).

    None of a part that has a traction, and where a result does not have friction.
    """
    if result.contact_friction is None or isinstance(part, RollerPart):
        return {}
    if isinstance(part, MeshPart) and part.on >= 0:
        return {}
    sheets = {sheet.name for sheet in result.model.sheets}
    found = {}
    contacts = result.model.contacts
    for row, (a, b) in enumerate(zip(contacts.part_a, contacts.part_b, strict=True)):
        other = b if a == part.name else a
        if part.name in (a, b) and other in sheets:
            found[other] = result.contact_friction[:, row, RUBS]
    return found

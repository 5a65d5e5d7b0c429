"""The parts of a scene at its start, in words, and the depth of those in contact in each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.checks import lints
from mdlgen.lints.lint import Lint
from mdlgen.lints.start import overlap
from mdlgen.model.overlaps.parts import rod
from mdlgen.model.parts.kinds import WITH_SHEET, kind_of
from mdlgen.model.parts.roller import KIND as ROLLER
from mdlgen.model.tables import (
    BOX_BOX,
    BOX_CYLINDER,
    CYLINDER_CYLINDER,
    EXTERNAL,
    Floats,
    Model,
    RollerPart,
)
from mdlgen.report.facts import facts

ROUND_OFF = 1e-9  # of places [mm]


@dataclass(frozen=True)
class Met:
    """One row of contacts as a run begins."""

    name: str  # name of the contact for the user
    one: str
    other: str
    deep: float | None  # [mm], below zero by how far two rounds are apart; None: not computed
    stiffness: float  # [N/mm^1.5]
    friction: tuple[float, float]  # static and dynamic
    restitution: float
    pairs: int | None  # number of stored pairs of bodies; None: searched for during the run

    @property
    def says(self) -> str:
        """The depth in words."""
        if self.deep is None:
            return "depth not computed"
        if 0.0 < abs(self.deep) < ROUND_OFF:
            return "just touching"
        if self.deep > 0.0:
            return f"{self.deep:.3g} mm deep"
        return f"{-self.deep:.3g} mm apart" if self.deep < 0.0 else "apart"


@dataclass(frozen=True)
class Known:
    """One part: what a label, a table and the box under the pointer show."""

    name: str
    kind: str
    at: tuple[float, float, float]  # where its name stands [mm]
    facts: tuple[str, ...]
    lints: tuple[Lint, ...]


def met(model: Model) -> list[Met]:
    """All contacts of a Model, in its order."""
    table, found = model.contacts, []
    for row, kind in enumerate(table.kind.tolist()):
        listed = model.external_pairs if kind == EXTERNAL else model.pairs
        kept = int(np.count_nonzero(listed.contact == row))
        found.append(
            Met(
                name=table.called(row),
                one=table.part_a[row],
                other=table.part_b[row],
                deep=None if kind == EXTERNAL else _deep(model, row, kind),
                stiffness=float(table.stiffness[row]),
                friction=(float(table.mu_static[row]), float(table.mu_dynamic[row])),
                restitution=float(table.restitution[row]),
                pairs=None if row in model.pairs.searched else kept,
            )
        )
    return found


def _deep(model: Model, row: int, kind: int) -> float | None:
    """Depth of the two parts of a contact in each other [mm]."""
    sheets = {sheet.name: sheet for sheet in model.sheets}
    one, name = model.contacts.part_a[row], model.contacts.part_b[row]
    if kind == BOX_BOX:
        return max(0.0, overlap(sheets[one], sheets[name]))
    part = next(p for p in model.machine if p.name == name)
    if kind in WITH_SHEET:
        return WITH_SHEET[kind].contact_depth(model, row, sheets[one], part)
    first, position = model.roller(one), model.bodies.position
    if kind == CYLINDER_CYLINDER:
        assert isinstance(part, RollerPart)
        if first.rim is not None or part.rim is not None:
            return None
        gap = position[part.body] - position[first.body]
        across = gap - first.axis * float(gap @ first.axis)
        return first.radius + part.radius - float(np.linalg.norm(across))
    shape = rod(first, position[first.body])
    into = kind_of(part).overlap(part, position[part.body], model.bodies.rotation[part.body])
    return max(0.0, into(shape))


def depths(model: Model) -> Floats:
    """Depth of each box of the sheets in a roller as the run begins [mm], (boxes,)."""
    found = np.zeros(sum(sheet.count for sheet in model.sheets))
    parts = {roller.name: roller for roller in model.rollers}
    for row in np.flatnonzero(model.contacts.kind == BOX_CYLINDER).tolist():
        mine = model.pairs.a[model.pairs.contact == row]
        if len(mine):
            deep = ROLLER.of_boxes(model, mine, parts[model.contacts.part_b[row]])
            found[mine] = np.maximum(found[mine], deep)
    return found


def known(model: Model) -> list[Known]:
    """Sheets, parts of the machine and probes, each with the lints that are about it."""
    about = _about(model)
    found = []
    for name, kind, at, said in facts(model):
        x, y, z = at.tolist()
        found.append(Known(name, kind, (x, y, z), tuple(said), about.get(name, ())))
    return found


def of_no_part(model: Model) -> list[Lint]:
    """The lints that are about no part."""
    about = {lint for found in _about(model).values() for lint in found}
    return [lint for lint in lints(model) if lint not in about]


def _about(model: Model) -> dict[str, tuple[Lint, ...]]:
    """Lints by the parts that they are about: of a contact both of its parts."""
    found: dict[str, list[Lint]] = {}
    names = {part.name for part in (*model.sheets, *model.machine, *model.probes, *model.reactions.sensors)}
    table = model.contacts
    for lint in lints(model):
        kind, _, rest = lint.where.partition(".")
        name = rest.partition(".")[0]
        if kind == "contacts":
            rows = [row for row in range(len(table)) if table.called(row) == name]
            parts = dict.fromkeys(p for row in rows for p in (table.part_a[row], table.part_b[row]))
        elif kind == "materials":
            parts = {}
        else:
            parts = {name: None} if name in names else {}
        for part in parts:
            found.setdefault(part, []).append(lint)
    return {name: tuple(some) for name, some in found.items()}

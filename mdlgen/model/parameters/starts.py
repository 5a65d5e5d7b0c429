"""Formulas for the places where pressed rollers touch and begin, over the values of an MDL file.

A roller that one contact holds, straight along its slide, begins d behind the place c where that contact
touches: its spring gives f + W - k (c + d - touch), W the weight along the slide, and the contact K d^1.5.
With P = f + W - k (c - touch) that is K d^1.5 + k d = P, a cubic equation of sqrt(d). With a = k/(3K) and
g = P/(2K) its root is sqrt(d) = C + a^2/C - a, C^3 = g - a^3 + sqrt(g (g - 2 a^3)); a text has P and C^2.

A spring that pushes less than g = 5/2 a^3, some 1e-7 mm of depth, counts as that.

A nip that has its sheet places its rollers in balance, whatever its force is: there they begin, and only the
touching place follows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from mdlgen.model.parameters.run import RUN
from mdlgen.model.press import balance
from mdlgen.model.tables import BOX_CYLINDER, CYLINDER_CYLINDER, Contacts, Floats, Parameter, SheetPart
from mdlgen.spec.nip import names_of
from mdlgen.spec.scene import Scene

FOLLOWING = ("push", "root", "touch", "start")  # rows of a data set that may follow
_STRAIGHT = 1e-9  # mm off the slide, or of a unit vector: round-off


@dataclass(frozen=True)
class Held:
    """The part that holds a pressed roller as the run begins."""

    name: str
    by: str  # a sheet or a roller; "": it begins where its nip has placed it
    entry: int  # of the contacts, whose stiffness holds it
    share: float  # of the contact's stiffness that counts
    first: str  # the roller that it touches ahead, "": none


def held(
    scene: Scene, name: str, sheets: tuple[SheetPart, ...], contacts: Contacts, start: tuple[float, float]
) -> Held | None:
    """The part that holds a roller; None where that is not exactly one contact straight ahead of it."""
    roller = scene.rollers[name]
    spec = roller.press
    if spec is None or roller.rim is not None or spec.stiffness == 0.0:
        return None
    if spec.start is not None or scene.gravity_profile is not None:
        return None
    if any(mesh.on == name for mesh in scene.meshes.values()):
        return None
    acts, first, way = [], "", math.inf
    for row in range(len(contacts)):
        parts = (contacts.part_a[row], contacts.part_b[row])
        if name not in parts:
            continue
        other = parts[0] if parts[1] == name else parts[1]
        if contacts.kind[row] == CYLINDER_CYLINDER:
            share = _of_roller(scene, name, other)
            if share is None:
                return None
            if share > 0.0:
                near = _touch(scene, name, other)
                first, way = (other, near) if near < way else (first, way)
                acts += [(other, row, share)] if start[1] > near else []
        elif contacts.kind[row] == BOX_CYLINDER:
            sheet = next(s for s in sheets if s.name == other)
            share = _of_sheet(scene, name, sheet, contacts.share[row] == "width")
            if share is None:
                return None
            if share > 0.0 and start[1] > _meets(scene, name, sheet.name):
                acts.append((other, row, share))
        else:
            return None
    if abs(start[1]) < _STRAIGHT and any(
        name in names_of(nip, scene.nips[nip].model_dump()) for nip in scene.nips
    ):
        return Held(name, "", -1, 0.0, first) if first else None
    if len(acts) != 1:
        return None
    by, row, share = acts[0]
    return Held(name, by, int(contacts.entry[row]), share, first)


def _of_roller(scene: Scene, name: str, other: str) -> float | None:
    """Part of the narrower width on which it meets another roller; None: not straight ahead."""
    roller, partner = scene.rollers[name], scene.rollers[other]
    assert roller.press is not None
    gap, axis = np.subtract(partner.center, roller.center), np.array(roller.axis)
    across = gap - axis * (gap @ axis)
    across -= np.array(roller.press.direction) * float(across @ roller.press.direction)
    if partner.rim is not None or partner.press is not None or np.linalg.norm(across) > _STRAIGHT:
        return None
    if abs(float(np.dot(roller.axis, roller.press.direction))) > _STRAIGHT:
        return None
    cylinder = balance.Cylinder(np.array(partner.center), partner.radius, partner.width, 1.0)
    return cylinder.share(np.array(roller.center), axis, roller.width)


def _of_sheet(scene: Scene, name: str, sheet: SheetPart, shared: bool) -> float | None:
    """Share of a flat sheet under it that counts; None where the sheet is not square to the slide."""
    roller = scene.rollers[name]
    assert roller.press is not None
    ways, axis = np.array(roller.press.direction), np.array(roller.axis)
    square = abs(abs(float(sheet.rotation[:, 2] @ ways)) - 1.0) < _STRAIGHT
    ahead = float(np.subtract(sheet.center, roller.center) @ ways) > 0.0
    shares = balance.covered_shares(sheet, np.array(roller.center), axis, roller.width, shared)
    if not shares:
        return 0.0
    plain = len(shares) == 1 and shares[0][1] == sheet.thickness
    return shares[0][0] if square and ahead and plain else None


def _along(scene: Scene, name: str, to: Floats | tuple[float, ...]) -> float:
    roller = scene.rollers[name]
    assert roller.press is not None
    return float(np.subtract(to, roller.center) @ np.array(roller.press.direction))


def _touch(scene: Scene, name: str, other: str) -> float:
    """Place where it touches another roller [mm]."""
    partner = scene.rollers[other]
    return _along(scene, name, partner.center) - scene.rollers[name].radius - partner.radius


def _meets(scene: Scene, name: str, sheet: str) -> float:
    """Place where it touches a sheet [mm]."""
    part = scene.sheets[sheet]
    return _along(scene, name, part.center) - scene.rollers[name].radius - 0.5 * part.thickness


def found(scene: Scene, what: Held) -> dict[str, float]:
    """Values that follow for a roller that is held so, by member, whatever else might touch it. They are the
    touching and starting place along its slide [mm], P [N] and C^2 [mm]; the start by bisection."""
    roller = scene.rollers[what.name]
    spec = roller.press
    assert spec is not None
    touch = _touch(scene, what.name, what.first) if what.first else 0.0
    if not what.by:
        return {"touch": touch}
    on_sheet = what.by in scene.sheets
    c = _meets(scene, what.name, what.by) if on_sheet else _touch(scene, what.name, what.by)
    stiff = what.share * scene.contacts[what.entry].stiffness
    carrier = spec.carrier_mass if spec.carrier_mass is not None else roller.mass / 1000
    weight = (roller.mass + carrier) * float(np.array(scene.gravity) @ np.array(spec.direction))
    least = 5.0 * spec.stiffness**3 / (27.0 * stiff**2)
    push = max(spec.preload + weight - spec.stiffness * (c - touch), least)
    a, g = spec.stiffness / (3.0 * stiff), push / (2.0 * stiff)
    root = (g - a**3 + math.sqrt(g * (g - 2.0 * a**3))) ** (2.0 / 3.0)
    low, high = 0.0, (push / stiff) ** (2.0 / 3.0)
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        less = stiff * middle**1.5 + spec.stiffness * middle < push
        low, high = (middle, high) if less else (low, middle)
    return {"touch": touch, "start": c + 0.5 * (low + high), "push": push, "root": root}


def followed(scene: Scene, what: Held, rows: list[Parameter]) -> list[Parameter]:
    """The rows of a text with those of a roller's start as formulas over others, and two more for them."""
    numbers, texts = found(scene, what), _texts(scene, what)
    made: list[Parameter] = []
    for row in rows:
        if row.data_set != what.name or row.member not in texts:
            made.append(row)
            continue
        if row.member == "start":
            push = "Push of its spring where that just touches (N)"
            made.append(Parameter(what.name, "push", push, numbers["push"], "N", None, "", texts["push"]))
            root = "Depth of its contact under it, before the spring gives"
            made.append(Parameter(what.name, "root", root, numbers["root"], "mm", None, "", texts["root"]))
        label = row.label.replace(", as written", "")
        made.append(replace(row, label=label, value=numbers[row.member], follows=texts[row.member]))
    return made


def _pull(ways: tuple[float, float, float]) -> str:
    """Gravity along a direction."""
    terms = [
        f" {'-' if way < 0.0 else '+'} "
        f"{'' if abs(way) == 1.0 else repr(abs(way)) + '*'}{reference(RUN, f'g_{axis}')}"
        for axis, way in zip("xyz", ways, strict=True)
        if way != 0.0
    ]
    return "".join(terms).removeprefix(" + ").strip()


def reference(data_set: str, member: str) -> str:
    """The name by which a formula has a value of a text."""
    return f"ds_{data_set}__{member}"


def _texts(scene: Scene, what: Held) -> dict[str, str]:
    """The formulas by member."""
    roller, name = scene.rollers[what.name], what.name
    spec = roller.press
    assert spec is not None

    def own(member: str) -> str:
        return reference(name, member)

    def along(other: str) -> str:
        ways = [(axis, way) for axis, way in zip("xyz", spec.direction, strict=True) if way != 0.0]
        return " + ".join(
            f"{'' if abs(way) == 1.0 else repr(abs(way)) + '*'}"
            + (
                f"({reference(other, axis)} - {own(axis)})"
                if way > 0.0
                else f"({own(axis)} - {reference(other, axis)})"
            )
            for axis, way in ways
        )

    touch = f"{along(what.first)} - {own('R')} - {reference(what.first, 'R')}" if what.first else "0 mm"
    if not what.by:
        return {"touch": touch}
    c = own("touch")
    if what.by in scene.sheets:
        c = f"({along(what.by)} - {own('R')} - {reference(what.by, 's')}/2)"
    elif what.by != what.first:
        c = f"({along(what.by)} - {own('R')} - {reference(what.by, 'R')})"
    stiff = reference(f"contact_{what.entry}", "k")
    stiff = stiff if what.share == 1.0 else f"{what.share!r}*{stiff}"
    weight = f" + ({own('M')} + {own('M_c')})*({_pull(spec.direction)})"
    least = f"5*{own('k')}^3/(27*({stiff})^2)"
    push = f"{own('f')}{weight}" + ("" if c == own("touch") else f" - {own('k')}*({c} - {own('touch')})")
    a, g = f"({own('k')}/(3*{stiff}))", f"({own('push')}/(2*{stiff}))"
    return {
        "touch": touch,
        "push": f"max({push}, {least})",
        "root": f"({g} - {a}^3 + sqrt({g}*({g} - 2*{a}^3)))^(2/3)",
        "start": f"{c} + (sqrt({own('root')}) + {a}^2/sqrt({own('root')}) - {a})^2",
    }

"""Lints over a Model: what is allowed, but is probably not what was meant. Each has a code and a remedy."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from mdlgen.check_cost import costly
from mdlgen.check_damping import damping
from mdlgen.check_parameters import parameters
from mdlgen.check_ways import against, apart, away, crosswise, sinks
from mdlgen.lint import Lint
from mdlgen.model import press
from mdlgen.model.overlap import Overlaps
from mdlgen.model.parts.kinds import WITH_SHEET
from mdlgen.model.parts.roller import FLAT
from mdlgen.model.rolling import rolls
from mdlgen.model.sheet_corners import corners
from mdlgen.model.sheet_overlap import SheetOverlaps
from mdlgen.model.sheet_pairs import linked
from mdlgen.model.tables import (
    BOX_BOX,
    BOX_CYLINDER,
    BOX_GUIDE,
    BOX_MESH,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    EXTERNAL,
    SUPPORT,
    Floats,
    Model,
    PlanePart,
    RollerPart,
    SheetPart,
)

PAPER_MODULUS = (100.0, 20000.0)  # MPa: from tissue to oriented board
DENSITY = (0.05, 20.0)  # g/cm^3: from foam to tungsten
MAX_ASPECT = 5.0  # of a box; a longer one bends in one way much more coarsely than in the other
COARSE_SMOOTHING, FINE_SMOOTHING = 0.05, 1e-4  # of the surface speed
# Of a sheet's thickness: half of it, and 1 % more, so that neither round-off of places is a
# finding nor a depth that reads as half of the thickness.
DEEP = 0.505
BESIDE = 1.5  # boxes that carry a roller, over those that it stands on: their neighbours tilt with them


def lints(model: Model) -> list[Lint]:
    """All findings, sorted by code and place."""
    found = {lint for check in CHECKS for lint in check(model)}
    return sorted(found, key=lambda lint: (lint.code, lint.where, lint.message))


def _modulus(model: Model) -> Iterator[Lint]:
    low, high = PAPER_MODULUS
    names = {s.name for s in model.sheets if s.count > 1}
    for row in model.parameters:
        if row.data_set in names and row.member in ("E_md", "E_cd") and not low <= row.value <= high:
            where = ".".join(map(str, row.path or (row.data_set, row.member)))
            yield Lint(
                "W101",
                where,
                f"{row.value:g} MPa is an unusual modulus for paper ({low:g} to {high:g} MPa)",
                "check the unit (MPa = N/mm^2)",
            )


def _aspect(model: Model) -> Iterator[Lint]:
    """A sheet with one box across is meant not to bend that way, so the shape of its boxes is no finding."""
    for sheet in model.sheets:
        if min(sheet.n_x, sheet.n_y) == 1:
            continue
        lengths = 2 * model.bodies.half[sheet.first : sheet.first + sheet.count, :2]
        aspects = np.maximum(lengths[:, 0] / lengths[:, 1], lengths[:, 1] / lengths[:, 0])
        worst = int(np.argmax(aspects))
        (d_x, d_y), aspect = lengths[worst].tolist(), float(aspects[worst])
        if aspect > MAX_ASPECT:
            counts, one = [sheet.n_x, sheet.n_y], [sheet.n_x, sheet.n_y]
            counts[int(d_y > d_x)] = math.ceil(counts[int(d_y > d_x)] * aspect / MAX_ASPECT)
            one[int(d_y > d_x)] = 1
            yield Lint(
                "W102",
                f"sheets.{sheet.name}.boxes",
                f"boxes of {d_x:.3g} mm x {d_y:.3g} mm are {aspect:.3g} times as long as wide",
                f"take {counts} boxes, or {one} where the sheet bends one way only",
            )


def _idle_in_plane(model: Model) -> Iterator[Lint]:
    for sheet in model.sheets:
        if sheet.layout == "plate" and sheet.in_plane and sheet.count > 1:
            yield Lint(
                "W115",
                f"sheets.{sheet.name}.layout",
                "k_tz of its material does not act in layout plate, where it follows from E_md and E_cd",
                "leave k_tz out, or take another layout",
            )


def _idle_clamp(model: Model) -> Iterator[Lint]:
    touched = set(model.contacts.part_a)
    for sheet in model.sheets:
        boxes = slice(sheet.first, sheet.first + sheet.count)
        acts = (
            np.any(model.gravity)
            or any(sheet.first <= body < sheet.first + sheet.count for body in model.loads.body)
            or np.any(model.bodies.velocity[boxes])
            or np.any(model.bodies.spin[boxes])
            or sheet.name in touched
        )
        if sheet.clamp is not None and not acts:
            yield Lint(
                "W103",
                f"sheets.{sheet.name}.clamp",
                "nothing acts on the clamped sheet: no gravity, load or contact",
                "give gravity, a load or a contact",
            )


def _facets(model: Model) -> Iterator[Lint]:
    for _, sheet, roller in _nips(model):
        if sheet.count == 1:
            continue
        across = [abs(float(roller.axis @ sheet.rotation[:, k])) for k in range(2)]
        axis = 0 if across[0] <= across[1] else 1
        length = float(2 * model.bodies.half[sheet.first : sheet.first + sheet.count, axis].max())
        if roller.radius < length / 2:
            yield Lint(
                "W104",
                f"rollers.{roller.name}.radius",
                f"radius {roller.radius:g} mm is below half a box ({length / 2:.3g} mm) of {sheet.name}: "
                "flat boxes cannot follow the roller",
                "use more boxes along the roller's circumference",
            )


def _deep_nip(model: Model) -> Iterator[Lint]:
    for row, sheet, roller in _nips(model):
        if roller.press is None:
            continue
        depth = (roller.press.preload / float(model.contacts.stiffness[row])) ** (2 / 3)
        if _deep(depth, sheet):
            yield Lint(
                "W105",
                f"contacts.{model.contacts.called(row)}.stiffness",
                f"the preload {roller.press.preload:g} N of {roller.name} presses {depth:.3g} mm deep, "
                f"more than {sheet.thickness / 2:g} mm, half of the thickness of {sheet.name}: "
                "the rollers meet through it",
                "raise the stiffness or lower the preload",
            )


def _deep_stack(model: Model) -> Iterator[Lint]:
    """Sheets under a pressed roller that it pushes too far into each other, or into a plate, as a run begins:
    there the roller is in balance with the sheet that it touches, and that sheet with nothing below it."""
    sheets, planes = {s.name: s for s in model.sheets}, {p.name: p for p in model.planes}
    groups, table = linked(list(sheets), model.contacts), model.contacts
    nips = np.flatnonzero(table.kind == CYLINDER_CYLINDER).tolist()
    nipped = {name for row in nips for name in (table.part_a[row], table.part_b[row])}
    for _, touched, roller in _nips(model):
        spring = roller.press
        if spring is None or spring.preload <= 0.0:
            continue
        for row in np.flatnonzero(np.isin(table.kind, (BOX_BOX, BOX_PLANE))).tolist():
            one, name = sheets[table.part_a[row]], table.part_b[row]
            below = sheets.get(name)
            on_plane = name in planes and roller.name not in nipped and _faces(planes[name], spring.direction)
            if one.name not in groups[touched.name] or not (below or on_plane):
                continue
            both = [sheet for sheet in (one, below) if sheet is not None]
            boxes = BESIDE * min(_boxes_under(sheet, roller) for sheet in both)
            if boxes == 0:
                continue
            thin = min(both, key=lambda sheet: sheet.thickness)
            # a constant force F on k z^1.5 is stopped where its work F z is 0.4 k z^2.5
            wanted = 2.5 * spring.preload / (boxes * (0.5 * thin.thickness) ** 1.5)
            stiffness = float(table.stiffness[row])
            if stiffness < wanted:
                depth = (2.5 * spring.preload / (boxes * stiffness)) ** (2 / 3)
                yield Lint(
                    "W122",
                    f"contacts.{table.called(row)}.stiffness",
                    f"as the run begins, the preload {spring.preload:g} N of {roller.name} pushes {one.name} "
                    f"some {depth:.2g} mm into {name}, more than half of the thickness of {thin.name}",
                    f"give a stiffness of {wanted:.3g} N/mm^1.5 or more, or less preload; a smaller run.step "
                    "does not help",
                )


def _faces(plane: PlanePart, direction: Floats) -> bool:
    """Whether what moves along a direction comes to the face of a plane."""
    return float(plane.normal @ direction) < -1.0 + FLAT


def _boxes_under(sheet: SheetPart, roller: RollerPart) -> float:
    """How many boxes of a sheet, flat where it starts, a roller stands on."""
    shares = press.covered_shares(sheet, roller.center, roller.axis, roller.width, False)
    return sum(share for share, _ in shares)


def _smoothing(model: Model) -> Iterator[Lint]:
    speeds = {r.name: abs(r.speed) * r.radius for r in model.rollers if r.speed}
    contacts = model.contacts
    for row in range(len(contacts)):
        own = [speeds[p] for p in (contacts.part_a[row], contacts.part_b[row]) if p in speeds]
        speed = max(own or speeds.values(), default=0.0)
        if speed == 0.0:
            continue
        coarse = max(float(contacts.smoothing[row]), float(contacts.stiction_velocity[row]))
        fine = min(float(contacts.smoothing[row]), float(contacts.stiction_velocity[row]))
        where = f"contacts.{contacts.called(row)}.smoothing"
        message = f"of the surface speed {speed * 1e3:.4g} mm/s"
        if coarse > COARSE_SMOOTHING * speed:
            yield Lint(
                "W106",
                where,
                f"{coarse * 1e3:g} mm/s is {coarse / speed:.2g} {message}: the sheet creeps",
                f"use {COARSE_SMOOTHING * speed * 1e3:.2g} mm/s or less",
            )
        if fine < FINE_SMOOTHING * speed:
            yield Lint(
                "W107",
                where,
                f"{fine * 1e3:g} mm/s is {fine / speed:.2g} {message}: Newton converges slowly",
                f"use {FINE_SMOOTHING * speed * 1e3:.2g} mm/s or more unless creep below that matters",
            )


def _idle_rolling(model: Model) -> Iterator[Lint]:
    contacts = model.contacts
    for entry in sorted(set(contacts.entry[contacts.rolling > 0.0].tolist())):
        rows = np.flatnonzero(contacts.entry == entry).tolist()
        if not any(rolls(model, row) for row in rows):
            one, two = contacts.part_a[rows[0]], contacts.part_b[rows[0]]
            yield Lint(
                "W125",
                f"contacts.{contacts.called(rows[0])}.rolling_resistance",
                f"{contacts.rolling[rows[0]]:g} between {one} and {two} does nothing: neither is a roller",
                "leave it out, or name a contact with a roller",
            )


def _idle_roller(model: Model) -> Iterator[Lint]:
    contacts = model.contacts
    rubs = (contacts.mu_static > 0.0) | (contacts.mu_dynamic > 0.0)
    for roller in model.rollers:
        own = np.array(
            [roller.name in pair for pair in zip(contacts.part_a, contacts.part_b, strict=True)], bool
        )
        if roller.speed is None and np.any(own) and not np.any(rubs & own):
            row = int(np.argmax(own))
            yield Lint(
                "W126",
                f"contacts.{contacts.called(row)}.friction",
                f"{roller.name} turns freely and none of its contacts has friction, so nothing turns it",
                "give friction, as friction: 0.5, or a drive",
            )


def _idle_drive(model: Model) -> Iterator[Lint]:
    for roller in model.rollers:
        where = f"rollers.{roller.name}.drive"
        if roller.speed == 0.0:
            yield Lint(
                "W108",
                f"{where}.{'speed' if roller.profile is None else 'profile'}",
                "the drive holds the roller still (speed 0)",
                "leave drive out for a roller that turns freely, or give a speed",
            )
        elif roller.speed is not None and roller.ramp > model.run.duration and model.run.analysis != "static":
            yield Lint(
                "W113",
                f"{where}.ramp",
                f"the ramp of {roller.ramp:g} ms is longer than the run of {model.run.duration:g} ms",
                "run longer, or ramp faster",
            )
        way = roller.one_way
        senses = np.sign(roller.corners[:, 1])
        if way is not None and roller.speed is not None and np.any(senses == -way.direction):
            yield Lint(
                "W117",
                f"rollers.{roller.name}.one_way.direction",
                f"the drive turns in sense {-way.direction}, in which the clutch only holds the roller back: "
                "it never drives",
                "give the direction the sign of the speed",
            )
        late = [] if roller.profile is None else roller.profile[:, 0] > model.run.duration
        if np.any(late) and model.run.analysis != "static":
            first = int(np.argmax(late))
            yield Lint(
                "W113",
                f"{where}.profile.{first}",
                f"the corner at {roller.corners[first, 0]:g} ms is after the end, {model.run.duration:g} ms",
                "run longer, or leave out what comes after the run",
            )


def _untouched(model: Model) -> Iterator[Lint]:
    parts = {*model.contacts.part_a, *model.contacts.part_b}
    parts |= {model.rollers[m.on].name for m in model.meshes if m.on >= 0 and m.name in parts}
    if not (model.rollers or model.planes or model.guides or model.meshes or model.externals):
        return
    for sheet in model.sheets:
        if sheet.name not in parts:
            yield Lint(
                "W109",
                f"sheets.{sheet.name}",
                "the sheet has no contact with any roller, plane or guide of the scene",
                f"add to contacts like {{between: [{sheet.name}, ...], stiffness: 300 N/mm^1.5, "
                "friction: 0.5}",
            )
    machine = (
        *(("rollers", r) for r in model.rollers),
        *(("planes", p) for p in model.planes),
        *(("guides", g) for g in model.guides),
        *(("meshes", m) for m in model.meshes),
        *(("parts", e) for e in model.externals),
    )
    for kind, part in machine:
        if part.name not in parts:
            yield Lint(
                "W111",
                f"{kind}.{part.name}",
                "the part has no contact, so it does nothing",
                "add a contact, or leave the part out",
            )


def _free_static(model: Model) -> Iterator[Lint]:
    if model.run.analysis != "static":
        return
    sides = zip(model.contacts.part_a, model.contacts.kind, strict=True)
    # what such a part holds is not known
    unknown = {sheet for sheet, kind in sides if kind in (EXTERNAL, BOX_GUIDE, BOX_MESH)}
    for index, sheet in enumerate(model.sheets):
        free = 6 - _held(model, index, sheet)
        if sheet.clamp is None and free > 0 and sheet.name not in unknown:
            yield Lint(
                "W110",
                f"sheets.{sheet.name}",
                f"in a static run the sheet is free to move in {free} of 6 ways as a rigid body",
                "clamp an edge, or support enough points",
            )


def _held(model: Model, index: int, sheet: SheetPart) -> int:
    """Rigid-body motions of a sheet that supports and contacts hold: the rank of their directions."""
    rows: list[Floats] = []

    def hold(point: Floats, direction: Floats) -> None:
        arm = (point - sheet.center) / max(sheet.size)
        rows.append(np.concatenate([direction, np.cross(arm, direction)]))

    bushings = model.bushings
    for k in np.flatnonzero((bushings.kind == SUPPORT) & (bushings.sheet == index)):
        for axis in np.flatnonzero(bushings.k[k, :3]):
            hold(bushings.origin[k], bushings.axes[k][:, axis])
    for _, part, roller in _nips(model):
        if part is sheet:
            for end in (-0.5, 0.5):
                hold(
                    model.bodies.position[roller.body] + end * roller.width * roller.axis,
                    sheet.rotation[:, 2],
                )
    planes = {p.name: p for p in model.planes}
    for row in np.flatnonzero(model.contacts.kind == BOX_PLANE):
        if model.contacts.part_a[row] == sheet.name:
            for corner in corners(sheet):
                hold(corner, planes[model.contacts.part_b[row]].normal)
    return int(np.linalg.matrix_rank(np.array(rows), tol=1e-9)) if rows else 0


def _interference(model: Model) -> Iterator[Lint]:
    sheets, parts = {s.name: s for s in model.sheets}, {part.name: part for part in model.machine}
    for row, number in enumerate(model.contacts.kind.tolist()):
        one, other = model.contacts.part_a[row], model.contacts.part_b[row]
        if number == BOX_BOX:
            two = (sheets[one], sheets[other])
            thin, thick = two if two[0].thickness <= two[1].thickness else two[::-1]
            depth = _overlap(*two)
            if _deep(depth, thin):
                yield _deep_start(model, row, f"sheets.{thick.name}.center", thick.name, depth, thin)
        elif number in WITH_SHEET:
            kind, sheet, part = WITH_SHEET[number], sheets[one], parts[other]
            depth = kind.depth_at_start(model, sheet, part)
            if _deep(depth, sheet):
                yield _deep_start(model, row, kind.place(part), part.name, depth, sheet)


def _overlap(one: SheetPart, two: SheetPart) -> float:
    """How deep two flat sheets are in each other at the start [mm]; 0 where they are not parallel."""
    normal = one.rotation[:, 2]
    if abs(float(normal @ two.rotation[:, 2])) < 1 - FLAT**2:
        return 0.0
    first, second = corners(one), corners(two)
    for axis in (*one.rotation.T[:2], *two.rotation.T[:2]):
        a, b = first @ axis, second @ axis
        if max(a.min(), b.min()) >= min(a.max(), b.max()):
            return 0.0
    return 0.5 * (one.thickness + two.thickness) - abs(float((two.center - one.center) @ normal))


def _deep(depth: float, sheet: SheetPart) -> bool:
    """Whether a part is deeper in a sheet than half of its thickness."""
    return depth > DEEP * sheet.thickness


def _deep_start(model: Model, row: int, where: str, part: str, depth: float, sheet: SheetPart) -> Lint:
    force = float(model.contacts.stiffness[row]) * depth**1.5
    return Lint(
        "W112",
        where,
        f"{part} starts {depth:.3g} mm inside {sheet.name}, more than "
        f"{sheet.thickness / 2:g} mm, half of its thickness: it is thrown off with {force:.3g} N",
        "move the part out of the sheet",
    )


def _density(model: Model) -> Iterator[Lint]:
    for sheet in model.sheets:
        volume = sheet.outline[0] * sheet.outline[1] * sheet.thickness / 1e3  # cm^3
        density = sheet.derived["m"] * sheet.count / volume
        if not DENSITY[0] <= density <= DENSITY[1]:
            yield Lint(
                "W114",
                f"sheets.{sheet.name}.mass",
                f"{density:.3g} g/cm^3 is not in {DENSITY[0]:g} to {DENSITY[1]:g}; paper has some 0.8 g/cm^3",
                "check the units of mass, size and thickness",
            )


def _nips(model: Model) -> Iterator[tuple[int, SheetPart, RollerPart]]:
    """(row of contacts, sheet, roller) of every sheet-roller pair."""
    sheets = {s.name: s for s in model.sheets}
    rollers = {r.name: r for r in model.rollers}
    for row in np.flatnonzero(model.contacts.kind == BOX_CYLINDER):
        yield int(row), sheets[model.contacts.part_a[row]], rollers[model.contacts.part_b[row]]


def _guessed_bending(model: Model) -> Iterator[Lint]:
    for sheet in model.sheets:
        given = {p.member for p in model.parameters if p.data_set == sheet.name}
        ways = [way for way, names in (("x", {"k_ty", "D_md"}), ("y", {"k_tx", "D_cd"})) if not names & given]
        if ways and sheet.count > 1:
            yield Lint(
                "W116",
                f"sheets.{sheet.name}.material",
                f"bending along {' and '.join(ways)} is guessed from modulus and thickness, E s^3/12; "
                "paper is softer or stiffer by its layers",
                "measure how far it hangs, and let mdlgen calibrate find D_md and D_cd",
            )


def _unfaced(model: Model) -> Iterator[Lint]:
    """Pressed rollers that nothing keeps from going through the roller that they are pressed towards."""
    known = {frozenset(pair) for pair in zip(model.contacts.part_a, model.contacts.part_b, strict=True)}
    carrying = {model.rollers[m.on].name for m in model.meshes if m.on >= 0}
    for roller in model.rollers:
        for other in model.rollers:
            named = frozenset((roller.name, other.name)) in known
            if roller.press is None or other is roller or named or {roller.name, other.name} & carrying:
                continue
            way = other.center - roller.center
            ahead, along = float(way @ roller.press.direction), float(way @ roller.axis)
            aside = float(np.linalg.norm(way - ahead * roller.press.direction - along * roller.axis))
            if (
                abs(along) < 0.5 * (roller.width + other.width)
                and aside < 0.5 * min(roller.radius, other.radius)
                # near enough for a nip
                and 0.0 < ahead < roller.reach + other.reach + 0.5 * min(roller.radius, other.radius)
            ):
                yield Lint(
                    "W118",
                    f"rollers.{roller.name}.press",
                    f"it presses towards {other.name} and has no contact with it, so it goes through it",
                    f"add to contacts {{between: [{roller.name}, {other.name}], stiffness: 30 N/mm^1.5, "
                    "friction: 0.5}",
                )


def _unmet(model: Model) -> Iterator[Lint]:
    """Rollers and plates, guides or meshes that come into each other and have no contact."""
    for pair in Overlaps(model).ahead():
        roller, part = pair.roller.name, pair.part.name
        yield Lint(
            "W119",
            f"rollers.{roller}",
            f"it comes into {model.called(pair.part.body)} and has no contact with it: a run ends where they "
            "overlap",
            f"add to contacts {{between: [{roller}, {part}], stiffness: 30 N/mm^1.5, friction: 0.5}}",
        )


def _on_each_other(model: Model) -> Iterator[Lint]:
    """Sheets that lie on or in another sheet, a roller, a plane or a guide and have no contact with it."""
    sheets, parts = SheetOverlaps(model).begin()
    says = "it lies on {}, or in it, and has no contact with it: the two go through each other"
    remedy = "add to contacts {{between: [{}, {}], stiffness: 300 N/mm^1.5, friction: 0.5}}"
    for one, two in sheets:
        message, what = says.format(f"sheet {two.name}"), remedy.format(one.name, two.name)
        yield Lint("W120", f"sheets.{one.name}", message, what)
    for sheet, part in parts:
        message, what = says.format(model.called(part.body)), remedy.format(sheet.name, part.name)
        yield Lint("W121", f"sheets.{sheet.name}", message, what)


CHECKS: tuple[Callable[[Model], Iterator[Lint]], ...] = (
    _modulus,
    _aspect,
    _idle_in_plane,
    _idle_clamp,
    _facets,
    _deep_nip,
    _deep_stack,
    _smoothing,
    _idle_rolling,
    _idle_roller,
    _idle_drive,
    _untouched,
    _unfaced,
    _unmet,
    _on_each_other,
    _free_static,
    _interference,
    _density,
    _guessed_bending,
    damping,
    parameters,
    costly,
    against,
    away,
    apart,
    sinks,
    crosswise,
)

"""Finds the plane in which a scene is its own mirror image."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.symmetry.mirror import Mirror
from mdlgen.mechanics.frame import Motion
from mdlgen.model.rotations import matrices
from mdlgen.model.tables import BOX_BOX, Floats, GuidePart, Ints, Model, PlanePart, RollerPart, SheetPart

# How well both sides must agree, relative to the largest number that is compared, and forces that sum up.
SAME, SAME_FORCE = 1e-9, 1e-7
# Motion for the comparison of forces: mm, rad, mm/ms, rad/ms.
MOVED, TURNED = 1e-3, 1e-2

Part = RollerPart | PlanePart | GuidePart


def find(model: Model, system: System) -> Mirror | None:
    """The plane, or None: there is none, or nothing touches. What is free keeps its momentum to round-off,
    which one side alone would not.

    It goes through the middle of the sheets, between boxes, along one of their edges. Everything is compared:
    bodies, what holds and drives them, contacts, loads, and the forces of the joints of a random state.
    """
    if not len(model.pairs) or not model.run.symmetry:
        return None
    for axis in (1, 0):
        normal = model.sheets[0].rotation[:, axis]
        mirror = _plane(model, normal, float(normal @ model.sheets[0].center))
        mirror = mirror and _contacts(model, mirror)
        if mirror is not None and _loads(model, mirror) and _joints(model, system, mirror):
            return mirror
    return None


def _same(a: Any, b: Any) -> bool:
    """Equal but for round-off."""
    if isinstance(a, (float, np.ndarray)) and isinstance(b, (float, np.ndarray)):
        a, b = np.asarray(a), np.asarray(b)
        if a.shape != b.shape:
            return False
        most = max(np.abs(a).max(initial=0.0), np.abs(b).max(initial=0.0))
        return bool(np.abs(a - b).max(initial=0.0) <= SAME * most)
    return bool(a == b)


def _plane(model: Model, normal: Floats, at: float) -> Mirror | None:
    """The Mirror of a plane in which all bodies have images; their contacts and joints may differ."""
    table, count = model.bodies, len(model.bodies.name)
    itself = np.arange(count)
    boxes = itself < sum(s.count for s in model.sheets)
    signs, none = np.ones((count, 3)), np.zeros(count, bool)
    blank = Mirror(normal, at, itself, signs, none, boxes, itself[:0], np.zeros(0), np.zeros((0, 3)), False)
    image = np.full(count, -1)
    for sheet in model.sheets:
        image[sheet.first : sheet.first + sheet.count] = _grid(blank, sheet)
    parts: tuple[Part, ...] = (*model.rollers, *model.planes, *model.guides)
    for part in parts:
        image[part.body] = next((o.body for o in parts if _alike(blank, model, part, o)), -1)
    if (image < 0).any() or (image[image] != itself).any():
        return None
    # the size of the scene is what places are compared by
    size = max(1.0, float(np.abs(table.position - table.position[0]).max(initial=0.0)))
    if np.abs(blank.places(table.position) - table.position[image]).max() > SAME * size:
        return None
    between = np.einsum("nji,njk->nik", blank.axes(table.rotation), table.rotation[image])
    signs = np.einsum("nii->ni", between)
    if np.abs(np.abs(between[boxes]) - np.eye(3)).max() > SAME or abs(normal @ model.gravity) > SAME * float(
        np.linalg.norm(model.gravity)
    ):
        return None
    gone = (image != itself) & ((table.position @ normal) - at > 0.0)
    mirror = replace(blank, image=image, signs=np.sign(signs), gone=gone)
    same = (
        _same(blank.seen(table.velocity), table.velocity[image])
        and _same(-blank.seen(table.spin), table.spin[image])
        and all(_same(v, v[image]) for v in (table.mass, table.inertia, table.half, table.friction))
        and bool((table.fixed == table.fixed[image]).all())
        and _sides(mirror, model)
    )
    return mirror if same else None


def _grid(mirror: Mirror, sheet: SheetPart) -> Ints:
    """Images of the boxes of a sheet; -1 where it is not cut between boxes."""
    grid = sheet.first + np.arange(sheet.count).reshape(sheet.n_y, sheet.n_x)
    along = np.abs(sheet.rotation.T @ mirror.normal)
    if along[1] > 1.0 - SAME and sheet.n_y % 2 == 0:
        return grid[::-1].ravel()
    if along[0] > 1.0 - SAME and sheet.n_x % 2 == 0:
        return grid[:, ::-1].ravel()
    return np.full(sheet.count, -1)


def _sides(mirror: Mirror, model: Model) -> bool:
    """Whether the free sides of boxes are those of their images. An axis along the normal shows its two ends
    exchanged, which box axes, being right-handed, take for their own."""
    exposed = model.bodies.exposed
    for sheet in model.sheets:
        own = slice(sheet.first, sheet.first + sheet.count)
        turn = [1, 0, 2, 3] if abs(float(sheet.rotation[:, 0] @ mirror.normal)) > 0.5 else [0, 1, 3, 2]
        if (exposed[own][:, turn] != exposed[mirror.image[own]]).any():
            return False
    return True


def _alike(mirror: Mirror, model: Model, one: Part, two: Part) -> bool:
    """Whether one part of the machine is seen as the other one."""
    if type(one) is not type(two):
        return False
    size = max(1.0, float(np.abs(one.center).max()))
    if np.abs(mirror.places(one.center) - two.center).max() > SAME * size:
        return False
    if isinstance(one, RollerPart) and isinstance(two, RollerPart):
        way = -float(mirror.seen(one.axis) @ two.axis)  # a turn is seen the other way round
        # an arm in the plane is not cut, and angles that are counted the other way are not compared
        whole = (one.arm is None or one is not two) and (one.rim is None or way > 0.0)
        if abs(abs(way) - 1.0) > SAME or not whole:
            return False
        return _roller(one, float(np.sign(way)), mirror) == _roller(two, 1.0, None)
    if isinstance(one, PlanePart):
        frames = [model.bodies.rotation[part.body] for part in (one, two)]
        square = np.abs(mirror.axes(frames[0][None])[0].T @ frames[1])
        own: dict[str, Any] = {"normal": mirror.seen(one.normal)}
        if one.press is not None:
            own["press"] = replace(one.press, direction=mirror.seen(one.press.direction))
        return bool(np.abs(square - np.eye(3)).max() < SAME) and _values_of(one, own) == _values_of(two, {})
    assert isinstance(one, GuidePart), "there are no other parts"
    # the outline of a guide lies in the mirror, its width goes across
    flat = np.abs(one.axes[:, :2].T @ mirror.normal).max() < SAME
    return bool(flat) and _values_of(one, {}) == _values_of(two, {})


def _roller(part: RollerPart, way: float, mirror: Mirror | None) -> tuple[Any, ...]:
    """What a roller does, in the sense of an axis that is turned by `way`."""
    clutch = part.one_way and replace(part.one_way, direction=int(way * part.one_way.direction))
    press = part.press
    if press is not None and mirror is not None:
        press = replace(press, direction=mirror.seen(press.direction))
    arm = part.arm
    if arm is not None and mirror is not None:
        arm = replace(arm, pivot=mirror.places(arm.pivot), center=mirror.places(arm.center))
    own = {
        "axis": 0.0,
        "speed": part.speed if part.speed is None else way * part.speed,
        "profile": part.profile if part.profile is None else part.profile * (1.0, way),
        "one_way": clutch,
        "press": press and _values_of(press, {}),
        "arm": arm and (_rounded(arm.center), *_values_of(replace(arm, torque=way * arm.torque), {})),
    }
    return _values_of(part, own)


_PLACE = ("name", "body", "center")


def _values_of(part: Any, instead: dict[str, Any]) -> tuple[Any, ...]:
    """All fields of a part but its name and its place, rounded to be compared."""
    values = (instead.get(f.name, getattr(part, f.name)) for f in fields(part) if f.name not in _PLACE)
    return tuple(_rounded(v) for v in values)


def _rounded(value: Any) -> Any:
    """A value that is equal to others but for round-off; what is not a number, as a sector has that goes by
    its roller, is equal too."""
    if isinstance(value, np.ndarray):
        most = float(np.nanmax(np.abs(value), initial=0.0)) or 1.0
        return (_rounded(most), *(_rounded(v) for v in (np.round(value / most, 9) + 0.0).ravel().tolist()))
    if is_dataclass(value):
        return _values_of(value, {})
    if isinstance(value, (list, tuple)):
        return tuple(_rounded(v) for v in value)
    if isinstance(value, float):
        return None if math.isnan(value) else float(f"{value:.9e}") + 0.0
    return value


# columns of Contacts that say which contact it is, not how it acts
_NO_LAW = ("entry", "part_a", "part_b", "name")


def _contacts(model: Model, mirror: Mirror) -> Mirror | None:
    """The Mirror with the rows of contacts, where each row has an image with the same law, and no box reaches
    a part on the other side. Boxes of two sheets meet on one side or on the other, as both are cut between
    boxes."""
    table, image = model.contacts, mirror.image
    parts = (*model.rollers, *model.planes, *model.guides)
    place = {part.name: part.body for part in parts}
    names = {part.body: part.name for part in parts}
    seen = {name: names[int(image[body])] for name, body in place.items()}
    ends = list(zip(table.part_a, table.part_b, strict=True))
    columns = [getattr(table, f.name) for f in fields(table) if f.name not in _NO_LAW]
    laws = list(zip(*(c.tolist() if isinstance(c, np.ndarray) else c for c in columns), strict=True))
    rows = {(*pair, law): row for row, (pair, law) in enumerate(zip(ends, laws, strict=True))}
    row_of_image = np.array(
        [rows.get((seen.get(a, a), seen.get(b, b), laws[row]), -1) for row, (a, b) in enumerate(ends)]
    )
    if (row_of_image < 0).any():
        return None
    own = image == np.arange(len(image))
    sheets = bool((table.kind == BOX_BOX).any())
    listed = table.kind[model.pairs.contact] != BOX_BOX
    a, b = model.pairs.a[listed], model.pairs.b[listed]
    across = (mirror.gone[a] != mirror.gone[b]) & ~own[a] & ~own[b]
    # a part that keeps off the plane is out of reach of the boxes on the other side, which a run watches
    clear = max(sheet.thickness for sheet in model.sheets)
    reached = {part.body for part in parts if not _off(mirror, part) > clear}
    if not reached.isdisjoint([*a[across].tolist(), *b[across].tolist()]):
        return None
    itself = np.arange(len(ends))
    far = np.array([any(mirror.gone[place[n]] for n in pair if n in place) for pair in ends])
    times = np.where(row_of_image == itself, 2.0, 1.0)
    apart = sheets or bool(across.any())
    senses = np.array([_senses(mirror, model, *pair) for pair in ends]).reshape(-1, 3)
    return replace(mirror, rows=np.where(far, row_of_image, itself), times=times, senses=senses, apart=apart)


def _senses(mirror: Mirror, model: Model, one: str, two: str) -> tuple[float, float, float]:
    """Whether the image of a part of each row turns as that turns about its axis, 1, or the other way, -1;
    and the image of the roller along whose surface friction counts."""
    rollers = {roller.body: roller for roller in model.rollers}
    axes = {roller.name: roller.axis for roller in model.rollers}
    image = {roller.name: rollers[int(mirror.image[roller.body])].axis for roller in model.rollers}

    def way(name: str) -> float:
        return -float(np.sign(mirror.seen(axes[name]) @ image[name])) if name in axes else 1.0

    return way(one), way(two), way(two) if two in axes else way(one)


def _off(mirror: Mirror, part: Part) -> float:
    """How far a part keeps off the plane [mm]."""
    away = abs(float(mirror.normal @ part.center) - mirror.at)
    if isinstance(part, RollerPart):
        along = min(1.0, abs(float(mirror.normal @ part.axis)))
        return away - 0.5 * part.width * along - part.radius * math.sqrt(1.0 - along * along)
    return away - 0.5 * part.width if isinstance(part, GuidePart) else -math.inf


def _loads(model: Model, mirror: Mirror) -> bool:
    """Whether what is loaded is seen as loaded alike, wherever it turns."""
    table, count = model.loads, len(mirror.image)
    force, moment, lever = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3, 3))
    np.add.at(force, table.body, table.force)
    np.add.at(moment, table.body, table.moment)
    np.add.at(lever, table.body, table.local[:, :, None] * table.force[:, None, :])
    turned = mirror.signs[:, :, None] * mirror.seen(lever)
    image = mirror.image
    return (
        _same(mirror.seen(force), force[image])
        and _same(-mirror.seen(moment), moment[image])
        and _same(turned[mirror.boxes], lever[image][mirror.boxes])
    )


def _joints(model: Model, system: System, mirror: Mirror) -> bool:
    """Whether joints are seen as joints: between the same bodies, as stiff, with the same forces in a random
    state and in its image; and whether one that goes across joins a box to its own image."""
    from mdlgen.backends.lattice.kernels.entries import joint_forces

    joints, image, count = system.joints, mirror.image, len(mirror.image)
    if not len(joints):
        return True
    seen = np.append(image, -1)  # the ground is its own image
    ends = (joints["a"], joints["b"])
    values = np.column_stack([joints[name] for name in ("k", "c", "length", "area", "refuses", "first")])
    tables = [
        np.column_stack([np.minimum(a, b), np.maximum(a, b), values])
        for a, b in (ends, (seen[ends[0]], seen[ends[1]]))
    ]
    ordered = [table[np.lexsort(np.round(table.T[::-1], 9))] for table in tables]
    if not all(_same(one, two) for one, two in zip(ordered[0].T, ordered[1].T, strict=True)):
        return False
    gone = np.append(mirror.gone, False)
    held = np.append(model.bodies.fixed, True)
    across = (gone[ends[0]] != gone[ends[1]]) & ~held[ends[0]] & ~held[ends[1]]
    if (seen[ends[0]] != ends[1])[across].any():
        return False
    x, r, u, w = _shaken(model)
    mirror.fill(x[:count], r[:count], u[:count], w[:count])
    f = np.zeros((count + 1, 6))
    joint_forces(joints, system.points, Motion(x, r, u, w), f)
    force, torque = f[:count, :3], f[:count, 3:]
    most = [float(np.abs(v).max(initial=0.0)) for v in (force, torque)]
    return bool(
        np.abs(mirror.seen(force) - force[image]).max() <= SAME_FORCE * most[0]
        and np.abs(mirror.seen(torque) + torque[image]).max() <= SAME_FORCE * most[1]
    )


def _shaken(model: Model) -> tuple[Floats, Floats, Floats, Floats]:
    """Places, rotations (bodies + 1, 9) and velocities of a state near the start in which no two bodies move
    alike; last the ground."""
    table, count = model.bodies, len(model.bodies.name)
    x, r, u, w = (np.zeros((count + 1, n)) for n in (3, 9, 3, 3))
    free = np.where(table.fixed, 0.0, 1.0)[:, None]
    # parts of multiples of squares are spread evenly, and follow no rule that boxes in rows follow
    shares = math.sqrt(2.0) * np.arange(1.0, 12 * count + 1.0) ** 2 % 1.0
    moved, turned, rate, spin = free * (4.0 * shares - 2.0).reshape(4, count, 3)
    x[:count] = table.position + MOVED * moved
    r[:count] = (matrices(TURNED * turned) @ table.rotation).reshape(-1, 9)
    r[count] = np.eye(3).ravel()
    u[:count], w[:count] = MOVED * rate, TURNED * spin
    return x, r, u, w

"""Finds the plane in which a scene is its own mirror image."""

from __future__ import annotations

import math
from dataclasses import fields, replace

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.bristles import cuts
from mdlgen.backends.lattice.kernels.tuning import MOVED, SAME, SAME_FORCE, TURNED
from mdlgen.backends.lattice.symmetry.mirror import Mirror
from mdlgen.backends.lattice.symmetry.parts import off, same, seen_as
from mdlgen.mechanics.frame import Motion
from mdlgen.model.rotations import matrices
from mdlgen.model.tables import BOX_BOX, Floats, Ints, Model, SheetPart


def find(model: Model, system: System) -> Mirror | None:
    """Returns the plane, or None if the scene has none or must not be halved.

    A scene without contacts is not halved: solved as a whole it conserves its momentum to round-off, but one
    half alone would not. Nor are scenes with air between sheets, measured friction, motors, limiters or
    shafts; with friction that sticks between a sheet and a roller that the plane cuts; with Poisson's effect,
    which couples boxes on both sides of the plane; with parts that turn about a pivot or slide; with stops;
    with loads or gravity that change over time.

    The plane passes through the middle of the sheets, between boxes and parallel to an edge. The check
    compares bodies, their supports and drives, contacts, loads, and the forces of joints in a random state.
    """
    if not len(model.pairs) or not model.run.symmetry or len(model.corners) or model.gates or model.stopped:
        return None
    if (model.contacts.air_viscosity > 0.0).any():
        return None  # air presses across the plane
    if model.contacts.frictions is not None:
        return None  # measured friction may vary over a sheet, without symmetry
    if any(roller.axle is not None or roller.leader >= 0 for roller in model.rollers):
        return None  # a motor, a limiter or a shaft may act on both sides
    if model.changes:
        return None  # loads on the two sides may have different factors over time
    for axis in (1, 0):
        normal = model.sheets[0].rotation[:, axis]
        mirror = _plane(model, normal, float(normal @ model.sheets[0].center))
        mirror = mirror and _contacts(model, mirror)
        if mirror is not None and cuts(system.bristles, mirror.image):
            continue
        if mirror is not None and _loads(model, mirror) and _joints(model, system, mirror):
            return mirror
    return None


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
    machine = model.machine
    for part in machine:
        image[part.body] = next((o.body for o in machine if seen_as(blank, model, part, o)), -1)
    if (image < 0).any() or (image[image] != itself).any():
        return None
    # errors of places are relative to the size of the scene
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
    alike = (
        same(blank.seen(table.velocity), table.velocity[image])
        and same(-blank.seen(table.spin), table.spin[image])
        and all(same(v, v[image]) for v in (table.mass, table.inertia, table.half, table.friction))
        and bool((table.fixed == table.fixed[image]).all())
        and _sides(mirror, model)
    )
    return mirror if alike else None


def _grid(mirror: Mirror, sheet: SheetPart) -> Ints:
    """Mirror images of the boxes of a sheet; -1 for all if the plane does not pass between boxes."""
    grid = sheet.first + np.arange(sheet.count).reshape(sheet.n_y, sheet.n_x)
    along = np.abs(sheet.rotation.T @ mirror.normal)
    if along[1] > 1.0 - SAME and sheet.n_y % 2 == 0:
        return grid[::-1].ravel()
    if along[0] > 1.0 - SAME and sheet.n_x % 2 == 0:
        return grid[:, ::-1].ravel()
    return np.full(sheet.count, -1)


def _sides(mirror: Mirror, model: Model) -> bool:
    """True if the free sides of each box are the mirror images of those of its image. The axes of all boxes
    are right-handed, while a reflection makes axes left-handed. So the two sides of an image along the normal
    are numbered in exchanged order."""
    exposed = model.bodies.exposed
    for sheet in model.sheets:
        own = slice(sheet.first, sheet.first + sheet.count)
        turn = [1, 0, 2, 3] if abs(float(sheet.rotation[:, 0] @ mirror.normal)) > 0.5 else [0, 1, 3, 2]
        if (exposed[own][:, turn] != exposed[mirror.image[own]]).any():
            return False
    return True


# columns of Contacts that identify a contact, and do not change its action
_NO_LAW = ("entry", "part_a", "part_b", "name", "frictions")


def _contacts(model: Model, mirror: Mirror) -> Mirror | None:
    """Returns the Mirror with the rows of contacts. None if a row has no image with the same law, or if a box
    can reach a part on the other side. The plane passes between boxes in each sheet. So boxes of two sheets
    that touch are on the same side."""
    table, image = model.contacts, mirror.image
    place = {part.name: part.body for part in model.machine}
    names = {part.body: part.name for part in model.machine}
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
    # boxes on the other side do not reach a part that is away from the plane; a run checks this
    clear = max(sheet.thickness for sheet in model.sheets)
    reached = {part.body for part in model.machine if not off(mirror, part) > clear}
    if not reached.isdisjoint([*a[across].tolist(), *b[across].tolist()]):
        return None
    itself = np.arange(len(ends))
    far = np.array([any(mirror.gone[place[n]] for n in pair if n in place) for pair in ends])
    times = np.where(row_of_image == itself, 2.0, 1.0)
    apart = sheets or bool(across.any())
    senses = np.array([_senses(mirror, model, *pair) for pair in ends]).reshape(-1, 3)
    return replace(mirror, rows=np.where(far, row_of_image, itself), times=times, senses=senses, apart=apart)


def _senses(mirror: Mirror, model: Model, one: str, two: str) -> tuple[float, float, float]:
    """Sense of rotation of the mirror image of each part of a row: 1 where it turns like the part about its
    own axis, -1 where it turns the other way. The third value is for the roller whose surface defines the
    direction of friction."""
    rollers = {roller.body: roller for roller in model.rollers}
    axes = {roller.name: roller.axis for roller in model.rollers}
    image = {roller.name: rollers[int(mirror.image[roller.body])].axis for roller in model.rollers}

    def way(name: str) -> float:
        return -float(np.sign(mirror.seen(axes[name]) @ image[name])) if name in axes else 1.0

    return way(one), way(two), way(two) if two in axes else way(one)


def _loads(model: Model, mirror: Mirror) -> bool:
    """True if loads are the mirror images of each other, at any rotation of the bodies."""
    table, count = model.loads, len(mirror.image)
    force, moment, lever = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3, 3))
    np.add.at(force, table.body, table.force)
    np.add.at(moment, table.body, table.moment)
    np.add.at(lever, table.body, table.local[:, :, None] * table.force[:, None, :])
    turned = mirror.signs[:, :, None] * mirror.seen(lever)
    image = mirror.image
    return (
        same(mirror.seen(force), force[image])
        and same(-mirror.seen(moment), moment[image])
        and same(turned[mirror.boxes], lever[image][mirror.boxes])
    )


def _joints(model: Model, system: System, mirror: Mirror) -> bool:
    """True if joints are the mirror images of each other: between the same bodies, with the same stiffness,
    and with the same forces in a random state and in its image. A joint across the plane must join a box to
    its own image."""
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
    if not all(same(one, two) for one, two in zip(ordered[0].T, ordered[1].T, strict=True)):
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
    """Places, rotations (bodies + 1, 9) and velocities of a state near the start in which all bodies move
    differently; the last one is the ground."""
    table, count = model.bodies, len(model.bodies.name)
    x, r, u, w = (np.zeros((count + 1, n)) for n in (3, 9, 3, 3))
    free = np.where(table.fixed, 0.0, 1.0)[:, None]
    # fractional parts of multiples of squares are distributed evenly, without the regularity of rows of boxes
    shares = math.sqrt(2.0) * np.arange(1.0, 12 * count + 1.0) ** 2 % 1.0
    moved, turned, rate, spin = free * (4.0 * shares - 2.0).reshape(4, count, 3)
    x[:count] = table.position + MOVED * moved
    r[:count] = (matrices(TURNED * turned) @ table.rotation).reshape(-1, 9)
    r[count] = np.eye(3).ravel()
    u[:count], w[:count] = MOVED * rate, TURNED * spin
    return x, r, u, w

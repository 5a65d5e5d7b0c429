"""Lints of guides, planes and meshes that turn about a pivot or slide."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.moved import BEYOND, displaced
from mdlgen.model.overlaps.parts import HAIR
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import Floats, GuidePart, MachinePart, Model, MovingPart, SheetPart

_STATIONS = 25  # places between both ends at which a part is checked
_FACING = 0.99  # cosine: a sheet passes a face that is square to its path on neither side
_SHARES = np.linspace(0.0, 1.0, 9)  # of each side of a block


def sweeps(model: Model) -> Iterator[Lint]:
    """Parts that a moving one goes through, by its profile, and has no contact with."""
    met = {frozenset(pair) for pair in zip(model.contacts.part_a, model.contacts.part_b, strict=True)}
    moving = {part.name for part, _ in model.gates}
    for gate, motion in model.gates:
        if motion.free:
            continue
        points = _points(kind_of(gate).blocks(gate))
        low, high = motion.ends
        moved = displaced(motion, np.linspace(low, high, _STATIONS), points)
        start = displaced(motion, np.zeros(1), points)
        for part in model.machine:
            if part is gate or part.name in moving or frozenset((gate.name, part.name)) in met:
                continue
            deep = [_inside(model, part, places) for places in (start, moved)]
            if deep[0] <= HAIR < deep[1]:
                yield Lint(
                    "W173",
                    _where(gate, motion),
                    f"on its way it goes through {model.called(part.body)}, {deep[1]:.3g} mm deep at most, "
                    "and nothing holds them apart",
                    "shorten its way, or move one of them",
                )


def through_sheets(model: Model) -> Iterator[Lint]:
    """Parts that go through a sheet as it lies at the start, and have no contact with it."""
    table, bodies = model.contacts, model.bodies
    met = {frozenset(pair) for pair in zip(table.part_a, table.part_b, strict=True)}
    for gate, motion in model.gates:
        if motion.free:
            continue
        low, high = motion.ends
        stations = np.linspace(low, high, _STATIONS)
        for sheet in model.sheets:
            if sheet.enters != 0.0 or frozenset((gate.name, sheet.name)) in met:
                continue
            boxes = slice(sheet.first, sheet.first + sheet.count)
            # the sheet as the part sees it, which turns the other way
            seen = displaced(motion, -stations, bodies.position[boxes])
            still = displaced(motion, np.zeros(1), bodies.position[boxes])
            deep = [_inside(model, gate, places) for places in (still, seen)]
            if deep[0] <= HAIR < deep[1]:
                yield Lint(
                    "W187",
                    _where(gate, motion),
                    f"on its way it goes through {sheet.name} where that lies at the start, {deep[1]:.3g} mm "
                    "deep at most, and the two have no contact",
                    f"give a contact between {sheet.name} and {gate.name}, or move one of them",
                )


def turned_away(model: Model) -> Iterator[Lint]:
    """Straight guides that move, are touched on one side, and show their back to all that comes by."""
    table = model.contacts
    met = {frozenset(pair) for pair in zip(table.part_a, table.part_b, strict=True)}
    bends = [guide.name for guide in model.guides if guide.radius > 0.0]

    def met_by(sheet: SheetPart) -> bool:
        """True if a sheet goes through a bend, so that it does not continue straight."""
        return any(frozenset((sheet.name, bend)) in met for bend in bends)

    for gate, motion in model.gates:
        if motion.free or not isinstance(gate, GuidePart) or gate.side not in ("left", "right"):
            continue
        sheets = [sheet for sheet in model.sheets if frozenset((gate.name, sheet.name)) in met]
        if not all(np.any(sheet.velocity) and not met_by(sheet) for sheet in sheets):
            continue  # its path is not known
        along, normal = gate.axes[:, 0], gate.axes[:, 1] * (1.0 if gate.side == "left" else -1.0)
        line = gate.center + np.linspace(-0.5, 0.5, len(_SHARES))[:, None] * gate.length * along
        places = np.unique([0.0, *motion.ends, *motion.places])
        faces, tips = displaced(motion, places, line), displaced(motion, places, line + normal)
        backs = [
            _back(face, (tip - face)[0], sheet.center, sheet.velocity)
            for face, tip in zip(faces, tips, strict=True)
            for sheet in sheets
        ]
        known = [back for back in backs if back is not None]
        if known and all(known):
            other = "right" if gate.side == "left" else "left"
            yield Lint(
                "W186",
                f"guides.{gate.name}.line.side",
                f"at each of its places its face looks away from where {sheets[0].name} comes: that passes "
                "behind it",
                f"side: {other}, if the sheet is to run along it",
            )


def _back(face: Floats, normal: Floats, center: Floats, velocity: Floats) -> bool | None:
    """True if a body that moves straight on, from a centre along its velocity, meets the back of a face or
    passes behind it. False if it meets the front or passes before it. None: not known. The face is given by
    points along a straight line, (n, 3)."""
    way = velocity / np.linalg.norm(velocity)
    ahead = float(normal @ way)
    facing = abs(ahead) > _FACING
    across = face[-1] - face[0] if facing else normal
    across = across - float(across @ way) * way
    high, far = (face - center) @ across, (face - center) @ way
    crosses = (high[:-1] * high[1:] < 0.0) & (far[1:] > 0.0)
    if crosses.any():
        return ahead > 0.0
    if facing or not (np.all(high > 0.0) or np.all(high < 0.0)):
        return None
    return bool(high[0] > 0.0)


def unused(model: Model) -> Iterator[Lint]:
    """Positions that no profile goes to, and no rule sends a part to."""
    orders = [order for rule in model.reactions.rules for order in rule.orders if order.kind == "move"]
    for part, moving in model.gates:
        known = set(moving.corners[:, 1].tolist())
        known |= {order.value for order in orders if order.name == part.name}
        idle = [
            name
            for name, place in zip(moving.names, moving.places.tolist(), strict=True)
            if place not in known
        ]
        if idle:
            yield Lint(
                "W174",
                f"{_where(part, moving)}.positions.{idle[0]}",
                f"it never goes to {', '.join(idle)}",
                "name them in its profile, or leave them out",
            )


def late(model: Model) -> Iterator[Lint]:
    """Profiles that are not at their end as the run is."""
    for part, moving in model.gates:
        if not moving.free and len(moving.corners) > 1 and moving.corners[-1, 0] > model.run.duration:
            yield Lint(
                "W175",
                f"{_where(part, moving)}.profile",
                f"its last corner is at {moving.corners[-1, 0]:g} ms, and the run ends at "
                f"{model.run.duration:g} ms",
                "run longer, or move the part earlier",
            )


def unbalanced(model: Model) -> Iterator[Lint]:
    """Free parts that their spring and weight drive away from where they begin, with no stop there."""
    for part, moving in model.gates:
        if not moving.free:
            continue
        force = _force(model, moving)
        stops = moving.stops
        rests = stops is not None and (stops.low if force < 0.0 else stops.high) == 0.0
        unit = "N mm" if moving.turns else "N"
        if abs(force) > 0.0 and not rests:
            yield Lint(
                "W176",
                _where(part, moving),
                f"as the run begins its spring and weight push it with {force:.3g} {unit}, and no stop holds "
                "it",
                f"give a {'torque' if moving.turns else 'force'} that balances its weight, or a stop at 0",
            )


def soft(model: Model) -> Iterator[Lint]:
    """Stops that give way by more than a run allows under the spring and the weight alone."""
    for part, moving in model.gates:
        stops = moving.stops
        if not moving.free or stops is None:
            continue
        far = BEYOND * (stops.high - stops.low)
        for end, sign in ((stops.low, -1.0), (stops.high, 1.0)):
            force = sign * (_force(model, moving) - moving.stiffness * end)
            if force > stops.stiffness * far:
                yield Lint(
                    "W177",
                    f"{_where(part, moving)}.stops",
                    f"spring and weight alone push the part past its stop by {force / stops.stiffness:.3g} "
                    f"{'rad' if moving.turns else 'mm'}; a run ends at {far:.3g}",
                    "make the stops stiffer",
                )


def _where(part: MachinePart, moving: MovingPart) -> str:
    return f"{kind_of(part).table}.{part.name}.{'pivot' if moving.turns else 'slide'}"


def _force(model: Model, moving: MovingPart) -> float:
    """Force along the motion of a free part at its place 0, or torque."""
    if moving.turns:
        return moving.force + float(moving.axis @ np.cross(moving.moment, model.gravity))
    return moving.force + moving.inertia * float(moving.axis @ model.gravity)


def _points(blocks: Floats) -> Floats:
    """Points all over blocks, (n, 8, 3) corners as of `geometry.solids`; (points, 3)."""
    begin = blocks[:, 0]
    sides = np.stack([blocks[:, k] - begin for k in (1, 2, 4)], axis=1)
    shares = np.stack(np.meshgrid(_SHARES, _SHARES, _SHARES, indexing="ij"), axis=-1).reshape(-1, 3)
    return (begin[:, None] + np.einsum("pk,bki->bpi", shares, sides)).reshape(-1, 3)


def _inside(model: Model, part: MachinePart, places: Floats) -> float:
    """Greatest depth of places (k, n, 3) in a part [mm]."""
    bodies, kind = model.bodies, kind_of(part)
    middle = np.broadcast_to(places.mean(axis=1, keepdims=True), places.shape)
    deep = kind.inside(part, places, middle, bodies.position[part.body], bodies.rotation[part.body])
    return 0.0 if deep is None else float(deep.max())

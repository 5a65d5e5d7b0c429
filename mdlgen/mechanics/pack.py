"""A Model's bodies, bushings, pairs and loads as records, in a solver's units and in its layout of records.

Rows of bodies are those of the Model; an additional one, the last, is the ground, which has the number -1.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.mechanics.arm import AXIAL, arm
from mdlgen.mechanics.axle import AXLE
from mdlgen.mechanics.curve import follow
from mdlgen.mechanics.driven import drive
from mdlgen.mechanics.frame import LAW_DYNAMIC, LAW_STATIC
from mdlgen.mechanics.gate import gate, put_stops
from mdlgen.mechanics.laws import damping_share
from mdlgen.mechanics.measured import FACES, FRICTION, MORE_CD, MORE_MD, POWER, REFERENCE
from mdlgen.mechanics.mesh_tables import mesh_numbers
from mdlgen.mechanics.records import FOLLOWER, LEADER, LOAD
from mdlgen.mechanics.rim import rim
from mdlgen.model.covers import levers
from mdlgen.model.rotations import matrices
from mdlgen.model.scatter import scatter_of
from mdlgen.model.tables import GROUND, Floats, Frictions, Ints, Model, Press


class Units(NamedTuple):
    """Units of a Model in those of a solver, where a newton stays one; by default the Model's own."""

    mm: float = 1.0
    per_mm: float = 1.0
    g: float = 1.0
    ms: float = 1.0
    hertz: float = 1.0  # 1 N/mm^1.5
    mpa: float = 1.0

    @property
    def speed(self) -> float:
        """1 mm/ms."""
        return self.mm / self.ms


OWN = Units()


def pack_bodies(model: Model, layout: np.dtype, units: Units = OWN, driven: bool = True) -> np.ndarray:
    """Records of all bodies, with no unknowns; `driven`: rollers follow their drives."""
    mm, g = units.mm, units.g
    table = model.bodies
    count = len(table.name)
    bodies = np.zeros(count + 1, layout)
    bodies["mass"][:count] = table.mass * g
    bodies["inertia"][:count] = table.inertia * g * mm**2
    bodies["half"][:count] = table.half * mm
    bodies["exposed"][:count] = table.exposed @ np.array([1, 2, 4, 8])
    bodies["size"] = bodies["ratio"] = 1.0
    for part in model.machine:
        if part.round is not None:
            bodies["size"][part.body] = [mm * length for length in part.round]
    piece = 0
    for roller in model.rollers:
        row = bodies[roller.body]
        row["axis"] = roller.axis
        row["press"][AXIAL] = roller.loaded_inertia * g * mm**2
        if roller.press is not None:
            _press(row, roller.press, roller.loaded_mass + roller.press.carrier_mass, units)
        if driven:
            drive(row, roller, units.ms, mm)
        piece = rim(row, roller, piece)
        arm(row, roller, mm, g, units.ms)
        if roller.arm is not None and roller.arm.stops is not None:
            put_stops(row, roller.arm.stops, 1.0, mm, roller.arm.angle)
    _turn_together(model, bodies, g * mm**2, driven)
    for plate, spring in model.plates:
        _press(bodies[plate.body], spring, plate.sliding_mass, units)
    for guide in model.guides:
        row = bodies[guide.body]
        row["half"] = [0.5 * mm * size for size in (guide.length, guide.width, guide.thickness)]
        row["arc"], row["side"] = (guide.radius * mm, guide.middle, guide.half_angle), guide.sides
    grip = 1.0 if model.run.analysis == "static" else 0.0
    for part in (*model.planes, *model.guides):
        bodies["ends"][part.body] = part.ends
        bodies["edge"][part.body] = (*(mm * r for r in part.edges), grip)
    for part, moving in model.gates:
        gate(bodies[part.body], moving, mm, g, units.ms)
    for mesh in model.meshes:
        if mesh.on >= 0:
            bodies["carries"][model.rollers[mesh.on].body] = 1
    return bodies


def _press(row: np.void, spring: Press, mass: float, units: Units) -> None:
    """Sets the direction of a body that slides on a spring, and the spring's numbers."""
    row["way"] = spring.direction
    force = spring.preload - spring.stiffness * (spring.start - spring.touch)
    stiffness, damping = spring.stiffness * units.per_mm, spring.damping * units.ms * units.per_mm
    row["press"][:AXIAL] = (stiffness, damping, force, mass * units.g)
    if spring.stops is not None:
        put_stops(row, spring.stops, units.mm, units.per_mm, spring.start)


def _turn_together(model: Model, bodies: np.ndarray, inertia: float, driven: bool) -> None:
    """Numbers the axles of rollers, and gives leaders the inertia of all rollers that turn with them;
    `inertia` is 1 g mm^2 in the solver's units."""
    axles = 0
    for roller in model.rollers:
        row = bodies[roller.body]
        if roller.axle is not None:
            row["press"][AXIAL] += roller.axle.inertia * inertia
            if driven:
                row["clutch"] = (AXLE, axles, 1.0)
            axles += 1
    for roller in model.rollers:
        if roller.leader >= 0 and driven:
            row, leads = bodies[roller.body], bodies[roller.leader]
            leads["press"][AXIAL] += roller.ratio**2 * row["press"][AXIAL]
            leads["coupled"], row["coupled"], row["ratio"] = LEADER, FOLLOWER, roller.ratio
            row["press"][AXIAL] = 0.0


def number(model: Model, bodies: np.ndarray, first: int, turning: bool = True) -> int:
    """Numbers the unknowns of rollers and plates from `first` on in the fields `slide` and `spin` (-1: none),
    and returns the next number; `turning`: free rollers have one."""
    bodies["slide"] = bodies["spin"] = -1
    for roller in model.rollers:
        row = bodies[roller.body]
        if roller.press is not None or roller.arm is not None:
            row["slide"], first = first, first + 1
        if turning and roller.leader >= 0:  # the leader has a number: it is the first of its shaft by name
            row["spin"] = bodies["spin"][roller.leader]
        elif turning and roller.turns:
            row["spin"], first = first, first + 1
    for plate, _ in model.plates:
        bodies["slide"][plate.body], first = first, first + 1
    for part, moving in model.gates:
        if moving.free:
            bodies["slide"][part.body], first = first, first + 1
    return first


def pack_bushings(model: Model, layout: np.dtype, order: Ints, units: Units = OWN) -> np.ndarray:
    """Records of the bushings `order`."""
    table = model.bushings
    bushings = np.zeros(len(order), layout)
    position = np.concatenate([model.bodies.position, np.zeros((1, 3))])
    rotation = np.concatenate([model.bodies.rotation, np.eye(3)[None]])
    axes, origin = table.axes[order], table.origin[order]
    # at rest the frame on b has turned onto the one on a
    frames = {"a": axes, "b": axes @ matrices(-table.rest[order])}
    for end in "ab":
        body = getattr(table, end)[order]
        bushings[end] = body
        bushings["r" + end] = np.einsum("nji,nj->ni", rotation[body], origin - position[body]) * units.mm
        bushings["f" + end] = np.einsum("nji,njk->nik", rotation[body], frames[end]).reshape(-1, 9)
    scale = np.array([units.per_mm] * 3 + [units.mm] * 3)
    bushings["k"] = table.k[order] * scale
    bushings["c"] = table.c[order] * scale * units.ms
    follow(bushings, model.curves, order, units.mm, units.mpa)
    return bushings


def pack_pairs(model: Model, layout: np.dtype, chosen: Ints, units: Units = OWN) -> np.ndarray:
    """Records of the kept pairs `chosen`, with their own friction."""
    pairs = pack_laws(model, layout, model.pairs.contact[chosen], units)
    mesh, other = mesh_numbers(model)
    pairs["a"], pairs["b"], pairs["mesh"] = model.pairs.a[chosen], other[chosen], mesh[chosen]
    pairs["law"][:, [LAW_STATIC, LAW_DYNAMIC]] *= model.pair_friction[chosen, None]
    scatter = scatter_of(model)
    if scatter is not None:
        pairs["law"][:, [LAW_STATIC, LAW_DYNAMIC]] *= scatter[chosen, None]
    return pairs


def pack_laws(model: Model, layout: np.dtype, chosen: Ints, units: Units = OWN) -> np.ndarray:
    """A pair of no bodies for each of the contacts `chosen`."""
    rows = model.contacts
    pairs = np.zeros(len(chosen), layout)
    pairs["kind"] = rows.kind[chosen]
    pairs["shared"] = np.array([share == "width" for share in rows.share], dtype=int)[chosen]
    pairs["k"], pairs["spread"] = rows.stiffness[chosen] * units.hertz, rows.spread[chosen] * units.mm
    beta = damping_share.py_func(rows.restitution)  # compiled code is for a solver alone to load
    speeds = (v * units.speed for v in (rows.stiction_velocity, rows.friction_velocity, rows.smoothing))
    lever, bend = levers(model)
    columns = (beta, rows.mu_static, rows.mu_dynamic, *speeds, rows.rolling, lever, bend * units.per_mm)
    for column, values in enumerate(columns):
        pairs["law"][:, column] = values[chosen]
    if rows.frictions is not None:
        pairs["measured"] = np.where(in_rows(rows.frictions), np.arange(1, len(rows) + 1), 0)[chosen]
        # with a table of speeds mu depends on the speed by that table alone
        tabled = rows.frictions.points[chosen] > 0
        pairs["law"][tabled, LAW_DYNAMIC] = pairs["law"][tabled, LAW_STATIC]
    return pairs


def in_rows(frictions: Frictions) -> NDArray[np.bool_]:
    """True for contacts whose laws use more than two coefficients of friction, (contacts,)."""
    factors = np.concatenate([frictions.direction, frictions.face], axis=1)
    return (factors != 1.0).any(axis=1) | (frictions.points > 0) | (frictions.pressure[:, 1] != 0.0)


def pack_frictions(model: Model, units: Units = OWN) -> Floats:
    """Rows as in mechanics.measured, one for each contact; none where no friction is measured."""
    frictions = model.contacts.frictions
    if frictions is None:
        return np.zeros((0, FRICTION))
    found = np.zeros((len(model.contacts), FRICTION))
    found[:, MORE_MD : MORE_CD + 1] = np.sqrt(frictions.direction - 1.0)
    scale = np.array([units.speed, 1.0, 1.0 / units.speed])
    points = (frictions.speed * scale).reshape(len(found), -1)
    found[:, FACES:REFERENCE] = np.concatenate([frictions.face, frictions.points[:, None], points], axis=1)
    found[:, REFERENCE] = frictions.pressure[:, 0] * units.mpa
    found[:, POWER] = frictions.pressure[:, 1]
    return found


def pack_loads(model: Model, units: Units = OWN) -> np.ndarray:
    """Records of the loads."""
    loads = np.zeros(len(model.loads.body), LOAD)
    loads["body"], loads["local"] = model.loads.body, model.loads.local * units.mm
    loads["force"], loads["moment"] = model.loads.force, model.loads.moment * units.mm
    return loads


def gravity(model: Model, units: Units = OWN) -> Floats:
    """(3,)"""
    return model.gravity * units.mm / units.ms**2


assert GROUND == -1, "the ground is the last row of the bodies"

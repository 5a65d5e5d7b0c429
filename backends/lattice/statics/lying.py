"""Sheets that lie on a plane at rest: friction holds each in its place.

At rest a contact has its normal force alone. Springs along the plane and about its normal hold a sheet, at
the face of one of its boxes that lies there. Their force and couple must be within the limit surface of all
contacts of the sheet (see limit).

Where a sheet slopes over an edge, friction turns the force of the edge towards the plate's normal (see
mechanics.edge). Such a force has no potential, and the symmetric stiffness of a balance would miss that. So
balances use forces along the normals of the sheet. The friction force of the last balance acts as a load on
the next one, until it no longer changes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.arrays import JOINT, System
from mdlgen.backends.lattice.kernels.state import Midpoint
from mdlgen.backends.lattice.kernels.tuning import GIVES, NO_FORCE, SLIDES_BEYOND
from mdlgen.backends.lattice.statics.limit import Limit, limit
from mdlgen.backends.lattice.statics.pressure import grips
from mdlgen.mechanics.edge import HOLDS
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.records import LOAD
from mdlgen.model.rotations import matrices, vectors
from mdlgen.model.tables import BOX_PLANE, GROUND, Floats, Model, PlanePart, SheetPart


class Hold(NamedTuple):
    """A sheet, the plane on which it lies, the box that is held, and the stiffness [N/mm]."""

    sheet: SheetPart
    plane: PlanePart
    box: int
    stiffness: float

    def base(self, model: Model) -> Floats:
        """Place at which the box is held (3,), in its own axes: below its middle, in the face of the plane,
        where friction acts."""
        bodies = model.bodies
        normal = bodies.rotation[self.plane.body][:, 2]
        high = float((bodies.position[self.box] - bodies.position[self.plane.body]) @ normal)
        return -(high - 0.5 * self.plane.size[2]) * (normal @ bodies.rotation[self.box])

    def pulls(self, model: Model, x: Floats, r: Floats) -> tuple[Floats, Floats]:
        """Load of the springs with bodies at x (n, 3), their rotations r (n, 9): the force along the plane
        [N] and the couple about its normal [N mm], (3,), and the place (3,)."""
        axes, own = model.bodies.rotation[self.plane.body], r[self.box].reshape(3, 3)
        first, base = model.bodies.rotation[self.box], self.base(model)
        turn = vectors(axes.T @ own @ first.T @ axes)
        place = x[self.box] + own @ base
        # in the middle frame, as for any bushing
        halfway = matrices(0.5 * turn)
        moved = (place - model.bodies.position[self.box] - first @ base) @ axes @ halfway
        moved[2] = 0.0
        force = self.stiffness * (halfway @ moved)
        return np.array([*force[:2], self.stiffness * _arm(model, self.box) ** 2 * float(turn[2])]), place


def _arm(model: Model, box: int) -> float:
    """Half of the sum of a box's sides [mm]."""
    return float(model.bodies.half[box, :2].sum())


def holds(model: Model, loose: list[SheetPart], load: float) -> list[Hold]:
    """A Hold for each of the `loose` sheets that lies over a fixed plane with friction: at the box that is
    furthest inside of it."""
    return [hold for hold in (_hold(model, sheet, load) for sheet in loose) if hold is not None]


def _hold(model: Model, sheet: SheetPart, load: float) -> Hold | None:
    table, places, best, found = model.contacts, model.bodies.position, 0.0, None
    for row in np.flatnonzero((table.kind == BOX_PLANE) & (table.mu_static > 0.0)).tolist():
        if table.part_a[row] != sheet.name:
            continue
        plane = next(part for part in model.planes if part.name == table.part_b[row])
        normal = model.bodies.rotation[plane.body][:, 2]
        if plane.press is not None or float(normal @ model.begun_gravity) >= 0.0:
            continue
        boxes = places[sheet.first : sheet.first + sheet.count] - places[plane.body]
        own = boxes @ model.bodies.rotation[plane.body]
        inside = (0.5 * np.array(plane.size[:2]) - np.abs(own[:, :2])).min(axis=1)
        inside[own[:, 2] <= 0.0] = 0.0
        at = int(np.argmax(inside))
        if inside[at] > best:
            best, found = float(inside[at]), Hold(sheet, plane, sheet.first + at, load / GIVES)
    return found


def held(model: Model, system: System, found: list[Hold]) -> System:
    """The System with these holds as joints to the ground."""
    joints = np.zeros(len(found), JOINT)
    for joint, hold in zip(joints, found, strict=True):
        axes, own = model.bodies.rotation[hold.plane.body], model.bodies.rotation[hold.box]
        joint["a"], joint["b"], joint["first"] = GROUND, hold.box, -1
        base = hold.base(model)
        joint["ra"], joint["rb"] = model.bodies.position[hold.box] + own @ base, base
        joint["fa"], joint["fb"] = axes.ravel(), (own.T @ axes).ravel()
        k = hold.stiffness
        joint["k"] = k, k, 0.0, 0.0, 0.0, k * _arm(model, hold.box) ** 2
    return system._replace(joints=np.concatenate([system.joints, joints]))


def slides(
    model: Model, systems: tuple[System, System], found: list[Hold], load: float, place: tuple, mid: Midpoint
) -> str | None:
    """Reason where friction cannot hold a sheet, or None; `systems`: with the friction at edges, and without;
    `place`: x (n, 3), r (n, 9), ...; `mid`: scratch."""
    x, r = place[:2]
    for hold in found:
        pulled, origin = hold.pulls(model, x, r)
        axes = model.bodies.rotation[hold.plane.body]
        every = grips(model, systems, hold.sheet, (axes, origin), (x, r), mid)
        middle = every.middle()
        pulled[2] -= middle[0] * pulled[1] - middle[1] * pulled[0]
        here = every.at(middle)
        length = here.reach()
        force = float(np.hypot(*pulled[:2]))
        if force + abs(pulled[2]) / length <= NO_FORCE * load:
            continue
        most = limit(here, pulled)
        if (1.0 - most.part) * (force + abs(pulled[2]) / length) > NO_FORCE * load:
            return _gives_way(hold, pulled, most, origin + axes[:, :2] @ middle, length, axes)
    return None


def _gives_way(hold: Hold, pulled: Floats, most: Limit, middle: Floats, length: float, axes: Floats) -> str:
    """Text for a sheet that yields to a force and a couple about the `middle` (3,) of its contacts."""
    force, couple = float(np.hypot(*pulled[:2])), abs(float(pulled[2]))
    speed, turns = float(np.hypot(*most.twist[:2])), float(most.twist[2])
    if speed > SLIDES_BEYOND * length * abs(turns):
        return (
            f"sheet {hold.sheet.name} slides on plane {hold.plane.name}: {force:.3g} N pull it along, "
            f"and friction holds {most.part * force:.3g} N, {most.part:.3g} of it"
        )
    # centre of rotation: the place where the rigid motion has no speed
    centre = middle + axes[:, :2] @ (np.array([-most.twist[1], most.twist[0]]) / turns)
    at = ", ".join(f"{value + 0.0:.3g}" for value in centre.round(3))
    return (
        f"sheet {hold.sheet.name} turns on plane {hold.plane.name} about ({at}) mm: {force:.3g} N and "
        f"{couple:.3g} N mm about the middle of its contacts pull it along, and friction holds "
        f"{most.part:.3g} of that, {most.part * force:.3g} N and {most.part * couple:.3g} N mm"
    )


class Grip:
    """Friction in the forces of edges, as loads on a System without it."""

    def __init__(self, system: System) -> None:
        self._with = system
        grips = system.bodies["edge"][:, HOLDS] > 0.0
        self.acts = bool((grips & (system.bodies["ends"] != 0)).any())
        if not self.acts:
            self.system = system
            return
        bodies, loads = system.bodies.copy(), np.zeros(len(system.nodes), LOAD)
        bodies["edge"][:, HOLDS] = 0.0
        loads["body"] = system.nodes
        self.system = system._replace(bodies=bodies, loads=np.concatenate([system.loads, loads]))
        self._loads = self.system.loads[len(system.loads) :]

    def changed(self, level: float, x: Floats, r: Floats, mid: Midpoint) -> float:
        """Sets the loads to the friction at places x (n, 3) and rotations r (n, 9); the part `level` of them
        will act. Returns the greatest change [N]; `mid`: scratch."""
        from mdlgen.backends.lattice.kernels import entries

        still, forces = np.zeros_like(x), []
        for system in (self._with, self.system):
            mid.forces[:] = 0.0
            entries.contacts(system.tables, Motion(x, r, still, still), mid)
            forces.append(mid.forces[system.nodes].copy())
        added = (forces[0] - forces[1]) / level
        change = float(np.abs(added[:, :3] - self._loads["force"]).max(initial=0.0)) * level
        self._loads["force"], self._loads["moment"] = added[:, :3], added[:, 3:]
        return change

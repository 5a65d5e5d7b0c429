"""Rollers: axles, carriers and arms, drives, rims, cylinders."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from mdlgen.altair.rims import DEEP, WHOLE, Side, graphics, rim_facets
from mdlgen.model.tables import Floats, Model, RollerPart
from mdlgen.verify.expected.parts.kind import (
    Body,
    Box,
    Bushing,
    Joint,
    Kind,
    Marker,
    Spring,
    own_vector,
    spring_of,
    stops_data,
)
from mdlgen.verify.expected.units import KG, SECOND, reach
from mdlgen.verify.solver_expressions import motion
from mdlgen.verify.tables import Part, Table, table


class _Rollers(Kind[RollerPart]):
    def bodies(self, model: Model, part: RollerPart) -> Iterator[Body]:
        """A carrier is a solid ball of the roller's radius. For an arm the inertia about its own axis counts;
        the MDL file gives it for all three."""
        if part.press is not None:
            ball = 0.4 * part.press.carrier_mass * part.radius**2
            place = model.bodies.position[part.body]
            yield Body(f"b_{part.name}_carrier", part.press.carrier_mass, (ball, ball, ball), place)
        if part.arm is not None:
            own = part.arm.inertia
            yield Body(f"b_{part.name}_arm", part.arm.mass, (own, own, own), part.arm.center)

    def points(self, model: Model, part: RollerPart) -> Iterator[tuple[str, Floats]]:
        yield f"p_{part.name}", model.bodies.position[part.body]
        for box in self.boxes(model, part):
            yield f"p_{box.name.removeprefix('gbox_')}", box.center
        for spring in self.springs(model, part):
            yield f"p_{part.name}_anchor", spring.anchor
        if part.arm is not None:
            yield f"p_{part.name}_pivot", part.arm.pivot
            yield f"p_{part.name}_arm", part.arm.center

    def joints(self, model: Model, part: RollerPart) -> Iterator[Joint]:
        name, at, on = part.name, model.bodies.position[part.body], "B_Ground"
        if part.press is not None:
            on = f"b_{name}_carrier"
            yield Joint(f"j_{name}_slide", "TRANSLATIONAL", on, "B_Ground", at, part.press.direction)
        if part.arm is not None:
            on = f"b_{name}_arm"
            yield Joint(f"j_{name}_pivot", "REVOLUTE", on, "B_Ground", part.arm.pivot, part.axis)
        yield Joint(f"j_{name}", "REVOLUTE", f"b_{name}", on, at, part.axis)

    def boxes(self, model: Model, part: RollerPart) -> Iterator[Box]:
        """Those that show a rim."""
        table = model.bodies
        for name, facet in rim_facets(part, table.position[part.body], table.rotation[part.body]):
            yield Box(f"gbox_{name}", f"b_{part.name}", *facet)

    def markers(self, model: Model, part: RollerPart) -> Iterator[Marker]:
        table = model.bodies
        if part.rim is not None:
            place, turn = table.position[part.body], table.rotation[part.body]
            yield Marker(f"m_{part.name}", "B_Ground", place, turn)

    def vectors(self, model: Model, part: RollerPart) -> Iterator[tuple[str, Floats]]:
        yield from own_vector(f"v_{part.name}_axis", part.axis)
        if part.press is not None:
            yield f"v_{part.name}_press", part.press.direction

    def outputs(self, model: Model, part: RollerPart) -> Iterator[tuple[str, Iterable[float]]]:
        """Position and spin."""
        state = motion(f"b_{part.name}")
        yield f"o_{part.name}", [*state.place(model.bodies.position[part.body]), *state.spin]

    def springs(self, model: Model, part: RollerPart) -> Iterator[Spring]:
        if part.press is not None:
            yield spring_of(model, part, part.press, f"b_{part.name}_carrier")

    def bushings(self, model: Model, part: RollerPart) -> Iterator[Bushing]:
        arm = part.arm
        if arm is not None and arm.sprung:
            name, turn = f"bsh_{part.name}_arm", model.bodies.rotation[part.body]
            law = (arm.stiffness, arm.damping, arm.torque)
            yield Bushing(name, f"b_{part.name}_arm", arm.pivot, turn, *law)

    def data(self, model: Model, part: RollerPart) -> dict[str, float]:
        rim, found = part.rim, {}
        for k, name in enumerate(rim.name if rim is not None else ()):
            assert rim is not None
            radius, turn = float(rim.radius[k]), float(rim.end[k] - rim.begin[k]) / rim.facets[k]
            found |= {f"{name}_n": float(rim.facets[k]), f"{name}_turn": turn}
            found |= {f"{name}_deep": DEEP * radius, f"{name}_chord": 2 * radius * math.tan(turn / 2)}
        found |= _of_motor(model, part) | stops_data(model, part.name)
        return found if part.arm is None else {**found, "I_a": part.arm.inertia * KG}

    def tables(self, model: Model) -> dict[str, Table]:
        return {"cylinders": cylinders(model)}

    def graphics(self, part: RollerPart, side: Side) -> list[str]:
        return graphics(part, side)

    def names(self, part: RollerPart) -> set[str]:
        n = part.name
        found = super().names(part) | {f"p_{n}_anchor", f"b_{n}_carrier", f"j_{n}_slide"}
        found |= {f"frc_{n}_clutch", f"frc_{n}_axle"}
        found |= {f"p_{n}_pivot", f"p_{n}_arm", f"b_{n}_arm", f"j_{n}_pivot", f"bsh_{n}_arm"}
        if part.rim is not None:
            shown = [name.removeprefix("gbox_") for name in graphics(part, WHOLE)]
            found |= {f"m_{n}", *(f"{kind}_{name}" for name in shown for kind in ("p", "gbox"))}
        return found


def _of_motor(model: Model, part: RollerPart) -> dict[str, float]:
    """No-load speed at the roller [rad/s], and growth of torque [N mm s/rad] over what it is slower than that
    [rad/s], by pieces of a table."""
    axle, last = part.axle, 0 if part.axle is None else len(part.axle.curve) - 1
    if axle is None or last < 1:
        return {}
    slow, torque = axle.curve.T
    slopes = np.diff(torque) / np.diff(slow) * SECOND
    given = {p.member: p.value for p in model.parameters if p.data_set == part.name}
    if "T_m" in given:
        return {"w_n": given["w_m"] / given["g_m"] / SECOND, "k_m": float(slopes[0])}
    found = {"w_n": given[f"w_m{last}"] / given["g_m"] / SECOND}
    for k in range(last, 0, -1):  # the curve begins without load, the table at rest
        found[f"k_m{k}"] = float(slopes[last - k])
        if k < last:
            found[f"b_m{k}"] = float(slow[last - k]) / SECOND
    return found


KIND = _Rollers()


def cylinders(model: Model) -> Table:
    """The cylinders that show all rollers."""
    rollers = model.rollers
    starts = [model.bodies.position[r.body] - r.axis * r.width / 2 for r in rollers]
    parts: dict[str, Part] = {
        "start": (np.array(starts).reshape(-1, 3), reach(model)),
        "axis": (np.array([r.axis for r in rollers]).reshape(-1, 3), 1.0),
        "radii": (np.array([(r.radius, r.radius) for r in rollers]).reshape(-1, 2), None),
        "length": (np.array([r.width for r in rollers]), None),
    }
    return table([f"gcyl_{r.name}" for r in rollers], parts, [(f"b_{r.name}", "CAPBOTH") for r in rollers])

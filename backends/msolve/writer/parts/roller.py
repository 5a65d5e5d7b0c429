"""Rollers: axles, slides, arms, drives, clutches and rims."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from mdlgen.altair.axles import pieces
from mdlgen.altair.rims import Side, graphics, rim_facets
from mdlgen.backends.msolve.writer.bodies import body, box, press
from mdlgen.backends.msolve.writer.parts.kind import Kind, Table
from mdlgen.backends.msolve.writer.units import per_thousand, row, same, thousandfold
from mdlgen.model.tables import Model, RollerPart
from mdlgen.model.tables.axle import LIMITER, OPEN, AxlePart


class _Rollers(Kind[RollerPart]):
    note = "axes: x, y and the axle"
    pressed = recorded = True

    def table(self, model: Model, part: RollerPart) -> Table:
        table = {**body(model, part.body), "radius": same(part.radius), "width": same(part.width)}
        if part.press is not None:
            mass = part.press.carrier_mass
            ball = 0.4 * mass * part.radius**2  # a solid ball, as the text has it
            own = {"mass": per_thousand(mass), "inertia": row([ball] * 3, per_thousand)}
            table["press"] = {**press(part, part.press), **own}
        if part.arm is not None:
            arm = part.arm
            table["arm"] = {
                "pivot": row(arm.pivot),
                "center": row(arm.center),
                "mass": per_thousand(arm.mass),
                "inertia": row([arm.inertia] * 3, per_thousand),
            }
            if arm.sprung:
                spring = {
                    "kt": same(arm.stiffness),
                    "ct": per_thousand(arm.damping),
                    "torque": same(arm.torque),
                }
                table["arm"] |= spring
        if part.profile is not None:
            corners = [[per_thousand(t), thousandfold(w)] for t, w in part.profile.tolist()]
            table["drive"] = {"profile": corners}
        elif part.speed is not None:
            table["drive"] = {"speed": thousandfold(part.speed), "ramp": per_thousand(part.ramp)}
        if part.one_way is not None:
            way = part.one_way
            clutch = {"torque": same(way.torque), "creep": thousandfold(way.creep)}
            table["clutch"] = {"direction": way.direction, **clutch}
        if part.axle is not None:
            table |= _torques(part.axle)
        if part.rim is not None:
            rim: dict[str, list[Any]] = {name: [] for name in part.rim.name}
            place, turned = model.bodies.position[part.body], model.bodies.rotation[part.body]
            for name, facet in rim_facets(part, place, turned):
                rim[name.removeprefix(f"{part.name}_").split("_")[0]].append(box(facet))
            table["rim"] = rim
        return table

    def graphics(self, part: RollerPart, side: Side) -> int:
        return len(graphics(part, side))

    def is_round(self, part: RollerPart, side: Side) -> bool:
        return graphics(part, side)[0].startswith("gcyl_")

    def labels(self, part: RollerPart) -> Iterator[str]:
        if part.press is not None:
            yield f"b_{part.name}_carrier"
        if part.arm is not None:
            yield f"b_{part.name}_arm"
        yield f"o_{part.name}"


def _torques(axle: AxlePart) -> Table:
    """Of a motor that runs by its voltage, a limiter and a bearing; none of them: no torque."""
    found: Table = {"torques": {}}
    if axle.kind == OPEN:
        found["torques"]["motor"] = [[thousandfold(s), per_thousand(more)] for s, more in pieces(axle)]
    elif axle.kind == LIMITER:
        found["torques"]["limiter"] = {"torque": same(axle.limit), "creep": thousandfold(axle.creep)}
    if axle.friction or axle.drag:
        bearing = {"torque": same(axle.friction), "creep": thousandfold(axle.ease)}
        found["torques"]["bearing"] = bearing | {"drag": per_thousand(axle.drag)}
    return found


KIND = _Rollers()

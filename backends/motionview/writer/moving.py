"""Rows of how guides, planes and meshes move, and of stops."""

from __future__ import annotations

from typing import NamedTuple

from mdlgen.altair.stops import stop_law
from mdlgen.backends.motionview.writer.axes import axis_of
from mdlgen.backends.motionview.writer.rows import Axis
from mdlgen.backends.motionview.writer.units import number
from mdlgen.mechanics.gate import BLUNT
from mdlgen.model.tables import MovingPart

Derived = list[tuple[str, str, str]]


class StopsView(NamedTuple):
    """Stops at a joint of a body to ground."""

    name: str  # of the part
    joint: str
    turns: bool
    body: str
    point: str
    law: str  # force along the joint, or torque about it


class MovingView(NamedTuple):
    """A turn about an axis, or a slide along a line, by a profile, or by forces."""

    turns: bool
    axis: Axis
    corners: int  # of the profile; 1: it stands
    free: bool
    sprung: bool
    center: tuple[str, str, str] | None  # of its mass, where it turns freely
    inertia: str  # about that; empty: as of a fixed part
    mass: str  # of all that slides freely; empty: that of the part
    guide: str  # vector across its axis
    stops: StopsView | None


def moving_view(
    name: str, moving: MovingPart | None, point: str, members: set[str], mass: str
) -> MovingView | None:
    """Of a part of a `mass`, whose body is at a point; None: it is fixed."""
    if moving is None:
        return None
    center, inertia, axis = None, "", axis_of(f"v_{name}_moves", moving.axis)
    if moving.free and moving.turns:
        letter = "g" if "g_x" in members else "a"
        center = (f"${letter}_x", f"${letter}_y", f"${letter}_z")
        inertia = f"($I_q-{mass}*{across(center, axis.vector)})" if letter == "g" else "$I_q"
    stops = None
    if moving.stops is not None:
        joint = f"j_{name}_{'pivot' if moving.turns else 'slide'}"
        stops = stops_view(
            name, joint, moving.turns, f"b_{name}", f"p_{name}_pivot" if moving.turns else point
        )
    least = min(range(3), key=lambda k: abs(moving.axis[k]))
    return MovingView(
        moving.turns,
        axis,
        len(moving.corners),
        moving.free,
        moving.sprung,
        center,
        inertia,
        "$M_q" if moving.free and not moving.turns else "",
        f"V_Global_{'XYZ'[least]}",
        stops,
    )


def moving_derived(members: set[str]) -> Derived:
    """What is computed of the stops of a part that moves freely."""
    return stops_derived(members, "$I_q" if "I_q" in members else "$M_q")


def across(point: tuple[str, str, str], axis: str) -> str:
    """Square of the distance of a point from the pivot $a, across an axis."""
    ways = [f"({p}-$a_{a})" for p, a in zip(point, "xyz", strict=True)]
    along = "+".join(f"{way}*{axis}.{a}" for way, a in zip(ways, "xyz", strict=True))
    return f"({'+'.join(f'{way}^2' for way in ways)}-({along})^2)"


def stops_view(name: str, joint: str, turns: bool, body: str, point: str, begins: str = "") -> StopsView:
    """Stops whose places count from $begins in the joint."""
    i, j = (f"{{{joint}.{end}.idstring}}" for end in "ij")
    place, rate = (f"AZ({i},{j})", f"WZ({i},{j},{j})") if turns else (f"DZ({i},{j},{j})", f"VZ({i},{j},{j})")
    unit = "*PI/180" if turns else f"-({{{begins}}})" if begins else ""
    low, high = (f"({{$e_{end}}}){unit}" if unit else f"{{$e_{end}}}" for end in ("lo", "hi"))
    return StopsView(
        name, joint, turns, body, point, stop_law(place, rate, (low, high), "{$k_e}", "{$b_e}", "{$o_e}")
    )


def stops_derived(members: set[str], inertia: str) -> Derived:
    """What is computed of stops: beta of their damping, and the rate over the place beyond at which that has
    changed its sign, by the inertia [kg, kg mm^2] of what moves."""
    if "k_e" not in members:
        return []
    rate = "Rate over way beyond a stop with all its damping (1/s)"
    return [
        ("b_e", "beta of the damping of its stops", "(1-$c_e^2)/(1+$c_e^2)"),
        ("o_e", rate, f"{number(BLUNT)}*sqrt(1000*$k_e/({inertia}))"),
    ]

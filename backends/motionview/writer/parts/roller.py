"""Rows of rollers, with their motors, arms and rims."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mdlgen.altair.rims import DEEP, WHOLE, graphics
from mdlgen.backends.motionview.writer.axes import axis_of, components, zx_vector
from mdlgen.backends.motionview.writer.moving import StopsView, across, stops_derived, stops_view
from mdlgen.backends.motionview.writer.parts.kind import Kind, PartView
from mdlgen.backends.motionview.writer.rows import Axis, Value
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.parameters.axles import home_of
from mdlgen.model.tables import Model, RimPart, RollerPart
from mdlgen.model.tables.axle import AxlePart


class ArmView(NamedTuple):
    """An arm: its centre of mass, and whether it has a spring."""

    center: tuple[str, str, str]
    sprung: bool


class AxleView(NamedTuple):
    """Torques about the axle."""

    points: int  # of its motor's curve; 0: it has no motor
    line: bool  # that is one of its stall torque and its no-load speed
    voltages: int  # corners of its motor's voltage; 0: full voltage throughout
    limiter: bool
    bearing: bool


class SectorView(NamedTuple):
    """A sector of a rim: its angles (deg) and radius as formulas, and how many boxes show it."""

    name: str
    begin: str
    radius: str
    facets: int


@dataclass(frozen=True)
class RollerView(PartView):
    """One roller."""

    template = "roller.mdl.j2"
    axis: Axis
    guide: str  # global vector that fixes the x axis of the body
    spins: str  # as the run begins, the value that says how fast; empty: it does not
    home: str  # data set of its speed: its own, or that of its shaft
    driven: bool  # has a speed: of its axle, or of the shaft of its clutch
    free_sense: int  # of its clutch, 1 or -1; 0: it has none
    ramped: bool
    corners: int  # of its speed over time; 0: a ramp
    pressed: bool
    press: tuple[str, str, str]
    arm: ArmView | None
    axle: AxleView | None
    stops: StopsView | None  # of its press, or its arm
    rim: list[SectorView]
    derived: list[tuple[str, str, str]]


class _Rollers(Kind[RollerPart]):
    def view(self, model: Model, part: RollerPart, given: list[Value]) -> RollerView:
        """One roller; its body has z along the axis."""
        press, home = part.press, home_of(model, part)
        rim, derived = _rim(part.rim) if part.rim is not None else ([], [])
        members, axis = {value.member for value in given}, axis_of(f"v_{part.name}_axis", part.axis)
        arm = None
        if part.arm is not None:
            x, y, z = (f"$g_{a}" if "g_x" in members else f"($a_{a}+${a})/2" for a in "xyz")
            arm = ArmView((x, y, z), part.arm.sprung)
            if "I_a" not in members:
                derived = [("I_a", "Inertia of the arm, a rod (kg mm2)", _rod(axis.vector)), *derived]
        derived = [*stops_derived(members, _stopped(part, axis.vector, arm)), *derived]
        axle = None
        if part.axle is not None:
            own, derived = part.axle, [*_motor(members, part.axle), *derived]
            corners = 0 if "u_0" not in members or part.profile is None else len(part.profile)
            axle = AxleView(len(own.curve), "T_m" in members, corners, "T_l" in members, "T_b" in members)
        return RollerView(
            name=part.name,
            given=given,
            axis=axis,
            guide=zx_vector(model.bodies.rotation[part.body]),
            spins=_begins(part, home) if part.first_spin != 0.0 else "",
            home=home,
            driven=part.speed is not None,
            free_sense=0 if part.one_way is None else part.one_way.direction,
            ramped=part.ramp > 0.0,
            corners=0 if part.profile is None else len(part.profile),
            pressed=press is not None,
            press=components(press.direction if press is not None else np.zeros(3)),
            arm=arm,
            axle=axle,
            stops=_stops(part),
            rim=rim,
            derived=derived,
        )

    def graphics(self, part: RollerPart) -> list[str]:
        return graphics(part, WHOLE)


def _begins(part: RollerPart, home: str) -> str:
    """The spin of a roller as the run begins: its own, or that of what drives it."""
    if not part.begins_turning:
        return "$spin"
    member = "omega" if part.profile is None else "w_0"
    return f"${member}" if home == part.name else f"$ratio*ds_{home}.real_{member}.value"


def _rod(axis: str) -> str:
    """Inertia of a rod from the pivot of an arm to the roller, about the middle along the axis."""
    along = "+".join(f"(${a}-$a_{a})*{axis}.{a}" for a in "xyz")
    square = "+".join(f"(${a}-$a_{a})^2" for a in "xyz")
    return f"$M_a*({square}-({along})^2)/12"


def _stops(part: RollerPart) -> StopsView | None:
    name = part.name
    if part.press is not None and part.press.stops is not None:
        return stops_view(name, f"j_{name}_slide", False, f"b_{name}_carrier", f"p_{name}", "$start")
    if part.arm is not None and part.arm.stops is not None:
        return stops_view(name, f"j_{name}_pivot", True, f"b_{name}_arm", f"p_{name}_pivot")
    return None


def _stopped(part: RollerPart, axis: str, arm: ArmView | None) -> str:
    """Mass of all that slides with a press, or inertia of all that turns with an arm."""
    if arm is None:
        return "$M+$M_c"
    turned = "+$M*$R^2/2" if part.speed is not None else ""
    return f"$I_a+$M_a*{across(arm.center, axis)}+$M*{across(('$x', '$y', '$z'), axis)}{turned}"


def _motor(members: set[str], axle: AxlePart) -> list[tuple[str, str, str]]:
    """What is computed of a motor: its no-load speed at the roller, and how its torque grows with what the
    roller is slower than that; of a table by pieces, from the no-load speed down."""
    last = len(axle.curve) - 1
    if last < 1:
        return []
    no_load = ("w_n", "No-load speed at the roller (rad/s)")
    if "T_m" in members:
        slope = "Torque over speed at the roller (N mm s/rad)"
        return [(*no_load, "$w_m/$g_m"), ("k_m", slope, "$g_m^2*$T_m/sqrt($w_m^2)")]
    derived: list[tuple[str, str, str]] = [(*no_load, f"$w_m{last}/$g_m")]
    for k in range(last, 0, -1):
        slower = f"($w_m{k}-$w_m{k - 1})" if k > 1 else "$w_m1"
        torque = f"($T_m{k - 1}-$T_m{k})" if k < last else f"$T_m{last - 1}"
        what = f"between its points {k - 1} and {k}"
        derived.append((f"k_m{k}", f"Torque over speed {what} (N mm s/rad)", f"$g_m^2*{torque}/{slower}"))
        if k < last:
            what = f"Slower than without load at point {k}, at the roller (rad/s)"
            derived.append((f"b_m{k}", what, f"($w_m{last}-$w_m{k})/$g_m"))
    return derived


def _rim(rim: RimPart) -> tuple[list[SectorView], list[tuple[str, str, str]]]:
    """The sectors of a rim, and what is computed of them; the number of their boxes is fixed in a text."""
    views, derived = [], []
    given = [name for name in rim.name if name[0] == "s"]
    for k, (name, own, facets) in enumerate(zip(rim.name, rim.own, rim.facets, strict=True)):
        number_of = int(name[1:])
        begin, end = f"$s{number_of}_from", f"$s{number_of}_to"
        if name[0] == "g":
            begin = end
            end = f"$s{number_of + 1}_from" if number_of + 1 < len(given) else "($s0_from+360)"
        radius = f"${name}_radius" if own else "$R"
        what = f"Sector {number_of}" if name[0] == "s" else f"Behind sector {number_of}"
        derived += [
            (f"{name}_n", f"{what} : boxes that show it; fixed in this text", str(facets)),
            (f"{name}_turn", f"{what} : angle of one of them", f"({end}-{begin})*PI/180/${name}_n"),
            (f"{name}_deep", f"{what} : thickness of a box (mm)", f"{number(DEEP)}*{radius}"),
            (f"{name}_chord", f"{what} : length of a box (mm)", f"2*{radius}*tan(${name}_turn/2)"),
        ]
        # within a turn either way, as people write angles
        turns = 360 * round(np.degrees(0.5 * (rim.begin[k] + rim.end[k])) / 360)
        views.append(SectorView(name, f"({begin}-({turns}))" if turns else begin, radius, facets))
    return views, derived


KIND = _Rollers()

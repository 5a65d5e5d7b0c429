"""Results of each part of a scene, by its name, in the units of summary.json: mm, mm/s, deg, N, rad/s."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from mdlgen.model.tables import Floats
from mdlgen.results.compare import travel
from mdlgen.results.passing import span
from mdlgen.results.summary_of_parts import part_rows
from mdlgen.results.torques import contact_torque, drive_power, drive_torque, grips
from mdlgen.results.wording import number, numbers
from mdlgen.units import PER_SECOND

if TYPE_CHECKING:
    from mdlgen.results.result import Result
    from mdlgen.results.tension import Tension

_SHOWN = 4  # digits


@dataclass(frozen=True, repr=False, eq=False, kw_only=True)
class _Named:
    """Shows its values at the end with their units."""

    units: ClassVar[dict[str, str]] = {}  # of each value
    shown: ClassVar[tuple[str, ...]] = ()
    name: str

    def __repr__(self) -> str:
        given = ", ".join(f"{key} {_text(getattr(self, key))} {self.units[key]}" for key in self.shown)
        return f"<{self.name}: {given}>"


def _text(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"[{', '.join(numbers(value.tolist(), _SHOWN, '-'))}]"
    return number(value, _SHOWN)


@dataclass(frozen=True, repr=False, eq=False, kw_only=True)
class SheetResult(_Named):
    """A sheet: values at the end, and its motion over `time`."""

    units: ClassVar[dict[str, str]] = {
        "travel": "mm",
        "speed": "mm/s",
        "yaw": "deg",
        "time": "ms",
        "position": "mm",
        "velocity": "mm/s",
        "turn": "deg",
        "tension": "N",
    }
    shown: ClassVar[tuple[str, ...]] = ("travel", "speed", "yaw")
    travel: Floats  # displacement of the centre of mass since the start [mm], (3,)
    speed: Floats  # [mm/s], velocity of the centre of mass at the end, (3,)
    yaw: float  # [deg], at the end
    time: Floats  # times of the values below [ms], (t,)
    position: Floats  # of the centre of mass [mm], (t, 3)
    velocity: Floats  # [mm/s], (t, 3)
    turn: Floats  # yaw [deg], (t,)
    # along its way: `force` of sections [N], (t, sections), `at` [mm]; None where it has no joints along it
    tension: Tension | None


@dataclass(frozen=True, repr=False, eq=False, kw_only=True)
class RollerResult(_Named):
    """A roller: values at the end, and its motion over `time`."""

    units: ClassVar[dict[str, str]] = {
        "speed": "rad/s",
        "center": "mm",
        "nip_force": "N",
        "time": "ms",
        "rate": "rad/s",
        "force": "N",
        "torque": "N*mm",
        "power": "W",
        "drive_torque": "N*mm",
        "drive_power": "W",
        "contact_torque": "N*mm",
        "tangential": "N",
        "traction": "1",
    }
    shown: ClassVar[tuple[str, ...]] = ("speed", "center", "nip_force", "torque", "power")
    speed: float  # about its axis [rad/s]
    center: Floats  # [mm], (3,)
    nip_force: float  # [N], sum of the normal forces on it
    torque: float  # [N mm], that its drive gives about its axis, 0 of a free one
    power: float  # [W], that its drive gives
    time: Floats  # times of the values below [ms], (t,)
    rate: Floats  # speed about its axis [rad/s], (t,)
    force: Floats  # sum of the normal forces [N], (t,)
    drive_torque: Floats  # that its drive gives about its axis [N mm], (t,)
    drive_power: Floats  # [W], (t,)
    contact_torque: Floats  # that contacts exert on it about its axis [N mm], (t,)
    tangential: Mapping[str, Floats]  # friction along its surface by the other part, as it turns [N], (t,)
    traction: Mapping[str, Floats]  # |T| / (mu N) of each, nan where it does not act, (t,)


@dataclass(frozen=True, repr=False, eq=False, kw_only=True)
class ProbeResult(_Named):
    """A probe: values at the end, and its motion over `time`."""

    units: ClassVar[dict[str, str]] = {
        "displacement": "mm",
        "speed": "mm/s",
        "time": "ms",
        "position": "mm",
        "velocity": "mm/s",
    }
    shown: ClassVar[tuple[str, ...]] = ("displacement", "speed")
    displacement: Floats  # [mm], since the start, (3,)
    speed: Floats  # [mm/s], velocity at the end, (3,)
    time: Floats  # times of the values below [ms], (t,)
    position: Floats  # [mm], (t, 3)
    velocity: Floats  # [mm/s], (t, 3)


def sheets(result: Result) -> Mapping[str, SheetResult]:
    """Results of the sheets, by name; a run that stored no state has none."""
    found = {}
    for k, sheet in enumerate(result.model.sheets if len(result.time) else ()):
        place, rate, yaw = result.sheet_motion(k)
        _, last = span(result, k)
        found[sheet.name] = SheetResult(
            name=sheet.name,
            travel=np.asarray(travel(result, k), dtype=float),
            speed=rate[last] * PER_SECOND,
            yaw=math.degrees(yaw[-1]),
            time=result.time,
            position=place,
            velocity=rate * PER_SECOND,
            turn=np.degrees(yaw),
            tension=result.tensions[k],
        )
    return MappingProxyType(found)


def rollers(result: Result) -> Mapping[str, RollerResult]:
    """Results of the rollers, by name; a run that stored no state has none."""
    found = {}
    for roller in result.model.rollers if len(result.time) else ():
        rate = result.spin[:, roller.body] @ roller.axis * PER_SECOND
        force = result.contact_force[:, list(part_rows(result, roller))].sum(axis=1)
        unknown = np.full(len(result.time), np.nan)  # of a file of an older version
        torque, power, contacts = (
            unknown if values is None else values
            for values in (f(result, roller) for f in (drive_torque, drive_power, contact_torque))
        )
        held = {grip.other: grip for grip in grips(result, roller)}
        found[roller.name] = RollerResult(
            name=roller.name,
            speed=float(rate[-1]),
            center=result.position[-1, roller.body],
            nip_force=float(force[-1]),
            time=result.time,
            rate=rate,
            force=force,
            torque=float(torque[-1]),
            power=float(power[-1]),
            drive_torque=torque,
            drive_power=power,
            contact_torque=contacts,
            tangential=MappingProxyType({other: grip.along for other, grip in held.items()}),
            traction=MappingProxyType({other: grip.used for other, grip in held.items()}),
        )
    return MappingProxyType(found)


def probes(result: Result) -> Mapping[str, ProbeResult]:
    """Results of the probes, by name; a run that stored no state has none."""
    found = {}
    for k, probe in enumerate(result.model.probes if len(result.time) else ()):
        place, rate = result.anchor_motion(k)
        _, last = span(result, probe.sheet)
        found[probe.name] = ProbeResult(
            name=probe.name,
            displacement=place[-1] - place[0],
            speed=rate[last] * PER_SECOND,
            time=result.time,
            position=place,
            velocity=rate * PER_SECOND,
        )
    return MappingProxyType(found)

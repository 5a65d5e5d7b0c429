"""Sheets between rollers: fixed, pressed and on arms, with and without a table."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mdlgen.bench.campaign import parts
from mdlgen.bench.campaign.draw import RANGES, Data, Draw, place, rounded
from mdlgen.bench.campaign.sheets import Drawn, sheet

# Part of the thickness that each roller of a nip may be pressed in: above a half they meet through the sheet
# (lint W105).
DEEP = 0.45


def grip(draw: Draw, thick: float) -> tuple[float, float]:
    """Force of a nip [N] and the least stiffness [N/mm^1.5] that holds it within DEEP."""
    deep = (DEEP * thick) ** 1.5
    force = draw.value("force", None, 0.7 * RANGES["stiffness"].high * deep)
    return force, force / deep


def transported(draw: Draw, *, most: int = 300, stock: str = "") -> Drawn:
    """A sheet whose boxes are short enough to follow rollers of 5 mm radius and more."""
    return sheet(draw, fewest=12, most=most, longest_box=8.0, stock=stock)


@dataclass(frozen=True)
class Drive:
    """Surface speed of the rollers of a scene."""

    speed: float  # [m/s]
    ramp: float  # [ms]

    @property
    def data(self) -> Data:
        made = {"surface_speed": f"{self.speed:g} m/s", "direction": "+x"}
        return {**made, "ramp": f"{self.ramp:g} ms"} if self.ramp else made

    def lasts(self, travel: float) -> float:
        """Time in which it conveys so far [ms]."""
        return self.ramp / 2 + travel / self.speed


def driven(draw: Draw, low: float | None = None, high: float | None = None) -> Drive:
    return Drive(draw.value("speed", low, high), draw.of(0.0, rounded(draw.log(1.0, 15.0))))


def nip(
    draw: Draw, one: Drawn, x: float, drive: Drive, held: str, lanes: int, radius: tuple[float, float]
) -> Data:
    """A nip at `x`, `held` pressed or fixed, in one or two lanes, with rollers of these radii [mm]."""
    force, stiff = grip(draw, one.thick)
    width = rounded(draw.even(0.2, 0.9) * one.width if lanes == 1 else draw.even(0.1, 0.25) * one.width)
    y = 0.0 if lanes == 1 else -rounded(0.28 * one.width)

    def roller(size: float, **keys: object) -> Data:
        contact = draw.contact("", "", stiff=stiff, speed=drive.speed)
        del contact["between"]
        mass = draw.even(*parts.DENSITY) * math.pi * size**2 * width
        return {**parts.cylinder(size, width, mass), **keys, "contact": contact}

    # a stiffer spring would lose its force on the path from the other roller to the sheet
    soft = min(2.0, 0.5 * force / one.thick)
    upper: Data = (
        {"press": {"stiffness": f"{draw.log(0.05 * soft, soft):g} N/mm"}} if held == "pressed" else {}
    )
    if draw.chance(0.2):
        upper["drive"] = drive.data
    between = draw.contact("", "", stiff=stiff, speed=drive.speed)
    del between["between"]
    made: Data = {
        "at": place(x, y, 0.0),
        "force": f"{force:g} N",
        "lower": roller(radius[0], drive=drive.data),
        "upper": roller(radius[1], **upper),
        "contact": between,
    }
    return {**made, "mirror": {"across": "y"}} if lanes == 2 else made


def table(draw: Draw, one: Drawn, length: float, x: float) -> Data:
    """A plate under the path of the sheet."""
    return parts.plate(length, 2.0 * one.width, x, -one.thick / 2 - draw.log(0.1, 2.0))


def _transport(draw: Draw, count: int) -> Data:
    """Sheets through `count` pairs; some of several pairs stand before the sheet."""
    one = transported(draw)
    drive = driven(draw)
    radius = draw.log(5.0, 15.0), draw.log(5.0, 12.0)
    lanes = draw.of(1, 2)
    pitch = max(2.0 * max(radius) + 1.0, draw.even(0.35, 0.8) * one.length)
    first = one.length * (draw.even(-0.3, 0.35) if count == 1 else draw.even(-0.35, 0.1))
    star = "_*" if lanes == 2 else ""
    nips = {}
    for k in range(count):
        own = Drive(rounded(drive.speed * draw.of(1.0, draw.even(1.0, 1.05))), drive.ramp)
        held = draw.of("pressed", "pressed", "fixed")
        nips[f"nip_{k + 1}{star}"] = nip(draw, one, first + k * pitch, own, held, lanes, radius)
    moves: Data = {}
    if draw.chance(0.25):
        moves["velocity"] = [f"{drive.speed:g} m/s", "0 m/s", "0 m/s"]
    if draw.chance(0.25):
        moves["turn"] = f"{draw.even(-5.0, 5.0):g} deg"
    scene: Data = {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, 0.0, **moves)},
        "nips": nips,
    }
    travel = draw.even(0.3, 1.0) * (one.length + (count - 1) * pitch)
    if draw.chance(0.5):
        scene["planes"] = {"table": table(draw, one, 3.0 * one.length + 2 * count * pitch, first)}
        scene["contacts"] = [draw.contact("note", "table", speed=drive.speed)]
    keys = {"margin": "40 mm"} if draw.chance(0.3) else {}
    return {**scene, "run": draw.run(drive.lasts(travel), **keys)}


def single(draw: Draw) -> Data:
    """One pair of rollers, pressed or fixed, in one or two lanes, conveys a sheet; half of the scenes have a
    table."""
    return _transport(draw, 1)


def several(draw: Draw) -> Data:
    """Two or three pairs, each pressed or fixed; later ones may be up to 5 % faster."""
    return _transport(draw, draw.of(2, 3))


def arms(draw: Draw) -> Data:
    """A pair whose upper roller is on an arm with a spring, in one or two lanes."""
    one = transported(draw)
    drive = driven(draw)
    force, stiff = grip(draw, one.thick)
    radius = draw.log(5.0, 15.0), draw.log(4.0, 10.0)
    x = rounded(one.length * draw.even(-0.2, 0.3))
    lanes = draw.of((0.0,), (-rounded(0.28 * one.width), rounded(0.28 * one.width)))
    width = rounded(draw.even(0.1, 0.25) * one.width)
    # behind the roller, as trailing arms are, above it
    reach, rise = draw.even(15.0, 40.0), draw.even(2.0, 15.0)
    spring = {"stiffness": f"{draw.log(10.0, 300.0):g} N*mm/rad"} if draw.chance(0.7) else {}
    rollers: Data = {}
    for k, y in enumerate(lanes, 1):
        high = radius[1] + one.thick / 2
        motor = parts.roller(draw, x, y, -radius[0] - one.thick / 2, radius[0], width)
        rollers[f"motor_{k}"] = {**motor, "drive": drive.data}
        rollers[f"idler_{k}"] = {
            **parts.roller(draw, x, y, high, radius[1], width),
            "arm": {
                "pivot": place(x - reach, y, high + rise),
                "mass": f"{draw.log(1.0, 10.0):g} g",
                "torque": f"{rounded(force * reach):g} N*mm",
                **spring,
            },
        }
    pairs = [("note", "motor_*"), ("note", "idler_*")]
    pairs += [(f"motor_{k + 1}", f"idler_{k + 1}") for k in range(len(lanes))]
    contacts = [draw.contact(first, second, stiff=stiff, speed=drive.speed) for first, second in pairs]
    scene: Data = {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, 0.0)},
        "rollers": rollers,
    }
    if draw.chance(0.5):
        scene["planes"] = {"table": table(draw, one, 4.0 * one.length, x)}
        contacts.append(draw.contact("note", "table", speed=drive.speed))
    travel = draw.even(0.2, 0.9) * one.length
    return {**scene, "contacts": contacts, "run": draw.run(drive.lasts(travel))}


def pick(draw: Draw) -> Data:
    """A driven roller on an arm, by its weight and a spring (0.5 to 3 N), drives a sheet on a table."""
    one = transported(draw)
    drive = driven(draw, None, 1.0)
    radius = draw.log(6.0, 15.0)
    width = rounded(draw.even(0.2, 0.7) * one.width)
    x, reach = rounded(one.length * draw.even(-0.2, 0.2)), draw.even(20.0, 50.0)
    force = draw.value("force", 0.5, 3.0)
    side = draw.sign()  # the arm trails the sheet, or stands against it
    # above the horizontal through the roller's lowest point; lower pivots lock where they stand ahead
    high = one.thick + radius
    part = {
        **parts.roller(draw, x, 0.0, high, radius, width),
        "drive": drive.data,
        "arm": {
            "pivot": place(x - side * reach, 0.0, high + draw.even(0.0, 10.0)),
            "mass": f"{draw.log(2.0, 10.0):g} g",
            "torque": f"{rounded(side * force * reach):g} N*mm",
            **({"damping": f"{draw.log(100.0, 3000.0):g} N*mm*ms/rad"} if draw.chance(0.5) else {}),
        },
    }
    contacts = [
        draw.contact("note", "pick", stiff=100.0, speed=drive.speed),
        draw.contact("note", "table", stiff=100.0, speed=drive.speed, friction=draw.even(0.1, 0.5)),
        draw.contact("pick", "table", stiff=100.0, speed=drive.speed),
    ]
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, one.thick / 2)},
        "rollers": {"pick": part},
        "planes": {"table": parts.plate(5.0 * one.length, 2.0 * one.width, one.length)},
        "contacts": contacts,
        "run": draw.run(drive.lasts(draw.even(0.2, 1.2) * one.length)),
    }


def gate(draw: Draw) -> Data:
    """A pair of rollers pushes a sheet on a table against a wall, up to 5 mm further than it can go."""
    one = transported(draw)
    drive = driven(draw, None, 1.0)
    radius = draw.log(5.0, 12.0), draw.log(5.0, 12.0)
    x = rounded(one.length * draw.even(-0.3, 0.2))
    gap = max(draw.log(1.0, 20.0), x + max(radius) + 1.0 - one.length / 2)
    height = draw.even(5.0, 30.0)
    stop = parts.wall(one.length / 2 + gap, 1.5 * one.width, height, -3.0)
    held = draw.of("pressed", "fixed")
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, 0.0)},
        "nips": {"nip": nip(draw, one, x, drive, held, 1, radius)},
        "planes": {"table": table(draw, one, 4.0 * one.length, 0.0), "wall": stop},
        "contacts": [
            draw.contact("note", "table", speed=drive.speed),
            draw.contact("note", "wall", stiff=grip(draw, one.thick)[1], speed=drive.speed),
        ],
        "run": draw.run(drive.lasts(gap + draw.even(0.5, 5.0))),
    }

"""Sheets that are thrown, that slide, that come against walls and that slip off tables."""

from __future__ import annotations

import math

from mdlgen.bench.campaign import parts
from mdlgen.bench.campaign.draw import Data, Draw, mm, rounded
from mdlgen.bench.campaign.kinds.falls import lowest
from mdlgen.bench.campaign.parts import plate
from mdlgen.bench.campaign.sheets import sheet


def thrown(draw: Draw) -> Data:
    """A sheet is thrown on a large plate at up to 3 m/s, spinning (up to 15 rad/s) and turned (up to 15
    deg)."""
    one = sheet(draw)
    about_x, about_y = draw.even(-15.0, 15.0), draw.even(-15.0, 15.0)
    height = draw.log(2.0, 40.0)
    speed, down, aside = draw.value("speed"), draw.even(10.0, 80.0), draw.even(-60.0, 60.0)
    level = speed * math.cos(math.radians(down))
    velocity = (
        level * math.cos(math.radians(aside)),
        level * math.sin(math.radians(aside)),
        -speed * math.sin(math.radians(down)),
    )
    note = one.at(
        0.0,
        0.0,
        lowest(one, about_x, about_y) + height,
        rotation=[f"{about_x:g} deg", f"{about_y:g} deg", "0 deg"],
        velocity=[f"{rounded(v):g} m/s" for v in velocity],
        spin=[f"{draw.even(-15.0, 15.0):g} rad/s" for _ in range(3)],
    )
    fall = height / max(0.15, -velocity[2])
    keys = {"margin": mm(draw.of(40.0, 60.0))} if draw.chance(0.5) else {}
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": note},
        "planes": {"table": plate(600.0, 600.0, 100.0)},
        "contacts": [draw.contact("note", "table")],
        "run": draw.run(min(fall, 80.0) + draw.log(10.0, 60.0), **keys),
    }


def slide(draw: Draw) -> Data:
    """A sheet slides along a plate at up to 3 m/s, in a third of the scenes over its end."""
    one = sheet(draw)
    speed, duration = draw.value("speed"), draw.log(20.0, 150.0)
    after = one.length / 2 + 1.2 * speed * duration
    if draw.chance(1 / 3):
        after = one.length / 2 + draw.even(0.1, 0.6) * speed * duration
    start = -one.length - 20.0
    table = plate(after - start, 2.0 * max(one.width, one.length), (after + start) / 2)
    note = one.at(
        0.0,
        0.0,
        one.thick / 2 + draw.of(0.0, 0.0, draw.log(0.02, 0.3)),
        velocity=[f"{speed:g} m/s", f"{draw.of(0.0, rounded(speed * draw.even(-0.2, 0.2))):g} m/s", "0 m/s"],
        turn=f"{draw.of(0.0, draw.even(-30.0, 30.0)):g} deg",
    )
    keys = {"margin": "40 mm"} if draw.chance(0.4) else {}
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": note},
        "planes": {"table": table},
        "contacts": [draw.contact("note", "table")],
        "run": draw.run(duration, **keys),
    }


def wall(draw: Draw) -> Data:
    """A sheet slides along a plate and comes against a wall, straight or askew."""
    one = sheet(draw)
    speed = draw.value("speed")
    turn = draw.of(0.0, 0.0, draw.even(-20.0, 20.0))
    reach = one.length / 2 * math.cos(math.radians(turn)) + one.width / 2 * abs(math.sin(math.radians(turn)))
    gap = draw.log(0.5, 15.0)
    height = draw.even(10.0, 40.0)
    keys = {"margin": "40 mm"} if draw.chance(0.4) else {}
    note = one.at(
        0.0,
        0.0,
        one.thick / 2 + draw.of(0.0, 0.05),
        velocity=[f"{speed:g} m/s", "0 m/s", "0 m/s"],
        turn=f"{turn:g} deg",
    )
    stop = parts.wall(reach + gap, 2.0 * max(one.width, one.length), height, -2.0)
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": note},
        "planes": {"table": plate(600.0, 400.0, 100.0), "wall": stop},
        "contacts": [draw.contact("note", "table"), draw.contact("note", "wall")],
        "run": draw.run(gap / speed + draw.log(10.0, 80.0), **keys),
    }


def slip(draw: Draw) -> Data:
    """A sheet lies on a table, 45 to 75 % of its length beyond the rounded edge, and slips off or stays."""
    one = sheet(draw, fewest=4)
    beyond = draw.even(0.45, 0.75) * one.length
    table = plate(2.0 * one.length, 1.5 * one.width, -one.length)
    table["edge_radius"] = mm(draw.log(0.5, 4.0))
    moves: Data = {}
    if draw.chance(0.3):
        moves["velocity"] = [f"{draw.log(0.1, 0.5):g} m/s", "0 m/s", "0 m/s"]
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(beyond - one.length / 2, 0.0, one.thick / 2, **moves)},
        "planes": {"table": table},
        "contacts": [draw.contact("note", "table")],
        "run": draw.run(draw.log(40.0, 250.0)),
    }

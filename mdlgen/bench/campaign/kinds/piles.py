"""Sheets on each other: piles that are fed and stacks that land."""

from __future__ import annotations

import math

from mdlgen.bench.campaign import parts
from mdlgen.bench.campaign.draw import RANGES, Data, Draw, mm, place, rounded
from mdlgen.bench.campaign.kinds.nips import Drive, driven
from mdlgen.bench.campaign.sheets import Drawn, sheet

# Factor by which a force that is applied at once deflects more than at rest (lint W122).
SUDDEN = 2.5
# Surface speed of a retard roller [m/s].
SLOW, FAST = 0.02, 0.1
# Length of a retard pad in radii of the feed roller.
PAD = 1.2
# Greatest jitter of a pile [mm], and how far its front edge then leads at one side by the greatest turn, of
# 0.5 deg, in widths.
JITTER, ASKEW = 0.5, 0.005


def _piled(draw: Draw, count: int) -> Drawn:
    """One of `count` sheets, of 300 boxes together."""
    most = max(4, int(RANGES["boxes"].high) // count)
    return sheet(draw, fewest=min(12, most), most=most, longest_box=12.0 if most >= 12 else None)


def _pile(draw: Draw, count: int, stiff: float, gap: float = 0.0, speed: float | None = None) -> Data:
    contact = draw.contact("", "", stiff=stiff, speed=speed, friction=draw.even(0.1, 0.6))
    del contact["between"]
    made: Data = {"of": "note", "count": count, "contact": contact}
    if gap:
        made["gap"] = mm(gap)
    if draw.chance(0.6):
        made["jitter"], made["turn"] = mm(draw.log(0.05, JITTER)), f"{draw.log(0.05, 0.5):g} deg"
        made["seed"] = draw.count(1, 99)
    return made


def _pressed(draw: Draw, thick: float) -> tuple[float, float]:
    """Force of a roller on a pile [N], and the stiffness below it that holds what lies there apart."""
    deep = (thick / 2) ** 1.5
    most = RANGES["stiffness"].high * deep / SUDDEN
    force = draw.value("force", 0.3, min(3.0, 0.8 * most))
    return min(force, 0.8 * most), min(SUDDEN * force / deep, 0.8 * RANGES["stiffness"].high)


def feed(draw: Draw) -> Data:
    """A pressed pick roller (0.5 to 3 N, less for thin sheets) drives the top of a pile of 2 to 8 sheets on a
    table."""
    count = draw.count(2, 8)
    one = _piled(draw, count)
    drive = driven(draw, None, 1.0)
    force, stiff = _pressed(draw, one.thick)
    radius, width = draw.log(6.0, 15.0), rounded(draw.even(0.2, 0.6) * one.width)
    pick = parts.roller(
        draw, one.length * draw.even(0.0, 0.3), 0.0, count * one.thick + radius, radius, width
    )
    pick["drive"] = drive.data
    pick["press"] = parts.spring(draw, "-z", force)
    contacts = [
        draw.contact("pile_*", "pick", stiff=stiff, speed=drive.speed, friction=draw.even(0.6, 1.2)),
        draw.contact("pile_*", "table", stiff=stiff, speed=drive.speed, friction=draw.even(0.2, 0.6)),
        draw.contact("pick", "table", stiff=stiff, speed=drive.speed),
    ]
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, one.thick / 2)},
        "piles": {"pile": _pile(draw, count, stiff, speed=drive.speed)},
        "rollers": {"pick": pick},
        "planes": {"table": parts.plate(4.0 * one.length, 2.0 * one.width, 0.5 * one.length)},
        "contacts": contacts,
        "run": draw.run(
            drive.lasts(draw.even(0.1, 0.6) * one.length), **({"margin": "40 mm"} if draw.chance(0.5) else {})
        ),
    }


def retard(draw: Draw) -> Data:
    """A pick roller pushes a pile of 2 to 4 sheets to a feed roller, against which a spring presses a retard
    pad or a retard roller, which turns back slowly or freely."""
    count = draw.count(2, 4)
    one = _piled(draw, count)
    drive = driven(draw, None, 0.8)
    force, stiff = _pressed(draw, one.thick)
    radius, width = draw.log(8.0, 14.0), rounded(draw.even(0.2, 0.6) * one.width)
    lead = one.length / 2
    top = count * one.thick
    beyond = draw.even(2.0, 10.0)  # from the leading edge to the feed roller
    pick = parts.roller(
        draw, lead - radius - 2.0 - draw.even(0.0, 0.3) * lead, 0.0, top + radius, radius, width
    )
    pick |= {"drive": drive.data, "press": parts.spring(draw, "-z", force)}
    faster = Drive(rounded(drive.speed * draw.even(1.0, 1.1)), drive.ramp)
    # the uppermost sheet comes in over the retard part, below the middle of the feed roller; the others begin
    # before that part, which they would stand in otherwise
    low = top - 1.25 * one.thick
    reach = max(0.5 * PAD * radius, math.sqrt(max(2.0 * radius * low - low * low, 0.0)))
    x = lead + max(beyond, reach + ASKEW * one.width + 2.0 * JITTER)
    feed_roller = parts.roller(draw, x, 0.0, low + radius, radius, width)
    feed_roller["drive"] = faster.data
    rubber = draw.even(0.5, 0.8)
    contacts = [
        draw.contact("pile_*", "pick", stiff=stiff, speed=drive.speed, friction=draw.even(0.9, 1.2)),
        draw.contact("pile_*", "table", stiff=stiff, speed=drive.speed, friction=draw.even(0.1, 0.3)),
        draw.contact("pile_*", "feed", stiff=stiff, speed=drive.speed, friction=draw.even(0.9, 1.2)),
        draw.contact("pile_*", "retard", stiff=stiff, speed=SLOW, friction=rubber),
        draw.contact("pick", "table", stiff=stiff, speed=drive.speed),
        draw.contact("feed", "retard", stiff=stiff, speed=SLOW, friction=rubber),
    ]
    end = x - radius - 1.0  # of the table
    scene: Data = {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, one.thick / 2)},
        "piles": {"pile": _pile(draw, count, stiff, speed=drive.speed)},
        "rollers": {"pick": pick, "feed": feed_roller},
        "planes": {"table": parts.plate(2.0 * one.length, 1.5 * one.width, end - one.length)},
        "contacts": contacts,
        "run": draw.run(drive.lasts(draw.even(0.3, 1.0) * one.length), margin="60 mm"),
    }
    spring = parts.spring(draw, "z", force)
    if draw.chance(0.5):
        length = rounded(PAD * radius)
        scene["planes"]["retard"] = {
            "center": place(x, 0.0, low - 1.0),
            "normal": "z",
            "size": [mm(length), mm(rounded(1.2 * width)), "2 mm"],
            "mass": f"{draw.log(1.0, 10.0):g} g",
            "press": spring,
        }
    else:
        small = rounded(min(radius, x - end - 0.5))
        lower = {**parts.roller(draw, x, 0.0, low - small, small, width), "press": spring}
        if draw.chance(0.6):
            back = math.copysign(rounded(draw.even(SLOW, FAST) * 1e3 / small), -1.0)
            lower["drive"] = {"speed": f"{back:g} rad/s"}
        scene["rollers"]["retard"] = lower
    return scene


def stack(draw: Draw) -> Data:
    """2 to 6 sheets, 0.05 to 2 mm apart, fall on a plate and on each other; in a third of the scenes they
    move along it, at up to 1 m/s."""
    count = draw.count(2, 6)
    one = _piled(draw, count)
    gap = draw.log(0.05, 2.0)
    moves: Data = {}
    speed = draw.log(0.1, 1.0)
    if draw.chance(1 / 3):
        moves["velocity"] = [f"{speed:g} m/s", "0 m/s", "0 m/s"]
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, one.thick / 2 + draw.of(0.0, gap), **moves)},
        "piles": {"pile": _pile(draw, count, 100.0, gap)},
        "planes": {"table": parts.plate(6.0 * one.length, 3.0 * one.width, one.length)},
        "contacts": [draw.contact("pile_*", "table", stiff=100.0)],
        "run": draw.run(math.sqrt(2.0 * count * gap / 9.81e-3) + draw.log(15.0, 100.0)),
    }

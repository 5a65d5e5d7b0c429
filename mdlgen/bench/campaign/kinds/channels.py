"""Sheets that rollers push through guides, straight and bent."""

from __future__ import annotations

import math

from mdlgen.bench.campaign.draw import RANGES, Data, Draw, mm, place, rounded
from mdlgen.bench.campaign.kinds.nips import Drive, driven, nip, transported
from mdlgen.bench.campaign.sheets import Drawn

# Digits behind the point of the ends of guides: faces within 1e-6 mm of each other continue each other.
EXACT = 7
# Greatest friction of a guide.
SMOOTH = 0.5


def _paper(draw: Draw) -> Drawn:
    """A sheet for a channel: paper, and board where the radius is large."""
    return transported(draw, most=200, stock=draw.of("paper", "paper", "paper", "board"))


def _arc(x: float, up: int, radius: float, angle: float, gap: tuple[float, float], width: str) -> Data:
    """Outer and inner guide of a bend that begins at `x` along x and turns up (1) or down (-1)."""
    ends = (-90.0, rounded(angle - 90.0, 6)) if up > 0 else (rounded(90.0 - angle, 6), 90.0)
    shared = {
        "center": place(x, 0.0, up * radius),
        "axis": "-y",
        "from": f"{ends[0]:g} deg",
        "to": f"{ends[1]:g} deg",
    }
    return {
        "outer": {"arc": {**shared, "radius": mm(radius + gap[0]), "side": "inside"}, "width": width},
        "inner": {"arc": {**shared, "radius": mm(radius - gap[1]), "side": "outside"}, "width": width},
    }


def _guided(draw: Draw, one: Drawn, guides: list[str], radius: float, drive: Drive) -> Data:
    """Contact of a sheet with guides that bend it to a radius [mm]; guides are smooth. They hold it within
    half of its thickness: its bending force, D width / radius^2, rises to some 10 times as its edge
    arrives."""
    bending = one.modulus * one.thick**3 / 12.0 * one.width / radius**2
    stiff = min(10.0 * bending / (one.thick / 2) ** 1.5, 0.5 * RANGES["stiffness"].high)
    friction = draw.value("friction", None, SMOOTH)
    return draw.contact("note", guides, stiff=stiff, speed=drive.speed, friction=friction)


def _line(start: tuple[float, float], end: tuple[float, float], side: str, width: str) -> Data:
    """A straight guide between two points [x, z]."""
    first, last = (place(x, 0.0, z, EXACT) for x, z in (start, end))
    return {"line": {"from": first, "to": last, "axis": "-y", "side": side}, "width": width}


def _bend(draw: Draw, one: Drawn) -> tuple[float, float, tuple[float, float]]:
    """Radius, angle and half gaps: sheets that are bent more strongly would crease."""
    least = max(10.0, 60.0 * one.thick)
    gap = draw.log(0.6, 4.0) / 2
    return (
        round(draw.log(least, max(60.0, 1.5 * least)), 2),
        draw.even(20.0, 120.0),
        (round(gap + one.thick / 2, 2), round(gap + one.thick / 2, 2)),
    )


def _pushed(draw: Draw, one: Drawn, drive: Drive) -> tuple[Data, float, float]:
    """A nip near the leading edge, where it is, and where guides may begin behind it."""
    radius = draw.log(5.0, 10.0), draw.log(5.0, 10.0)
    x = round(one.length / 2 - draw.even(2.0, 0.4 * one.length), 1)
    made = nip(draw, one, x, drive, draw.of("pressed", "pressed", "fixed"), 1, radius)
    return {"nip": made}, x, x + max(radius) + draw.even(0.5, 4.0)


def arc(draw: Draw) -> Data:
    """A nip pushes a sheet into a bend of two arcs: radius 10 to 90 mm, gap 0.6 to 4 mm, 20 to 120 deg, up or
    down; the sheet begins before it."""
    one = _paper(draw)
    drive = driven(draw, 0.2, 2.0)
    nips, _, begins = _pushed(draw, one, drive)
    radius, angle, gap = _bend(draw, one)
    begins = round(max(begins, one.length / 2 + draw.even(0.2, 5.0)), 2)
    width = mm(rounded(1.2 * one.width))
    guides = _arc(begins, draw.sign(), radius, angle, gap, width)
    path = begins - one.length / 2 + radius * math.radians(angle) + draw.even(-0.3, 0.3) * one.length
    keys = {"margin": "40 mm"} if draw.chance(0.5) else {}
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, 0.0)},
        "nips": nips,
        "guides": guides,
        "contacts": [_guided(draw, one, ["outer", "inner"], radius, drive)],
        "run": draw.run(drive.lasts(max(5.0, path)), **keys),
    }


def channel(draw: Draw) -> Data:
    """The same with straight guides before the bend, after it, or both, which continue its faces."""
    one = _paper(draw)
    drive = driven(draw, 0.2, 2.0)
    nips, _, begins = _pushed(draw, one, drive)
    radius, angle, gap = _bend(draw, one)
    begins = round(max(begins, one.length / 2 - 10.0), 2)
    width = mm(rounded(1.2 * one.width))
    lead = round(max(begins + draw.even(3.0, 25.0), one.length / 2 + 0.5), 2)
    up = draw.sign()
    guides = _arc(lead, up, radius, angle, gap, width)
    outer, inner = (-up * gap[0], "left" if up > 0 else "right"), (up * gap[1], "right" if up > 0 else "left")
    form = draw.of("before", "after", "both")
    if form != "after":
        for name, (z, side) in (("outer_in", outer), ("inner_in", inner)):
            guides[name] = _line((begins, z), (lead, z), side, width)
    if form != "before":
        after = draw.even(5.0, 40.0)
        turn = math.radians(angle)
        along = math.cos(turn), up * math.sin(turn)
        for name, size, side in (
            ("outer_out", radius + gap[0], outer[1]),
            ("inner_out", radius - gap[1], inner[1]),
        ):
            start = lead + size * math.sin(turn), up * (radius - size * math.cos(turn))
            end = start[0] + after * along[0], start[1] + after * along[1]
            guides[name] = _line(start, end, side, width)
    path = lead - one.length / 2 + radius * math.radians(angle) + draw.even(-0.3, 0.5) * one.length
    keys = {"margin": "40 mm"} if draw.chance(0.5) else {}
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, 0.0)},
        "nips": nips,
        "guides": guides,
        "contacts": [_guided(draw, one, ["outer*", "inner*"], radius, drive)],
        "run": draw.run(drive.lasts(max(5.0, path)), **keys),
    }


def funnel(draw: Draw) -> Data:
    """A nip pushes a sheet between two straight guides that converge (5 to 25 deg each) to a gap of 0.6 to
    4 mm, which may continue straight."""
    one = _paper(draw)
    drive = driven(draw, 0.2, 2.0)
    nips, _, begins = _pushed(draw, one, drive)
    begins = round(max(begins, one.length / 2 - 10.0), 2)
    width = mm(rounded(1.2 * one.width))
    half = round(draw.log(0.6, 4.0) / 2 + one.thick / 2, 2)
    length, slope = draw.even(5.0, 25.0), draw.even(5.0, 25.0)
    wide = round(half + length * math.tan(math.radians(slope)), 3)
    middle = round(begins + length, 2)
    shift = draw.of(0.0, round(draw.even(-0.5, 0.5) * half, 2))
    guides = {
        "floor_in": _line((begins, shift - wide), (middle, shift - half), "left", width),
        "roof_in": _line((begins, shift + wide), (middle, shift + half), "right", width),
    }
    straight = draw.even(5.0, 40.0) if draw.chance(0.7) else 0.0
    if straight:
        for name, z, side in (("floor", shift - half, "left"), ("roof", shift + half, "right")):
            guides[name] = _line((middle, z), (round(middle + straight, 2), z), side, width)
    path = middle + straight - one.length / 2 + draw.even(-0.3, 0.3) * one.length
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, 0.0)},
        "nips": nips,
        "guides": guides,
        "contacts": [_guided(draw, one, ["floor*", "roof*"], 40.0, drive)],
        "run": draw.run(drive.lasts(max(5.0, path))),
    }

"""Curled and folded sheets, and sheets with dog ears."""

from __future__ import annotations

import math

from mdlgen.bench.campaign.draw import Data, Draw, mm, rounded
from mdlgen.bench.campaign.kinds.falls import falling
from mdlgen.bench.campaign.kinds.nips import driven, nip, table, transported
from mdlgen.bench.campaign.parts import plate
from mdlgen.bench.campaign.sheets import Drawn, sheet


def _curl(draw: Draw) -> Data:
    return {"curl": {"radius": mm(draw.log(40.0, 400.0) * draw.sign()), "along": draw.of("x", "y")}}


def _folds(draw: Draw, one: Drawn, most: float) -> Data:
    """One or two creases of up to `most` deg along the direction with more boxes, each on a line between
    boxes."""
    along = "x" if one.boxes[0] >= one.boxes[1] else "y"
    count, size = (one.boxes[0], one.length) if along == "x" else (one.boxes[1], one.width)
    lines = sorted({draw.count(1, count - 1) for _ in range(draw.of(1, 2))})
    folds = []
    for line in lines:
        fold: Data = {
            "along": along,
            "at": mm(size * line / count - size / 2, 7),
            "angle": f"{draw.even(8.0, most) * draw.sign():g} deg",
        }
        if draw.chance(0.5):
            fold["stiffness"] = draw.even(0.2, 0.9)
        folds.append(fold)
    return {"folds": folds}


def _hangs(one: Drawn, folds: list[Data]) -> float:
    """How far a folded sheet reaches below its middle, which is level [mm]: both parts of it rise at a fold
    of a positive angle."""
    half = (one.length if folds[0]["along"] == "x" else one.width) / 2
    creases = [(_number(fold["at"]), math.radians(_number(fold["angle"]))) for fold in folds]
    depth = 0.0
    for side in (-1.0, 1.0):
        own = sorted((abs(at), angle) for at, angle in creases if at * side >= 0.0)
        height = slope = 0.0
        ends = [*(at for at, _ in own[1:]), half]
        for (at, angle), end in zip(own, ends, strict=False):
            slope += angle
            height += (end - at) * math.sin(slope)
            depth = max(depth, -height)
    return depth


def _number(quantity: str) -> float:
    return float(quantity.partition(" ")[0])


def _falls(draw: Draw, one: Drawn, shape: Data, depth: float) -> Data:
    """A sheet of that shape, which reaches `depth` [mm] below its centre, falls on a plate."""
    gap = draw.log(0.2, 5.0)
    side = 3.0 * max(one.length, one.width)
    moves: Data = {}
    if draw.chance(0.4):
        moves["velocity"] = [f"{draw.log(0.1, 1.5):g} m/s", "0 m/s", "0 m/s"]
    height = depth + one.thick / 2 + gap
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, height, shape=shape, **moves)},
        "planes": {"table": plate(side, side)},
        "contacts": [draw.contact("note", "table")],
        "run": falling(draw, gap),
    }


def curled(draw: Draw) -> Data:
    """A sheet that is curled (radius 40 to 400 mm, either way, along x or y) falls on a plate, in 40 % of the
    scenes with up to 1.5 m/s along it."""
    one = sheet(draw, fewest=8, strip=0.0)
    shape = _curl(draw)
    size = one.length if shape["curl"]["along"] == "x" else one.width
    radius = _number(shape["curl"]["radius"])
    # the middle of the outline stays at the centre; edges rise with a positive radius
    turn = min(0.5 * size / abs(radius), math.pi)
    depth = abs(radius) * (1.0 - math.cos(turn))
    return _falls(draw, one, shape, depth)


def folded(draw: Draw) -> Data:
    """A sheet with one or two creases (8 to 60 deg) falls on a plate in the same way."""
    one = sheet(draw, fewest=8, strip=0.0)
    shape = _folds(draw, one, 60.0)
    return _falls(draw, one, shape, _hangs(one, shape["folds"]))


def worn(draw: Draw) -> Data:
    """A pair of rollers conveys a sheet that begins flat and pushes towards a curl or a crease of 40 deg at
    most; half of the scenes have a table."""
    one = transported(draw)
    shape = _curl(draw) if draw.chance(0.5) or max(one.boxes) < 2 else _folds(draw, one, 40.0)
    drive = driven(draw)
    x = rounded(one.length * draw.even(-0.2, 0.3))
    radius = draw.log(5.0, 12.0), draw.log(5.0, 12.0)
    scene: Data = {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, 0.0, shape={**shape, "start": "flat"})},
        "nips": {"nip": nip(draw, one, x, drive, draw.of("pressed", "fixed"), 1, radius)},
    }
    if draw.chance(0.5):
        scene["planes"] = {"table": table(draw, one, 4.0 * one.length, x)}
        scene["contacts"] = [draw.contact("note", "table", speed=drive.speed)]
    return {**scene, "run": draw.run(drive.lasts(draw.even(0.2, 0.8) * one.length), margin="20 mm")}

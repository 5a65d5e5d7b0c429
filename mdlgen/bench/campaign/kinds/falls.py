"""Sheets that fall on plates, their edges, meshes and rollers."""

from __future__ import annotations

import math

from mdlgen.bench.campaign import parts, solids
from mdlgen.bench.campaign.draw import Data, Draw, mm, place, rounded
from mdlgen.bench.campaign.parts import plate
from mdlgen.bench.campaign.sheets import Drawn, sheet

GRAVITY = 9.81e-3  # [mm/ms^2]


def falling(draw: Draw, height: float) -> Data:
    """`run` of a sheet that falls by a height [mm] and then has some time to come to rest."""
    return draw.run(math.sqrt(2.0 * height / GRAVITY) + draw.log(15.0, 120.0))


def lowest(one: Drawn, about_x: float, about_y: float) -> float:
    """How far the lowest corner of a turned sheet is below its centre [mm]; angles in deg."""
    x, y = math.radians(about_x), math.radians(about_y)
    return (
        one.length / 2 * abs(math.sin(y))
        + one.width / 2 * abs(math.sin(x)) * math.cos(y)
        + one.thick / 2 * math.cos(x) * math.cos(y)
    )


def flat(draw: Draw) -> Data:
    """A sheet falls flat on a plate, in a third of the scenes one smaller than the sheet, in a quarter an
    inclined one (up to 25 deg)."""
    one = sheet(draw)
    gap = draw.log(0.2, 15.0)
    size = [
        rounded(side * draw.of(draw.even(0.4, 0.95), draw.even(1.1, 3.0), 3.0))
        for side in (one.length, one.width)
    ]
    slope = draw.even(2.0, 25.0) * draw.sign() if draw.chance(0.25) else 0.0
    up = math.sin(math.radians(slope)), math.cos(math.radians(slope))
    away = one.thick / 2 + gap
    turned: Data = {}
    if slope:
        turned = {"rotation": ["0 deg", f"{slope:g} deg", "0 deg"]}
    elif draw.chance(0.4):
        turned = {"turn": f"{draw.even(-30.0, 30.0):g} deg"}
    table = {
        "center": place(-5.0 * up[0], 0.0, -5.0 * up[1], 6),
        "normal": [rounded(up[0], 9), 0, rounded(up[1], 9)] if slope else "z",
        "size": [mm(rounded(size[0])), mm(rounded(size[1])), "10 mm"],
        "mass": "100 g",
    }
    note = {**one.at(away * up[0], 0.0, away * up[1]), **turned}
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": note},
        "planes": {"table": table},
        "contacts": [draw.contact("note", "table")],
        "run": falling(draw, gap),
    }


def tilted(draw: Draw) -> Data:
    """A sheet that is turned about x and y (up to 35 deg) falls on a plate, in half of the scenes with a
    small speed and spin."""
    one = sheet(draw)
    about_x, about_y = (draw.even(-35.0, 35.0) if draw.chance(0.8) else 0.0 for _ in range(2))
    gap = draw.log(0.2, 10.0)
    moves: Data = {}
    if draw.chance(0.5):
        moves["velocity"] = [f"{draw.even(-0.3, 0.3):g} m/s" for _ in range(3)]
        moves["spin"] = [f"{draw.even(-5.0, 5.0):g} rad/s" for _ in range(3)]
    note = one.at(
        0.0,
        0.0,
        lowest(one, about_x, about_y) + gap,
        rotation=[f"{about_x:g} deg", f"{about_y:g} deg", f"{draw.of(0.0, draw.even(-40.0, 40.0)):g} deg"],
        **moves,
    )
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": note},
        "planes": {"table": plate(2.5 * one.length, 2.5 * one.width)},
        "contacts": [draw.contact("note", "table")],
        "run": falling(draw, gap + one.length / 4 * abs(math.sin(math.radians(about_y)))),
    }


def edge(draw: Draw) -> Data:
    """A sheet falls across the edge of a plate, with 20 to 80 % of its length beyond it; the edge is sharp or
    has a radius of 0.3 to 3 mm."""
    one = sheet(draw)
    gap = draw.log(0.1, 8.0)
    beyond = draw.even(0.2, 0.8) * one.length
    table = plate(1.5 * one.length, 1.5 * one.width, -0.75 * one.length)
    if draw.chance(0.5):
        table["edge_radius"] = mm(draw.log(0.3, 3.0))
    turned: Data = {"turn": f"{draw.even(-30.0, 30.0):g} deg"} if draw.chance(0.4) else {}
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(beyond - one.length / 2, 0.0, one.thick / 2 + gap, **turned)},
        "planes": {"table": table},
        "contacts": [draw.contact("note", "table")],
        "run": falling(draw, gap),
    }


def mesh(draw: Draw) -> Data:
    """A sheet falls on a block, a ramp or a roof, an OBJ or STL file, flat or turned (up to 25 deg)."""
    one = sheet(draw)
    length, width, height = (
        rounded(one.length * draw.even(0.5, 2.0)),
        rounded(one.width * draw.even(0.5, 2.0)),
        draw.even(5.0, 20.0),
    )
    form = draw.of("block", "ramp", "roof")
    if form == "block":
        shape = solids.block(length, width, height)
    else:
        ridge = length / 2 if form == "ramp" else rounded(length * draw.even(-0.3, 0.3))
        shape = solids.prism(length, width, height, ridge)
    suffix = draw.of("obj", "stl")
    about_x, about_y = (draw.even(-25.0, 25.0) if draw.chance(0.4) else 0.0 for _ in range(2))
    gap = draw.log(0.2, 8.0)
    part: Data = {"file": f"meshes/{form}.{suffix}", "center": place(0.0, 0.0, 0.0)}
    if draw.chance(1 / 3):
        part["edge_radius"] = mm(draw.even(0.1, 0.9))
    note = one.at(
        0.0,
        0.0,
        lowest(one, about_x, about_y) + gap,
        rotation=[f"{about_x:g} deg", f"{about_y:g} deg", f"{draw.of(0.0, draw.even(-40.0, 40.0)):g} deg"],
    )
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": note},
        "meshes": {form: part},
        "contacts": [draw.contact("note", form)],
        "run": falling(draw, gap),
        "files": {f"meshes/{form}.{suffix}": (solids.obj if suffix == "obj" else solids.stl)(*shape)},
    }


def roller(draw: Draw) -> Data:
    """A sheet falls across a roller, which stands, turns freely or is driven."""
    one = sheet(draw, fewest=4)
    radius, gap = draw.log(4.0, 25.0), draw.log(0.2, 8.0)
    speed = draw.value("speed", 0.1, 1.5)
    x = rounded(one.length * draw.even(-0.25, 0.25))
    part = parts.roller(draw, x, 0.0, -radius, radius, rounded(one.width * draw.even(0.3, 1.3)))
    driven = draw.chance(0.6)
    if driven:
        part["drive"] = {"speed": f"{rounded(draw.sign() * 1e3 * speed / radius):g} rad/s"}
    turned: Data = {"turn": f"{draw.even(-20.0, 20.0):g} deg"} if draw.chance(0.4) else {}
    return {
        "materials": {one.stock: one.material},
        "sheets": {"note": one.at(0.0, 0.0, one.thick / 2 + gap, **turned)},
        "rollers": {"roller": part},
        "contacts": [draw.contact("note", "roller", speed=speed if driven else None)],
        "run": falling(draw, gap),
    }

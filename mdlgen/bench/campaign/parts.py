"""Parts of machines that several kinds of scenes have; lengths in mm."""

from __future__ import annotations

import math

from mdlgen.bench.campaign.draw import Data, Draw, mm, place, rounded

# Rollers are solid, of plastic to aluminium [g/mm^3].
DENSITY = (1.0e-3, 2.8e-3)


def plate(length: float, width: float, x: float = 0.0, top: float = 0.0) -> Data:
    """A level plate with its upper face at z = `top` and its middle at `x`."""
    return {
        "center": place(x, 0.0, top - 5.0),
        "normal": "z",
        "size": [mm(rounded(length)), mm(rounded(width)), "10 mm"],
        "mass": "100 g",
    }


def wall(x: float, width: float, height: float, bottom: float) -> Data:
    """A plate whose face at `x` looks to -x, and whose lower end is at z = `bottom`."""
    return {
        "center": place(x + 5.0, 0.0, height / 2 + bottom),
        "normal": "-x",
        "along": "y",
        "size": [mm(rounded(width)), mm(height), "10 mm"],
        "mass": "100 g",
    }


def roller(draw: Draw, x: float, y: float, z: float, radius: float, width: float) -> Data:
    """A roller about y, solid."""
    mass = draw.even(*DENSITY) * math.pi * radius**2 * width
    return {"center": place(x, y, z), "axis": "y", **cylinder(radius, width, mass)}


def cylinder(radius: float, width: float, mass: float) -> Data:
    """Size and mass [g] of a roller that a nip places."""
    return {"radius": mm(radius), "width": mm(width), "mass": f"{rounded(mass):g} g"}


def spring(draw: Draw, direction: str, force: float) -> Data:
    """The press of a roller or plate with a force [N]."""
    made: Data = {
        "direction": direction,
        "stiffness": f"{draw.log(0.05, 0.5):g} N/mm",
        "preload": f"{rounded(force):g} N",
    }
    if draw.chance(0.6):
        made["damping_ratio"] = draw.of(0.05, 0.1, 0.3)
    return made

"""Sheets of paper, board and plastic, drawn at random."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from mdlgen.bench.campaign.draw import RANGES, Data, Draw, mm, place, rounded

LAYOUTS = ("edge_to_edge", "edge_to_edge", "center_to_center", "plate")


@dataclass(frozen=True)
class Stock:
    """Material ranges of a sheet; each pair is a lowest and a highest value."""

    thickness: tuple[float, float]  # [mm]
    density: tuple[float, float]  # [g/cm^3]
    modulus: tuple[float, float]  # E_md [MPa]
    across: tuple[float, float]  # E_cd / E_md
    length: tuple[float, float]  # sides [mm]


STOCKS = {
    "paper": Stock((0.05, 0.2), (0.6, 1.1), (2500.0, 5500.0), (0.35, 0.85), (40.0, 150.0)),
    "board": Stock((0.2, 0.5), (0.6, 0.9), (2000.0, 5000.0), (0.4, 0.7), (50.0, 150.0)),
    "card": Stock((0.25, 0.8), (1.2, 1.45), (2000.0, 3500.0), (1.0, 1.0), (54.0, 90.0)),
}
# Sides of a box: above 5 lint W102 warns.
LONG = 4.5
# How often each is drawn.
SHARES = {"paper": 0.7, "board": 0.15, "card": 0.15}


@dataclass
class Drawn:
    """A sheet with its material; lengths in mm."""

    material: Data
    entry: Data
    length: float
    width: float
    thick: float
    boxes: tuple[int, int]
    stock: str
    modulus: float  # E_md [MPa]

    def at(self, x: float, y: float, z: float, **keys: Any) -> Data:
        """The entry of the sheet, its centre there."""
        return {**self.entry, "center": place(x, y, z), **keys}


def sheet(
    draw: Draw,
    *,
    fewest: int = 1,
    most: int = 300,
    longest_box: float | None = None,
    stock: str = "",
    strip: float = 0.1,
) -> Drawn:
    """A sheet of `fewest` to `most` boxes. Boxes are about square; `longest_box` [mm] bounds their length
    along x. A part `strip` of the sheets has one row of boxes."""
    stock = stock or list(SHARES)[draw.weighted(list(SHARES.values()))]
    kind = STOCKS[stock]
    thick = draw.value("thickness", *kind.thickness)
    length = draw.log(*kind.length)
    width = draw.log(max(20.0, 0.3 * length), min(150.0, 2.0 * length))
    boxes = _boxes(draw, length, width, fewest, most, longest_box, strip)
    if boxes[1] == 1 and boxes[0] > 2:
        width = min(width, rounded(2.0 * length / boxes[0] + 5.0))
    along = draw.even(*kind.modulus)
    across = rounded(along * draw.even(*kind.across))
    material: Data = {"E_md": f"{along:g} MPa", "E_cd": f"{across:g} MPa"}
    if draw.chance(0.9):  # else it follows from E and s, as E s^3 / 12
        factor = draw.even(0.6, 1.2) * thick**3 / 12.0
        material["D_md"] = f"{rounded(along * factor):g} N*mm"
        material["D_cd"] = f"{rounded(across * factor):g} N*mm"
    if draw.chance(0.3):
        material["damping"] = draw.of(
            {"time": f"{draw.log(0.02, 0.5):g} ms"}, {"ratio": draw.of(0.05, 0.1, 0.2)}
        )
    density = draw.even(*kind.density)
    entry: Data = {
        "material": stock,
        "size": [mm(length), mm(width)],
        "thickness": mm(thick),
        **draw.of(
            {"grammage": f"{rounded(1e3 * density * thick):g} g/m^2"}, {"density": f"{density:g} g/cm^3"}
        ),
        "boxes": list(boxes),
        "layout": draw.of(*LAYOUTS),
    }
    return Drawn(material, entry, length, width, thick, boxes, stock, along)


def _boxes(
    draw: Draw, length: float, width: float, fewest: int, most: int, longest: float | None, strip: float
) -> tuple[int, int]:
    """Boxes along both sides, within `most` together."""
    total = draw.log(max(fewest, RANGES["boxes"].low), min(most, RANGES["boxes"].high))
    least = 1 if longest is None else min(math.ceil(length / longest), most)
    if draw.chance(strip):
        return max(least, min(round(total), 50, most)), 1
    along = math.sqrt(total * length / width) * math.exp(draw.even(-0.3, 0.3))
    along = min(max(round(along), least), most)
    across = max(round(total / along), math.ceil(width / (LONG * length / along)))
    return along, min(across, max(1, most // along))

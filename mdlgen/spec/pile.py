"""Piles: sheets that lie on each other, said once."""

from __future__ import annotations

import math
import random
import warnings
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Annotated, Any

from pydantic import Field

from mdlgen.spec.fields import Name
from mdlgen.spec.nip import merged
from mdlgen.spec.quantities import default, of_text, quantity
from mdlgen.spec.strict import Strict

Path = tuple[str | int, ...]
Fill = Callable[[Any, str], Any]
MOST = 1000


class Pile(Strict):
    """Sheets on each other: NAME_1 is the lowest, NAME_2 lies on it, and so on along the normal of the first.
    Each touches the one below and the one above."""

    of: Name = Field(
        description="the sheet, under sheets, that all are like; the lowest takes its place, and no sheet "
        "has its name any more"
    )
    count: Annotated[int, Field(ge=1, le=MOST)] = Field(description=f"how many there are, 1 to {MOST}")
    contact: dict[str, Any] = Field(
        description="keys of the contact of each sheet with the next one, but between and name"
    )
    gap: Annotated[float, quantity("mm", 0.0)] = Field(
        default=default("0 mm"), description="between two of them as the run begins"
    )
    jitter: Annotated[float, quantity("mm", 0.0)] = Field(
        default=default("0 mm"),
        description="each but the lowest is displaced by up to this along either of its sides",
    )
    turn: Annotated[float, quantity("deg", 0.0)] = Field(
        default=default("0 deg"), description="each but the lowest is turned in its plane by up to this"
    )
    seed: Annotated[int, Field(ge=0)] = Field(
        default=1, description="the same seed gives the same displacements and turns"
    )


def names_of(name: str, pile: Any) -> list[str]:
    """The names of the sheets of a pile, from the lowest; one where its count is none."""
    count = pile.get("count") if isinstance(pile, dict) else None
    good = count if type(count) is int and 1 <= count <= MOST else 1
    return [f"{name}_{k + 1}" for k in range(good)]


def written(data: dict[str, Any], origins: dict[Path, Path], fill: Fill) -> None:
    """Puts the sheets of piles in the place of those that they are of, and adds their contacts, which are a
    list; `fill` gives a contact its defaults. Data of a wrong form are left for validation."""
    piles, sheets = data.get("piles"), data.get("sheets")
    if not isinstance(piles, dict) or not isinstance(sheets, dict):
        return
    contacts = list(data["contacts"]) if isinstance(data.get("contacts"), (list, tuple)) else []
    made: dict[Any, Any] = {}
    good = {
        name: pile
        for name, pile in piles.items()
        if isinstance(pile, dict) and isinstance(sheets.get(str(pile.get("of"))), dict)
    }
    members = {member for name, pile in good.items() for member in names_of(name, pile)}
    for sheet, keys in sheets.items():
        own = {name: pile for name, pile in good.items() if pile["of"] == sheet}
        if not own and sheet not in members:
            made[sheet] = keys
        for name, pile in own.items():
            names = names_of(name, pile)
            for member, place in zip(names, _places(keys, pile, len(names)), strict=True):
                # a value given under sheets counts there: --set sheets.cassette_3.mass=..
                made[member] = merged({**keys, **place}, given := sheets.get(member, {}))
                origins["sheets", member] = ("sheets", sheet)
                for key in given if isinstance(given, dict) else ():
                    origins["sheets", member, key] = ("sheets", member, key)
            for pair in pairwise(names):
                origins["contacts", len(contacts)] = ("piles", name, "contact")
                law = fill(pile.get("contact"), "contacts")
                law = law if isinstance(law, dict) else {}
                contacts.append({**law, "between": list(pair), "name": f"{pair[0]}_{pair[1]}"})
    data["sheets"], data["contacts"] = made, contacts


def _places(sheet: dict[str, Any], pile: dict[str, Any], count: int) -> Iterator[dict[str, Any]]:
    """Center and turn, or rotation, of each sheet of a pile."""
    center = sheet.get("center", ["0 mm"] * 3)
    thickness, gap = sheet.get("thickness"), pile.get("gap", "0 mm")
    jitter, turn = value_of(pile.get("jitter", "0 mm"), "mm"), value_of(pile.get("turn", "0 deg"), "deg")
    seed = pile.get("seed", 1)
    draw = random.Random(seed if type(seed) is int else 1)
    key = "turn" if sheet.get("rotation") is None else "rotation"
    angles = sheet["rotation"] if key == "rotation" else ["0 deg", "0 deg", sheet.get("turn") or "0 deg"]
    axes = _axes(angles)
    good = axes is not None and isinstance(center, (list, tuple)) and len(center) == 3
    pitched = value_of(thickness, "mm") > 0.0 and value_of(gap, "mm") >= 0.0
    for k in range(count):
        aside = [draw.uniform(-1.0, 1.0) * jitter for _ in range(2)] if k else [0.0, 0.0]
        swung = draw.uniform(-1.0, 1.0) * turn if k else 0.0
        if axes is None or not good:
            yield {}
            continue
        up = f"{k}*({thickness} + {gap})" if k and pitched else None
        places = [
            _moved(place, axis[2], up, axis[0] * aside[0] + axis[1] * aside[1])
            for place, axis in zip(center, axes, strict=True)
        ]
        yield {"center": places, **({} if swung == 0.0 else turned(key, angles, swung))}


def value_of(text: Any, unit: str) -> float:
    """In internal units; 0 where its own field reports it."""
    try:
        return float(of_text(text, unit))
    except (TypeError, ValueError):
        return 0.0


def _axes(angles: Any) -> list[tuple[float, float, float]] | None:
    """Rows of the rotation about the global x, then y, then z axis; None where there is none of that form."""
    if not isinstance(angles, (list, tuple)) or len(angles) != 3:
        return None
    if all(value_of(angle, "deg") == 0.0 for angle in angles[:2]):
        turn = value_of(angles[2], "deg")
        c, s = math.cos(turn), math.sin(turn)
        return [(c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)]
    from scipy.spatial.transform import Rotation

    turned = Rotation.from_euler("xyz", [value_of(angle, "deg") for angle in angles]).as_matrix()
    return [(float(a), float(b), 0.0 if abs(c) < 1e-15 else float(c)) for a, b, c in turned]


def _moved(place: Any, along: float, up: str | None, aside: float) -> Any:
    """A coordinate, moved by a part of a formula and by a length [mm]."""
    if not isinstance(place, str):
        return place
    found = place
    if up is not None and along != 0.0:
        found = f"({place}) + {up}" if along == 1.0 else f"({place}) + {along!r}*{up}"
    return found if aside == 0.0 else f"{found} + ({aside!r} mm)"


def turned(key: str, angles: Any, swung: float) -> dict[str, Any]:
    """The angles of a sheet that is turned about its normal [rad]."""
    if key == "turn":
        return {"turn": f"({angles[2]}) + ({math.degrees(swung)!r} deg)"}
    from scipy.spatial.transform import Rotation

    given = Rotation.from_euler("xyz", [value_of(angle, "deg") for angle in angles])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a sheet that stands on an edge, whose angles are not unique
        found = (given * Rotation.from_euler("z", swung)).as_euler("xyz", degrees=True)
    return {"rotation": [f"{angle!r} deg" for angle in map(float, found)]}

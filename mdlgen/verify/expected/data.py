"""Data sets that a text must have of a Model."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.altair.curves import written
from mdlgen.model.tables import Anchor, Model, SheetPart
from mdlgen.units import parse_unit
from mdlgen.verify.expected.bent_sheets import shape
from mdlgen.verify.expected.cells import cells, damping_times
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.expected.units import KG, SECOND
from mdlgen.verify.tables import Table, table

# From the Model's unit to that of the text.
FACTORS = {
    **dict.fromkeys(("mm", "N", "1", "MPa", "N/mm", "N*mm", "N*mm/rad", "N*mm/rad/mm", "N/mm^1.5"), 1.0),
    "g": KG,
    "g/mm^3": KG,
    "g*mm^2": KG,
    **dict.fromkeys(("N*mm*ms/rad", "N*ms/mm"), SECOND),
    "ms": SECOND,
    "1/ms": 1 / SECOND,
    "mm/ms": 1 / SECOND,
    "mm/ms^2": 1 / SECOND**2,
    "rad/ms": 1 / SECOND,
    "rad": 180 / math.pi,
}


def factor(unit: str) -> float:
    """Factor from the Model's unit to that of the text, for units that only a user's parameters have, too."""
    if unit in FACTORS:
        return FACTORS[unit]
    _, mass, time, _ = parse_unit(unit).dimension
    # a unit of mass without time is in kg; with a time, a mass is a force N by s^2/mm
    return (KG if (mass, time) == (1.0, 0.0) else 1e-6**mass) * SECOND**time


def data(model: Model) -> Table:
    """All numbers of all data sets: those that the user gave, and those that follow from them."""
    found: dict[str, float] = {}
    for p in model.parameters:
        found[f"ds_{p.data_set}.real_{p.member}"] = p.value * factor(p.unit)
    for index, sheet in enumerate(model.sheets):
        for member, value in _derived(model, index).items():
            # a value that the user gave stands there already
            found.setdefault(f"ds_{sheet.name}.real_{member}", value)
        found |= {k: v for k, v in cells(model, index).items() if k not in found}
        found |= shape(sheet)
    for part in model.machine:
        for member, value in kind_of(part).data(model, part).items():
            found.setdefault(f"ds_{part.name}.real_{member}", value)
    for support in model.supports:
        found[f"ds_{support.name}.real_factor"] = _factor(model, support)
        found |= _place(support.name, support.at, support.edge)
    for probe in model.probes:
        found |= _place(f"probe_{probe.name}", probe.at, probe.edge)
    if model.run.analysis != "static":
        found["ds_run.real_h_min"] = min(1e-6, found["ds_run.real_h_max"] / 100)
    angles = [math.degrees(1.0) if ".real_turn" in n or ".real_r_" in n else 0.0 for n in found]
    numbers = np.array(list(found.values()))
    places = np.array(
        [
            100.0 if n.endswith(("real_x", "real_y")) or ".real_l_" in n or "_shape.real_" in n else 0.0
            for n in found
        ]
    )
    # starts that follow are sums of places of parts, some mm each
    sums = {f"ds_{p.data_set}.real_{p.member}" for p in model.parameters if p.follows and p.unit == "mm"}
    terms = np.array([10.0 if n in sums else 0.0 for n in found])
    scale = np.maximum.reduce([np.abs(numbers), np.array(angles), places, terms]) if found else numbers
    return table(found, {"value": (numbers, scale[:, None])})


def _factor(model: Model, support: Anchor) -> float:
    """Stiffness of a support relative to k_z of its sheet: its bushings act side by side."""
    mine = [k for k, name in enumerate(model.bushings.name) if name.rpartition("_")[0] == support.name]
    return float(model.bushings.k[mine, :3].sum(axis=0).max() / model.sheets[support.sheet].derived["k_z"])


def _place(data_set: str, at: tuple[float, float], edge: str | None) -> dict[str, float]:
    return {} if edge else {f"ds_{data_set}.real_{a}": v for a, v in zip("xy", at, strict=True)}


def _derived(model: Model, index: int) -> dict[str, float]:
    """Values of a sheet that the text computes, from the tables of its boxes and bushings."""
    sheet, rows = model.sheets[index], model.bushings
    d_x, d_y, s = sheet.d_x, sheet.d_y, sheet.thickness
    m = sheet.derived["m"] * KG
    inertia = [sheet.derived[f"I_{axis}"] for axis in "xyz"]
    if sheet.uniform:  # then it is that of each box
        box = sheet.first
        m, (d_x, d_y, s), inertia = (
            model.bodies.mass[box] * KG,
            2 * model.bodies.half[box],
            model.bodies.inertia[box],
        )
    found = {"n_x": float(sheet.n_x), "n_y": float(sheet.n_y), "d_x": d_x, "d_y": d_y, "m": m}
    found |= {f"I_{a}": v * KG for a, v in zip("xyz", inertia, strict=True)}
    mine = rows.sheet == index
    if not np.any(mine):
        return found
    found |= guessed(model, sheet)
    names = ("x", "y", "z", "tx", "ty", "tz")
    found |= {f"k_{n}": sheet.derived[f"k_{n}"] for n in names}
    found |= {f"c_{n}": sheet.derived[f"c_{n}"] * SECOND for n in names}
    if sheet.uniform:  # where it is not, each class has its own
        found |= {f"A_{c.axis}": c.area for c in written(model)[0] if c.sheet == index}
    if sheet.rotation_damping == "inertia":  # of a box about the edges and the corner that its hinges are on
        found["J_x"], found["J_y"] = m * (d_y**2 / 3 + s**2 / 12), m * (d_x**2 / 3 + s**2 / 12)
        found["J_z"] = m * (d_x**2 + d_y**2) / 3
    if sheet.rotation_damping == "time":
        given = {p.member: p.value for p in model.parameters if p.data_set == sheet.name}
        times = dict(zip(("tau_md", "tau_cd", "tau"), damping_times(given), strict=True))
        own = "tau_md" in given or "eta_md" in given
        found |= times if own else {"tau": times["tau"]}
    if sheet.layout == "plate":
        found |= {name: sheet.derived[name] for name in ("G", "D_twist", "k_x_shear", "k_y_shear", "k_tz_y")}
        found |= {n: sheet.derived[n] * SECOND for n in ("c_x_shear", "c_y_shear", "c_tz_y")}
    return found | (_twist(model, sheet, found) if sheet.twist else {})


def guessed(model: Model, sheet: SheetPart) -> dict[str, float]:
    """Bending stiffness per width that nobody gave [N mm]: that of a solid plate."""
    given = {p.member: p.value for p in model.parameters if p.data_set == sheet.name}
    pairs = (("D_md", "k_ty", "E_md"), ("D_cd", "k_tx", "E_cd"))
    return {
        plate: given[modulus] * sheet.thickness**3 / 12
        for plate, hinge, modulus in pairs
        if plate not in given and hinge not in given
    }


def _twist(model: Model, sheet: SheetPart, found: dict[str, float]) -> dict[str, float]:
    """Twisting stiffness 2 D_twist times width by length of joints along x and along y, and its damping.

    A sheet may have joints one way only; the text shows both values.
    """
    given = {p.member: p.value for p in model.parameters if p.data_set == sheet.name}
    twist: dict[str, float] = {}
    for name, slender, zeta in (
        ("tx", sheet.d_y / sheet.d_x, "zeta"),
        ("ty", sheet.d_x / sheet.d_y, "zeta_ty"),
    ):
        k = 2 * (given["D_twist"] if "D_twist" in given else found["D_twist"]) * slender
        twist[f"k_{name}_twist"] = k
        if sheet.rotation_damping == "time":
            twist[f"c_{name}_twist"] = damping_times(given)[2] * k
            continue
        heavy = found["m"] if sheet.rotation_damping == "paper" else found[f"J_{name[1]}"]
        twist[f"c_{name}_twist"] = 2 * given[zeta] * math.sqrt(k * heavy * SECOND)
    return twist

"""Expected content of an MDL file for unequal boxes and joints of a sheet, class by class."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.altair.classes import JointClass, box_classes, joint_classes
from mdlgen.altair.curves import written
from mdlgen.model.tables import Floats, Model, SheetPart
from mdlgen.verify.expected.units import KG, SECOND

_SIX = ("x", "y", "z", "tx", "ty", "tz")


def cells(model: Model, index: int) -> dict[str, float]:
    """Members of the data sets of lengths, zones and classes, those that the user gave left out."""
    sheet = model.sheets[index]
    if sheet.uniform:
        return {}
    found = _lengths(model, sheet)
    for zone in sheet.zones:
        found[f"ds_{sheet.name}_zone_{zone.name}.real_s"] = (
            sheet.thickness if zone.thickness is None else zone.thickness
        )
    return found | _boxes(model, sheet) | _joints(model, index)


def _lengths(model: Model, sheet: SheetPart) -> dict[str, float]:
    found: dict[str, float] = {}
    for axis, graded, lines in zip("xy", sheet.graded, (sheet.lines_x, sheet.lines_y), strict=True):
        if not graded:
            continue
        name = f"{sheet.name}_grid_{axis}"
        sizes = [p.value for p in model.parameters if p.data_set == name]
        found |= {f"ds_{name}.real_t_{k}": math.fsum(sizes[:k]) for k in range(len(lines))}
        found |= {f"ds_{name}.real_d_{k}": float(d) for k, d in enumerate(np.diff(lines))}
        found |= {f"ds_{name}.real_l_{k}": float(at) for k, at in enumerate(lines)}
    return found


def _boxes(model: Model, sheet: SheetPart) -> dict[str, float]:
    found: dict[str, float] = {}
    bodies, before = model.bodies, 0.0
    classes, _ = box_classes(sheet)
    for c in classes:
        body = sheet.first + c.first
        d_x, d_y, s = 2 * bodies.half[body]
        dense = 1.0
        for zone in sheet.zones:
            thick = sheet.thickness if zone.thickness is None else zone.thickness
            dense += zone.share[c.first] * (zone.density * thick / sheet.thickness - 1.0)
        weight = d_x * d_y * dense
        before += c.many * weight
        i_x, i_y, i_z = bodies.inertia[body] * KG
        members = {"s": s, "e": _stiff(sheet)[c.first], "f": bodies.friction[body], "w": weight, "a": before}
        members |= {"m": bodies.mass[body] * KG, "I_x": i_x, "I_y": i_y, "I_z": i_z}
        found |= {f"ds_{sheet.name}_cells.real_{k}_{c.name}": float(v) for k, v in members.items()}
    return found


def _stiff(sheet: SheetPart) -> Floats:
    return 1.0 + sum((zone.share * (zone.stiffness - 1.0) for zone in sheet.zones), np.zeros(sheet.count))


def _joints(model: Model, index: int) -> dict[str, float]:
    """Values of each class, from the first bushing of it."""
    sheet, rows = model.sheets[index], model.bushings
    found: dict[str, float] = {}
    given = {p.member: p.value for p in model.parameters if p.data_set == sheet.name}
    sections = {curve.joints: curve.area for curve in written(model)[0] if curve.sheet == index}
    for joints, classes, _ in joint_classes(sheet):
        mine = np.flatnonzero((rows.sheet == index) & (rows.kind == joints.kind))
        for c in classes:
            times = joints.scale * _widened(sheet, c, one=int(joints.one[c.first]))
            k, c_six = rows.k[mine[c.first]] / times, rows.c[mine[c.first]] / times * SECOND
            one, two = (int(boxes[c.first]) for boxes in (joints.one, joints.two))
            members = _between(model, sheet, c, one, two)
            members |= {f"k_{n}": v for n, v in zip(_SIX, k, strict=True)}
            members |= {f"c_{n}": v for n, v in zip(_SIX, c_six, strict=True)}
            members = _as_written(sheet, given, members, c.along_x)
            if sheet.layout == "plate":
                members |= _sheared(sheet, given, members, c.along_x)
            if c.name in sections:
                members["A"] = sections[c.name]
            found |= {f"ds_{sheet.name}_joints.real_{n}_{c.name}": float(v) for n, v in members.items()}
    return found


def _widened(sheet: SheetPart, c: JointClass, one: int) -> Floats:
    """Factors of an MDL file on the values of a class, (6,): a joint that twists has half a box more for each
    side of its boxes that is the sheet's own and not clamped."""
    times = np.ones(6)
    if sheet.twist:
        strip, strips, side = (
            (one // sheet.n_x, sheet.n_y, "y") if c.along_x else (one % sheet.n_x, sheet.n_x, "x")
        )
        ends = {f"{side}_min": 0, f"{side}_max": strips - 1}
        held = sheet.clamp.edge if sheet.clamp is not None else ""
        times[3 if c.along_x else 4] += 0.5 * sum(strip == at for edge, at in ends.items() if edge != held)
    return times


def _between(model: Model, sheet: SheetPart, c: JointClass, one: int, two: int) -> dict[str, float]:
    half, mass, stiff = model.bodies.half, model.bodies.mass, _stiff(sheet)
    first, second = sheet.first + one, sheet.first + two
    axis = 0 if c.along_x else 1
    a, b = 2 * half[first, axis], 2 * half[second, axis]
    width = 2 * half[first, 1 - axis]
    d_x, d_y = ((a + b) / 2, width) if c.along_x else (width, (a + b) / 2)
    s, m = half[first, 2] + half[second, 2], (mass[first] + mass[second]) / 2 * KG
    thick = [2 * half[body, 2] / sheet.thickness for body in (first, second)]
    found = {"d_x": d_x, "d_y": d_y, "s": s, "m": m}
    for name, power in (("p", 1), ("b", 3)):
        parts = a / (stiff[one] * thick[0] ** power) + b / (stiff[two] * thick[1] ** power)
        found[name] = (a + b) / parts
    if c.crease >= 0 and sheet.bend is not None:
        found["b"] *= sheet.bend.creases[c.crease].stiffness
    if sheet.rotation_damping == "inertia":
        found["J_x"], found["J_y"] = m * (d_y**2 / 3 + s**2 / 12), m * (d_x**2 / 3 + s**2 / 12)
        found["J_z"] = m * (d_x**2 + d_y**2) / 3
    return found


def damping_times(given: dict[str, float]) -> tuple[float, float, float]:
    """Damping times [s] of MD, of CD, and of what goes with both, from the given values of a sheet."""
    if "f" in given:
        per = 2 * math.pi * given["f"] / SECOND
        md, cd = (given.get(f"eta_{way}", given.get("eta", math.nan)) / per for way in ("md", "cd"))
    else:
        md, cd = (given.get(f"tau_{way}", given.get("tau", math.nan)) * SECOND for way in ("md", "cd"))
    return md, cd, (md + cd) / 2


def _as_written(
    sheet: SheetPart, given: dict[str, float], found: dict[str, float], along_x: bool
) -> dict[str, float]:
    """The text shows a twisted joint's own bending too, which no bushing has."""
    if not sheet.twist:
        return found
    name, about = ("tx", "x") if along_x else ("ty", "y")
    found[f"k_{name}_twist"], found[f"c_{name}_twist"] = found[f"k_{name}"], found[f"c_{name}"]
    shape = found["d_x"] / found["d_y"]
    hinge, modulus, plate, mean = ("k_tx", "E_cd", "D_cd", sheet.d_x / sheet.d_y)
    if not along_x:
        hinge, modulus, plate, shape, mean = "k_ty", "E_md", "D_md", 1 / shape, 1 / mean
    stiff = given.get(plate, given[modulus] * sheet.thickness**3 / 12)
    bent = found["b"] * (given[hinge] * shape / mean if hinge in given else stiff * shape)
    if sheet.rotation_damping == "time":
        md, cd, _ = damping_times(given)
        found[f"k_{name}"], found[f"c_{name}"] = bent, (cd if along_x else md) * bent
        return found
    zeta = given["zeta"] if along_x else given["zeta_ty"]
    heavy = found["m"] if sheet.rotation_damping == "paper" else found[f"J_{about}"]
    found[f"k_{name}"], found[f"c_{name}"] = bent, 2 * zeta * math.sqrt(bent * heavy * SECOND)
    return found


def _sheared(
    sheet: SheetPart, given: dict[str, float], found: dict[str, float], along_x: bool
) -> dict[str, float]:
    """The MDL file shows both Eqs. 5 and 6 of a joint of a plate, and its shear next to the replaced one."""
    name, modulus, shape = "y", "E_cd", found["d_x"] / found["d_y"]
    if not along_x:
        name, modulus, shape = "x", "E_md", 1 / shape
    k = found["p"] * given[modulus] * sheet.thickness * shape
    if sheet.rotation_damping == "time":
        md, cd, _ = damping_times(given)
        c = (cd if along_x else md) * k
    else:
        c = 2 * given["zeta"] * math.sqrt(k * found["m"] * SECOND)
    shear = {f"{symbol}_{name}_shear": found[f"{symbol}_{name}"] for symbol in "kc"}
    return shear | {f"k_{name}": k, f"c_{name}": c}

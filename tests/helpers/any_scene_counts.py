"""What the text of a scene must have, counted from the spec; and what a text has."""

from __future__ import annotations

import re
from collections import Counter
from fnmatch import fnmatchcase

from any_scene import OF_TIMED, TIMED, Spec, pitch


def held_rows(sheet: Spec) -> tuple[int, int, bool] | None:
    """(axis, rows of boxes that are held, whether from the far edge)."""
    if "clamp" not in sheet:
        return None
    axis = "xy".index(sheet["clamp"]["edge"][0])
    rows = round(float(sheet["clamp"]["length"].removesuffix(" mm")) / pitch(sheet, axis))
    return axis, rows, sheet["clamp"]["edge"].endswith("max")


def free_boxes(sheet: Spec) -> set[tuple[int, int]]:
    boxes = {(i, j) for i in range(sheet["boxes"][0]) for j in range(sheet["boxes"][1])}
    held = held_rows(sheet)
    if held is None:
        return boxes
    axis, rows, far = held
    count = sheet["boxes"][axis]
    return {box for box in boxes if (count - 1 - box[axis] if far else box[axis]) >= rows}


def bushing_nodes(sheet: Spec) -> list[tuple[int, int]]:
    """Half-cell node of every bushing of a sheet: two at the ends of a side, or one in its middle."""
    free, sides = free_boxes(sheet), []
    for i, j in free:
        sides += [((2 * i + 2, 2 * j + 1), 1)] if (i + 1, j) in free else []
        sides += [((2 * i + 1, 2 * j + 2), 0)] if (i, j + 1) in free else []
    held = held_rows(sheet)
    if held is not None:
        axis, rows, far = held
        line = 2 * (sheet["boxes"][axis] - rows) if far else 2 * rows
        for k in range(sheet["boxes"][1 - axis]):
            sides.append(((line, 2 * k + 1), 1) if axis == 0 else ((2 * k + 1, line), 0))
    shifts = (-1, 1) if sheet["layout"] == "edge_to_edge" else (0,)
    return [(x + s * (not up), y + s * up) for (x, y), up in sides for s in shifts]


def boxes_at(place: Spec, sheet: Spec) -> int:
    """Boxes that hold a material point: 1, 2 on a side, 4 on a corner between four."""
    if "edge" in place:
        return 1 + (sheet["boxes"]["yx".index(place["edge"][0])] % 2 == 0)
    count = 1
    for k, (text, cells) in enumerate(zip(place["at"], sheet["boxes"], strict=True)):
        node = round(2 * float(text.removesuffix(" mm")) / pitch(sheet, k)) + cells
        count *= 1 + (node % 2 == 0 and 0 < node < 2 * cells)
    return count


def is_moving(sheet: Spec) -> bool:
    return any(float(v.split()[0]) != 0.0 for v in (*sheet["velocity"], *sheet["spin"]))


def possible_pairs(scene: Spec) -> int:
    """Pairs of bodies of all pairs of parts that the contacts name."""
    size = {n: s["boxes"][0] * s["boxes"][1] for n, s in scene["sheets"].items()}
    parts = [*scene["sheets"], *scene["rollers"], *scene["planes"]]
    total = 0
    for entry in scene["contacts"]:
        sides = [[p for p in parts if fnmatchcase(p, pattern)] for pattern in entry["between"]]
        total += sum(size.get(a, 1) for a in sides[0] for _ in sides[1])
    return total


def expected_members(scene: Spec) -> int:
    """Numbers in all data sets: what the user gave, and what a sheet's formulas make of it."""
    total = 7 * len(scene["planes"]) + 7 * len(scene["contacts"])
    total += 7 + (scene["run"]["analysis"] == "transient")  # of the run
    springs = [plane["press"] for plane in scene["planes"].values() if "press" in plane]
    total += sum(5 + ("carrier_mass" in press) for press in springs)
    for name, sheet in scene["sheets"].items():
        material = scene["materials"][sheet["material"]]
        plate = sheet["layout"] == "plate"
        bending = [k for k in ("k_tx", "k_ty", "k_tz", "D_cd", "D_md", "D_twist", "G") if k in material]
        if plate and "k_tz" in material:
            bending.remove("k_tz")  # it does not act there
        total += 3 + (3 if "rotation" in sheet else 1) + 6 + len(bending) + 6 * is_moving(sheet)
        damping = material["damping"]
        given, follow = OF_TIMED[TIMED.index(damping)] if damping in TIMED else (2, 0)
        total += given
        total += 8  # n, d, m, I
        if bushing_nodes(sheet) or any(s["sheet"] == name for s in scene["supports"]):
            total += 9 + sum(k in material for k in ("D_cd", "D_md")) + ("k_tz" not in bending)
            total += (
                4 * (plate or "D_twist" in material) + 3 * (damping.get("rotation") == "inertia") + follow
            )
            total += 6 * plate + sum(k not in material for k in ("D_twist", "G")) * plate
    for roller in scene["rollers"].values():
        drive = roller.get("drive", {})
        total += (
            6 + (2 * len(drive["profile"]) if "profile" in drive else len(drive)) + 7 * ("press" in roller)
        )
    total += sum(2 * ("at" in probe) for probe in scene["probes"].values())
    return total + sum(1 + 2 * ("at" in support) for support in scene["supports"])


def expected_counts(scene: Spec, pairs: int) -> Counter[str]:
    """Statements by name; `pairs` are the pairs of bodies that are kept."""
    table, machine = list(scene["sheets"].values()), list(scene["rollers"].values())
    plates, probes, supports = scene["planes"], list(scene["probes"].values()), scene["supports"]
    boxes = sum(s["boxes"][0] * s["boxes"][1] for s in table)
    free = sum(len(free_boxes(s)) for s in table)
    moving = sum(len(free_boxes(s)) for s in table if is_moving(s))
    joints = sum(len(bushing_nodes(s)) for s in table)
    nodes = sum(len(set(bushing_nodes(s))) for s in table)
    pressed = sum("press" in r for r in machine)
    sprung = sum("press" in p for p in plates.values())
    surfaces = [s["boxes"][0] * s["boxes"][1] for s in table if s["surface"]]
    own = sum(r["axis"] not in ("x", "y", "z") for r in machine)
    tilted = [p["normal"] for p in plates.values() if p["normal"] != "z"]
    own_normals = sum(normal not in ("x", "y") for normal in tilted)
    held = sum(boxes_at(s, scene["sheets"][s["sheet"]]) for s in supports)
    marked = sum(boxes_at(p, scene["sheets"][p["sheet"]]) for p in probes)
    sets = len(table) + len(machine) + len(plates) + len(scene["contacts"]) + len(supports) + 1
    sets += sum("at" in p for p in probes)
    bodies = boxes + len(machine) + pressed + len(plates)
    points = boxes + nodes + pressed + sprung + sum(map(len, (table, machine, plates, probes, supports)))
    angled = sum("rotation" in s for s in table)
    return +Counter(
        {
            "BeginMDL": 1,
            "EndMDL": 1,
            "StandardInclude": 1,
            "SetCurrentSolverMode": 1,
            "SetBoolean": 1,
            **{"BeginContext": 1, "EndContext": 1, "SetOption": 5},  # gravity and units
            "Template": 1,
            "DefineTemplate": 1,
            **{"System": 1, "DefineSystem": 1},  # run settings
            "DefineDataSet": sets,
            "DataSet": sets,
            "EndDefine": sets + 2,
            "Point": points,
            "SetPoint": points,
            "Marker": len(table) + marked + sum(surfaces),
            "Vector": pressed + sprung + own + own_normals + len(table) + angled,
            "SetVector": pressed + sprung + own + own_normals + len(table) + angled,
            "Body": bodies,
            "SetBodyInertia": bodies,
            "SetBodyIC": moving,
            "SetBodyICFlag": moving,
            "Bush": joints + held,
            "SetBush": joints + held,
            "FixedJoint": boxes - free + len(plates) - sprung,
            "RevJoint": len(machine),
            "TransJoint": pressed + sprung,
            "CoilSpring": pressed + sprung,
            "SetCoilSpring": pressed + sprung,
            "Motion": sum("drive" in r for r in machine),
            "SetMotion": sum("drive" in r for r in machine),
            "Graphic": bodies - pressed,
            "DeformableSurface": len(surfaces),
            "SetOrientation": len(table) + boxes + joints + len(machine) + len(tilted),
            "Contact": pairs,
            "Output": len(probes) + len(machine) + sprung,
        }
    )


def statement_counts(text: str) -> Counter[str]:
    """Statements by name, seen by lines, which is not how the reader sees them."""
    return Counter(re.findall(r"^ *\*(\w+)\(", text, re.M))


NAME = re.compile(r"(?<![\w.])(?:def_)?(?:p|b|m|v|j|bsh|gbox|gcyl|con|mot|cs|ds|tmplt|o|defsur)_\w+")


def dangling(text: str) -> set[str]:
    """Names of ours that are used and not defined, by a statement with a label or a Define."""
    block = re.sub(r'"[^"\n]*"', '""', text[text.index("*BeginMDL") :])
    defined = re.findall(r'^ *\*\w+\( (\w+), ""|^ *\*Define\w+\( (\w+)', block, re.M)
    standard = {"ds_gravity", "ds_units"}  # of the standard include
    return set(NAME.findall(block)) - {one or two for one, two in defined} - standard

"""What holds for the text of any scene: it reads clean, its statements can be counted from the spec, and
nothing that is typed as a name becomes a statement."""

from __future__ import annotations

import copy
import json
import re
from collections import Counter
from fnmatch import fnmatchcase
from importlib import import_module
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mdlgen.backends.motionview import emit
from mdlgen.backends.motionview.reader import read
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import PlanePart
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load, loads

Spec = dict[str, Any]

# ---------------------------------------------------------------- any valid scene

AXES = st.sampled_from(["x", "y", "z", "-x", "-z", [0.6, 0.8, 0.0], [-1.0, 2.0, 0.5]])
RATIOS = st.sampled_from([0.0, 0.04, 0.12])


def mm(value: float) -> str:
    return f"{value!r} mm"


def lengths(low: float, high: float) -> st.SearchStrategy[str]:
    return st.floats(low, high, allow_subnormal=False).map(mm)


def triple(unit: str, size: float) -> st.SearchStrategy[list[str]]:
    # what is not zero is at least 1e-20 of its unit
    some = st.floats(-size, size, allow_subnormal=False).map(lambda v: v if abs(v) >= 1e-20 else 0.0)
    one = st.one_of(st.just(0.0), some)
    return st.lists(one.map(lambda v: f"{v!r} {unit}"), min_size=3, max_size=3)


# Near the sheets, or out of their reach.
CENTERS = st.one_of(triple("mm", 40), st.just(["0 mm", "400 mm", "0 mm"]))


def pitch(sheet: Spec, axis: int) -> float:
    """Box length, L/n or L/(n-1)."""
    length = float(sheet["size"][axis].removesuffix(" mm"))
    return length / (sheet["boxes"][axis] - (sheet["grid"] == "paper"))


def half_cells(sheet: Spec, node: tuple[int, int]) -> list[str]:
    """`at` of a node of the half-cell grid from the corner of box (0, 0)."""
    return [mm((n / 2 - sheet["boxes"][k] / 2) * pitch(sheet, k)) for k, n in enumerate(node)]


@st.composite
def materials(draw: st.DrawFn, layout: str) -> Spec:
    made: Spec = {"E_md": "3530 MPa", "E_cd": draw(st.sampled_from(["1113 MPa", "9 GPa"]))}
    made |= draw(st.sampled_from([{"k_tx": "0.15 N*mm/rad"}, {"D_cd": "0.24 N*mm"}]))
    made |= draw(st.sampled_from([{"k_ty": "0 N*mm/rad"}, {"D_md": "0.4 N*mm"}]))
    made |= draw(st.sampled_from([{}, {"k_tz": "5 N*mm/rad"}]))
    if layout != "edge_to_edge" and draw(st.booleans()):
        made["D_twist"] = "0.1 N*mm"
    if layout == "plate" and draw(st.booleans()):
        made["G"] = "700 MPa"
    made["damping"] = draw(st.sampled_from(TIMED)) if draw(st.booleans()) else draw(ratios())
    return made


# Each with how many of its values a text has as given, and how many follow where the sheet has joints.
TIMED: list[Spec] = [
    {"time": "0.1 ms"},
    {"time": ["0 ms", "0.3 ms"]},
    {"loss_factor": 0.05, "at": "40 Hz"},
    {"loss_factor": [0.05, 0.02], "at": "0.04 kHz"},
]
OF_TIMED = ((1, 0), (2, 1), (2, 1), (3, 3))


@st.composite
def ratios(draw: st.DrawFn) -> Spec:
    made: Spec = {"ratio": draw(RATIOS), "rotation": draw(st.sampled_from(["inertia", "paper"]))}
    if draw(st.booleans()):
        made["ratio_ty"] = draw(RATIOS)
    return made


@st.composite
def sheets(draw: st.DrawFn, material: str) -> Spec:
    boxes = [draw(st.integers(1, 4)), draw(st.integers(1, 4))]
    sheet: Spec = {
        "material": material,
        "size": [draw(lengths(5, 80)), draw(lengths(5, 80))],
        "thickness": "0.1 mm",
        "mass": "0.6 g",
        "boxes": boxes,
        "layout": draw(st.sampled_from(["edge_to_edge", "center_to_center", "plate"])),
        "grid": draw(st.sampled_from(["tiled", "paper"])) if min(boxes) > 1 else "tiled",
        "center": draw(triple("mm", 50)),
        "velocity": draw(st.one_of(st.just(["0 m/s"] * 3), triple("m/s", 2))),
        "spin": draw(st.one_of(st.just(["0 rad/s"] * 3), triple("rad/s", 9))),
        "surface": min(boxes) > 1 and draw(st.booleans()),
    }
    sheet |= draw(
        st.one_of(
            st.sampled_from([{}, {"turn": "0 deg"}, {"turn": "10 deg"}]),
            triple("deg", 180).map(lambda angles: {"rotation": angles}),
        )
    )
    if draw(st.booleans()):
        edge = draw(st.sampled_from(["x_min", "x_max", "y_min", "y_max"]))
        axis = "xy".index(edge[0])
        rows = draw(st.integers(0, boxes[axis] - 1))
        sheet["clamp"] = {"edge": edge, "length": mm(rows * pitch(sheet, axis))}
    return sheet


@st.composite
def places(draw: st.DrawFn, table: dict[str, Spec]) -> Spec:
    """A material point on a line or in a box, or an edge."""
    name = draw(st.sampled_from(sorted(table)))
    if draw(st.booleans()):
        return {"sheet": name, "edge": draw(st.sampled_from(["x_min", "x_max", "y_min", "y_max"]))}
    step = draw(st.sampled_from([1, 2]))  # 2: a corner of boxes
    n_x, n_y = (2 * n // step for n in table[name]["boxes"])
    node = (step * draw(st.integers(0, n_x)), step * draw(st.integers(0, n_y)))
    return {"sheet": name, "at": half_cells(table[name], node)}


@st.composite
def rollers(draw: st.DrawFn) -> Spec:
    roller: Spec = {
        "center": draw(CENTERS),
        "axis": draw(AXES),
        "radius": "5 mm",
        "width": "8 mm",
        "mass": "0.5 g",
    }
    if draw(st.booleans()):
        roller["drive"] = draw(
            st.sampled_from(
                [
                    {"speed": "100 rad/s", "ramp": "0 ms"},
                    {"speed": "100 rad/s", "ramp": "5 ms"},
                    {"profile": [["0 ms", "0 rad/s"], ["1 ms", "90 rad/s"], ["2 ms", "-9 rad/s"]]},
                ]
            )
        )
    if draw(st.booleans()):
        # so long that no start takes up all of it
        roller["press"] = {
            "direction": draw(AXES),
            "stiffness": "0.3 N/mm",
            "preload": "3 N",
            "free_length": "99 mm",
        }
    return roller


@st.composite
def planes(draw: st.DrawFn) -> Spec:
    plane: Spec = {
        "center": draw(CENTERS),
        "normal": draw(AXES),
        "size": ["90 mm", "80 mm", "10 mm"],
        "mass": "9 g",
    }
    if draw(st.booleans()):
        plane["press"] = {
            "direction": plane["normal"],
            "stiffness": "0.3 N/mm",
            "preload": "3 N",
            "free_length": "99 mm",
            **draw(st.sampled_from([{}, {"carrier_mass": "1 g"}])),
        }
    return plane


FRICTION = st.sampled_from([0, 0.9, {"static": 0.9, "dynamic": 0}])


@st.composite
def contacts(draw: st.DrawFn, scene: Spec) -> list[Spec]:
    """At most one entry for the sheets with the rollers, with each plane, and for two parallel rollers."""
    wanted = []
    if "roll_0" in scene["rollers"]:
        wanted.append(
            [draw(st.sampled_from(["sheet_*", "sheet_0"])), draw(st.sampled_from(["roll_*", "r*_0"]))]
        )
    wanted += [["sheet_?", name] for name in scene["planes"]]
    if "roll_1" in scene["rollers"]:
        wanted.append(["roll_0", "roll_1"])
        one, two = scene["rollers"]["roll_0"], scene["rollers"]["roll_1"]
        two["axis"] = one["axis"]
        if "press" in one:
            two.pop("press", None)
    return [
        {
            "between": between,
            "stiffness": "300 N/mm^1.5",
            "friction": draw(FRICTION),
            "smoothing": draw(st.sampled_from(["1 mm/s", "20 mm/s"])),
        }
        for between in draw(st.permutations(wanted))
        if draw(st.booleans())
    ]


@st.composite
def specs(draw: st.DrawFn) -> Spec:
    scene: Spec = {"name": "any", "gravity": draw(triple("m/s^2", 10)), "materials": {}, "sheets": {}}
    for k in range(draw(st.integers(1, 2))):
        sheet = scene["sheets"][f"sheet_{k}"] = draw(sheets(f"paper_{k}"))
        scene["materials"][f"paper_{k}"] = draw(materials(sheet["layout"]))
    scene["rollers"] = {f"roll_{k}": draw(rollers()) for k in range(draw(st.integers(0, 2)))}
    scene["planes"] = {f"plane_{k}": draw(planes()) for k in range(draw(st.integers(0, 2)))}
    scene["contacts"] = draw(contacts(scene))
    scene["probes"] = {f"probe_{k}": draw(places(scene["sheets"])) for k in range(draw(st.integers(0, 2)))}
    fixes = st.sampled_from([["z"], ["x", "y"], ["x", "y", "z"]])
    scene["supports"] = [
        draw(places(scene["sheets"])) | {"fix": draw(fixes)} for _ in range(draw(st.integers(0, 2)))
    ]
    scene["run"] = {
        "duration": "5 ms",
        "analysis": draw(st.sampled_from(["transient", "static"])),
        "prune": draw(st.booleans()),
    }
    return scene


# ---------------------------------------------------------------- what a scene has, counted from the spec


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


def is_turned(sheet: Spec) -> bool:
    return any(float(a.split()[0]) != 0.0 for a in (*sheet.get("rotation", []), sheet.get("turn", "0 deg")))


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
    total = 7 * len(scene["planes"]) + 7 * len(scene["contacts"]) + 2  # of the run
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
    aligned = sum(not is_turned(s) for s in table)
    return +Counter(
        {
            "BeginMDL": 1,
            "EndMDL": 1,
            "StandardInclude": 1,
            "SetCurrentSolverMode": 1,
            "SetBoolean": 1,
            "Template": 1,
            "DefineTemplate": 1,
            "DefineDataSet": sets,
            "DataSet": sets,
            "EndDefine": sets + 1,
            "Point": points,
            "SetPoint": points,
            "Marker": len(table) + marked + sum(surfaces),
            "Vector": pressed + sprung + own + own_normals,
            "SetVector": pressed + sprung + own + own_normals,
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
            "if": aligned,
            "endif": aligned,
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
    return set(NAME.findall(block)) - {one or two for one, two in defined}


@settings(max_examples=80, suppress_health_check=[HealthCheck.too_slow])
@given(spec=specs(), set_contact=st.booleans())
def test_text_of_any_scene(spec: Spec, set_contact: bool) -> None:
    written = json.dumps(spec)
    model = lower(loads(written))
    text = emit(model, set_contact=set_contact)

    reading = read(text)
    assert not reading.report.findings, [str(f) for f in reading.report.findings[:5]]
    assert not dangling(text)
    assert emit(lower(loads(written)), set_contact=set_contact) == text
    assert text.isascii()

    possible, kept = possible_pairs(spec), len(model.pairs)
    assert kept <= possible if spec["run"]["prune"] else kept == possible
    found = statement_counts(text)
    assert found.pop("Real") == found.pop("SetReal") == expected_members(spec)
    assert found.pop("SetContact", 0) == (kept if set_contact else 0)
    assert found == expected_counts(spec, kept)


# ---------------------------------------------------------------- hostile names


PLAIN: Spec = {
    "name": "plain",
    "materials": {"paper": {"E_md": "1 GPa", "E_cd": "1 GPa", "k_tx": "1 N*mm/rad", "k_ty": "1 N*mm/rad"}},
    "sheets": {
        "note": {
            "material": "paper",
            "size": ["9 mm", "9 mm"],
            "thickness": "0.1 mm",
            "mass": "1 g",
            "boxes": [2, 1],
        }
    },
    "rollers": {
        "roll": {
            "center": ["0 mm", "0 mm", "-3 mm"],
            "axis": "y",
            "radius": "3 mm",
            "width": "3 mm",
            "mass": "1 g",
        }
    },
    "planes": {
        "plate": {
            "center": ["0 mm", "0 mm", "-9 mm"],
            "normal": "z",
            "size": ["9 mm", "9 mm", "1 mm"],
            "mass": "1 g",
        }
    },
    "contacts": [{"between": ["note", "roll"], "stiffness": "1 N/mm^1.5", "friction": 0}],
    "probes": {"lead": {"sheet": "note", "edge": "x_max"}},
    "supports": [{"sheet": "note", "at": ["0 mm", "0 mm"], "fix": ["z"]}],
}
# Where a name stands: as a key of a mapping, or as a value.
KEYS = (
    ("materials", "paper"),
    ("sheets", "note"),
    ("rollers", "roll"),
    ("planes", "plate"),
    ("probes", "lead"),
)
VALUES = (
    ("name",),
    ("sheets", "note", "material"),
    ("contacts", 0, "between", 0),
    ("contacts", 0, "between", 1),
    ("probes", "lead", "sheet"),
    ("supports", 0, "sheet"),
)
HOSTILE = {
    "quote": 'x" )\n  *Include( "evil.mdl" )\n  *Point( p, "',
    "quotes": '"x"',
    "new line": "x\n*EndMDL()",
    "return": "x\r*EndMDL()",
    "statement": "*EndMDL()",
    "comma": "x, y",
    "parenthesis": "x)",
    "backquote": "`x`",
    "brace": "{ds_note.real_L_x.value}",
    "jinja": "<< scene >>",
    "jinja braces": "{{ scene }}",
    "dollar": "$L_x",
    "comment": "// x",
    "letters": "n\u00f6te",
    "wide": "\uff41\uff42",
    "dotless": "\u0131f",
    "direction mark": "x\u202ey",
    "line separator": "x\u2028*EndMDL()",
    "nul": "x\x00",
    "empty": "",
    "blank": " ",
    "digit first": "1x",
    "long": "x" * 10_000,
    "one too long": "x" * 64,
    "reserved": "b_ground",
    "reserved, other case": "Global_Frame",
    "word": "endif",
}


def counts_of(spec: Spec) -> Counter[str]:
    return statement_counts(emit(lower(loads(json.dumps(spec)))))


def with_name(spec: Spec, place: tuple[str | int, ...], name: str) -> Spec:
    """The spec with a name typed at one place: a key of KEYS (and all that refers to it), or a value."""
    if place in KEYS:
        kind, old = place
        spec = json.loads(json.dumps(spec).replace(json.dumps(old), json.dumps(name)))
        assert name in spec[kind]
        return spec
    made: Any = copy.deepcopy(spec)
    holder = made
    for step in place[:-1]:
        holder = holder[step]
    holder[place[-1]] = name
    return made


@pytest.mark.parametrize("place", [*KEYS, *VALUES], ids=lambda p: ".".join(map(str, p)))
def test_hostile_names_are_refused_wherever_a_name_may_stand(place: tuple[str | int, ...]) -> None:
    for kind, name in HOSTILE.items():
        with pytest.raises(SpecError) as caught:
            counts_of(with_name(PLAIN, place, name))
        assert "\n" not in str(caught.value), kind
        assert len(str(caught.value)) < 1000, kind


@pytest.mark.parametrize(("kind", "old"), KEYS[1:])
def test_names_that_differ_in_case_only_are_refused(kind: str, old: str) -> None:
    for _, name in KEYS[1:]:
        spec = copy.deepcopy(PLAIN)
        spec[kind][name.capitalize()] = spec[kind][old]
        with pytest.raises(SpecError, match="used twice"):
            counts_of(spec)


PIECES = st.sampled_from(
    ["x", "note", "_0", "0_0", "_ANCHOR", "contact_", '"', "`", "*", "(", " )", ", ", "\n", "é"]
)


@settings(max_examples=100)
@given(place=st.sampled_from(KEYS), name=st.lists(PIECES, min_size=1, max_size=4).map("".join))
def test_no_name_changes_the_statements(place: tuple[str, str], name: str) -> None:
    """With any name there are the statements that there are with a plain one, or none at all."""
    try:
        found = counts_of(with_name(PLAIN, place, name))
    except SpecError:
        return
    assert found == counts_of(PLAIN)


@pytest.mark.parametrize("name", ["motionview", "motionsolve"])
def test_a_part_of_a_kind_without_words_is_refused_by_name(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    parts = import_module(f"mdlgen.backends.{name}.writer.parts")
    model = lower(load(samples() / "verify" / "incline.yaml"))
    assert model.planes
    monkeypatch.delitem(parts.WRITTEN, PlanePart)
    with pytest.raises(RefusedError, match=rf"{model.planes[0].name} is a plane, which is not written yet"):
        emitter(name).emit(model)

"""Any valid scene, drawn at random."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

Spec = dict[str, Any]

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

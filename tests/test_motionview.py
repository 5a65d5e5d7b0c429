"""The MotionView text, read back by a small reader of its own and compared with the Model."""

from __future__ import annotations

import ast
import json
import math
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import backends.motionview as motionview
from mdlgen.errors import MdlgenError, RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import GROUND, SUPPORT, Model
from mdlgen.paths import samples
from mdlgen.spec.load import load

GOLDEN = Path(__file__).parent / "golden"
# Both sides do the same few operations in another order and in units 1000 apart: some ulp remain.
RELATIVE = 1e-12


def model_of(sample: str, *overrides: str) -> Model:
    return lower(load(samples() / sample, overrides=list(overrides)))


# ---------------------------------------------------------------- a small, strict reader of MDL


def statements(text: str) -> list[tuple[str, list[str]]]:
    """(name, arguments) of every statement between BeginMDL and EndMDL; template bodies are skipped."""
    at = text.index("*BeginMDL")
    found, closed = [], 0
    for match in re.finditer(r"\*(\w+)\(", text[at:]):
        start = at + match.start()
        if start < closed:
            continue  # inside a statement that was read already
        between = text[closed:start] if closed else ""
        if not (found and found[-1][0] == "DefineTemplate"):
            assert not between.strip(), f"text outside of statements: {between.strip()[:80]!r}"
        args, closed = _arguments(text, at + match.end())
        found.append((match[1], args))
    assert found[-1] == ("EndMDL", [])
    assert not text[closed:].strip()
    return found


def _arguments(text: str, at: int) -> tuple[list[str], int]:
    """Arguments from behind the opening parenthesis, and where the statement ends."""
    args, depth, start, quote = [], 0, at, ""
    for k in range(at, len(text)):
        c = text[k]
        if quote:
            quote = "" if c == quote else quote
        elif c in '"`':
            quote = c
        elif c in "({[":
            depth += 1
        elif c == ")" and depth == 0:
            last = text[start:k].strip()
            return ([*args, last] if args or last else []), k + 1
        elif c in ")}]":
            depth -= 1
        elif c == "," and depth == 0:
            args.append(text[start:k].strip())
            start = k + 1
    raise AssertionError("a statement does not end")


_TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+)|([A-Za-z_]\w*(?:\.\w+)*)|(==|!=|&&|\|\||.))")
GLOBAL_AXES = {"xaxis": 0, "yaxis": 1, "zaxis": 2}


class Reader:
    """Entities of a text by identifier, and the values of its expressions."""

    def __init__(self, text: str):
        self.text = text
        self.all = statements(text)
        self.entity: dict[str, tuple[str, list[str]]] = {}
        self.members: dict[str, dict[str, list[str]]] = {}
        self.reals: dict[str, str] = {}
        self.points: dict[str, list[str]] = {"P_Global_Origin": ["0", "0", "0"]}
        self.vectors: dict[str, list[str]] = {}
        self.orient: dict[str, list[str]] = {}
        self.sets: dict[str, dict[str, list[str]]] = {}
        self.cache: dict[str, np.ndarray] = {}
        block = ""
        for name, args in self.all:
            if name == "SetReal":
                assert args[0] not in self.reals, f"{args[0]} is set twice"
                self.reals[args[0]] = args[1]
        for name, args in self.active():
            if name.startswith("Define") and name != "DeformableSurface":
                block = args[0]
                self._define(block, name, args)
            elif name == "EndDefine":
                block = ""
            elif name == "Real":
                self.members.setdefault(block, {})[args[0]] = args[1:]
            elif name == "SetReal":
                continue
            elif name == "SetPoint":
                assert args[0] not in self.points
                self.points[args[0]] = args[1:]
            elif name == "SetVector":
                self.vectors[args[0]] = args[1:]
            elif name == "SetOrientation":
                assert args[0] not in self.orient
                self.orient[args[0]] = args[1:]
            elif name.startswith("Set"):
                assert args[0] not in self.sets.setdefault(name, {}), f"{name} {args[0]} twice"
                self.sets[name][args[0]] = args[1:]
            elif len(args) > 1 and args[1].startswith('"'):
                self._define(args[0], name, args)

    def active(self) -> Iterator[tuple[str, list[str]]]:
        """Statements outside of if blocks, and those inside whose condition holds."""
        branches: list[tuple[bool, bool]] = []  # of each open if: this branch acts, one before it did
        for name, args in self.all:
            if name == "if":
                holds = bool(self.value(args[0]))
                branches.append((holds, holds))
            elif name in ("else", "elseif"):
                _, done = branches.pop()
                holds = not done and (name == "else" or bool(self.value(args[0])))
                branches.append((holds, done or holds))
            elif name == "endif":
                branches.pop()
            elif all(acts for acts, _ in branches):
                yield name, args
            else:
                assert name.startswith("Set") and name != "SetReal", f"{name} inside of an if"
        assert not branches, "an if does not end"

    def _define(self, identifier: str, name: str, args: list[str]) -> None:
        assert identifier not in self.entity, f"{identifier} is defined twice"
        self.entity[identifier] = (name, args[1:])

    def of_kind(self, *kinds: str) -> dict[str, list[str]]:
        return {k: args for k, (kind, args) in self.entity.items() if kind in kinds}

    # values

    def value(self, expression: str):
        tokens = [m.groups() for m in _TOKEN.finditer(expression) if m.group().strip()]
        parser = _Parser(self, tokens)
        result = parser.ternary()
        assert parser.at == len(tokens), f"cannot read {expression!r}"
        return result

    def point(self, name: str) -> np.ndarray:
        if name not in self.cache:
            self.cache[name] = np.array([self.value(e) for e in self.points[name]])
        return self.cache[name]

    def vector(self, name: str) -> np.ndarray:
        if name.startswith("V_Global_"):
            return np.eye(3)["XYZ".index(name[-1])]
        if name in self.vectors:
            return np.array([self.value(e) for e in self.vectors[name]])
        marker, axis = name.split(".")
        return self.axes(marker)[:, GLOBAL_AXES[axis]]

    def axes(self, name: str) -> np.ndarray:
        """Axes of a marker, b.cm or bushing in columns; global where none are set."""
        if name not in self.orient:
            return np.eye(3)
        if f"axes {name}" not in self.cache:
            args = self.orient[name]
            assert args[:2] == ["TWOAXES", "ZX"]
            z, rest = self._direction(args[2:])
            x, rest = self._direction(rest)
            assert not rest
            z = z / np.linalg.norm(z)
            x = x - z * (x @ z)
            x /= np.linalg.norm(x)
            self.cache[f"axes {name}"] = np.stack([x, np.cross(z, x), z], axis=1)
        return self.cache[f"axes {name}"]

    def _direction(self, args: list[str]) -> tuple[np.ndarray, list[str]]:
        if args[0] == "DXDYDZ":
            return np.array([self.value(a) for a in args[1:4]]), args[4:]
        assert args[0] == "VECTOR"
        return self.vector(args[1]), args[2:]

    def reference(self, name: str):
        if name == "PI":
            return math.pi
        head, _, tail = name.partition(".")
        if tail.endswith(".value"):
            full = name.removesuffix(".value")
            if full not in self.cache:
                self.cache[full] = self.value(self.reals[full])  # type: ignore[assignment]
            return self.cache[full]
        if tail in ("x", "y", "z") and head in self.points:
            return self.point(head)["xyz".index(tail)]
        if tail in ("x", "y", "z"):
            return self.vector(head)["xyz".index(tail)]
        if tail == "r1":
            return self.value(self.entity[head][1][6])
        raise AssertionError(f"unknown reference {name!r}")

    def solver_value(self, expression: str, time: float) -> float:
        """A back-quoted expression whose braces hold numbers, at a time."""
        assert expression[0] == expression[-1] == "`"
        pasted = re.sub(r"\{([^}]*)\}", lambda m: repr(float(self.value(m[1]))), expression[1:-1])
        return eval(pasted, {"__builtins__": {}}, {"MAX": max, "TIME": time})


class _Parser:
    """Recursive descent over the operators that MotionView writes itself."""

    def __init__(self, reader: Reader, tokens: list[tuple]):
        self.reader, self.tokens, self.at = reader, tokens, 0

    def peek(self) -> str | None:
        return self.tokens[self.at][2] if self.at < len(self.tokens) else None

    def take(self, *wanted: str) -> str | None:
        if self.peek() in wanted:
            self.at += 1
            return self.tokens[self.at - 1][2]
        return None

    def need(self, wanted: str) -> None:
        assert self.take(wanted), f"expected {wanted!r} in {self.tokens}"

    def ternary(self):
        condition = self.either()
        if not self.take("?"):
            return condition
        yes = self.ternary()
        self.need(":")
        no = self.ternary()
        return yes if condition else no

    def either(self):
        left = self.both()
        while self.take("||"):
            right = self.both()
            left = left or right
        return left

    def both(self):
        left = self.compared()
        while self.take("&&"):
            right = self.compared()
            left = left and right
        return left

    def compared(self):
        left = self.sum()
        while op := self.take("<", "==", "!="):
            right = self.sum()
            left = {"<": left < right, "==": left == right, "!=": left != right}[op]
        return left

    def sum(self):
        left = self.product()
        while op := self.take("+", "-"):
            right = self.product()
            left = left + right if op == "+" else left - right
        return left

    def product(self):
        left = self.signed()
        while op := self.take("*", "/"):
            right = self.signed()
            left = left * right if op == "*" else left / right
        return left

    def signed(self):
        return -self.signed() if self.take("-") else self.power()

    def power(self):
        base = self.primary()
        return base ** self.signed() if self.take("^") else base

    def primary(self):
        number, name, sign = self.tokens[self.at]
        self.at += 1
        if number:
            return float(number)
        if sign == "(":
            inner = self.ternary()
            self.need(")")
            return inner
        if sign == "{":
            return np.array(self.listed("}"))
        assert name, f"unexpected {sign!r}"
        if name == "loc_rel_to":
            return self.loc_rel_to()
        if self.take("("):
            return {"sqrt": math.sqrt, "sin": math.sin, "cos": math.cos}[name](*self.listed(")"))
        return self.reader.reference(name)

    def listed(self, end: str) -> list:
        items = [self.ternary()]
        while self.take(","):
            items.append(self.ternary())
        self.need(end)
        return items

    def loc_rel_to(self) -> float:
        self.need("(")
        local = self.ternary()
        self.need(",")
        marker = self.tokens[self.at][1]
        self.at += 1
        self.need(")")
        self.need("[")
        index = int(self.tokens[self.at][0])
        self.at += 1
        self.need("]")
        origin = self.reader.entity[marker][1][2]
        return (self.reader.point(origin) + self.reader.axes(marker) @ local)[index]


# ---------------------------------------------------------------- the text and the Model

C2C = "sheets.note.layout=center_to_center"
SMALL = "sheets.note.boxes=[3,4]"
PLATES = ('materials.eur10.D_cd="0.242 N*mm"', 'materials.eur10.D_md="0.4 N*mm"')
TURN = 'sheets.note.turn="10 deg"'
GENERAL = 'sheets.note.rotation=["20 deg","-35 deg","110 deg"]'
MOVING = (
    'sheets.note.velocity=["1.5 m/s","0 m/s","-0.2 m/s"]',
    'sheets.note.spin=["3 rad/s","-7 rad/s","11 rad/s"]',
)
# a note that stands across the machine lifts the rollers far at the start
LONG_SPRINGS = tuple(
    f'rollers.counter_{row}_{side}.press.free_length="30 mm"' for row in (1, 2) for side in ("left", "right")
)
CASES = {
    "transport": ("transport_4x4.yaml",),
    "transport_c2c": ("transport_4x4.yaml", C2C),
    "tilted": ("transport_tilted.yaml",),
    "4x2": ("transport_4x2.yaml",),
    "paper_grid": ("transport_4x4.yaml", SMALL, "sheets.note.grid=paper"),
    "paper_damping": ("transport_4x4.yaml", SMALL, "materials.eur10.damping.rotation=paper"),
    "paper_damping_c2c": ("transport_4x4.yaml", SMALL, C2C, "materials.eur10.damping.rotation=paper"),
    "plates": ("transport_4x4.yaml", SMALL, *PLATES),
    "twist": ("transport_4x4.yaml", SMALL, C2C, *PLATES, 'materials.eur10.D_twist="0.1 N*mm"'),
    "twist_paper": (
        "transport_4x4.yaml",
        SMALL,
        C2C,
        'materials.eur10.D_twist="0.1 N*mm"',
        "materials.eur10.damping.rotation=paper",
    ),
    "twist_clamp_x": (
        "cantilever.yaml",
        SMALL,
        C2C,
        'materials.eur10.D_twist="0.1 N*mm"',
        "sheets.note.clamp.edge=x_max",
    ),
    "soft_cd": ("transport_4x4.yaml", SMALL, 'materials.eur10.E_cd="90000 MPa"'),
    "turned": ("transport_4x4.yaml", SMALL, TURN),
    "general": (
        "transport_4x4.yaml",
        SMALL,
        C2C,
        GENERAL,
        *LONG_SPRINGS,
        'sheets.note.center=["1 mm","-2 mm","3 mm"]',
    ),
    "moving": ("transport_4x4.yaml", SMALL, GENERAL, *LONG_SPRINGS, *MOVING),
    "surface": ("transport_4x4.yaml", SMALL, "sheets.note.surface=true"),
    "cantilever": ("cantilever.yaml",),
    "clamp_length": ("cantilever.yaml", 'sheets.note.clamp.length="12.7 mm"'),
    "clamp_moving": ("cantilever.yaml", SMALL, 'sheets.note.clamp.length="31.75 mm"', *MOVING),
    "supports": (
        "cantilever.yaml",
        TURN,
        'supports=[{"sheet":"note","at":["0 mm","0 mm"],"fix":["z"]},'
        '{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
    ),
    "block": ("verify/slide.yaml",),
    "k_tz_left_out": ("verify/slide.yaml", "sheets.block.boxes=[2,3]", 'materials.solid.k_tx="2 N*mm/rad"'),
    "incline": ("verify/incline.yaml",),
    "skew_machine": (
        "transport_4x4.yaml",
        SMALL,
        "rollers.motor_1_left.axis=[0.95,0.2,0.1]",
        "rollers.counter_1_left.axis=[0.95,0.2,0.1]",
        "rollers.motor_1_right.axis=[0.6,0.8,0]",
        "rollers.counter_1_right.axis=[-0.6,-0.8,0]",
        "rollers.motor_2_left.axis=-x",
        "rollers.counter_2_left.axis=x",
        "rollers.counter_2_right.press.direction=[0.1,0.2,-1]",
        "planes.support.normal=[0.3,-0.2,1]",
    ),
}


@pytest.fixture(scope="module", params=sorted(CASES))
def case(request) -> tuple[Model, Reader]:
    sample, *overrides = CASES[request.param]
    model = model_of(sample, *overrides)
    return model, Reader(motionview.emit(model))


def close(found, expected, scale: float = 0.0) -> None:
    """Within RELATIVE of the value, or of `scale` where differences of such values are meant."""
    np.testing.assert_allclose(found, expected, rtol=RELATIVE, atol=RELATIVE * scale)


def test_bodies_have_the_place_axes_mass_and_inertia_of_the_model(case):
    model, reader = case
    bodies = reader.of_kind("Body")
    table = model.bodies
    carriers = {f"b_{r.name}_carrier" for r in model.rollers if r.press is not None}
    assert set(bodies) == {f"b_{name}" for name in table.name} | carriers
    for k, name in enumerate(table.name):
        label, point = bodies[f"b_{name}"][:2]
        assert label == f'"{table.label[k]}"'
        close(reader.point(point), table.position[k], scale=100.0)
        close(reader.axes(f"b_{name}.cm"), table.rotation[k], scale=1.0)
        mass, *inertia = (reader.value(a) for a in reader.sets["SetBodyInertia"][f"b_{name}"])
        close(mass * 1000, table.mass[k])
        close(np.array(inertia[:3]) * 1000, table.inertia[k])
        assert inertia[3:] == [0.0, 0.0, 0.0]


def test_bushings_have_the_place_axes_and_values_of_the_model(case):
    model, reader = case
    bushes, table = reader.of_kind("Bush"), model.bushings
    assert set(bushes) == {f"bsh_{name}" for name in table.name}
    for row, name in enumerate(table.name):
        _, body_1, body_2, point = bushes[f"bsh_{name}"]
        a = int(table.a[row])
        assert body_1 == ("B_Ground" if a == GROUND else f"b_{model.bodies.name[a]}")
        assert body_2 == f"b_{model.bodies.name[int(table.b[row])]}"
        close(reader.point(point), table.origin[row], scale=100.0)
        close(reader.axes(f"bsh_{name}"), table.axes[row], scale=1.0)
        args = reader.sets["SetBush"][f"bsh_{name}"]
        assert args[0:24:2] == ["LIN"] * 12
        values = np.array([reader.value(a) for a in args[1:24:2]])
        close(np.concatenate([values[0:3], values[6:9]]), table.k[row])
        close(np.concatenate([values[3:6], values[9:12]]) * 1000, table.c[row])
        assert [reader.value(a) for a in args[24:]] == [0.0] * 6


def test_corners_that_bushings_share_are_one_point(case):
    model, reader = case
    for k, sheet in enumerate(model.sheets):
        points = {args[3] for args in reader.of_kind("Bush").values()}
        joints = (model.bushings.sheet == k) & (model.bushings.kind != SUPPORT)
        corners = {tuple(node) for node in model.bushings.node[joints].tolist()}
        assert sum(p.startswith(f"p_{sheet.name}_node_") for p in points) == len(corners)


def test_initial_velocities(case):
    model, reader = case
    table = model.bodies
    given = reader.sets.get("SetBodyIC", {})
    moving = {f"b_{n}" for k, n in enumerate(table.name) if table.velocity[k].any() or table.spin[k].any()}
    assert set(given) == moving
    assert set(reader.sets.get("SetBodyICFlag", {})) == moving
    for k, name in enumerate(table.name):
        if f"b_{name}" in moving:
            values = np.array([reader.value(a) for a in given[f"b_{name}"]])
            close(values[:3], table.velocity[k] * 1000, scale=1500.0)
            close(values[3:], table.spin[k] * 1000)
            assert reader.of_kind("Body")[f"b_{name}"][-2:] == ["Global_Frame", "Global_Frame"]


def test_held_bodies_have_a_fixed_joint(case):
    model, reader = case
    held = {args[1] for args in reader.of_kind("FixedJoint").values()}
    assert held == {f"b_{n}" for k, n in enumerate(model.bodies.name) if model.bodies.fixed[k]}


def test_no_point_of_a_sheet_is_a_bare_coordinate(case):
    model, reader = case
    for name in reader.points:
        if name == "P_Global_Origin":
            continue
        numbers = [e for e in reader.points[name] if not re.search(r"\bds_\w+\.real_\w+\.value", e)]
        assert not numbers, f"{name} has the bare coordinates {numbers}"
    for sheet in model.sheets:
        for box in model.bodies.name[sheet.first : sheet.first + sheet.count]:
            assert all(f", m_{sheet.name} )" in e for e in reader.points[f"p_{box}"])


def test_parameters_stand_in_their_data_sets(case):
    model, reader = case
    factor = {"g": 1e3, "ms": 1e3, "mm/ms": 1e-3, "rad/ms": 1e-3, "rad": math.pi / 180}
    for p in model.parameters:
        close(float(reader.reals[f"ds_{p.data_set}.real_{p.member}"]) * factor.get(p.unit, 1.0), p.value)
        assert p.member and f"real_{p.member}" in reader.members[f"def_ds_{p.data_set}"]


def test_derived_members_are_the_tables_of_the_sheet(case):
    model, reader = case
    for sheet in model.sheets:
        for name, expected in sheet.derived.items():
            if f"real_{name}" not in reader.members[f"def_ds_{sheet.name}"]:
                assert name[0] in "kc" and not np.any(model.bushings.sheet == 0)
                continue
            scale = 1000.0 if name[0] in "mIc" else 1.0
            close(reader.reference(f"ds_{sheet.name}.real_{name}.value") * scale, expected)


def test_machine(case):
    model, reader = case
    for roller in model.rollers:
        name, press = roller.name, roller.press
        _, body, on, point, kind, axis = reader.of_kind("RevJoint")[f"j_{name}"]
        assert (body, kind) == (f"b_{name}", "VECTOR")
        close(reader.vector(axis), roller.axis, scale=1.0)
        graphic = reader.entity[f"gcyl_{name}"][1]
        expected = [roller.radius, roller.radius, roller.width, -roller.width / 2]
        close([reader.value(a) for a in graphic[6:10]], expected)
        assert on == (f"b_{name}_carrier" if press else "B_Ground")
        if press:
            close(reader.point(point), roller.center + press.start * press.direction, scale=10.0)
            slide = reader.of_kind("TransJoint")[f"j_{name}_slide"]
            assert slide[1:3] == [on, "B_Ground"]
            close(reader.vector(slide[5]), press.direction, scale=1.0)
            mass = reader.value(reader.sets["SetBodyInertia"][on][0])
            close(mass * 1000, press.carrier_mass)
            spring = reader.of_kind("CoilSpring")[f"cs_{name}"]
            ends = reader.point(spring[3]) - reader.point(spring[4])
            close(ends, (press.start - press.touch + press.free_length) * press.direction, scale=10.0)
            numbers = reader.sets["SetCoilSpring"][f"cs_{name}"]
            assert numbers[0:4:2] == ["LIN", "LIN"]
            k, c, f, length = (reader.value(numbers[i]) for i in (1, 3, 4, 5))
            expected = [press.stiffness, press.damping, press.preload, press.free_length]
            close([k, c * 1000, f, length], expected)
        else:
            close(reader.point(point), roller.center)
        if roller.speed is None:
            assert f"mot_{name}" not in reader.entity
        else:
            assert reader.entity[f"mot_{name}"][1][1:] == ["JOINT", f"j_{name}", "ROT"]
            kind, form, expression = reader.sets["SetMotion"][f"mot_{name}"]
            assert (kind, form) == ("VEL", "EXPR")
            for t in (0.0, 0.3, 1.0, 5.0):
                share = min(1.0, t) if roller.ramp > 0 else 1.0
                found = reader.solver_value(expression, t * roller.ramp / 1000)
                close(found, roller.speed * 1000 * share, scale=1.0)


def test_graphics_of_boxes(case):
    model, reader = case
    for k, name in enumerate(model.bodies.name):
        if model.bodies.half[k].any():
            args = reader.entity[f"gbox_{name}"][1]
            assert args[1:6] == ["BOX", f"b_{name}", "CENTER", f"p_{name}", "ZX"]
            axes = reader._direction(args[6:8])[0], reader._direction(args[8:10])[0]
            close(axes[0], model.bodies.rotation[k][:, 2], scale=1.0)
            x = axes[1] - axes[0] * (axes[0] @ axes[1])
            close(x / np.linalg.norm(x), model.bodies.rotation[k][:, 0], scale=1.0)
            close([reader.value(a) for a in args[10:13]], 2 * model.bodies.half[k])


def test_contacts_are_the_pairs_of_the_model(case):
    model, reader = case
    found = set()
    for args in reader.of_kind("Contact").values():
        _, law, friction, kind_1, a, n_1, g_1, flip_1, kind_2, b, n_2, g_2, flip_2 = args
        assert (law, friction) == ("POISSON", "ON")
        assert (kind_1, n_1, flip_1) == (kind_2, n_2, flip_2) == ("BODY", "1", "false")
        assert reader.entity[g_1][1][2] == a and reader.entity[g_2][1][2] == b
        found.add((a, b))
    names = [f"b_{n}" for n in model.bodies.name]
    assert found == {(names[a], names[b]) for a, b in zip(model.pairs.a, model.pairs.b, strict=True)}


def test_probes(case):
    model, reader = case
    for probe in model.probes:
        args = reader.entity[f"o_{probe.name}"][1]
        markers = re.findall(r"DX\(\{(\w+)\.idstring\}", args[2])
        assert len(markers) == len(probe.body)
        for marker, body, local in zip(markers, probe.body, probe.local, strict=True):
            _, on, point = reader.entity[marker][1]
            assert on == f"b_{model.bodies.name[body]}"
            expected = model.bodies.position[body] + model.bodies.rotation[body] @ local
            close(reader.point(point), expected, scale=100.0)


ARITY = {  # measured over real files or documented: see the MDL reference
    "BeginMDL": 2, "EndMDL": 0, "StandardInclude": 1, "SetCurrentSolverMode": 1, "SetBoolean": 2,
    "DefineDataSet": 1, "Real": 3, "EndDefine": 0, "DataSet": 3, "SetReal": 2,
    "Point": 2, "Vector": 2, "SetVector": 4, "SetPoint": 4, "Marker": 4,
    "Body": 7, "SetBodyInertia": 8, "SetBodyIC": 7, "SetBodyICFlag": 7,
    "Bush": 5, "SetBush": 31, "CoilSpring": 6, "SetCoilSpring": 7, "Contact": 14,
    "RevJoint": 7, "TransJoint": 7, "FixedJoint": 5, "Motion": 5, "SetMotion": 4,
    "Output": 9, "Template": 5, "DefineTemplate": 2, "if": 1, "endif": 0,
}  # fmt: skip


def test_argument_counts(case):
    _, reader = case
    for name, args in reader.all:
        if name == "SetOrientation":
            assert len(args) in (7, 11)
        elif name == "Graphic":
            assert len(args) == {"BOX": 15, "CYLINDER": 13}[args[2]]
        elif name == "DeformableSurface":
            assert len(args) == 5 + int(args[3]) * int(args[4])
        else:
            assert len(args) == ARITY[name], name
    assert reader.members.keys() <= reader.entity.keys()


GLOBALS = {"B_Ground", "V_Global_X", "V_Global_Y", "V_Global_Z", "Global_Frame", "DS_MotionSolve_Simopts"}
REACHED = {"Point", "Marker", "Vector", "DefineDataSet", "DefineTemplate"}  # of no use unless referred to
WORDS = re.compile(r"(?<![\w.])(?:def_)?(?:p|b|m|v|j|bsh|gbox|gcyl|con|mot|cs|ds|tmplt|o|defsur)_\w+")


def test_every_name_used_is_defined_and_every_name_defined_is_used(case):
    _, reader = case
    used: Counter[str] = Counter()
    for _, args in reader.all:
        for arg in args[1:] if args and args[0] in reader.entity else args:
            if not arg.startswith('"'):
                used.update(re.findall(WORDS, arg))
                used.update(w for w in re.findall(r"\b[A-Z]\w*_\w+", arg) if w in GLOBALS)
    undefined = set(used) - set(reader.entity) - GLOBALS
    assert not undefined
    idle = [n for n, (kind, _) in reader.entity.items() if kind in REACHED and not used[n]]
    assert not idle
    lowered = Counter(n.lower() for n in reader.entity)
    assert max(lowered.values()) == 1
    for target in reader.reals:
        data_set, member = target.split(".")
        assert member in reader.members[reader.entity[data_set][1][1]]
    sets = {n: args[1] for n, args in reader.of_kind("DataSet").items()}
    assert {f"{n}.{m}" for n, d in sets.items() for m in reader.members[d]} == set(reader.reals)


def test_surface_lists_its_markers_row_by_row():
    model = model_of(*CASES["surface"])
    reader = Reader(motionview.emit(model))
    args = reader.entity["defsur_note"][1]
    assert args[1:4] == ["NATURAL", "4", "3"]
    assert args[4:] == [f"m_note_{i}_{j}" for j in range(4) for i in range(3)]


def test_changing_one_value_moves_the_whole_note():
    """What a user does in MotionView: edit a value of ds_note; the same text must follow."""
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL, TURN))
    for old, new, override in (
        ("real_turn, 10.0 )", "real_turn, -25.0 )", 'sheets.note.turn="-25 deg"'),
        ("real_L_x, 67.0 )", "real_L_x, 80.0 )", 'sheets.note.size=["80 mm","127 mm"]'),
        ("real_k_tx, 0.15 )", "real_k_tx, 0.3 )", 'materials.eur10.k_tx="0.3 N*mm/rad"'),
        ("real_M, 0.00072 )", "real_M, 0.001 )", 'sheets.note.mass="1 g"'),
    ):
        assert text.count(f"ds_note.{old}") == 1
        reader = Reader(text.replace(f"ds_note.{old}", f"ds_note.{new}"))
        model = model_of("transport_4x4.yaml", SMALL, *([TURN] if "turn" not in override else []), override)
        test_bodies_have_the_place_axes_mass_and_inertia_of_the_model((model, reader))
        test_bushings_have_the_place_axes_and_values_of_the_model((model, reader))


SUPPORTED = (
    'supports=[{"sheet":"note","at":["0 mm","0 mm"],"fix":["z"]},'
    '{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
    'probes.inside={"sheet":"note","at":["3 mm","-7 mm"]}',
)
TURNED_SCENES = {
    "transport": ("transport_4x4.yaml",),
    "c2c": ("transport_4x4.yaml", SMALL, C2C),
    "moving": ("transport_4x4.yaml", SMALL, *MOVING),
    "surface": ("transport_4x4.yaml", SMALL, "sheets.note.surface=true"),
    "supports": ("cantilever.yaml", *SUPPORTED),
    "clamp": ("cantilever.yaml", SMALL, 'sheets.note.clamp.length="31.75 mm"', *MOVING),
    "block": ("verify/slide.yaml", "sheets.block.boxes=[2,3]"),
}


def follows(text: str, model: Model) -> None:
    """Everything of the text that has a place or axes is where `model` has it."""
    case = model, Reader(text)
    test_bodies_have_the_place_axes_mass_and_inertia_of_the_model(case)
    test_bushings_have_the_place_axes_and_values_of_the_model(case)
    test_initial_velocities(case)
    test_graphics_of_boxes(case)
    test_probes(case)


def edited(text: str, value: str, new: float) -> str:
    """`text` with only the number of one value of a data set changed."""
    pattern = rf"(\*SetReal\( {re.escape(value)}, )[-+.e\d]+( \))"
    text, count = re.subn(pattern, lambda m: f"{m[1]}{new!r}{m[2]}", text)
    assert count == 1
    return text


@pytest.mark.parametrize("name", sorted(TURNED_SCENES))
def test_editing_the_turn_turns_the_whole_sheet_and_back(name):
    sample, *overrides = TURNED_SCENES[name]
    sheet = "block" if name == "block" else "note"
    aligned = model_of(sample, *overrides)
    turned = model_of(sample, *overrides, f'sheets.{sheet}.turn="10 deg"')
    assert not np.allclose(aligned.bushings.axes, turned.bushings.axes)
    text, value = motionview.emit(aligned), f"ds_{sheet}.real_turn"
    follows(edited(text, value, 10.0), turned)
    follows(edited(text, value, 0.0), aligned)
    follows(edited(motionview.emit(turned), value, 0.0), aligned)


@pytest.mark.parametrize("axis", "xyz")
def test_editing_one_of_three_angles_turns_the_whole_sheet_and_back(axis):
    angles = ["20 deg" if a == axis else "0 deg" for a in "xyz"]
    # without springs: a note that stands across the machine lifts the rollers
    scene = ("cantilever.yaml", SMALL, *MOVING, *SUPPORTED)
    aligned = model_of(*scene, 'sheets.note.rotation=["0 deg","0 deg","0 deg"]')
    turned = model_of(*scene, f"sheets.note.rotation={json.dumps(angles)}")
    text, value = motionview.emit(aligned), f"ds_note.real_r_{axis}"
    follows(text, aligned)
    follows(edited(text, value, 20.0), turned)
    follows(edited(motionview.emit(turned), value, 0.0), aligned)


def test_an_aligned_sheet_is_oriented_only_once_it_is_turned():
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL))
    assert not any(name.startswith(("bsh_", "b_note")) for name in Reader(text).orient)
    assert text.count("*if( ds_note.real_turn.value != 0 )") == text.count("*if(") == 1
    turned = motionview.emit(model_of("transport_4x4.yaml", SMALL, TURN))
    assert "*if(" not in turned
    assert "inside an if" in text and "inside an if" not in turned


def test_banner_says_that_contacts_belong_to_the_start():
    head, _, _ = motionview.emit(model_of("transport_4x4.yaml", SMALL)).partition("*BeginMDL")
    assert "where they start" in head
    every = motionview.emit(model_of("transport_4x4.yaml", SMALL, "run.prune=false"))
    assert "where they start" not in every.partition("*BeginMDL")[0]


@pytest.mark.parametrize("set_contact", [False, True])
@pytest.mark.parametrize("name", sorted(CASES))
def test_a_value_can_be_edited_exactly_where_the_text_uses_it(name, set_contact):
    sample, *overrides = CASES[name]
    reader = Reader(motionview.emit(model_of(sample, *overrides), set_contact=set_contact))
    used = set(re.findall(r"\b(ds_\w+\.real_\w+)\.value", reader.text))
    for data_set, (_, block) in reader.of_kind("DataSet").items():
        for member, (_, edit) in reader.members[block].items():
            assert f"{data_set}.{member}" in used or edit == "NO_EDIT", f"{data_set}.{member}"


def test_numbers_read_as_the_user_wrote_them():
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL, TURN))
    for line in (
        "ds_note.real_M, 0.00072 )",
        "ds_note.real_turn, 10.0 )",
        "ds_motor_1_left.real_omega, 186.7 )",
        "ds_motor_1_left.real_ramp, 0.005 )",
        "ds_counter_1_left.real_M, 0.00039 )",
        "ds_run.real_end, 0.05 )",
    ):
        assert line in text


# ---------------------------------------------------------------- what the text cannot say


def test_loads_are_refused_by_name():
    model = model_of("cantilever.yaml", 'loads=[{"sheet":"note","edge":"y_max","force":["0 N","1 N","0 N"]}]')
    with pytest.raises(RefusedError, match="loads"):
        motionview.check(model)
    with pytest.raises(RefusedError):
        motionview.emit(model)


def test_a_spring_shorter_than_its_compression_is_refused_by_name():
    model = model_of("transport_4x4.yaml", SMALL)
    roller = next(r for r in model.rollers if r.press is not None)
    assert roller.press is not None
    far = replace(
        roller, press=replace(roller.press, start=roller.press.touch - 2 * roller.press.free_length)
    )
    rollers = tuple(far if r is roller else r for r in model.rollers)
    with pytest.raises(RefusedError, match=roller.name):
        motionview.check(replace(model, rollers=rollers))


def test_static_analysis_writes_a_static_command():
    assert 'analysis_type  = "Static"' in motionview.emit(model_of("cantilever.yaml"))
    assert 'analysis_type  = "Transient"' in motionview.emit(model_of("transport_4x4.yaml", SMALL))


def _run_script(script: str) -> tuple[dict, dict]:
    """Runs a companion with a stand-in for MotionView; (gravity, numbers by contact)."""
    tree = ast.parse(script)
    tree.body = [n for n in tree.body if not isinstance(n, ast.ImportFrom)]
    children: dict[str, dict] = {}

    class Entity:
        def __init__(self, name):
            self.name = name

        def setValues(self, **numbers):
            children.setdefault(self.name, {}).update(numbers)

    class Gravity:
        pass

    class Root:
        gravity = Gravity()

        def __getattr__(self, name):
            return Entity(name)

    root = Root()
    space = {"mview": type("mview", (), {"getModel": staticmethod(lambda: root)}), "print": lambda *a: None}
    exec(compile(tree, "companion", "exec"), space)
    return vars(Root.gravity), children


def test_companion_sets_every_contact():
    smooth, rough = "contacts.6.friction=0", "contacts.4.friction={static: 0.9, dynamic: 0.7}"
    model = model_of("transport_4x4.yaml", SMALL, smooth, rough)
    script = motionview.companion(model)
    assert script is not None and script.isascii()
    assert len(motionview.companion_reasons(model)) == 1
    gravity, numbers = _run_script(script)
    assert not gravity
    smoothing = model.contacts.smoothing[-1] * 1000
    reader = Reader(motionview.emit(model))
    assert set(numbers) == set(reader.of_kind("Contact"))
    expected = {"penalty": 100.0, "rest_coeff": 0.5, "normal_trans_vel": smoothing}
    assert numbers["con_note_0_0_support"] == expected
    assert reader.entity["con_note_0_0_support"][1][2] == "OFF"
    driven = next(v for k, v in numbers.items() if k.startswith("con_note_") and "motor" in k)
    assert (driven["penalty"], driven["mu_static"], driven["mu_dynamic"]) == (300.0, 0.9, 0.7)


def test_companion_is_left_out_where_it_is_not_needed():
    model = model_of("cantilever.yaml")
    assert motionview.companion(model) is None
    assert motionview.companion_reasons(model) == []
    default = tuple(f'contacts.{k}.smoothing="1 mm/s"' for k in range(7))
    contacts = model_of("transport_4x4.yaml", SMALL, *default)
    assert motionview.companion(contacts, set_contact=True) is None
    smooth = model_of("transport_4x4.yaml", SMALL, *default, 'contacts.0.smoothing="0.1 mm/s"')
    assert any("normal_trans_vel" in r for r in motionview.companion_reasons(smooth, set_contact=True))
    _, numbers = _run_script(motionview.companion(smooth, set_contact=True) or "")
    assert numbers["con_motor_1_left_counter_1_left"] == {"normal_trans_vel": 0.1}


def test_companion_sets_gravity():
    gravity, _ = _run_script(motionview.companion(model_of("verify/incline.yaml")) or "")
    assert gravity == {"x": 3355.2176, "y": 0.0, "z": -9218.3846}


def test_set_contact_writes_the_numbers_in_the_documented_order():
    overrides = ("contacts.6.friction=0", 'contacts.0.smoothing="2 mm/s"')
    model = model_of("transport_4x4.yaml", SMALL, *overrides)
    reader = Reader(motionview.emit(model, set_contact=True))
    rows = reader.sets["SetContact"]
    assert set(rows) == set(reader.of_kind("Contact"))
    assert [reader.value(a) for a in rows["con_note_0_0_support"]] == [100.0, 0.5]
    found = [reader.value(a) for a in rows["con_motor_1_left_counter_1_left"]]
    assert found == [30.5, 0.5, 1.0, 1.0, 2.0, 2.0]


def test_banner_stands_before_the_block_and_holds_no_statement():
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL))
    head, _, block = text.partition("*BeginMDL")
    lines = head.splitlines()
    assert lines[0] == "/" * 70 and "*" not in head and "//" not in block
    assert all("//" not in line for line in lines if line != "/" * 70)
    assert "share width" in head and "Companion script" in head


# ---------------------------------------------------------------- names, bytes, goldens


def test_names_that_would_meet_are_refused():
    sheet = '"material":"eur10","size":["67 mm","127 mm"],"thickness":"0.1 mm","mass":"0.72 g","boxes":[1,1]'
    contact = 'contacts=[{"between":["motor_1_left","counter_1_left"],"stiffness":"1 N/mm^1.5"}]'
    for name in ("contact_0", "Global_Origin", "counter_1_left_ANCHOR"):
        model = model_of("transport_4x4.yaml", f'sheets={{"{name}":{{{sheet}}}}}', contact, "probes={}")
        with pytest.raises(SpecError, match="would be called"):
            motionview.emit(model)


def test_a_hostile_label_or_name_is_stopped_at_the_gate():
    model = model_of("transport_4x4.yaml", SMALL)
    bad = 'x" )\n  *Include("evil.mdl'
    for changed in (
        replace(model, name=bad),
        replace(model, bodies=replace(model.bodies, label=(bad, *model.bodies.label[1:]))),
        replace(model, bushings=replace(model.bushings, name=(bad, *model.bushings.name[1:]))),
        replace(model, parameters=(replace(model.parameters[0], label=bad),)),
    ):
        with pytest.raises(SpecError):
            motionview.emit(changed)


_LETTERS = st.text(st.sampled_from('ab_Z09 "`*(){}<>$%#,;\n\r\\/\u00e9.'), min_size=1, max_size=24)


@settings(max_examples=60, deadline=None)
@given(scene=_LETTERS, sheet=_LETTERS, roller=_LETTERS, probe=_LETTERS)
def test_no_name_becomes_a_statement(scene, sheet, roller, probe):
    from mdlgen.spec.scene import Scene

    def build(scene_name, sheet_name, roller_name, probe_name):
        return Scene.model_validate(
            {
                "name": scene_name,
                "materials": {
                    "m": {"E_md": "1 MPa", "E_cd": "1 MPa", "k_tx": "1 N*mm/rad", "k_ty": "1 N*mm/rad"}
                },
                "sheets": {
                    sheet_name: {
                        "material": "m",
                        "size": ["9 mm", "9 mm"],
                        "thickness": "0.1 mm",
                        "mass": "1 g",
                        "boxes": [2, 1],
                    }
                },
                "rollers": {
                    roller_name: {
                        "center": ["0 mm", "0 mm", "-3 mm"],
                        "axis": "y",
                        "radius": "3 mm",
                        "width": "3 mm",
                        "mass": "1 g",
                    }
                },
                "contacts": [{"between": ["*", "*"], "stiffness": "1 N/mm^1.5"}],
                "probes": {probe_name: {"sheet": sheet_name, "at": ["0 mm", "0 mm"]}},
            }
        )

    plain = Counter(name for name, _ in statements(motionview.emit(lower(build("s", "t", "u", "v")))))
    try:
        text = motionview.emit(lower(build(scene, sheet, roller, probe)))
    except (MdlgenError, ValueError):
        return
    assert Counter(name for name, _ in statements(text)) == plain


def _subprocess(code: str, **environment: str) -> str:
    run = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, **environment},
        cwd=Path(__file__).parents[1],
    )
    return run.stdout


_EMIT = """
import hashlib, sys
import backends.motionview as mv
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import load
model = lower(load(samples() / "transport_4x4.yaml", overrides=["sheets.note.boxes=[3,4]"]))
text = mv.emit(model) + (mv.companion(model) or "")
print(hashlib.sha256(text.encode()).hexdigest())
print(sorted(m for m in sys.modules if m.split(".")[0] in ("exudyn", "numba", "scipy", "matplotlib")))
"""


def test_text_does_not_depend_on_the_hash_seed_and_loads_no_solver():
    outputs = {_subprocess(_EMIT, PYTHONHASHSEED=seed) for seed in ("0", "1", "4242")}
    assert len(outputs) == 1
    assert outputs.pop().splitlines()[1] == "[]"


def test_text_is_ascii_with_lf_and_ends_in_one_newline(case):
    _, reader = case
    assert reader.text.isascii() and "\r" not in reader.text and "\t" not in reader.text
    assert reader.text.endswith("*EndMDL()\n")
    assert not re.search(r"[ ]+$|\n\n\n", reader.text, re.M)
    assert not re.findall(r"\b(?:nan|inf|None|Undefined)\b|\$", reader.text)
    assert str(Path.cwd()) not in reader.text


GOLDENS = {
    "transport_4x4_e2e_2x3.mdl": ("transport_4x4.yaml", "sheets.note.boxes=[2,3]"),
    "transport_4x4_c2c_2x3.mdl": ("transport_4x4.yaml", "sheets.note.boxes=[2,3]", C2C, TURN),
    "transport_4x4.mdl": ("transport_4x4.yaml",),
}


@pytest.mark.parametrize("name", sorted(GOLDENS))
def test_golden(name):
    sample, *overrides = GOLDENS[name]
    text, path = motionview.emit(model_of(sample, *overrides)), GOLDEN / name
    if os.environ.get("MDLGEN_ACCEPT"):
        path.write_bytes(text.encode("ascii"))
    expected = path.read_bytes().decode("ascii") if path.exists() else ""
    if text != expected:
        pairs = zip(text.splitlines(), expected.splitlines(), strict=False)
        line, (new, old) = next(((k, p) for k, p in enumerate(pairs, 1) if p[0] != p[1]), (0, ("", "")))
        pytest.fail(
            f"{path.name} differs from the text, first in line {line}:\n"
            f"  golden: {old[:200]}\n  text:   {new[:200]}\n"
            "If the new text is right, accept it with\n"
            "  MDLGEN_ACCEPT=1 python -m pytest tests/test_motionview.py -k golden",
            pytrace=False,
        )

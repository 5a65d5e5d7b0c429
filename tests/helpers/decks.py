"""Scenes of decks, and decks of scenes."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import pytest
from unsaid import UNSAID

import mdlgen
from mdlgen.backends import motionsolve
from mdlgen.cli import app
from mdlgen.model.tables import Model
from mdlgen.paths import samples

SMALL = "sheets.note.boxes=[3,4]"
C2C = "sheets.note.layout=center_to_center"
GENERAL = 'sheets.note.rotation=["20 deg","-35 deg","110 deg"]'
MOVING = (
    'sheets.note.velocity=["1.5 m/s","0 m/s","-0.2 m/s"]',
    'sheets.note.spin=["3 rad/s","-7 rad/s","11 rad/s"]',
)
LONG_SPRINGS = tuple(
    f'rollers.counter_{row}_{side}.press.free_length="30 mm"' for row in (1, 2) for side in ("left", "right")
)
FOUR = "transport_4x4.yaml"
SHORT_SPRING = 'rollers.counter_1_left.press.free_length="0.003 mm"'
CASES: dict[str, tuple[str, ...]] = {
    **{
        path.relative_to(samples()).with_suffix("").as_posix(): (
            path.relative_to(samples()).as_posix(),
            *UNSAID.get(path.stem, ()),
        )
        for path in sorted(samples().rglob("*.yaml"))
    },
    "surface": (FOUR, SMALL, "sheets.note.surface=true"),
    "turned": (FOUR, SMALL, 'sheets.note.turn="10 deg"', 'sheets.note.center=["1 mm","-2 mm","0 mm"]'),
    "general": (FOUR, SMALL, GENERAL, *LONG_SPRINGS),
    "center_to_center": (FOUR, SMALL, C2C),
    "plate": (FOUR, SMALL, "sheets.note.layout=plate"),
    "paper_damping": (FOUR, SMALL, "materials.eur10.damping.rotation=paper"),
    "moving": (FOUR, SMALL, GENERAL, *LONG_SPRINGS, *MOVING),
    "clamp": ("cantilever.yaml", 'sheets.note.clamp.length="12.7 mm"', 'sheets.note.turn="30 deg"'),
    "clamp_moving": ("cantilever.yaml", SMALL, 'sheets.note.clamp.length="31.75 mm"', *MOVING),
    "supports": (
        "cantilever.yaml",
        'supports=[{"sheet":"note","at":["0 mm","0 mm"],"fix":["z"]},'
        '{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
    ),
    "gravity_turned": (FOUR, SMALL, 'gravity=["1 m/s^2","-2 m/s^2","-9.3 m/s^2"]'),
    "weightless": (FOUR, SMALL, 'gravity=["0 m/s^2","0 m/s^2","0 m/s^2"]'),
    "no_friction": (FOUR, SMALL, *(f"contacts.{k}.friction=0" for k in range(3))),
    "static_with_contacts": ("verify/slide.yaml", "run.analysis=static"),
    "profile": (
        FOUR,
        SMALL,
        "rollers.motor_1_left.drive={profile: [[1 ms, -5 rad/s], [3 ms, 90 rad/s], [4 ms, 0 rad/s]]}",
    ),
    "at_once": (FOUR, SMALL, 'rollers.motor_1_left.drive.ramp="0 ms"'),
    "skew_machine": (
        FOUR,
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
LOADS = (
    "cantilever.yaml",
    SMALL,
    'sheets.note.turn="90 deg"',
    'loads=[{"sheet":"note","edge":"y_max","force":["0 N","1 N","2 N"]},'
    '{"sheet":"note","edge":"x_max","moment":["0 N*mm","3 N*mm","0 N*mm"]}]',
)
# Two boxes between a driven roller and a pressed one, and one of all else that there is.
SCENE = {
    "name": "deck_small",
    "materials": {"m": {"E_md": "3 GPa", "E_cd": "1 GPa", "k_tx": "0.1 N*mm/rad", "k_ty": "0.2 N*mm/rad"}},
    "sheets": {
        "note": {
            "material": "m",
            "size": ["20 mm", "20 mm"],
            "thickness": "0.1 mm",
            "mass": "0.1 g",
            "boxes": [2, 2],
            "turn": "30 deg",
            "velocity": ["1 m/s", "0 m/s", "0 m/s"],
            "surface": True,
        }
    },
    "rollers": {
        "low": {
            "center": ["0 mm", "0 mm", "-5.05 mm"], "axis": "y", "radius": "5 mm", "width": "4 mm",
            "mass": "1 g", "drive": {"speed": "100 rad/s", "ramp": "5 ms"},
        },
        "up": {
            "center": ["0 mm", "0 mm", "5.05 mm"], "axis": "y", "radius": "5 mm", "width": "4 mm",
            "mass": "1 g",
            "press": {"direction": "-z", "stiffness": "0.3 N/mm", "preload": "3 N", "free_length": "6 mm"},
        },
    },
    "planes": {
        "table": {"center": ["0 mm", "0 mm", "-10 mm"], "normal": "z", "size": ["50 mm", "50 mm", "2 mm"],
                  "mass": "9 g"},
    },
    "contacts": [
        {"between": ["note", "low"], "stiffness": "300 N/mm^1.5", "friction": 0.5, "smoothing": "1 mm/s"},
        {"between": ["note", "up"], "stiffness": "300 N/mm^1.5", "friction": 0, "smoothing": "1 mm/s"},
    ],
    "loads": [{"sheet": "note", "at": ["9 mm", "0 mm"], "force": ["0 N", "0.5 N", "0 N"]}],
    "supports": [{"sheet": "note", "at": ["-9 mm", "0 mm"], "fix": ["z"]}],
    "probes": {"middle": {"sheet": "note", "at": ["0 mm", "0 mm"]}},
    "run": {"duration": "10 ms"},
}  # fmt: skip


@cache
def model_of(sample: str, *overrides: str) -> Model:
    return mdlgen.lower(mdlgen.load(samples() / sample, list(overrides)))


@cache
def deck_of(name: str) -> str:
    return motionsolve.emit(model_of(*(CASES.get(name) or LOADS)))


@cache
def small_deck() -> str:
    return motionsolve.emit(mdlgen.lower(mdlgen.loads(json.dumps(SCENE))))


def flat(value: Any) -> list[Any]:
    """Numbers and words of nested sequences, in order."""
    return [v for item in value for v in flat(item)] if isinstance(value, (list, tuple)) else [value]


def run(*args: object) -> int:
    with pytest.raises(SystemExit) as ended:
        app([str(a) for a in args], prog_name="mdlgen")
    assert isinstance(ended.value.code, int)
    return ended.value.code

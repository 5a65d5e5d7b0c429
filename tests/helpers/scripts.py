"""Scenes of scripts for MotionSolve, and scripts of scenes."""

from __future__ import annotations

import json
from functools import cache

from decks import CASES as DECKS
from decks import FOUR, LOADS, SCENE, SMALL, model_of
from places import RICH

import mdlgen
from mdlgen.backends import msolve
from mdlgen.model.tables import Model

FEW = "sheets.note.boxes=[4,6]"
CANTILEVER = "cantilever.yaml"
CLUTCHES = (
    FOUR,
    SMALL,
    "rollers.counter_1_left.one_way={direction: 1, torque: 1 N*mm}",
    "rollers.motor_1_left.one_way={direction: -1, torque: 2 N*mm}",
)
CASES: dict[str, tuple[str, ...]] = {
    **DECKS,
    "loads": LOADS,
    "graded": (FOUR, FEW, "sheets.note.grading={x: [2,1,1,2]}"),
    "zoned": (
        FOUR,
        FEW,
        "sheets.note.zones={stripe: {x: [-5 mm, 5 mm], y: [-10 mm, 40 mm], stiffness: 2, friction: 0.5}}",
    ),
    "curled": (CANTILEVER, FEW, "sheets.note.shape={curl: {radius: 80 mm, along: y}}"),
    "pushed": (CANTILEVER, FEW, "sheets.note.shape={start: flat, curl: {radius: 80 mm, along: y}}"),
    "plate_clamped": (CANTILEVER, FEW, "sheets.note.layout=plate"),
}


@cache
def script_of(name: str) -> str:
    """The script of a case."""
    return msolve.emit(model_of(*CASES[name]))


@cache
def rich() -> Model:
    """A scene with nearly everything in it."""
    return mdlgen.lower(mdlgen.load(RICH))


@cache
def small_script() -> str:
    """The script of two boxes between rollers."""
    return msolve.emit(mdlgen.lower(mdlgen.loads(json.dumps(SCENE))))

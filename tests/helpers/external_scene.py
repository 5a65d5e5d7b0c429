"""A scene of a sheet with parts of the user's own model."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from called import Run, runner
from places import GOLDEN

import mdlgen
import mdlgen.backends.motionview as motionview
from mdlgen.backends.motionview.reader import read
from mdlgen.model.tables import Model
from mdlgen.paths import samples

SYSTEMS = GOLDEN / "systems"
FOUR = samples() / "transport_4x4.yaml"
SMALL = "sheets.note.boxes=[2,3]"
SCENE = """\
name: feed
materials:
  eur10: {E_md: 3530 MPa, E_cd: 1113 MPa, k_tx: 0.15 N*mm/rad, k_ty: 0.185 N*mm/rad}
sheets:
  note: {material: eur10, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [3, 4]}
rollers:
  motor: {center: [0 mm, 0 mm, 15.05 mm], axis: y, radius: 15 mm, width: 5 mm, mass: 0.88 g}
parts:
  feed: {external: true, body: b_feed, graphics: [gra_feed]}
  guide: {external: true, body: MODEL.sys_guide.b_guide, graphics: [sys_guide.gra_a, sys_guide.gra_b]}
contacts:
  - {between: [note, "*e*"], stiffness: 300 N/mm^1.5, friction: 1.0}
  - {between: [note, motor], stiffness: 100 N/mm^1.5, friction: 0}
probes:
  lead: {sheet: note, at: [33.5 mm, 0 mm]}
run: {duration: 5 ms}
"""


def model_of(*overrides: str) -> Model:
    return mdlgen.lower(mdlgen.loads(SCENE, overrides))


def sheets_of(model: Model) -> str:
    return motionview.emit(model, only="sheets")


def counts(text: str) -> Counter[str]:
    return Counter(s.name for s in read(text).program.statements)


def host_of(model: Model, include: str) -> str:
    """A model of the user's with the machine's bodies, each with its graphics."""
    lines = ['*BeginMDL( host, "Host" )', "  *StandardInclude(FILE)", f"  {include}"]
    given = []
    for part in [*model.rollers, *model.planes]:
        body, graphic = f"b_{part.name}", f"{'gcyl' if part in model.rollers else 'gbox'}_{part.name}"
        given += [body, graphic]
        lines += [
            f'  *Body( {body}, "{part.name}", P_Global_Origin, , , ,  )',
            f"  *SetBodyInertia( {body}, 1, 1, 1, 1 )",
            f'  *Graphic( {graphic}, "{part.name}", SPHERE, {body}, P_Global_Origin, 5, 3 )',
        ]
    name = model.name
    lines += [f'  *System( sys_{name}, "Mine", def_sys_{name}, {", ".join(given)} )', "*EndMDL()", ""]
    return "\n".join(lines)


def commands(capsys: pytest.CaptureFixture[str], folder: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs commands in a folder that holds the scene alone."""
    (folder / "feed.yaml").write_text(SCENE)
    return runner(capsys, folder, monkeypatch)

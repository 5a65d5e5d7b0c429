"""Names and bytes of a MotionView text."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace

import pytest
from places import ROOT
from written import model_of

import mdlgen.backends.motionview as motionview
from mdlgen.errors import SpecError

SMALL = "sheets.note.boxes=[3,4]"


def test_names_that_would_meet_are_refused():
    sheet = '"material":"eur10","size":["67 mm","127 mm"],"thickness":"0.1 mm","mass":"0.72 g","boxes":[1,1]'
    contact = 'contacts=[{"between":["motor_1_left","counter_1_left"],"stiffness":"1 N/mm^1.5","friction":0}]'
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


def _subprocess(code: str, **environment: str) -> str:
    run = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, **environment},
        cwd=ROOT,
    )
    return run.stdout


_EMIT = """
import hashlib, sys
import mdlgen.backends.motionview as mv
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

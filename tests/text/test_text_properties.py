"""What holds for the text of any scene: it reads clean, and its statements can be counted from the spec."""

from __future__ import annotations

import json

from any_scene import Spec, specs
from any_scene_counts import dangling, expected_counts, expected_members, possible_pairs, statement_counts
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mdlgen.backends.motionview import emit
from mdlgen.backends.motionview.reader import read
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads


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
    assert found.pop("Real") == found.pop("SetReal") - 3 == expected_members(spec)
    assert found.pop("SetContact", 0) == (kept if set_contact else 0)
    assert found == expected_counts(spec, kept)

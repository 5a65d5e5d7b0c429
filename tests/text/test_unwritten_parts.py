"""Parts that a text has no words for."""

from __future__ import annotations

from importlib import import_module

import pytest

from mdlgen.errors import RefusedError
from mdlgen.model.lower import lower
from mdlgen.model.tables import PlanePart
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify.expected.parts.kinds import KINDS
from mdlgen.verify.verification import verify


@pytest.mark.parametrize("name", ["motionview", "motionsolve", "msolve"])
def test_a_part_of_a_kind_without_words_is_refused_by_name(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    parts = import_module(f"mdlgen.backends.{name}.writer.parts.kinds")
    model = lower(load(samples() / "verify" / "incline.yaml"))
    assert model.planes
    monkeypatch.delitem(parts.WRITTEN, PlanePart)
    with pytest.raises(RefusedError, match=rf"{model.planes[0].name} is a plane, which is not written yet"):
        emitter(name).emit(model)


def test_verify_refuses_a_part_of_a_kind_of_which_it_expects_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load(samples() / "verify" / "incline.yaml")
    model = lower(scene)
    monkeypatch.delitem(KINDS, PlanePart)
    with pytest.raises(RefusedError, match=rf"verify: {model.planes[0].name} is a plane"):
        verify(scene, model)

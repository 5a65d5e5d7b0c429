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

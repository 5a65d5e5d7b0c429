"""Solvers and outputs by name, and a run that is compared with one at half its step."""

from __future__ import annotations

from dataclasses import replace

import pytest
from synthetic import moving, small_model

import mdlgen
from mdlgen import registry
from mdlgen.backend import Backend
from mdlgen.errors import SpecError
from mdlgen.model.tables import Model
from mdlgen.results.compare import scale
from mdlgen.results.result import Result


@pytest.fixture(scope="module")
def model() -> Model:
    return small_model()


class TestRegistry:
    @pytest.mark.parametrize("name", ["Lattice", "", "Exudyn", "os"])
    def test_an_unknown_solver_names_those_there_are(self, model: Model, name: str) -> None:
        with pytest.raises(SpecError, match="there are: auto, exudyn"):
            mdlgen.solve(model, name)

    def test_an_unknown_text_backend_names_those_there_are(self, model: Model) -> None:
        with pytest.raises(SpecError, match="there are: motionsolve, motionview, msolve"):
            mdlgen.emit(model, "adams")

    def test_check_step_returns_the_finer_with_its_distance(
        self, model: Model, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        asked: list[float | None] = []

        class Fake:
            def solve(self, model: Model, progress: object = None, step: float | None = None) -> Result:
                asked.append(step)
                # an error that is proportional to the step
                h = step or 0.05
                return replace(moving(model, shift=h), step=h)

        monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
        found = mdlgen.solve(model, check_step=True)
        assert asked == [None, 0.025]
        assert found.step == 0.025
        assert found.error_estimate == pytest.approx(0.025 / scale(found), rel=1e-9)

    def test_check_step_keeps_a_failure(self, model: Model, monkeypatch: pytest.MonkeyPatch) -> None:
        class Fake:
            def solve(self, model: Model, progress: object = None, step: float | None = None) -> Result:
                return moving(model).failed("no") if step else moving(model)

        monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
        assert mdlgen.solve(model, check_step=True).status == "at half the step (0.025 ms): no"

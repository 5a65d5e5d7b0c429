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
from mdlgen.report.text import summary_text
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
                return replace(moving(model, shift=h), step=h, steps=round(10.0 / h))

        monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
        found = mdlgen.solve(model, check_step=True)
        assert asked == [None, 0.025]
        assert found.step == 0.025
        assert found.error_estimate == pytest.approx(0.025 / scale(found), rel=1e-9)

    def test_check_step_keeps_the_run_where_the_finer_one_fails(
        self, model: Model, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        class Fake:
            def solve(self, model: Model, progress: object = None, step: float | None = None) -> Result:
                return moving(model).failed("no") if step else moving(model)

        monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
        found = mdlgen.solve(model, check_step=True)
        assert found.status == "inaccurate" and found.usable and not found.ok
        assert found.error_unknown.endswith("a run at half the step (0.025 ms) ended early: no")

    def test_runs_of_the_same_steps_are_not_compared(
        self, model: Model, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """A solver that divides the steps of both runs to the same 100 shows nothing."""
        taken = {None: 100, 0.025: 100}

        class Fake:
            def solve(self, model: Model, progress: object = None, step: float | None = None) -> Result:
                return replace(moving(model), step=step or 0.05, steps=taken[step])

        monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
        found = mdlgen.solve(model, check_step=True)
        assert found.status == "inaccurate" and "nothing was compared" in found.error_unknown
        taken[0.025] = 150
        found = mdlgen.solve(model, check_step=True)
        # both agree: what is known is that the error is below the least that is estimated
        assert found.ok and found.error_below and found.error_estimate == 0.25 * model.run.tolerance
        record = found.summary()
        assert record["error_below"] and "sheets.note.position" in record["estimates_below"]
        assert "error estimate below 0.025 % (" in summary_text(record)

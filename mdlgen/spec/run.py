"""Settings of a run: its duration, and its steps."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from mdlgen.spec.fields import PositiveLength, Time
from mdlgen.spec.quantities import default, ratio
from mdlgen.spec.strict import Strict, fail


class Run(Strict):
    """Duration, analysis and accuracy of a run."""

    duration: Time = Field(default=default("1 ms"), description="end time of a transient run")
    analysis: Literal["transient", "static"] = Field(
        default="transient", description="transient: motion over time; static: the state of rest"
    )
    step: Time | None = Field(default=None, description="time step; chosen from the tolerance where left out")
    tolerance: Annotated[float, ratio(1e-12, 0.1)] = Field(
        default=1e-3,
        description="error that the estimate must not exceed: of positions of sheets, and of turns of rigid "
        "blocks, relative to the travel, or to a tenth of the sheet's length if that is more; of slides and "
        "arms relative to their range, or to the same lengths if these are more",
    )
    limit: Time | None = Field(
        default=None,
        description="wall time after which the run ends with what there is: the best complete pass, whose "
        "error may then be above the tolerance, or the part so far; none where left out",
    )
    print_step: Time | None = Field(
        default=None, description="time between outputs; duration / 200 where left out"
    )
    prune: bool = Field(default=True, description="leave out pairs of boxes and parts that cannot touch")
    symmetry: bool = Field(
        default=True, description="solve one half of a scene that is its own mirror image (lattice)"
    )
    sleep: bool = Field(
        default=True,
        description="leave out sheets on each other that rest, until something moves them (lattice)",
    )
    threads: Annotated[int, Field(ge=1)] = Field(
        default=1,
        description="without effect, for scenes of older versions; passes of a run go on at the same time "
        "where there are two processors",
    )
    margin: PositiveLength = Field(
        default=default("5 mm"),
        description="how far a body may go beyond the bounds that its speeds allow; pairs within are kept",
    )

    @model_validator(mode="after")
    def _steps(self) -> Run:
        for name in ("step", "print_step"):
            value = getattr(self, name)
            if value is not None and value > self.duration:
                raise fail(f"{name} {value:g} ms is longer than the duration {self.duration:g} ms")
            if value is not None and self.duration / value > 1e8:
                raise fail(
                    f"{name} {value:g} ms makes more than 1e8 steps of the duration {self.duration:g} ms"
                )
        return self

"""Checks, before a scene is run, that its requirements can be judged."""

from __future__ import annotations

from mdlgen.model.tables import Model
from mdlgen.results.begun import begun_of
from mdlgen.results.summary import summary
from mdlgen.results.verdict import judge


def check(model: Model) -> None:
    """Raises SpecError for a requirement about a measure or a time that a run of the Model has not."""
    if model.require:
        begun = begun_of(model)
        judge(begun, summary(begun, without=("estimates", "verdict")))

"""Checks, before a scene is run, that its requirements can be judged."""

from __future__ import annotations

from mdlgen.errors import SpecError
from mdlgen.model.tables import Model
from mdlgen.results.begun import begun_of
from mdlgen.results.summary import summary
from mdlgen.results.verdict import judged


def check(model: Model) -> None:
    """Raises SpecError for a requirement about a measure or a time that a run of the Model has not, with the
    others of these."""
    if not model.require:
        return
    begun = begun_of(model)
    record = summary(begun, without=("estimates", "verdict"))
    wrong: list[SpecError] = []
    for k in range(len(model.require)):
        try:
            judged(begun, record, k)
        except SpecError as error:
            wrong.append(error)
    if wrong:
        raise wrong[0].with_others(wrong[1:])

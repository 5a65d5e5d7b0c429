"""Runs that more than one test looks at, by the real solvers."""

from __future__ import annotations

import os
import pickle
import uuid
from copy import deepcopy
from functools import lru_cache
from pathlib import Path

from asked import as_asked

import mdlgen
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import chosen
from mdlgen.results.result import Result
from mdlgen.runs.provenance import digest

# Folder that the workers of one session share, see conftest; None: there is one worker.
folder: Path | None = None
MOST = 32  # results that a worker holds
LONG = 0.5  # s
_held: dict[str, Result] = {}


def solved(model: Model, solver: str = "auto") -> Result:
    """The result of a model, of the run before where there was one of an equal model in this session: a test
    of each solver and one that both agree look at the same runs.

    Not for what asks whether two runs are the same.
    """
    key = f"{digest(model)}_{chosen(solver, model)[0]}"
    result = _held.pop(key, None) or _read(key)
    if result is None:
        result = mdlgen.solve(model, solver)
        assert as_asked(result), result.status
        _write(key, result)
    _held[key] = result
    if len(_held) > MOST:
        del _held[next(iter(_held))]
    return deepcopy(result)


def _read(key: str) -> Result | None:
    if folder is None or not (folder / key).exists():
        return None
    return pickle.loads((folder / key).read_bytes())


def _write(key: str, result: Result) -> None:
    # what is run in less time takes as long to write and read
    if folder is not None and result.wall_s + result.estimate_s > LONG:
        folder.mkdir(exist_ok=True)
        part = folder / uuid.uuid4().hex
        part.write_bytes(pickle.dumps(result))
        os.replace(part, folder / key)


@lru_cache(maxsize=8)
def ran(sample: str, *overrides: str) -> Result:
    """The result of a sample."""
    return solved(mdlgen.lower(mdlgen.load(samples() / f"{sample}.yaml", overrides)))


def transport(*more: str) -> Result:
    return ran("transport_4x4", "sheets.note.boxes=[5,8]", *more)

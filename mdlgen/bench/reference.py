"""States of a finer run, stored on disk under a name that depends on scene, solver and code."""

from __future__ import annotations

import hashlib
import io
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mdlgen import paths
from mdlgen.bench.case import Reference
from mdlgen.model.tables import Model

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# A change of any of these may change a solver's result for the same scene.
SHARED_CODE = ("mdlgen.mechanics", "mdlgen.model")


def file_of(reference: Reference, module: str, folder: Path) -> Path:
    """Path of the states of a reference: a name by the content of scene, solver and code."""
    run = reference.run
    digest = hashlib.sha256(run.text().encode())
    digest.update(repr((run.sets, run.without, reference.solver)).encode())
    for room in (module, *SHARED_CODE):
        for source in _sources(room):
            digest.update(source.read_bytes())
    return folder / f"reference_{run.sample.replace('/', '_')}_{digest.hexdigest()[:16]}.npz"


def _sources(module: str) -> list[Path]:
    found = find_spec(module)
    if found is None or found.origin is None:
        return []
    origin = Path(found.origin)
    return sorted(origin.parent.rglob("*.py")) if origin.name == "__init__.py" else [origin]


def keep(result: Result, file: str) -> None:
    """Write the states that `states` reads. Raises OutputError."""
    stream = io.BytesIO()
    np.savez_compressed(
        stream,
        time=result.time,
        position=result.position,
        rotation=result.rotation,
        velocity=result.velocity,
        spin=result.spin,
        contact_force=result.contact_force,
    )
    paths.write_atomic(Path(file), stream.getvalue())


def states(file: str, model: Model) -> Result:
    """The states in `file` as a result of `model`, which has the same bodies and contacts."""
    from mdlgen.results.result import ContactStatistics, Result

    none = np.zeros(len(model.contacts))
    with np.load(file) as held:
        return Result(
            model=model,
            solver="reference",
            status="ok",
            statistics=ContactStatistics(none, none, none, none, none),
            **{name: held[name] for name in held.files},
        )

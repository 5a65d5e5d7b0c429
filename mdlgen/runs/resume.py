"""Resumes a run that was cut off: its request is stored in the folder of its results."""

from __future__ import annotations

import functools
import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mdlgen.errors import OutputError
from mdlgen.spec.limits import DEFAULT
from mdlgen.spec.load import loads, read

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.runs.checkpoint import Checkpointer

FOLDER, FILE = "checkpoint", "run.json"


@dataclass(frozen=True)
class RunRequest:
    """The request of a run."""

    spec: str  # the file's name, and its text
    text: str
    beside: str  # folder of the files that it names
    sets: tuple[str, ...]
    limits: tuple[str, ...]
    solver: str
    check_step: bool

    def model(self) -> Model:
        """The tables of its scene. Raises SpecError."""
        from mdlgen.model.lower import lower

        limits = DEFAULT.raised(self.limits)
        return lower(loads(self.text, self.spec, self.sets, Path(self.beside), limits))


def request(
    spec: Path, sets: list[str] | None, limits: list[str] | None, solver: str, check_step: bool
) -> RunRequest:
    """Of a command. Raises SpecError, OutputError for a file that cannot be read."""
    beside = str(spec.parent.resolve())
    return RunRequest(
        str(spec), read(spec), beside, tuple(sets or ()), tuple(limits or ()), solver, check_step
    )


def checkpointer(
    folder: Path, of: RunRequest, model: Model, every: float, packages: tuple[str, ...]
) -> Checkpointer:
    """Writes a state of the run into `folder`, next to its results, every so many seconds; `packages` have
    the solver's code."""
    from mdlgen.runs.checkpoint import Checkpointer
    from mdlgen.runs.provenance import digest

    def provenance() -> dict[str, str]:
        held = {"task": asdict(of), "model": digest(model), **code(packages)}
        return {FILE: json.dumps(held, indent=1)}

    return Checkpointer(folder / FOLDER, every, provenance)


@functools.cache
def code(packages: tuple[str, ...]) -> dict[str, str]:
    """Provenance of this process: to be read before its files can have changed."""
    from mdlgen.runs.provenance import processor, provenance

    return provenance(packages) | processor()


def can_resume(folder: Path) -> bool:
    """True if there is a run in `folder` to continue."""
    return (folder / FOLDER / FILE).is_file()


def resumed(folder: Path) -> tuple[RunRequest, dict[str, Any]]:
    """The request of the run in `folder`, and its provenance. Raises OutputError."""
    from mdlgen.paths import read_at_most, recover

    place = folder / FOLDER
    recover(place)
    if not can_resume(folder):
        raise OutputError(
            f"{folder}: holds no run to continue; a run of lattice leaves one when it is cut off "
            "after --checkpoint seconds"
        )
    try:
        provenance = json.loads(read_at_most(place / FILE, 10_000_000, named=True))
        asked = provenance["task"]
        for name in ("sets", "limits"):
            asked[name] = tuple(str(item) for item in asked[name])
        words = {name: str(asked[name]) for name in ("spec", "text", "beside", "solver")}
        request = replace(RunRequest(**asked), **words, check_step=bool(asked["check_step"]))
        return request, provenance
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise OutputError(f"{place / FILE}: is not what a run was asked for ({str(error)[:100]})") from None


def check_same(folder: Path, there: dict[str, Any], model: Model, packages: tuple[str, ...]) -> None:
    """Raises RefusedError by name where a run would not resume with bitwise identical results."""
    from mdlgen.runs import provenance

    provenance.check_same(folder, there, {"model": provenance.digest(model), **code(packages)})

"""A run that can be gone on with: what it was asked for, in the folder of its results."""

from __future__ import annotations

import functools
import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mdlgen.errors import OutputError, RefusedError, SpecError
from mdlgen.spec.limits import DEFAULT
from mdlgen.spec.load import loads, read

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.keep import Keep

FOLDER, SEAL = "checkpoint", "run.json"
ROOMS = ("mdlgen.backends.lattice", "mdlgen.mechanics")


@dataclass(frozen=True)
class Task:
    """What a run was asked for."""

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


def task(spec: Path, sets: list[str] | None, limits: list[str] | None, solver: str, check_step: bool) -> Task:
    """Of a command. Raises SpecError, OutputError for a file that cannot be read."""
    beside = str(spec.parent.resolve())
    return Task(str(spec), read(spec), beside, tuple(sets or ()), tuple(limits or ()), solver, check_step)


def kept(folder: Path, of: Task, model: Model, every: float) -> Keep:
    """Keeps a run of lattice in `folder`, beside its results, every so many seconds."""
    from mdlgen.results.keep import Keep
    from mdlgen.results.seal import digest

    def seal() -> dict[str, str]:
        return {SEAL: json.dumps({"task": asdict(of), "model": digest(model), **code()}, indent=1)}

    return Keep(folder / FOLDER, every, seal)


@functools.cache
def code() -> dict[str, str]:
    """What bits follow from in this process: to be asked for before its files can have changed."""
    from mdlgen.results.seal import surroundings

    return surroundings(*ROOMS)


def is_kept(folder: Path) -> bool:
    """Whether there is a run in `folder` to go on with."""
    return (folder / FOLDER / SEAL).is_file()


def again(folder: Path) -> tuple[Task, dict[str, Any]]:
    """What the run in `folder` was asked for, and its seal. Raises OutputError."""
    from mdlgen.paths import read_at_most, recover

    place = folder / FOLDER
    recover(place)
    if not is_kept(folder):
        raise OutputError(
            f"{folder}: holds no run to go on with; a run of lattice leaves one when it is cut off "
            "after --checkpoint seconds"
        )
    try:
        seal = json.loads(read_at_most(place / SEAL, 10_000_000, named=True))
        told = seal["task"]
        for name in ("sets", "limits"):
            told[name] = tuple(str(item) for item in told[name])
        words = {name: str(told[name]) for name in ("spec", "text", "beside", "solver")}
        return replace(Task(**told), **words, check_step=bool(told["check_step"])), seal
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise OutputError(f"{place / SEAL}: is not what a run was asked for ({str(error)[:100]})") from None


def compare(folder: Path, seal: dict[str, Any], model: Model) -> None:
    """Raises RefusedError by name where a run would not go on to the same bits."""
    from mdlgen.results.seal import digest

    now = {"model": digest(model), **code()}
    words = {"model": "a file that the scene names", "code": "the solver's code"}
    for name, value in now.items():
        if seal.get(name) != value:
            what = words.get(name, f"{name} ({str(seal.get(name))[:60]}, now {value})")
            raise RefusedError(
                f"{folder}: the run cannot go on to the same bits: {what} has changed since; run it anew"
            )


def check(solver: str, reason: str, wish: str) -> None:
    """Raises RefusedError by name where a solver does not keep what is asked for."""
    if solver != "lattice":
        why = f" ({reason})" if reason else ""
        raise RefusedError(
            f"{wish}: {solver} runs this scene{why}, whose accelerations and factors stay inside of it, so "
            "that no run of it goes on to the same bits; lattice keeps them"
        )


def single(spec: Path | None, resume: Path | None, others: bool) -> None:
    """Raises SpecError unless exactly one of a scene and a run to go on with is named."""
    if (spec is None) == (resume is None):
        raise SpecError("name a scene, mdlgen run SPEC, or a run to go on with, mdlgen run --resume DIR")
    if resume is not None and others:
        raise SpecError("--resume takes scene, values, solver and folder from the run that it goes on with")

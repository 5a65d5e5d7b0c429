"""One run of a scene with its values turned, in the worker: what is wrong with it, its parts as they are
computed, its result."""

from __future__ import annotations

import contextlib
import io
import json
import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mdlgen.errors import MdlgenError, SpecError
from mdlgen.live.controls import controls
from mdlgen.spec.limits import DEFAULT
from mdlgen.spec.load import Document, meant, parse
from mdlgen.spec.mistakes import located

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.runs.checkpoint import Checkpointer
    from mdlgen.spec.scene import Scene

# The step of a draft at a tolerance of 1e-3 [ms], and in steps where one is given. The fast solver's search
# begins with a little less; a longer one saves nothing, since it is halved where it does not converge.
DRAFT_STEP, DRAFT_PART = 0.25, 4.0
# Between two reports of progress, before the first part of the animation, between two parts [s], which take
# at most a share of the run.
REPORT, FIRST_PART, PART, SHARE = 0.1, 1.0, 0.4, 0.2

Send = Callable[[dict[str, Any], bytes], None]


class Cancelled(Exception):
    """A newer run takes the place of this one."""


@dataclass(frozen=True)
class Job:
    """A request to the worker; `draft`: one pass at a coarse step, without estimates; `parts`: with the
    animation as it grows; `first`: with the scene before its first step."""

    number: int
    text: str
    file: str  # as errors name it
    folder: str  # of the files that the scene names
    sets: tuple[str, ...]  # of the command line
    turned: tuple[tuple[str, str], ...]  # path and text of each value that differs from the file
    limits: tuple[str, ...] = ()
    solver: str = "auto"
    draft: bool = False
    parts: bool = True
    first: bool = False

    @classmethod
    def of(cls, record: dict[str, Any]) -> Job:
        """From what was sent."""
        held = {name: tuple(record[name]) for name in ("sets", "limits")}
        return cls(**{**record, **held, "turned": tuple((path, text) for path, text in record["turned"])})

    @property
    def overrides(self) -> tuple[str, ...]:
        return (*self.sets, *(f"{path}={text}" for path, text in self.turned))


def perform(job: Job, send: Send, cancelled: Callable[[], bool]) -> None:
    """Runs it; whatever is found is sent, and at last one of ended, refused, failed."""
    try:
        _perform(job, send, cancelled)
    except Cancelled:
        send({"kind": "ended", "how": "cancelled"}, b"")
    except MdlgenError as error:
        send({"kind": "refused", "errors": mistakes(error, job)}, b"")
    except MemoryError:
        send({"kind": "failed", "reason": "not enough memory for this scene"}, b"")
    except Exception as error:  # one bad run is no end of the page
        send({"kind": "failed", "reason": f"internal error: {type(error).__name__}: {error}"[:500]}, b"")


def mistakes(error: MdlgenError, job: Job) -> list[dict[str, Any]]:
    """Each mistake as `mdlgen check` says it, with its line where that is of the file."""
    several = (error, *error.others) if isinstance(error, SpecError) else (error,)
    found = []
    for one in several:
        line = None
        path = ""
        if isinstance(one, SpecError):
            if one.place is None and one.path:
                with contextlib.suppress(MdlgenError):
                    one = located(one, _document(job.text, job.file, job.limits))
            path = ".".join(map(str, one.path))
            line = one.place.line if one.place is not None and one.place.file == job.file else None
        found.append({"says": str(one), "line": line, "path": path})
    return found


@lru_cache(maxsize=2)
def _document(text: str, file: str, limits: tuple[str, ...]) -> Document:
    """To parse a text takes longer than all else before a run is begun."""
    return parse(text, file, DEFAULT.raised(limits))


def _scene(job: Job, overrides: tuple[str, ...]) -> Scene:
    document = _document(job.text, job.file, job.limits).copy()
    return meant(document, overrides, Path(job.folder), DEFAULT.raised(job.limits))


@lru_cache(maxsize=1)
def _described(text: str, file: str, sets: tuple[str, ...], folder: str, limits: tuple[str, ...]) -> str:
    """The values that can be changed in the scene as the file has it, as JSON."""
    document = _document(text, file, limits).copy()
    scene = meant(document, sets, Path(folder), DEFAULT.raised(limits))
    return json.dumps([asdict(control) for control in controls(scene, document)], allow_nan=False)


def _perform(job: Job, send: Send, cancelled: Callable[[], bool]) -> None:
    from mdlgen import registry
    from mdlgen.live.drawn import begun, finished
    from mdlgen.model.lower import lower
    from mdlgen.processors import processors
    from mdlgen.results.mark import mark
    from mdlgen.runs.checkpoint import Checkpointer

    # the file alone may be right where a value that was turned is not
    with contextlib.suppress(MdlgenError):
        own = _described(job.text, job.file, job.sets, job.folder, job.limits)
        send({"kind": "controls"}, own.encode())
    model = lower(_scene(job, job.overrides))
    if cancelled():
        raise Cancelled
    send({"kind": "begun", "scene": model.name}, b"")
    if job.first:
        send({"kind": "start"}, begun(model))
    name, _ = registry.chosen(job.solver, model)
    backend = registry.solver(name)
    keep = Checkpointer()
    reporter = _Reporter(job, model, send, cancelled, keep)
    with contextlib.redirect_stdout(io.StringIO()):  # a solver may talk there
        if job.draft:
            if not backend.capabilities.resumes or model.run.analysis == "static":
                send({"kind": "ended", "how": "no draft"}, b"")  # its step is not chosen as simply
                return
            result = backend.solve(model, reporter, draft_step(model), keep=keep)
        else:
            result = registry.solve(model, name, reporter, False, keep, processors())
    if cancelled():
        raise Cancelled
    if job.draft and not result.usable:  # the full run says whether it is the step
        send({"kind": "ended", "how": "no draft"}, b"")
        return
    result.source = job.text
    body = finished(result, job.draft)
    how, took = "draft" if job.draft else "full", round(result.wall_s + result.estimate_s, 4)
    wrong = None if job.draft and result.usable else mark(result)
    send({"kind": "ended", "how": how, "status": result.status, "mark": wrong, "solved_s": took}, body)


def draft_step(model: Model) -> float:
    """[ms]"""
    run = model.run
    wanted = DRAFT_PART * run.step if run.step is not None else DRAFT_STEP * math.sqrt(run.tolerance / 1e-3)
    return min(wanted, run.duration / 20)


class _Reporter:
    """Called by the solver during a run: cancels it, reports its progress, and sends the part so far of a
    long run."""

    def __init__(self, job: Job, model: Model, send: Send, cancelled: Callable[[], bool], keep: Checkpointer):
        self.job, self.model, self.send, self.cancelled, self.keep = job, model, send, cancelled, keep
        self.begun = self.reported = self.parted = time.perf_counter()
        self.cost = 0.0  # of the last part [s]
        self.furthest = 0.0  # end of the part that has been shown [ms]

    def __call__(self, at: float, end: float, steps: int, touching: int) -> None:
        if self.cancelled():
            raise Cancelled
        now = time.perf_counter()
        if now - self.reported < REPORT:
            return
        self.reported = now
        self.send({"kind": "progress", "time": at, "end": end, "steps": steps, "touching": touching}, b"")
        if not self.job.parts:
            return
        # a finer pass starts at 0 again: the part of a coarser one stays until this one is as far
        wait = max(PART, self.cost / SHARE) if self.furthest else FIRST_PART
        if self.keep.part is None or at <= self.furthest or now - self.parted < wait:
            return
        from mdlgen.live.drawn import partial

        part = self.keep.part()
        self.furthest = float(part.time[-1])
        self.send({"kind": "part", "time": self.furthest, "end": end}, partial(part))
        self.parted = time.perf_counter()
        self.cost = self.parted - now

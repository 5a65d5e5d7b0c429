"""The session behind a page: the scene's file, the values that are changed, and the run that belongs to both.

Each change asks for a draft, and then for the full run. The newest change wins: a full run in progress is
cancelled at once. A draft is cancelled after a moment in which it may end, so that there is something to see
while a value is dragged.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import re
import shlex
from collections.abc import AsyncIterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from mdlgen.errors import MdlgenError, SpecError, printable
from mdlgen.live.controls import SEVERAL, of_pattern
from mdlgen.live.job import Job
from mdlgen.live.process import Worker
from mdlgen.live.writing import still_turned, with_values
from mdlgen.paths import write_atomic
from mdlgen.spec.load import loads, read

# Time that a draft still runs while a newer value waits [s], and the one after a draft that was cancelled.
# So there is something to see while a slider moves; of a long run its parts are shown.
PATIENCE, MORE_PATIENCE = 0.5, 1.5
DRAWING = 0.12  # that a page has to draw a draft, before the full run takes all processors [s]
PAUSE = 0.2  # without a newer value, after which the full run follows a draft while a slider is held [s]
GRACE = 0.5  # that a run has to end once it is cancelled, before its process is ended [s]
LONGEST = 300  # characters of a value
DRAFT, FULL = "draft", "full"
_NAMED = re.compile(r"\bfile[\"']?: *([^\s,}#]+)")  # a mesh or a curve


class Session:
    """One scene, on all pages that show it; its methods are called in one event loop."""

    def __init__(
        self, file: Path, sets: tuple[str, ...] = (), limits: tuple[str, ...] = (), solver: str = "auto"
    ):
        self.file, self.sets, self.limits, self.solver = file, sets, limits, solver
        self.text = ""
        self.turned: dict[str, str] = {}
        self.errors: list[dict[str, Any]] = []
        self.controls: list[dict[str, Any]] = []
        self.body: bytes = b""  # of the run that is shown, as JSON
        self._shown: dict[str, Any] = {"number": 0, "kind": None, "status": "", "solved_s": None}
        self._scene = file.stem
        self._progress: dict[str, Any] | None = None
        self._word = ""
        self._version = {"controls": 0, "text": 0}
        self._todo: list[str] = []
        self._drafted = False  # a draft of the newest values is shown
        self._held = False  # a slider is: the full run waits for a pause
        self._drawing = False  # a draft has just been sent
        self._job: Job | None = None  # that the worker has
        self._job_began = 0.0
        self._impatient = False  # the last draft was ended for a newer value
        self._cancelled = False
        self._number = 0
        self._timers: dict[str, asyncio.TimerHandle] = {}
        self._waiting: set[asyncio.Event] = set()
        self._tasks: set[asyncio.Task[None]] = set()
        self._ended = False
        self._worker = Worker(self._heard, self._died)

    async def start(self) -> None:
        """Starts the worker, and the first run. Raises OutputError, OSError."""
        self.text = read(self.file)
        await self._worker.start()
        self._ask_anew()

    async def end(self) -> None:
        self._ended = True
        for timer in self._timers.values():
            timer.cancel()
        self._publish()
        await self._worker.end()

    # requests of a page

    def state(self) -> dict[str, Any]:
        """All small data; large data are requested by their version."""
        return {
            "file": str(self.file),
            "scene": self._scene,
            "errors": self.errors,
            "turned": self.turned,
            "command": self.command(),
            "controls": self._version["controls"],
            "text": self._version["text"],
            "run": self._shown,
            "busy": None if self._job is None else DRAFT if self._job.draft else FULL,
            "progress": self._progress,
            "word": self._word,
        }

    async def states(self) -> AsyncIterator[dict[str, Any]]:
        """The state, and then each newer one, as fast as they are taken."""
        changed = asyncio.Event()
        self._waiting.add(changed)
        try:
            while not self._ended:
                yield self.state()
                await changed.wait()
                changed.clear()
        finally:
            self._waiting.discard(changed)

    def command(self) -> str:
        """The command line that runs the scene as it is shown."""
        sets = [*self.sets, *(f"{path}={text}" for path, text in self.turned.items())]
        words = ["mdlgen", "run", str(self.file), *(word for item in sets for word in ("--set", item))]
        if self.solver != "auto":
            words += ["--solver", self.solver]
        return shlex.join([*words, *(word for item in self.limits for word in ("--limit", item))])

    def turn(self, values: Mapping[str, Any], held: bool) -> None:
        """Gives values another text, or with None that of the file; `held`: more are to come soon. Raises
        SpecError for what is not among the controls."""
        known = {control["path"]: control for control in self.controls}
        changed = dict(self.turned)
        for path, text in values.items():
            if path not in known:
                raise SpecError(f"{path[:80]!r} is no value that can be changed here")
            if text is not None and not (isinstance(text, str) and 0 < len(text) <= LONGEST):
                raise SpecError(f"{path}: a value is a text of at most {LONGEST} characters")
            if text is None or printable(text).strip() == known[path]["text"]:
                changed.pop(path, None)
            else:
                changed[path] = printable(text).strip()
        before, self.turned, self._held = self.turned, changed, held
        if changed != before:
            self._ask_anew()
        elif not held:
            self._go_on()

    def add(self, pattern: str) -> None:
        """One more control, for all values that a path with patterns meets. Raises SpecError."""
        control = asdict(of_pattern(self.text, pattern))
        if control["path"] not in {other["path"] for other in self.controls}:
            self._list([*self.controls, control])
            self._publish()

    def write(self) -> None:
        """Puts the turned values into the file. Raises SpecError where the scene would be wrong, or the file
        is not the one that is shown, OutputError where it cannot be written."""
        if read(self.file) != self.text:
            raise SpecError(f"{self.file} has been edited meanwhile; check it first")
        text = with_values(self.text, str(self.file), self.turned)
        loads(text, str(self.file), (), self.file.parent)
        write_atomic(self.file, text)
        # values of --set are in the file once they were changed on the page
        self.sets = tuple(item for item in self.sets if item.partition("=")[0].strip() not in self.turned)
        self.turned = {}
        self._take(text)

    def look(self) -> None:
        """Checks if the file, or one that it names, was edited."""
        try:
            text = read(self.file)
        except MdlgenError as error:
            self.errors = [_plain(str(error))]
            self._publish()
            return
        self.turned = still_turned(self.text, text, self.turned)
        self._take(text)

    def files(self) -> set[Path]:
        """The scene's file and those that it names; through a link, both."""
        named = {self.file.parent / name.strip("\"'") for name in _NAMED.findall(self.text)}
        return {self.file, *named} | {file.resolve() for file in (self.file, *named)}

    def names(self) -> set[str]:
        return {file.name for file in self.files()}

    def folders(self) -> set[Path]:
        """Where these files are, of those that there are: in the scene's folder or below."""
        root = self.file.parent.resolve()
        found = {file.parent.resolve() for file in self.files()}
        return {self.file.resolve().parent, *(f for f in found if f.is_relative_to(root) and f.is_dir())}

    # runs

    def _take(self, text: str) -> None:
        self.text = text
        self._version["text"] += 1
        self._held = False
        self._ask_anew()

    def _ask_anew(self) -> None:
        """Requests the newest values, and cancels the run in progress."""
        self._todo = [DRAFT, FULL]
        self._stop_timer("pause")
        if self._job is not None and not self._cancelled:
            wait = MORE_PATIENCE if self._impatient else PATIENCE
            left = wait - (self._now() - self._job_began) if self._job.draft else 0.0
            if left > 0.0:
                self._timer("patience", left, self._cancel)
            else:
                self._cancel()
        self._go_on()
        self._publish()

    def _cancel(self) -> None:
        if self._job is None or self._cancelled:
            return
        self._cancelled = True
        self._worker.cancel(self._job.number)
        self._timer("grace", GRACE, lambda: self._do(self._restart()))

    def _go_on(self) -> None:
        """Starts the next job."""
        if self._job is not None or not self._todo or self._ended:
            return
        if self._todo[0] == FULL and (self._held or self._drawing):
            self._timer("pause", PAUSE if self._held else DRAWING, self._let_go)
            return
        self._number += 1
        kind = self._todo.pop(0)
        self._drafted = self._drafted and kind == FULL
        self._job = Job(
            number=self._number,
            text=self.text,
            file=str(self.file),
            folder=str(self.file.parent.resolve()),
            sets=self.sets,
            turned=tuple(self.turned.items()),
            limits=self.limits,
            solver=self.solver,
            draft=kind == DRAFT,
            parts=not self._drafted,
            first=self._shown["kind"] is None,
        )
        self._job_began, self._cancelled = self._now(), False
        self._worker.ask(self._job)

    def _let_go(self) -> None:
        self._held = self._drawing = False
        self._go_on()
        self._publish()

    def _heard(self, record: dict[str, Any], body: bytes) -> None:
        kind = record["kind"]
        if kind == "word":
            self._word = record["word"]
        elif self._job is None or record["number"] != self._job.number:
            return
        elif kind == "controls":
            self._list([*json.loads(body), *self._several()])
        elif kind == "begun":
            self._scene = record["scene"]
        elif kind == "progress":
            self._word = ""
            self._progress = {name: record[name] for name in ("time", "end", "steps", "touching")}
        elif kind in ("start", "part"):
            self._show(kind, "", body)
        else:
            self._close(record, body)
        self._publish()

    def _close(self, record: dict[str, Any], body: bytes) -> None:
        """The worker has done with its job."""
        for name in ("patience", "grace"):
            self._stop_timer(name)
        assert self._job is not None
        if self._job.draft:
            self._impatient = self._cancelled
        newest = (self._job.text, dict(self._job.turned)) == (self.text, self.turned)
        self._job, self._progress, self._word = None, None, ""
        if record["kind"] == "ended" and record["how"] in (DRAFT, FULL):
            # the page shows the result in any case; `mark` names its faults
            self.errors = [_plain(record["mark"])] if record["mark"] else []
            self._drafted = self._drawing = newest and record["how"] == DRAFT
            self._show(record["how"], record["status"], body, record["solved_s"])
        elif record["kind"] == "refused" and newest:
            self.errors = record["errors"]
            self._todo = []
        elif record["kind"] == "failed" and newest:
            self.errors = [_plain(record["reason"])]
            self._todo = []
        self._go_on()

    def _show(self, kind: str, status: str, body: bytes, solved_s: float | None = None) -> None:
        number = self._shown["number"] + bool(body)
        self._shown = {"number": number, "kind": kind, "status": status, "solved_s": solved_s}
        self.body = body or self.body

    def _list(self, controls: list[dict[str, Any]]) -> None:
        if controls != self.controls:
            self.controls = controls
            self._version["controls"] += 1

    def _several(self) -> list[dict[str, Any]]:
        """The controls of several values, as the text has them now; those that meet nothing go."""
        found = []
        for control in self.controls:
            if control["group"] == SEVERAL:
                with contextlib.suppress(SpecError):
                    found.append(asdict(of_pattern(self.text, control["path"])))
        return found

    def _died(self) -> None:
        """The worker ended by itself, which another one may not."""
        reason = "the process of the run has ended; the next change starts another one"
        self._do(self._restart({"kind": "failed", "reason": reason}))

    async def _restart(self, closing: dict[str, Any] | None = None) -> None:
        await self._worker.end()
        if self._ended:
            return
        try:
            await self._worker.start()
        except OSError as error:
            closing = {"kind": "failed", "reason": f"no process can be started: {error.strerror or error}"}
        if self._job is not None:
            self._close(closing or {"kind": "ended", "how": "cancelled"}, b"")
        self._publish()

    # the event loop

    def _now(self) -> float:
        return asyncio.get_running_loop().time()

    def _timer(self, name: str, delay: float, then: Any) -> None:
        self._stop_timer(name)
        self._timers[name] = asyncio.get_running_loop().call_later(delay, then)

    def _stop_timer(self, name: str) -> None:
        timer = self._timers.pop(name, None)
        if timer is not None:
            timer.cancel()

    def _do(self, work: Any) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _publish(self) -> None:
        for changed in self._waiting:
            changed.set()


def _plain(says: str) -> dict[str, Any]:
    """A mistake that is at no line."""
    return {"says": says, "line": None, "path": ""}

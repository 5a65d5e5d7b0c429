"""Runs samples by the shipped machine code and by what numba compiles: `python -m mdlgen.program.compare`.
With `--other bitcode` the other one is what LLVM makes here of the shipped bitcode.

A process of each kind runs the same sample in turn, `--repeat` times. Printed are how far the two are apart;
what is allowed; and the processor time of the shipped code over the other's (medians). Apart are places, at
most, as a part of the travel, or Euler parameters; where contacts rattle, the quantity that is apart most for
its error estimate, in the norm of that. The exit code is 1 where they differ by more, or where one of the
samples in TIMED takes more than 5 % longer. numba compiles for minutes where it has not kept these kernels.

It stands above what it runs, so it knows that by name only.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import os
import pickle
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

# Samples and their settings, so that none takes long. In the first, the last bit of a force stays the
# last bit of a place; contacts of the others rattle, and one that closes later changes all that follows.
# The block of verify/slide does not rattle, but nothing turns it back: at its own tolerance, one iteration a
# step leaves 1e-9 of its course open.
CALM: dict[str, tuple[str, ...]] = {
    "transport_4x4": (),
    "transport_nips": (),
    "stack": (),
    "cantilever": (),
    "saddle": (),
    "snatch": (),
    "crease": (),
    "rubber_nip": (),
    "register": (),
    "verify/aslant": (),
    "verify/drop": ("run.duration=60 ms",),
    "verify/flip": (),
    "verify/hanging": (),
    "verify/incline": (),
    "verify/rollup": (),
    "verify/slide": ("run.tolerance=1e-4",),
    "verify/spun": (),
    "verify/tension": (),
}
RATTLING: dict[str, tuple[str, ...]] = {
    "channel": (),
    "diverter": ("run.duration=20 ms",),
    "duplex": ("run.duration=20 ms",),
    "feeder": (
        *("sheets.note_1.boxes=[6,2]", "sheets.note_2.boxes=[4,2]"),
        *("run.duration=2 ms", "run.print_step=0.05 ms"),
    ),
    "feeder_one": ("run.duration=20 ms",),
    "feeder_window": (),
    "guide_joint": (),
    "landing": (),
    "peel": ("run.duration=4 ms",),
    "pick": (),
    "pile": ("run.duration=5 ms",),
    "recycler": ("run.duration=10 ms", "sheets.note.boxes=[8,1]"),
    "retard": ("run.duration=60 ms",),
    "retard_pad": (),
    "spring_plate": (),
    "stall": (),
    "stream": ("run.duration=70 ms",),
    "sorter": ("run.duration=70 ms",),
    "tilt_correction": ("run.duration=8 ms",),
    "transport_4x2": (),
    "transport_tilted": ("run.duration=20 ms",),
}
# Scenes that exudyn runs: it takes a second for each millisecond.
EXUDYN = {
    "cantilever": (),
    "landing": ("run.duration=10 ms", "run.step=0.1 ms"),
    "transport_4x2": ("run.duration=4 ms", "run.step=0.1 ms"),
    "pick": ("run.duration=2 ms", "run.step=0.1 ms"),
}
SAME, UNKNOWN = 1e-9, 1e-4  # parts of the travel; where contacts rattle, and it has no estimate
TIMED, SLOWER = ("transport_4x4", "feeder_one"), 1.05
ENOUGH = 5  # runs of which a median shows 5 %


class Run(NamedTuple):
    """One run of a sample."""

    result: Any  # mdlgen.results.result.Result
    took: float  # processor time [s]


@dataclass(frozen=True)
class Row:
    """A sample by both."""

    solver: str
    name: str
    alike: bool  # the same status and stored times; where contacts do not rattle, as many steps
    status: str
    apart: float  # as a part of the scale of `of`
    allowed: float
    of: str  # what is apart most for what is allowed
    ratio: float  # time of the shipped code over the other's
    runs: int  # by each

    @property
    def same(self) -> bool:
        """True if both runs agree."""
        return self.alike and self.status == "ok" and self.apart <= self.allowed

    @property
    def slower(self) -> bool:
        """True if the shipped program takes longer than it may."""
        timed = self.name in TIMED and self.solver == "lattice" and self.runs >= ENOUGH
        return timed and self.ratio > SLOWER

    def __str__(self) -> str:
        mark = "" if self.same else "  DIFFERS"
        mark += "  SLOWER" if self.slower else ""
        message = f"{self.of} {self.apart:.1e} of {self.allowed:.1e}, time {self.ratio:.3f}"
        return f"{self.solver} {self.name}: {self.status}, {message}{mark}"


class Other(Exception):
    """A process does not run its job."""


# Kinds of code, by how the record of a run (Program.code) begins, and the variables that ask for them.
KINDS = {"shipped": "shipped for", "bitcode": "made for", "numba": "compiled by numba"}
ASKED_FOR = {"numba": "MDLGEN_NUMBA", "bitcode": "MDLGEN_BITCODE"}


class Process:
    """Runs samples by one kind of code."""

    def __init__(self, kind: str):
        self._kind = kind
        path = os.pathsep.join(sys.path)
        asked = {variable: str(int(name == kind)) for name, variable in ASKED_FOR.items()}
        self._process = subprocess.Popen(
            [sys.executable, "-c", "from mdlgen.program.compare import answer; answer()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, **asked, "PYTHONPATH": path},
        )

    def run(self, solver: str, name: str, sets: Sequence[str]) -> Run:
        """A run of a sample. Raises Other where it is by other code."""
        assert self._process.stdin is not None and self._process.stdout is not None
        pickle.dump((solver, name, tuple(sets)), self._process.stdin)
        self._process.stdin.flush()
        message = pickle.load(self._process.stdout)
        code = message.result.versions["code"]
        if not code.startswith(KINDS[self._kind]):
            raise Other(f"{solver} runs code that is {code}: python -m mdlgen.program.build --check")
        return message

    def close(self) -> None:
        """Ends the process."""
        self._process.kill()
        self._process.communicate()


def compared(
    solver: str, samples: dict[str, tuple[str, ...]], repeat: int, other: str = "numba"
) -> Iterator[Row]:
    """A row of each sample, run by shipped code and by that of the `other` kind. Raises Other."""
    with contextlib.ExitStack() as stack:
        both = [Process(kind) for kind in ("shipped", other)]
        for process in both:
            stack.callback(process.close)
        for name, sets in samples.items():
            for process in both:  # loads, or compiles, the code for the sample
                process.run(solver, name, sets)
            runs = [[process.run(solver, name, sets) for process in both] for _ in range(repeat)]
            yield _row(solver, name, [list(kind) for kind in zip(*runs, strict=True)])


def _row(solver: str, name: str, runs: list[list[Run]]) -> Row:
    one, two = (kind[-1].result for kind in runs)
    alike = (one.status, one.position.shape) == (two.status, two.position.shape)
    alike &= one.steps == two.steps or name not in CALM
    most = Apart(float("inf"), SAME, "all")
    if alike:
        most = max(
            _places(one, two) if name in CALM else _estimated(one, two), key=lambda a: a.part / a.allowed
        )
    took = [statistics.median(run.took for run in kind) for kind in runs]
    return Row(solver, name, alike, one.status, *most, took[0] / took[1], len(runs[0]))


class Apart(NamedTuple):
    """Difference of two runs in a quantity and the allowed one, relative to its scale."""

    part: float
    allowed: float
    of: str


def _places(one: Any, two: Any) -> list[Apart]:
    places = one.position
    travel = np.abs(places - places[0]).max() or np.abs(places).max() or 1.0
    return [
        Apart(float(np.abs(places - two.position).max() / travel), SAME, "places"),
        Apart(float(np.abs(one.rotation - two.rotation).max()), SAME, "turns"),
    ]


def _estimated(one: Any, two: Any) -> list[Apart]:
    """Differences of the quantities that have an estimate, and of those that run.tolerance judges. Each run
    is as far from the exact value as its estimate. Differences are in the norm of the estimates."""
    quantities = importlib.import_module("mdlgen.results.quantities")
    estimates = [importlib.import_module("mdlgen.results.estimates").complete(run) for run in (one, two)]
    found: list[Apart] = []
    for name, gap in quantities.differences(one, two).items():
        errors = [_error(run[name]) for run in estimates]
        if None not in errors:
            found.append(Apart(gap.value, sum(filter(None, errors)) / gap.scale, name))
    return found


def _error(estimate: Any) -> float | None:
    """In the unit of its scale; of what run.tolerance does not judge None where it is not known."""
    if estimate.value is not None:
        return estimate.value * estimate.scale
    return None if estimate.judged is None else UNKNOWN * estimate.judged


def answer() -> None:
    """Runs the job that comes on standard input."""
    stream = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # a solver may talk there
    mdlgen: Any = importlib.import_module("mdlgen")
    folder = importlib.import_module("mdlgen.paths").samples()
    while True:
        try:
            solver, name, sets = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        model = mdlgen.lower(mdlgen.load(folder / f"{name}.yaml", sets))
        begun = time.process_time()
        result = mdlgen.solve(model, solver)
        took = time.process_time() - begun
        pickle.dump(Run(result, took), stream)
        stream.flush()


def main() -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(prog="python -m mdlgen.program.compare", description=__doc__)
    parser.add_argument("samples", nargs="*", help="samples; all if left out")
    parser.add_argument("--repeat", type=int, default=1, help="runs of each sample by each kind of code")
    parser.add_argument("--other", choices=("numba", "bitcode"), default="numba", help="what to compare with")
    wanted = parser.parse_args()
    wrong = False
    for solver, samples in (("lattice", CALM | RATTLING), ("exudyn", EXUDYN)):
        chosen = {name: sets for name, sets in samples.items() if name in (wanted.samples or samples)}
        for row in compared(solver, chosen, max(1, wanted.repeat), wanted.other) if chosen else ():
            print(row, flush=True)
            wrong |= not row.same or row.slower
    sys.exit(int(wrong))


if __name__ == "__main__":
    main()

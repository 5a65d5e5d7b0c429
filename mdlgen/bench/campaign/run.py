"""Runs a campaign and writes its files."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

from mdlgen import paths, registry
from mdlgen.bench.campaign.found import Campaign
from mdlgen.bench.campaign.kinds import KINDS
from mdlgen.bench.campaign.report import table
from mdlgen.bench.campaign.row import NONE, OK, CampaignRow
from mdlgen.bench.campaign.scene import drawn
from mdlgen.bench.campaign.task import Task
from mdlgen.bench.campaign.workers import Workers
from mdlgen.bench.machine import machine, versions
from mdlgen.errors import MdlgenError, OutputError, SpecError, did_you_mean
from mdlgen.processors import processors

Say = Callable[[str], None]
# One scene in so many is compared with finer steps.
TENTH = 10
# Processor time for the run of one scene [s].
LIMIT = 60.0
# Rows between two writes of campaign.json; a campaign that is killed loses fewer.
OFTEN = 20


def campaign(
    count: int,
    seed: int,
    folder: Path,
    *,
    only: Sequence[int] = (),
    kinds: Sequence[str] = (),
    workers: int | None = None,
    limit: float = LIMIT,
    solver: str = "auto",
    finer: bool = True,
    sticking: bool = False,
    say: Say = lambda text: None,
) -> Campaign:
    """Run the scenes 1 to `count` of a seed, or the numbers in `only`. `kinds` selects some of them.

    `workers` processes run one scene each at a time (None: one for each processor), for at most `limit` [s]
    of processor time. One scene in ten is compared with finer steps, unless `finer` is false. With `sticking`
    friction sticks in every second contact. Writes
    campaign.json and campaign.md into `folder`, and into `folder`/scenes the scenes that have no result or an
    inaccurate one, or that `only` names. Raises SpecError for a solver or a kind that there is not,
    OutputError for files that cannot be written.
    """
    registry.check_solver(solver)
    for kind in kinds:
        if kind not in KINDS:
            close = did_you_mean(kind[:40], KINDS)
            raise SpecError(f"there is no kind {kind[:40]!r}{close or ';'} there are: {', '.join(KINDS)}")
    numbers = list(only) or list(range(1, count + 1))
    if kinds:
        numbers = [number for number in numbers if drawn(seed, number).kind in kinds]
    try:
        (folder / "scenes").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot make this folder: {error.strerror or error}") from None
    found = Campaign(seed, len(numbers), limit, dict(machine()), versions(), sticking=sticking)
    tasks = [
        Task(seed, number, finer and number % TENTH == 0, solver, limit=limit, sticking=sticking)
        for number in numbers
    ]
    try:
        with Workers(workers or processors(), solver) as pool:
            for row in pool.rows(tasks):
                found.rows.append(row)
                say(_progress(row, len(found.rows), len(numbers)))
                if only or row.status != OK:
                    _write_scene(seed, row, sticking, folder / "scenes")
                if len(found.rows) % OFTEN == 0:
                    write(found, folder)
    finally:  # an interrupted campaign keeps its rows
        found.rows.sort(key=lambda row: row.number)
        write(found, folder)
    return found


def write(found: Campaign, folder: Path) -> None:
    """campaign.json and campaign.md; both or none. Raises OutputError."""
    files: dict[Path, str | bytes] = {
        folder / "campaign.json": json.dumps(found.json(), indent=1, allow_nan=False) + "\n",
        folder / "campaign.md": table(found),
    }
    paths.write_together(files)


def _progress(row: CampaignRow, done: int, count: int) -> str:
    took = "" if row.cpu_s is None else f" in {row.cpu_s:.3g} s"
    why = f": {row.reason}" if row.reason else ""
    mark = ", chaotic" if row.chaotic else ""
    return f"{done}/{count} {row.kind} {row.number}, {row.boxes} boxes: {row.status}{mark}{took}{why}"


def _write_scene(seed: int, row: CampaignRow, sticking: bool, folder: Path) -> None:
    try:
        scene = drawn(seed, row.number, sticking=sticking)
    except MdlgenError:  # none of its draws is accepted, which its row says
        assert row.status == NONE
        return
    scene.write(folder)

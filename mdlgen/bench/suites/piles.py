"""Piles: what sheets that lie on each other cost, at rest, under a feeding roller, and in a feeder."""

from __future__ import annotations

from functools import partial

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.registry import REFERENCE
from mdlgen.results.result import Result

SAMPLE = "pile"
STEP = 0.1  # [ms]
DURATION, QUICK = 100.0, 20.0  # [ms]
GRID = (10, 20)
LANDING = 20.0  # [ms], in which notes that touch sink into each other by their weights
COUNTS = {"rest": (5, 20), "lands": (5, 20), "awake": (5, 20), "fed": (5, 20, 100)}
NAMES = {
    "rest": "at rest",
    "lands": f"at rest, none asleep, first {LANDING:g} ms",
    "awake": "at rest, none asleep",
    "fed": "under a roller",
}
TALL = 0.1  # of a note [mm]
# The middle of the roller over the face of the uppermost note [mm]; for a pile at rest it stands still above.
ABOVE, AWAY = 12.4, 250.0
STILL = ("rollers.pick.press=null", "rollers.pick.drive=null")
CREEP = 10.0  # [um/s] that a pile at rest may move by
STIFFNESS = "100 N/mm^1.5"  # soft enough for that step
CONTACT = f"{{stiffness: {STIFFNESS}, restitution: 0.5, friction: 0.3, smoothing: 1 mm/s}}"
LIMIT = 1800.0  # [s]
# Two notes that are parted by a feeder's rollers, at its own step; the begin of that at a longer one, with
# air and without; and all of it with air.
FEEDER, FEEDER_STEP, FED = "feeder", 0.05, 600.0  # -, [ms], [ms]
AIR = "contacts.6.air={viscosity: 18.2 uPa*s}"


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """Piles of 5 to 100 notes of 200 boxes at a step that is given, some in which no sheet sleeps; in Exudyn
    a small one."""
    duration = QUICK if quick or solver == REFERENCE else DURATION
    found = []
    for kind, counts in COUNTS.items():
        if (kind in ("lands", "awake") and solver == REFERENCE) or (kind == "lands" and quick):
            continue
        for count in counts[:1] if quick or solver == REFERENCE else counts:
            rests, awake = kind in ("rest", "lands", "awake"), kind in ("lands", "awake")
            middle = AWAY if rests else ABOVE + TALL * count
            sets = (
                f"piles.cassette.count={count}",
                f"sheets.note.boxes=[{GRID[0]},{GRID[1]}]",
                f"rollers.pick.center=[0 mm, 0 mm, {middle:g} mm]",
                *(STILL if rests else ("rollers.pick.drive={speed: 25 rad/s, ramp: 10 ms}",)),
                f"piles.cassette.contact={CONTACT}",
                f"contacts.floor.stiffness={STIFFNESS}",
                f"contacts.pick.between=[cassette_{count}, pick]",
                f"probes.lead.sheet=cassette_{count}",
                f"run.duration={LANDING if kind == 'lands' else duration:g} ms",
                *(("run.sleep=false",) if awake else ()),
                "require=[]",
            )
            measure = balance if kind == "lands" else creep if rests else partial(feeds, count=count)
            name = f"{count} notes {NAMES[kind]}"
            found.append(
                BenchCase("piles", name, Run(SAMPLE, sets, STEP), measure, repeats=False, limit=LIMIT)
            )
    if solver != REFERENCE:
        grid = f"[{GRID[0]},{GRID[1]}]"
        sets = (
            *(f"sheets.note_{number}.boxes={grid}" for number in (1, 2)),
            "require=[]",
        )
        whole = (*sets, f"run.duration={duration if quick else FED:g} ms")
        begin = (*sets, f"run.duration={duration:g} ms")
        runs = {
            "feeder, two notes": Run(FEEDER, whole, FEEDER_STEP),
            f"feeder, first {duration:g} ms": Run(FEEDER, begin, STEP),
            f"feeder, first {duration:g} ms, air": Run(FEEDER, (*begin, AIR), STEP),
        }
        if not quick:
            runs["feeder, two notes, air"] = Run(FEEDER, (*whole, AIR), STEP)
        found += [
            BenchCase("piles", name, run, parts, repeats=False, limit=LIMIT) for name, run in runs.items()
        ]
    return found


def creep(result: Result, _: Result | None) -> list[Finding]:
    """How fast the notes of a pile move at the end, as a part of what they may."""
    notes = range(len(result.model.sheets))
    fastest = max(float(np.linalg.norm(result.sheet_motion(k)[1][-1])) for k in notes)
    details = _taken(result) | {"creep_um_per_s": 1e6 * fastest}
    return [Finding(f"creep, of {CREEP:g} um/s", 1e6 * fastest / CREEP, None, details)]


def balance(result: Result, _: Result | None) -> list[Finding]:
    """The energy balance of a pile."""
    return [Finding("energy balance, relative", abs(result.energy.balance_error), None, _taken(result))]


def feeds(result: Result, _: Result | None, count: int) -> list[Finding]:
    """The energy balance of a pile whose uppermost note is fed, and how far that and the next one came."""
    names = [sheet.name for sheet in result.model.sheets]
    notes = [names.index(f"cassette_{number}") for number in (count, count - 1)]
    ways = [float(np.ptp(result.sheet_motion(k)[0][[0, -1], 0])) for k in notes]
    details = _taken(result) | {"fed_mm": ways[0], "next_mm": ways[1]}
    return [Finding("energy balance, relative", abs(result.energy.balance_error), None, details)]


def parts(result: Result, _: Result | None) -> list[Finding]:
    """The energy balance of a feeder, and where its notes end."""
    ends = {s.name: float(result.sheet_motion(k)[0][-1, 0]) for k, s in enumerate(result.model.sheets)}
    details = _taken(result) | {f"{name}_x_mm": x for name, x in ends.items()}
    return [Finding("energy balance, relative", abs(result.energy.balance_error), None, details)]


def _taken(result: Result) -> dict[str, float]:
    return {"steps": float(result.steps or 0), "iterations": float(result.iterations or 0)}

"""Rungs of piles: 2 to 50 sheets laid askew, at rest, dropped, struck, thrown, fed; masses 1 : 100."""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Measure, Run
from mdlgen.bench.oracles import impact as oracle
from mdlgen.bench.suites.ladder import FORCED, MOST_STEPS, lasting, rung, within
from mdlgen.model.tables import Floats, Model
from mdlgen.results.result import Result

SAMPLE, PILE = "pile", "cassette"
MASS, THICKNESS, GRAVITY = 0.72, 0.1, 9.81e-3  # [g], [mm], [mm/ms^2]
STIFFNESS, FRICTION, SMOOTHING = 2000.0, 0.3, 1e-3  # of a box [N/mm^1.5], -, [mm/ms]
PRESSED, GRIP, SURFACE, RAMP, ROLLER_SMOOTHING = 0.5 + 15 * GRAVITY, 0.8, 0.3, 10.0, 3e-3  # of the sample
SAMPLE_FRICTION = 0.15  # between its sheets
NO_GRAVITY = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
NO_LIMITS = "run.prune=false"

COUNTS = ((2, (3, 4)), (5, (3, 4)), (10, (2, 2)), (20, (2, 2)), (50, (1, 1)))  # of sheets, and of boxes
STEPS = (1.0, 0.1, 0.01, 0.001)  # [ms]
SOFT = 20.0  # [N/mm^1.5]: sheets on it swing slowly enough for the longest of these steps
HEAVY = 100.0  # times the mass of the others
GAP = 0.2  # [mm] between sheets that fall on each other or are struck
THROWN, STRUCK = 0.3, 0.1  # [mm/ms]
REST, SLIDE, FALL = 200.0, 20.0, 50.0  # [ms]
ASKEW, IN_LINE = ("0.3 mm", "1 deg"), ("0 mm", "0 deg")

# Askew sheets have 1 % less in common, which bears all the weight.
WEIGHT, SUNK, CREEP = 1e-3, 1e-2, 1e-5  # relative, relative, [mm/ms]
# Speeds after up to four impacts, each right to a few thousandths.
SLID, STRIKES, FALLS, FED = 5e-3, 1e-2, 1e-3, 5e-3
MOMENTUM = 1e-9
GAINED, DEEP = 1e-3, 0.5  # of the energy that passes through, of the thickness


def rungs() -> list[BenchCase]:
    """All of them."""
    return [*_rest(), *_dropped(), *_struck(), *_falling(), *_sliding(), *_fed()]


def _law(mu: float, c: float, stiffness: float) -> str:
    smooth = f"smoothing: {SMOOTHING * 1e3:g} mm/s"
    return f"stiffness: {stiffness:g} N/mm^1.5, restitution: {c:g}, friction: {mu:g}, {smooth}"


def _pile(
    count: int,
    boxes: tuple[int, int],
    mu: float = FRICTION,
    c: float = 0.5,
    laid: tuple[str, str] = ASKEW,
    gap: float = 0.0,
    stiffness: float = STIFFNESS,
) -> tuple[str, ...]:
    """Overrides of a pile on its floor without the roller of the sample."""
    return (
        f"piles.{PILE}.count={count}",
        f"piles.{PILE}.contact={{{_law(mu, c, stiffness)}}}",
        f"piles.{PILE}.jitter={laid[0]}",
        f"piles.{PILE}.turn={laid[1]}",
        f"piles.{PILE}.gap={gap:g} mm",
        f"sheets.note.boxes=[{boxes[0]},{boxes[1]}]",
        f"sheets.note.center=[0 mm, 0 mm, {0.5 * THICKNESS + gap:g} mm]",
        "rollers={}",
        "probes={}",
        "require=[]",
        f'contacts={{floor: {{between: ["{PILE}_*", floor], {_law(mu, c, stiffness)}}}}}',
        "run.tolerance=0.001",
    )


def _mass(*numbers: int) -> tuple[str, ...]:
    return tuple(f"sheets.{PILE}_{k}.mass={HEAVY * MASS:g} g" for k in numbers)


def _thrown(number: int, x: float, z: float = 0.0) -> str:
    return f"sheets.{PILE}_{number}.velocity=[{x:g} m/s, 0 m/s, {z:g} m/s]"


def _of(name: str, sets: tuple[str, ...], measure: Measure, step: float | None = None) -> BenchCase:
    return rung(name, Run(SAMPLE, sets, step), measure)


def _rest() -> list[BenchCase]:
    """Laid on each other without a load: they sink in by their weight, and rest."""
    made = [
        _of(f"pile of {count}: laid down", (*_pile(count, boxes), *lasting(REST)), rests)
        for count, boxes in COUNTS
    ]
    for name, heavy in (("heavy on light", (5,)), ("light on heavy", (1,)), ("in turns", (2, 4))):
        sets = (*_pile(5, (2, 2)), *_mass(*heavy), *lasting(REST))
        made.append(_of(f"pile of masses 1 : 100, {name}: laid down", sets, rests))
    for step in STEPS:
        whole = step * MOST_STEPS >= REST
        # a sheet that has not come to rest yet is judged by the impulse, for which each step is stored
        sets = (*_pile(5, (2, 2)), *within(step, REST), *(() if whole else (f"run.print_step={step:g} ms",)))
        made.append(_of(f"step {step * 1e-3:g} s: pile laid down", sets, rests if whole else sinks, step))
    soft = (*_pile(5, (2, 2), stiffness=SOFT), *lasting(REST))
    return [*made, _of(f"step {STEPS[0] * 1e-3:g} s: soft pile laid down", soft, rests, STEPS[0])]


def _dropped() -> list[BenchCase]:
    """All fall at once, each from over the one below."""
    counts = ((2, (3, 4)), (5, (2, 2)), (20, (1, 1)))
    return [
        _of(
            f"pile of {count}: dropped from {GAP:g} mm each",
            (*_pile(count, boxes, c=0.2, gap=GAP), *lasting(2 * REST)),
            partial(rests, fallen=GAP),
        )
        for count, boxes in counts
    ]


def _struck() -> list[BenchCase]:
    """Newton's cradle of sheets that float apart: the first is thrown at the second."""
    made = []
    for name, count, c, heavy in (
        ("c_R 1", 5, 1.0, ()),
        ("c_R 0.5", 5, 0.5, ()),
        ("masses 1 : 100", 3, 0.8, (3,)),
        ("masses 100 : 1", 3, 0.8, (1,)),
    ):
        mass = np.full(count, MASS)
        mass[[k - 1 for k in heavy]] *= HEAVY
        lasts = sum(GAP / speed for speed in _passed_on(mass, c)[:-1]) + 3.0
        sets = (*_pile(count, (2, 2), 0.0, c, IN_LINE, GAP), *_mass(*heavy), NO_GRAVITY, NO_LIMITS)
        sets = (*sets, _thrown(1, 0.0, STRUCK), *lasting(lasts))
        made.append(_of(f"sheets struck one by another, {name}", sets, partial(passes_on, c=c)))
    return made


def _falling() -> list[BenchCase]:
    """A pile that falls freely while one of its sheets is thrown into it."""
    sets = (*_pile(5, (2, 2)), _thrown(5, 0.1, -0.2), "planes.floor.center=[0 mm, 0 mm, -500 mm]", NO_LIMITS)
    made = [
        _of(f"step {step * 1e-3:g} s: pile in free fall, struck", (*sets, *within(step, FALL)), falls, step)
        for step in STEPS
    ]
    still = (*_pile(20, (2, 2)), "planes.floor.center=[0 mm, 0 mm, -500 mm]", NO_LIMITS, *lasting(FALL))
    return [*made, _of("pile of 20: in free fall", still, falls)]


def _sliding() -> list[BenchCase]:
    """One sheet is thrown along the others: friction of both its faces slows it down."""
    made = []
    for name, count, number, mu, heavy in (
        ("top one of 5", 5, 5, 0.3, ()),
        ("top one of 50", 50, 50, 0.3, ()),
        ("middle one of 5", 5, 3, 0.2, ()),
        ("heavy one on 4 light ones", 5, 5, 0.3, (5,)),
        ("light one on 4 heavy ones", 5, 5, 0.3, (1, 2, 3, 4)),
        ("top one of 5, mu 0", 5, 5, 0.0, ()),
        ("middle one of 20, mu 0", 20, 10, 0.0, ()),
    ):
        boxes = (1, 1) if count == 50 else (2, 2)
        sets = (*_pile(count, boxes, mu), *_mass(*heavy), _thrown(number, THROWN), "run.margin=30 mm")
        measure = partial(slides, number=number, mu=mu)
        made.append(_of(f"thrown along a pile: {name}", (*sets, *lasting(SLIDE)), measure))
    sets = (*_pile(5, (2, 2)), _thrown(5, THROWN), "run.margin=30 mm")
    measure = partial(slides, number=5, mu=FRICTION)
    made += [
        _of(f"step {step * 1e-3:g} s: thrown along a pile", (*sets, *within(step, SLIDE)), measure, step)
        for step in STEPS
    ]
    soft = (*_pile(5, (2, 2), stiffness=SOFT), _thrown(5, THROWN), "run.margin=30 mm", *lasting(SLIDE))
    return [*made, _of(f"step {STEPS[0] * 1e-3:g} s: thrown along a soft pile", soft, measure, STEPS[0])]


def _fed() -> list[BenchCase]:
    """The roller of the sample draws the uppermost sheet off."""
    made = []
    for count, boxes in ((2, (3, 4)), (10, (3, 4)), (50, (1, 2))):
        sets = (
            f"piles.{PILE}.count={count}",
            f"sheets.note.boxes=[{boxes[0]},{boxes[1]}]",
            f"rollers.pick.center=[0 mm, 0 mm, {12.4 + THICKNESS * count:g} mm]",
            f"contacts.pick.between=[{PILE}_{count}, pick]",
            f"probes.lead.sheet={PILE}_{count}",
            "require=[]",
            "run.tolerance=0.001",
            *lasting(30.0),
        )
        made.append(_of(f"pile of {count}: fed by a roller", sets, feeds))
    return made


def _passed_on(mass: Floats, c: float) -> list[float]:
    """Speeds [mm/ms] with which each sheet strikes the next one, and that of the last one at the end."""
    speeds = [STRUCK]
    for first, second in pairwise(mass.tolist()):
        e = oracle.restitution(c, SMOOTHING / speeds[-1])
        speeds.append((1 + e) * first / (first + second) * speeds[-1])
    return speeds


def _sheets(result: Result) -> tuple[Floats, Floats, Floats]:
    """Places and velocities of the sheets' middles from the lowest up (t, n, 3), and their masses [g]."""
    model = result.model
    names = [sheet.name for sheet in model.sheets]
    order = [names.index(f"{PILE}_{k + 1}") for k in range(len(names))]
    motion = [result.sheet_motion(k) for k in order]
    boxes = [slice(model.sheets[k].first, model.sheets[k].first + model.sheets[k].count) for k in order]
    mass = np.array([model.bodies.mass[own].sum() for own in boxes])
    return np.stack([m[0] for m in motion], 1), np.stack([m[1] for m in motion], 1), mass


def _on_floor(result: Result) -> Floats:
    """Force of the pile on its floor [N], (t,)."""
    contacts = result.model.contacts
    rows = [k for k, pair in enumerate(zip(contacts.part_a, contacts.part_b, strict=True)) if "floor" in pair]
    return result.contact_force[:, rows].sum(axis=1)


def _sunk(model: Model, mass: Floats) -> Floats:
    """How far each sheet of a pile at rest has sunk [mm] from where it touches the next one, from the lowest
    up: k z^1.5 of each box bears its part of what lies on it."""
    borne = GRAVITY * np.cumsum(mass[::-1])[::-1] / model.sheets[0].count
    return np.cumsum((borne / model.contacts.stiffness[0]) ** (2 / 3))


def _kept(result: Result, through: float) -> list[Finding]:
    """Energy that came from nowhere, over that which passes `through` [N mm], and the order of the sheets.

    Kinetic energy of the boxes and that of their weight never exceed those of the start, at which nothing is
    bent or pressed in.
    """
    model = result.model
    count = sum(sheet.count for sheet in model.sheets)
    mass = model.bodies.mass[:count]
    total = 0.5 * np.einsum("b,tbi->t", mass, result.velocity[:, :count] ** 2)
    total -= np.einsum("b,tbi,i->t", mass, result.position[:, :count], model.gravity)
    above = np.diff(_sheets(result)[0][..., 2], axis=1)
    gained = max(float((total - total[0]).max()), 0.0) / through
    return [
        Finding("energy above its start, greatest, relative", gained, GAINED),
        Finding("depth of a sheet in another, over the thickness", 1 - float(above.min()) / THICKNESS, DEEP),
    ]


def rests(result: Result, _: Result | None, fallen: float = 0.0) -> list[Finding]:
    """At the end the floor bears the weight, the uppermost sheet is at its pressed place, and nothing moves.
    A sheet that fell by `fallen` did so by g t^2/2 until the first of them struck."""
    place, rate, mass = _sheets(result)
    late = result.time >= 0.75 * result.time[-1]
    weight, sunk = GRAVITY * mass.sum(), float(_sunk(result.model, mass)[-1])
    borne = float(_on_floor(result)[late].mean())
    found = THICKNESS * (len(mass) - 0.5) - float(place[-1, -1, 2])
    fastest = float(np.linalg.norm(rate[late], axis=2).max())
    through = GRAVITY * float(mass @ (_sunk(result.model, mass) + fallen * np.arange(1, len(mass) + 1)))
    forced = result.model.run.step is not None
    made = [
        Finding("force on the floor, relative", abs(borne / weight - 1), FORCED if forced else WEIGHT),
        Finding("way that the pile sank, relative", abs(found / sunk - 1), FORCED if forced else SUNK),
        Finding("greatest creep, over 10 um/s", fastest / CREEP, 1.0),
        *_kept(result, through),
    ]
    if fallen:
        before = int(np.searchsorted(result.time, np.sqrt(2 * fallen / GRAVITY))) - 1
        exact = 0.5 * GRAVITY * result.time[before] ** 2
        error = float(np.abs((place[0] - place[before])[:, 2] - exact).max()) / exact
        made.insert(0, Finding("fall before the first impact, relative", error, FALLS))
    return made


def sinks(result: Result, _: Result | None) -> list[Finding]:
    """The momentum of a pile that sinks in is the impulse of the floor and of its weight."""
    rate, mass = _sheets(result)[1:]
    force, time = _on_floor(result), result.time
    pushed = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(time))])
    weight = GRAVITY * mass.sum()
    error = float(np.abs(rate[..., 2] @ mass - pushed + weight * time).max() / (weight * time[-1]))
    name = "momentum against the impulse, over that of the weight"
    through = GRAVITY * float(mass @ _sunk(result.model, mass))
    return [Finding(name, error, FORCED), *_kept(result, through)]


def passes_on(result: Result, _: Result | None, c: float) -> list[Finding]:
    """Speed of the last sheet by momentum and the quadrature of each impact; the sum of all momenta."""
    rate, mass = _sheets(result)[1:]
    exact, found = _passed_on(mass, c)[-1], float(rate[-1, -1, 2])
    start = float(mass[0]) * STRUCK
    drift = float(np.abs(rate[..., 2] @ mass / start - 1).max())
    through = 0.5 * start * STRUCK
    details = {"exact_m_per_s": exact, "found_m_per_s": found}
    return [
        Finding("speed of the last sheet, relative", abs(found / exact - 1), STRIKES, details),
        Finding("momentum, greatest drift, relative", drift, MOMENTUM),
        *_kept(result, through),
    ]


def falls(result: Result, _: Result | None) -> list[Finding]:
    """The middle of all masses goes by v t + g t^2/2, whatever the sheets do to each other."""
    place, rate, mass = _sheets(result)
    time, part = result.time[:, None], mass / mass.sum()
    exact = time * (part @ rate[0]) + 0.5 * result.model.gravity * time**2
    gap = np.einsum("k,tki->ti", part, place - place[0]) - exact
    error = float(np.linalg.norm(gap, axis=1).max() / np.linalg.norm(exact[-1]))
    struck = 0.5 * float(mass @ np.sum(rate[0] ** 2, axis=1))
    through = struck or float(mass.sum()) * GRAVITY * float(np.linalg.norm(exact[-1]))
    return [Finding("fall of the middle of all masses, relative", error, FALLS), *_kept(result, through)]


def slides(result: Result, _: Result | None, number: int, mu: float) -> list[Finding]:
    """Way of the sheet that was thrown by the impulse of friction, mu that of the normal forces on both of
    its faces; it takes what lies on it along. Without friction nothing else moves.

    The weight of what is above a face is borne there but for the way that it sinks meanwhile: the integral of
    the normal force over time, twice, is the sum of m (g t^2/2 - sunk) of all sheets above.
    """
    place, _rate, mass = _sheets(result)
    time = float(result.time[-1])
    way = (place[-1] - place[0])[:, 0]
    borne = mu * mass * (0.5 * GRAVITY * time**2 - _sunk(result.model, mass))
    above, k = float(borne[number:].sum()), number - 1
    exact = THROWN * time - (2 * above + float(borne[k])) / float(mass[k])
    tolerance = SLID if result.model.run.step is None else FORCED
    details = {"exact_mm": exact, "found_mm": float(way[k])}
    made = [Finding("way, relative", abs(float(way[k]) / exact - 1), tolerance, details)]
    if len(mass) > number:
        error = float(np.abs(way[number:] - above / mass[number:].sum()).max()) / exact
        made.append(Finding("way of those on it, relative", error, tolerance))
    # more friction holds than moves what lies below: each goes by less than the smoothing on the next one
    held = float(np.max(way[:k] / (SMOOTHING * time * np.arange(1, number))))
    made.append(Finding("creep of those below it, over the smoothing", held, 1.0 if mu else SLID))
    return [*made, *_kept(result, 0.5 * float(mass[k]) * THROWN**2)]


def feeds(result: Result, _: Result | None) -> list[Finding]:
    """The uppermost sheet goes as the roller's surface does, less the slip at which friction holds against
    that of the sheet below it: s(slip over the smoothing) = mu (N + m g)/(mu_r N). The others are held."""
    place, _rate, mass = _sheets(result)
    way, time = (place[-1] - place[0])[:, 0], float(result.time[-1])
    held = SAMPLE_FRICTION * (PRESSED + GRAVITY * mass[-1]) / (GRIP * PRESSED)
    slip = ROLLER_SMOOTHING * float(_slip(held))
    exact = SURFACE * (time - 0.5 * RAMP) - slip * time
    found = float(way[-1])
    details = {"exact_mm": exact, "found_mm": found}
    # the floor's smoothing is that of the roller
    most = (ROLLER_SMOOTHING + SMOOTHING * np.arange(len(mass) - 1)) * time
    crept = float(np.max(way[:-1] / most))
    above = np.diff(place[..., 2], axis=1)
    return [
        Finding("way of the sheet that is fed, relative", abs(found / exact - 1), FED, details),
        Finding("creep of those below it, over the smoothing", crept, 1.0),
        Finding("depth of a sheet in another, over the thickness", 1 - float(above.min()) / THICKNESS, DEEP),
    ]


def _slip(part: float) -> float:
    """Where the cubic STEP from -1 to 1, x (3 - x^2)/2, is `part`: of x = 2 sin a it is sin 3a."""
    return 2.0 * math.sin(math.asin(part) / 3.0)

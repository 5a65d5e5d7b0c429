"""Friction that sticks: a block on a slope, a card in a nip that stands, a nip that pulls, one that starts
and stops, and two cards that lean on each other."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

GROUP, SAMPLE = "Friction that sticks", "verify/slide"
GRAVITY = 9.81e-3  # [mm/ms^2]
NONE = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
STIFF = 300.0  # of contacts [N/mm^1.5]
# A block on a slope: mass, mu, k_t, angles below and above atan(mu) = 21.8 deg.
BLOCK, MU, K_T, ANGLES = 10.0, 0.4, 40.0, (8.0, 30.0)  # [g], [N/mm], [deg]
# A card that hangs in a nip which stands (the scene hold_in_stopped_nip): preload; the share of 2 mu N that
# its weight is; its size along the fall.
PRELOAD, HELD, SLIDES = 1.0, 0.6, 1.1  # [N]
# A nip that pulls a note against a force, and one that starts and stops: radius, preload, forces.
RADIUS, PRESS, FORCES = 8.0, 2.0, (0.3, 0.6)  # [mm], [N]
STARTS, RAMP, SPEED = 10, 6.0, 100.0  # up, on, down and at rest for a ramp each [ms]; [rad/s]
# Two cards that lean on each other: friction above and below tan(20 deg)/2 = 0.18.
STANDS, FALLS = 0.5, 0.1
LASTS, FALLEN = 5000.0, 400.0  # [ms]
CARD = "{E_md: 3600 MPa, E_cd: 3600 MPa, D_md: 0.30 N*mm, D_cd: 0.30 N*mm}"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or the one that both solvers end within a second."""
    low, high = (_slope(angle) for angle in ANGLES)
    if quick:
        return [high]
    nips = [_hangs(HELD, 1000.0), _hangs(SLIDES, 40.0), *(_pulls(force) for force in FORCES), _register()]
    return [low, high, *nips, _house(STANDS, LASTS), _house(FALLS, FALLEN)]


def _friction(mu: float, k_t: float = K_T) -> str:
    return f"{{static: {mu}, dynamic: {mu}, sticking: {k_t} N/mm}}"


def _slope(angle: float) -> BenchCase:
    """The block of the sample at rest, under gravity that leans along x."""
    lean = math.radians(angle)
    along, down = GRAVITY * math.sin(lean), GRAVITY * math.cos(lean)
    sunk = (BLOCK * down / 1000.0) ** (2 / 3)
    sets = (
        f"gravity=[{1e3 * along!r} m/s^2, 0 m/s^2, {-1e3 * down!r} m/s^2]",
        "sheets.block.velocity=[0 m/s, 0 m/s, 0 m/s]",
        f"sheets.block.center=[-400 mm, 0 mm, {5.0 - sunk!r} mm]",
        f"contacts.0.friction={_friction(MU)}",
        "run={duration: 1000 ms, step: 0.2 ms}"
        if math.tan(lean) < MU
        else "run={duration: 50 ms, step: 0.05 ms, tolerance: 0.01}",
    )
    name = f"block on a slope of {angle:g} deg, mu {MU:g}"
    return row(GROUP, name, Run(SAMPLE, sets), partial(_rests if math.tan(lean) < MU else _runs_down, lean))


def _rests(lean: float, result: Result, _: Result | None) -> list[Finding]:
    """How far the block's lower face gives way in a second, and how far it then still goes."""
    x = result.position[:, 0, 0]
    late = result.time >= 0.5 * result.time[-1]
    given = BLOCK * GRAVITY * math.sin(lean) / K_T
    basis = Basis("a spring below mu N: W sin(a)/k_t, and it stays", "the swing before it comes to rest")
    low = _face(result)
    return [
        against("way of its face", given, float(low[-1] - low[0]), 1e-2, "mm", basis),
        against("creep", 0.0, float(np.ptp(x[late])), 1e-5, "mm", basis, 1.0),
    ]


def _face(result: Result) -> np.ndarray:
    """Where the middle of the lower face of a block of 10 mm is along x, (t,)."""
    w, x, y, z = np.moveaxis(result.rotation[:, 0], -1, 0)
    return result.position[:, 0, 0] - 5.0 * 2.0 * (x * z + w * y)


def _runs_down(lean: float, result: Result, _: Result | None) -> list[Finding]:
    """Acceleration over the later half of the run."""
    exact = GRAVITY * (math.sin(lean) - MU * math.cos(lean))
    late = result.time >= 0.5 * result.time[-1]
    found = float(np.polyfit(result.time[late], result.velocity[late, 0, 0], 1)[0])
    basis = Basis("g (sin a - mu cos a)", "what swings on as it begins to slide")
    return [against("acceleration", exact, found, 2e-3, "mm/ms^2", basis)]


def _rollers(one: str, two: str, way: str, at: float) -> str:
    """Two rollers of a nip, each at a distance along an axis; the second is pressed."""
    places = (f"[{-at!r} mm, 0 mm, 0 mm]", f"[{at!r} mm, 0 mm, 0 mm]")
    if way == "z":
        places = (f"[0 mm, 0 mm, {-at!r} mm]", f"[0 mm, 0 mm, {at!r} mm]")
    shape = f"axis: y, radius: {RADIUS} mm, width: 30 mm"
    return (
        f"rollers={{a: {{center: {places[0]}, {shape}, {one}}}, b: {{center: {places[1]}, {shape}, {two}}}}}"
    )


def _hangs(share: float, duration: float) -> BenchCase:
    """The card weighs a share of what friction holds on both its sides."""
    mass = share * 2.0 * MU * PRELOAD / GRAVITY
    note = (
        f"{{material: p, size: [60 mm, 40 mm], thickness: 0.3 mm, mass: {mass!r} g, boxes: [6, 4],"
        " layout: plate, rotation: [0 deg, 90 deg, 0 deg], center: [0 mm, 0 mm, -20 mm]}"
    )
    stands = "mass: 20 g, drive: {speed: 0 rad/s}"
    press = f"press: {{direction: -x, stiffness: 0.5 N/mm, preload: {PRELOAD} N, damping_ratio: 0.3}}"
    sets = (
        f"materials={{p: {CARD}}}",
        f"sheets={{n: {note}}}",
        "planes={}",
        _rollers(stands, f"{stands}, {press}", "x", RADIUS + 0.14),
        f"contacts=[{{between: [n, [a, b]], stiffness: {STIFF} N/mm^1.5, friction: {_friction(MU)},"
        " restitution: 0.3, smoothing: 5 mm/s}]",
        f"run={{duration: {duration} ms, margin: 20 mm, tolerance: 0.01,"
        f" step: {0.2 if share < 1.0 else 0.1} ms}}",
    )
    name = f"card in a stopped nip, its weight {share:g} of 2 mu N"
    return row(GROUP, name, Run(SAMPLE, sets), partial(_hung, share < 1.0, mass))


def _hung(holds: bool, mass: float, result: Result, _: Result | None) -> list[Finding]:
    """How fast it goes down after 800 ms, or what it accelerates by."""
    count = result.model.sheets[0].count
    z, v = (values[:, :count, 2].mean(axis=1) for values in (result.position, result.velocity))
    late = result.time >= 0.8 * result.time[-1]
    if holds:
        found = 1e3 * float(np.ptp(z[late])) / float(np.ptp(result.time[late]))
        basis = Basis("friction below mu N moves nothing", "1e-3 mm/s")
        return [against("speed after 800 ms", 0.0, found, 1e-3, "mm/s", basis, 1.0)]
    late = result.time >= 0.5 * result.time[-1]
    exact = GRAVITY - MU * float(result.contact_force[late].sum(axis=1).mean()) / mass
    found = -float(np.polyfit(result.time[late], v[late], 1)[0])
    basis = Basis("g - mu (N_1 + N_2)/m", "the nips' normal forces while it swings")
    return [against("acceleration", exact, found, 3e-2, "mm/ms^2", basis)]


def _web(drive: str, force: float, duration: float, step: float = 0.1) -> tuple[str, ...]:
    """A note between a driven roller and a free one, pulled back by a force."""
    note = (
        "{material: p, size: [200 mm, 40 mm], thickness: 0.2 mm, mass: 2 g, boxes: [40, 2], layout: plate,"
        " center: [-60 mm, 0 mm, 0 mm]}"
    )
    press = f"press: {{direction: -z, stiffness: 0.5 N/mm, preload: {PRESS} N, damping_ratio: 0.3}}"
    return (
        NONE,
        f"materials={{p: {CARD[:-1]}, damping: {{ratio: 0.3}}}}}}",
        f"sheets={{n: {note}}}",
        "planes={}",
        _rollers(f"mass: 20 g, drive: {drive}", f"mass: 2 g, {press}", "z", RADIUS + 0.09),
        f"contacts=[{{between: [n, [a, b]], stiffness: {STIFF} N/mm^1.5, friction: {_friction(MU)},"
        " restitution: 0.3, smoothing: 5 mm/s}]",
        f"loads=[{{sheet: n, edge: x_min, force: [{-force!r} N, 0 N, 0 N]}}]",
        f"run={{duration: {duration} ms, margin: 60 mm, step: {step} ms}}",
    )


def _pulls(force: float) -> BenchCase:
    sets = _web("{speed: 125 rad/s, ramp: 20 ms}", force, 100.0)
    return row(GROUP, f"nip that pulls a note with {force:g} N", Run(SAMPLE, sets), partial(_creeps, force))


def _creeps(force: float, result: Result, _: Result | None) -> list[Finding]:
    """How much slower the note goes than the roller, in parts of both."""
    late = result.time >= 0.5 * result.time[-1]
    nip = float(result.contact_force[late, 0].mean())
    half, grip = math.sqrt(2.0 * RADIUS * (nip / STIFF) ** (2 / 3)), MU * nip
    exact = 2.0 * grip / (K_T * half) * (1.0 - math.sqrt(1.0 - force / grip))
    x = result.position[late, : result.model.sheets[0].count, 0].mean(axis=1)
    v = float(x[-1] - x[0]) / float(np.ptp(result.time[late]))
    source = "Carter (1926) for a spring k_t: 2 mu N/(k_t a) (1 - sqrt(1 - F/(mu N)))"
    basis = Basis(source, "boxes that come into the nip, and the step of 0.1 ms")
    return [against("creep", exact, (1.0 - v) / (0.5 * (1.0 + v)), 1e-2, "", basis)]


def _register() -> BenchCase:
    corners = [[0.0, 0.0]]
    for k in range(STARTS):
        up, on, down, rest = (RAMP * (4 * k + n) for n in (1, 2, 3, 4))
        corners += [[up, SPEED], [on, SPEED], [down, 0.0]]
        corners += [[rest, 0.0]] if k < STARTS - 1 else []
    profile = ", ".join(f"[{t} ms, {w} rad/s]" for t, w in corners)
    sets = _web(f"{{profile: [{profile}]}}", 0.0, corners[-1][0] + 30.0, 0.05)
    turned = sum(0.5 * (w1 + w2) * 1e-3 * (t2 - t1) for (t1, w1), (t2, w2) in pairwise(corners))
    name = f"nip that starts and stops {STARTS} times"
    # the reference solver takes 5,400 steps
    return row(GROUP, name, Run(SAMPLE, sets), Registers(RADIUS * turned), 900.0)


@dataclass(frozen=True)
class Registers:
    """Way of a note against that of its roller's surface."""

    turned: float  # [mm]

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        x = result.position[:, : result.model.sheets[0].count, 0].mean(axis=1)
        basis = Basis("omega R t: a nip without load creeps by nothing", "0.002 mm for each start")
        return [against("way", self.turned, float(x[-1] - x[0]), 2e-3 * STARTS, "mm", basis, 1.0)]


def _house(mu: float, duration: float) -> BenchCase:
    """The scene house_mu_0.5, with friction that sticks."""

    def card(side: int) -> str:
        return (
            "{material: p, size: [88 mm, 60 mm], thickness: 0.3 mm, mass: 1.8 g, boxes: [8, 6],"
            f" layout: plate, rotation: [0 deg, {side * 70} deg, 0 deg],"
            f" center: [{side * 15.215} mm, 0 mm, 41.42 mm]}}"
        )

    law = f"stiffness: {STIFF} N/mm^1.5, friction: {_friction(mu)}, restitution: 0.2, smoothing: 1 mm/s"
    sets = (
        "materials={p: {E_md: 3000 MPa, E_cd: 3000 MPa, D_md: 8 N*mm, D_cd: 8 N*mm}}",
        f"sheets={{a: {card(-1)}, b: {card(1)}}}",
        "planes={t: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 300 mm, 10 mm], mass: 100 g}}",
        f"contacts=[{{between: [[a, b], t], {law}}}, {{between: [a, b], {law}}}]",
        f"run={{duration: {duration} ms, margin: 60 mm, tolerance: 0.01}}",
    )
    name = f"two cards that lean on each other, mu {mu:g}, {1e-3 * duration:g} s"
    return row(GROUP, name, Run(SAMPLE, sets), partial(_leans, mu))


def _leans(mu: float, result: Result, _: Result | None) -> list[Finding]:
    """How far the lower edges come apart, or how low the ridge is in the end."""
    source = "20 deg from upright they stand where mu is above tan(20 deg)/2 = 0.18"
    first, last = result.position[0], result.position[-1]
    count = result.model.sheets[0].count
    # the sheet a leans with its first column at the lower edge, b with its last
    low = [int(np.argmin(first[s : s + count, 2])) + s for s in (0, count)]
    apart = float(np.linalg.norm(last[low[0]] - last[low[1]]) - np.linalg.norm(first[low[0]] - first[low[1]]))
    if mu > 0.5 * math.tan(math.radians(20.0)):
        basis = Basis(source, "0.1 mm: springs that give way as the cards come to rest")
        return [against("lower edges, apart", 0.0, apart, 0.1, "mm", basis, 1.0)]
    high = float(first[: 2 * count, 2].max())
    down = float(last[: 2 * count, 2].max()) / high
    basis = Basis(source, "below half of the height that it had")
    return [against("height of the ridge over that at first", 0.0, down, 0.5, "", basis, 1.0)]

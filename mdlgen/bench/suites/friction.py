"""A block that slides, stops or creeps on a plane, against Coulomb's law regularised by the cubic STEP."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import friction as oracle
from mdlgen.results.result import Result

GRAVITY = 9.81
WANTED = 5e-3  # relative, of all closed forms here


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """Slopes on which it slides, slopes on which it creeps, and stopping on the level."""
    slides = [(20, 0.3), (30, 0.4)]
    creeps = [(20, 0.5, 1.0), (20, 0.5, 10.0), (10, 0.3, 1.0)]
    stops = [(1.5, 0.3), (0.8, 0.5)]
    if quick:
        slides, creeps, stops = slides[:1], creeps[:1], stops[1:]
    return [
        *(_slope(degrees, mu, 1.0, slide) for degrees, mu in slides),
        *(_slope(degrees, mu, smooth, creep) for degrees, mu, smooth in creeps),
        *(_stop(speed, mu) for speed, mu in stops),
    ]


def _slope(degrees: float, mu: float, smoothing: float, measure) -> BenchCase:
    angle = math.radians(degrees)
    x, z = GRAVITY * math.sin(angle), -GRAVITY * math.cos(angle)
    sets = (
        f"gravity=[{x!r} m/s^2, 0 m/s^2, {z!r} m/s^2]",
        f"contacts.0.friction={mu}",
        f"contacts.0.smoothing={smoothing} mm/s",
        "run.duration=200 ms",
    )
    name = f"{degrees:g} deg, mu {mu:g}: {measure.__name__}" + (
        f", smoothing {smoothing:g} mm/s" if measure is creep else ""
    )
    return BenchCase("friction", name, Run("verify/incline", sets), measure)


def _stop(speed: float, mu: float) -> BenchCase:
    sets = (f"contacts.0.friction={mu}", f"sheets.block.velocity=[{speed} m/s, 0 m/s, 0 m/s]")
    return BenchCase("friction", f"stops from {speed:g} m/s, mu {mu:g}", Run("verify/slide", sets), stop)


def _angle(result: Result) -> float:
    x, _, z = result.model.gravity
    return math.atan2(x, -z)


def slide(result: Result, _: Result | None) -> list[Finding]:
    """Mean acceleration over the second half of the run."""
    rate, half = result.velocity[:, 0, 0], len(result.time) // 2
    found = float((rate[-1] - rate[half]) / (result.time[-1] - result.time[half]))
    gravity = float(np.linalg.norm(result.model.gravity))
    mu = float(result.model.contacts.mu_dynamic[0])
    exact = oracle.slide_acceleration(gravity, _angle(result), mu)
    return [
        Finding("acceleration, relative", abs(found / exact - 1), WANTED, {"exact_m_per_s2": 1e3 * exact})
    ]


def creep(result: Result, _: Result | None) -> list[Finding]:
    """Speed at the end."""
    contacts = result.model.contacts
    exact = oracle.creep(_angle(result), float(contacts.mu_static[0]), float(contacts.stiction_velocity[0]))
    found = float(result.velocity[-1, 0, 0])
    return [Finding("speed, relative", abs(found / exact - 1), WANTED, {"exact_mm_per_s": 1e3 * exact})]


def stop(result: Result, _: Result | None) -> list[Finding]:
    """Way at the end of the run."""
    exact, found = slid(result)
    return [Finding("way, relative", abs(found / exact - 1), WANTED, {"exact_mm": exact})]


def slid(result: Result) -> tuple[float, float]:
    """Way that the block of verify/slide should have made at the end, and made [mm]."""
    model = result.model
    exact = oracle.slid(
        float(model.sheets[0].velocity[0]),
        float(model.contacts.mu_dynamic[0]),
        float(np.linalg.norm(model.gravity)),
        float(model.contacts.stiction_velocity[0]),
        float(result.time[-1]),
    )
    return exact, float(result.position[-1, 0, 0] - model.bodies.position[0, 0])

"""A static run: the load is applied in increments, each balanced before the next."""

from __future__ import annotations

import time as clock
from collections.abc import Callable

import numpy as np

from mdlgen.backends.lattice.arrays import System, partner
from mdlgen.backends.lattice.integrate.islands import groups
from mdlgen.backends.lattice.integrate.record import Recorder
from mdlgen.backends.lattice.integrate.there import There, Whole
from mdlgen.backends.lattice.integrate.work import begun_places
from mdlgen.backends.lattice.kernels import tuning
from mdlgen.backends.lattice.kernels.state import (
    ACTS,
    DEPTH_NOW,
    DEPTH_TIME,
    FORCE_NOW,
    FORCE_TIME,
    MAX_DEPTH,
    MAX_FORCE,
    TIME,
    Kept,
    Midpoint,
    State,
    Workspace,
)
from mdlgen.backends.lattice.kernels.tuning import (
    FEW_ITERATIONS,
    FIRST_PART,
    LEAST_PART,
    MANY_ITERATIONS,
    REST_MOST,
    TETHER,
)
from mdlgen.backends.lattice.statics import lying, standing
from mdlgen.mechanics.arm import FORCE_0
from mdlgen.mechanics.frame import RADIUS, Motion
from mdlgen.mechanics.mesh import LOST
from mdlgen.mechanics.point import DEPTH, PRESSING
from mdlgen.mechanics.roller_plate import DEEP_ROLLER
from mdlgen.model import curves
from mdlgen.model.overlaps.unheld import Unheld
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import BOX_GUIDE, BOX_PLANE, GROUND, ON_PARTS, Model, SheetPart
from mdlgen.results.result import Result


def rest(model: Model, system: System, work: Workspace) -> Result:
    """The Result of a Model at rest, from its start, for which the arrays of `work` are set."""
    from mdlgen.backends.lattice.kernels import entries
    from mdlgen.backends.lattice.kernels.linear.band import PAD

    state, mid, kept = work.state, work.mid, work.kept
    x, r, s = place = (state.x, state.r, state.s)
    state.v[:] = 0.0
    state.l[:] = 0.0
    lists = (mid.touched, mid.results, mid.near)
    still = np.zeros_like(x)
    load = _load(model, system)
    loose = _loose(model)
    found = lying.holds(model, loose, load)
    grip = lying.Grip(lying.held(model, system, found))
    tables = grip.system.tables
    entries.remember(tables.bodies, system.pairs, tables.shapes, Motion(x, r, still, still))
    size = (system.border, 6 * (system.reach + 1) + PAD)
    held = (TETHER if len(found) < len(loose) else 0.0, _reach(model))

    def balanced(level: float, load: float) -> tuple[bool, int, int, float]:
        iterations, worst, left = 0, -1, 0.0
        for _ in range(tuning.MOST_GRIPS):
            done, more, worst, left = entries.equilibrium(tables, size, level, load, *held, place, lists)
            iterations += more
            if not done or not grip.acts or level == 0.0:
                return done, iterations, worst, left
            left = grip.changed(level, x, r, mid) / load
            if left <= tuning.STEADY:
                return True, iterations, worst, left
        return False, iterations, worst, left

    def falls(level: float) -> int:
        nodes, (border, height) = len(system.nodes), size
        matrix = np.zeros((nodes, 6, height)), np.zeros((border, 6 * nodes)), np.zeros((border, border))
        if entries.stands(tables, level, held[0], tuning.STANDS, place, lists, matrix):
            return 0
        return standing.falling(*matrix)

    given = [array.copy() for array in place]

    def stable(level: float) -> bool:
        kept = [array.copy() for array in place]
        for array, old in zip(place, given, strict=True):
            array[:] = old
        found = balanced(level, load)[0] and falls(level) == 0
        for array, old in zip(place, kept, strict=True):
            array[:] = old
        return found

    # compiles, or loads from the cache, before the clock starts: relative to such a load all is in balance
    balanced(0.0, np.inf)
    falls(0.0)
    begun = clock.perf_counter()
    reason = _parts(model, balanced, load, place)
    if reason is None:
        reason = _stretched(model, system, x, r) or _touch(model, system, state, mid, kept)
        reason = reason or lying.slides(model, (system, grip.system), found, load, place, mid)
        reason = reason or _outside(model, x) or Unheld(model).found(x, r, 0.0)
    if reason is None and (ways := falls(1.0)) > 0:
        reason = standing.reason(ways, standing.begins(stable))
    wall = clock.perf_counter() - begun
    recorder = Recorder(model, system, work, Whole(There(), *begun_places(model)))
    recorder.store(0.0)
    result = recorder.result("lattice", reason, np.zeros((groups(work), 4)))
    result.wall_s, result.steps = wall, 0
    return result


def _parts(model: Model, balanced: Callable, load: float, place: tuple) -> str | None:
    """Brings the whole load into balance, in increments of variable size. Returns a reason where that fails;
    then the place is the last one in balance."""
    level, part, iterations = 0.0, FIRST_PART, 0
    reason = None
    while level < 1.0 and iterations < REST_MOST:
        aim = min(1.0, level + part)
        kept = [array.copy() for array in place]
        found, more, worst, left = balanced(aim, load)
        iterations += more
        if found:
            level, part, reason = aim, 2 * part if more <= FEW_ITERATIONS else part, None
            continue
        reason = _outside(model, place[0]) or _unbalanced(model, level, aim, worst, left * load)
        for array, old in zip(place, kept, strict=True):
            array[:] = old
        part *= 0.25
        if part < LEAST_PART or iterations > MANY_ITERATIONS:
            break
    if level < 1.0 and reason is None:
        reason = f"no balance was found above {100 * level:.3g} % of the load in {iterations} iterations"
    return reason


def _unbalanced(model: Model, level: float, aim: float, worst: int, force: float) -> str:
    """Reason why a part of the load has no balance."""
    loose = "; at rest friction holds sheets on fixed planes alone" if len(model.pairs) else ""
    return (
        f"no balance was found above {100 * level:.3g} % of the load: at {100 * aim:.3g} % {force:.3g} N are "
        f"left on {model.bodies.name[worst]}{loose}"
    )


def _load(model: Model, system: System) -> float:
    """Force that scales residuals [N]: the weight, the loads, or a moment over a sheet's length; where there
    are none, the springs' preload."""
    weight = float(system.bodies["mass"][system.nodes].sum() * np.linalg.norm(system.gravity))
    length = max(max(s.size) for s in model.sheets)
    forces = [float(np.linalg.norm(row["force"])) for row in system.loads]
    moments = [float(np.linalg.norm(row["moment"])) / length for row in system.loads]
    springs = float(np.abs(system.bodies["press"][:, FORCE_0]).max())
    return max(weight, *forces, *moments, 0.0) or max(springs, 1e-12)


def _loose(model: Model) -> list[SheetPart]:
    """The sheets that no bushing holds to the ground or to a fixed box."""
    held, loose = (model.bushings.a == GROUND) | model.bodies.fixed[model.bushings.a], []
    for sheet in model.sheets:
        ends = model.bushings.b[held]
        fixed = model.bodies.fixed[sheet.first : sheet.first + sheet.count]
        if not (fixed.any() or ((ends >= sheet.first) & (ends < sheet.first + sheet.count)).any()):
            loose.append(sheet)
    return loose


def _reach(model: Model) -> float:
    """The longest step [mm]: half of the distance that would take a box through a contact."""
    return min((kind_of(part).half_depth(part) for part in model.machine), default=np.inf)


def _touch(model: Model, system: System, state: State, mid: Midpoint, kept: Kept) -> str | None:
    """Writes contacts at rest into the rows of the Recorder. Returns a reason where a box is too deep in a
    plane."""
    from mdlgen.backends.lattice.kernels import entries

    still = np.zeros_like(state.x)
    count = entries.contacts(system.tables, Motion(state.x, state.r, still, still), mid)
    for k in range(count):
        pair, force, depth = system.pairs[mid.touched[k]], mid.results[k, PRESSING], mid.results[k, DEPTH]
        plate = pair["kind"] in (BOX_GUIDE, BOX_PLANE)
        most = system.bodies["half"][pair["b"], 2] if plate else LOST
        if pair["kind"] in ON_PARTS:
            most = DEEP_ROLLER * system.bodies["size"][pair["a"], RADIUS]
        if depth > most:
            return f"{model.too_deep(int(pair['a']), partner(model, pair))} at rest; give a stiffer contact"
        kept.marks[mid.touched[k]] = True
        row = kept.rows[pair["row"]]
        # integrals are over a time of 1
        row[[MAX_FORCE, FORCE_TIME, FORCE_NOW]] += force
        row[[MAX_DEPTH, DEPTH_TIME, DEPTH_NOW]] = max(row[MAX_DEPTH], depth)
        row[[TIME, ACTS]] = 1.0
    return None


def _stretched(model: Model, system: System, x: np.ndarray, r: np.ndarray) -> str | None:
    """Reason where a joint is beyond its curve, or None."""
    from mdlgen.backends.lattice.kernels.entries import overstretched

    joint, strain = overstretched(system.points, system.joints, x, r)
    return None if joint < 0 else curves.overstretched(model, int(system.joints["row"][joint]), float(strain))


def _outside(model: Model, x: np.ndarray) -> str | None:
    """Reason where a body is outside of the bounds for which its contacts were chosen, or None."""
    pairs = model.pairs
    there = x[: len(pairs.low)]
    out = ((there < pairs.low) | (there > pairs.high)).any(axis=1)
    if not out.any():
        return None
    body = int(np.argmax(out))
    bounds, advice = model.bounds_of(body)
    return f"{model.bodies.name[body]} goes beyond {bounds} before it rests; {advice}"

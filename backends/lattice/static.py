"""A static run: the load in parts, each in balance before the next."""

from __future__ import annotations

import time as clock
from collections.abc import Callable

import numpy as np

from mdlgen.backends.lattice import lying, standing
from mdlgen.backends.lattice.arrays import System, partner
from mdlgen.backends.lattice.record import Recorder
from mdlgen.mechanics.mesh import LOST
from mdlgen.mechanics.pair import DEEP_ROLLER
from mdlgen.model import curves
from mdlgen.model.tables import BOX_GUIDE, BOX_PLANE, GROUND, ON_PARTS, Model, SheetPart
from mdlgen.model.unheld import Unheld
from mdlgen.results.result import Result

FIRST_PART = 1.0  # of the load
LEAST_PART = 1e-4
FEW = 30  # rounds up to which a part grows
MANY = 2000  # rounds after which a part that fails ends the run
# Rounds after which no other part is begun: a hard sheet bent both ways takes many that do not fail.
MOST = 200_000
# Of the stiffest: holds sheets that lie on contacts only along what does not hold them.
TETHER = 1e-9


def rest(model: Model, system: System, moving: tuple) -> Result:
    """The Result of a Model at rest; `moving` is (state, mid, matrix) at the start."""
    from mdlgen.backends.lattice.kernels import entries
    from mdlgen.backends.lattice.kernels.band import PAD

    state, mid, _ = moving
    x, r, v, l, s = state[:5]
    v[:] = 0.0
    l[:] = 0.0
    lists = (mid[5], mid[6], mid[8])
    load = _load(model, system)
    loose = _loose(model)
    found = lying.holds(model, loose, load)
    grip = lying.Grip(lying.held(model, system, found))
    tables = grip.system.tables
    entries.remember(tables[0], system.pairs, x, r)
    size = (system.border, 6 * (system.reach + 1) + PAD)
    held = (TETHER if len(found) < len(loose) else 0.0, _reach(model))

    def balanced(level: float, load: float) -> tuple[bool, int, int, float]:
        rounds, worst, left = 0, -1, 0.0
        for _ in range(lying.MOST_GRIPS):
            done, more, worst, left = entries.equilibrium(tables, *size, level, load, *held, x, r, s, lists)
            rounds += more
            if not done or not grip.acts or level == 0.0:
                return done, rounds, worst, left
            left = grip.changed(level, x, r, (mid[4], *lists)) / load
            if left <= lying.STEADY:
                return True, rounds, worst, left
        return False, rounds, worst, left

    def falls(level: float) -> int:
        nodes, (border, height) = len(system.nodes), size
        matrix = np.zeros((nodes, 6, height)), np.zeros((border, 6 * nodes)), np.zeros((border, border))
        if entries.stands(tables, level, held[0], standing.SLOW, x, r, s, lists, matrix):
            return 0
        return standing.falling(*matrix)

    given = [array.copy() for array in (x, r, s)]

    def stable(level: float) -> bool:
        kept = [array.copy() for array in (x, r, s)]
        for array, old in zip((x, r, s), given, strict=True):
            array[:] = old
        found = balanced(level, load)[0] and falls(level) == 0
        for array, old in zip((x, r, s), kept, strict=True):
            array[:] = old
        return found

    # compiles, or loads from the cache, before the clock starts: against such a load all is in balance
    balanced(0.0, np.inf)
    falls(0.0)
    begun = clock.perf_counter()
    reason = _parts(model, balanced, load, (x, r, s))
    rows = (np.zeros((len(model.contacts), 10)), np.zeros(len(system.pairs), bool))
    if reason is None:
        reason = _stretched(model, system, x, r) or _touch(model, system, state, mid, rows)
        reason = reason or lying.slides(model, found, rows[0][:, 5], load, x, r)
        reason = reason or _outside(model, x) or Unheld(model).found(x, r, 0.0)
    if reason is None and (ways := falls(1.0)) > 0:
        reason = standing.reason(ways, standing.begins(stable))
    wall = clock.perf_counter() - begun
    recorder = Recorder(model, system, system.tables, state, mid, rows)
    recorder.store(0.0)
    result = recorder.result("lattice", reason, np.zeros(4))
    result.wall_s, result.steps = wall, 0
    return result


def _parts(model: Model, balanced: Callable, load: float, place: tuple) -> str | None:
    """Brings the whole load into balance, in larger or smaller parts as it goes; a reason where that fails,
    and the last place in balance."""
    level, part, rounds = 0.0, FIRST_PART, 0
    reason = None
    while level < 1.0 and rounds < MOST:
        aim = min(1.0, level + part)
        kept = [array.copy() for array in place]
        found, more, worst, left = balanced(aim, load)
        rounds += more
        if found:
            level, part, reason = aim, 2 * part if more <= FEW else part, None
            continue
        reason = _outside(model, place[0]) or _unbalanced(model, level, aim, worst, left * load)
        for array, old in zip(place, kept, strict=True):
            array[:] = old
        part *= 0.25
        if part < LEAST_PART or rounds > MANY:
            break
    if level < 1.0 and reason is None:
        reason = f"no balance was found above {100 * level:.3g} % of the load in {rounds} iterations"
    return reason


def _unbalanced(model: Model, level: float, aim: float, worst: int, force: float) -> str:
    """Why a part of the load has no balance."""
    loose = ", and friction holds nothing at rest" if len(model.pairs) else ""
    return (
        f"no balance was found above {100 * level:.3g} % of the load: at {100 * aim:.3g} % {force:.3g} N are "
        f"left on {model.bodies.name[worst]}{loose}"
    )


def _load(model: Model, system: System) -> float:
    """What residuals are measured by [N]: the weight, the loads, or a moment over a sheet's length; where
    there are none, the springs' preload."""
    weight = float(system.bodies["mass"][system.nodes].sum() * np.linalg.norm(system.gravity))
    length = max(max(s.size) for s in model.sheets)
    forces = [float(np.linalg.norm(row["force"])) for row in system.loads]
    moments = [float(np.linalg.norm(row["moment"])) / length for row in system.loads]
    springs = float(np.abs(system.bodies["press"][:, 2]).max())
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
    """The longest step [mm]: half of what a box would have to cross to be behind a contact."""
    depths = [float(model.bodies.half[plane.body, 2]) for plane in model.planes]
    depths += [0.5 * guide.thickness for guide in model.guides] + [0.5 for _ in model.meshes]
    radii = [0.5 * roller.radius for roller in model.rollers]
    return min([*depths, *radii], default=np.inf)


def _touch(model: Model, system: System, state: tuple, mid: tuple, rows: tuple) -> str | None:
    """Contacts at rest into the rows of the Recorder; a reason where a box is too deep in a plane."""
    from mdlgen.backends.lattice.kernels import entries

    x, r = state[:2]
    f, touched, outs, near = mid[4], mid[5], mid[6], mid[8]
    still = np.zeros_like(x)
    count = entries.contacts(system.bodies, system.pairs, system.meshes, x, r, still, f, touched, outs, near)
    table, marks = rows
    for k in range(count):
        pair, force, depth = system.pairs[touched[k]], outs[k, 12], outs[k, 15]
        plate = pair["kind"] in (BOX_GUIDE, BOX_PLANE)
        most = system.bodies["half"][pair["b"], 2] if plate else LOST
        if pair["kind"] in ON_PARTS:
            most = DEEP_ROLLER * system.bodies["size"][pair["a"], 0]
        if depth > most:
            return f"{model.too_deep(int(pair['a']), partner(model, pair))} at rest; give a stiffer contact"
        marks[touched[k]] = True
        row = table[pair["row"]]
        # greatest, sums over a time of 1, now; and it acts
        row[[1, 3, 5]] += force
        row[[0, 2, 6]] = max(row[0], depth)
        row[[4, 7]] = 1.0
    return None


def _stretched(model: Model, system: System, x: np.ndarray, r: np.ndarray) -> str | None:
    """A reason where a joint is beyond its curve."""
    from mdlgen.backends.lattice.kernels.entries import overstretched

    joint, strain = overstretched(system.points, system.joints, x, r)
    return None if joint < 0 else curves.overstretched(model, int(system.joints["row"][joint]), float(strain))


def _outside(model: Model, x: np.ndarray) -> str | None:
    """A reason where a body is outside of the bounds from which its contacts were chosen."""
    pairs = model.pairs
    there = x[: len(pairs.low)]
    out = ((there < pairs.low) | (there > pairs.high)).any(axis=1)
    if not out.any():
        return None
    body = int(np.argmax(out))
    bounds, advice = model.bounds_of(body)
    return f"{model.bodies.name[body]} goes beyond {bounds} before it rests; {advice}"

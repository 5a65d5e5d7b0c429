"""What a run of the lattice solver works on, by names; the columns of its arrays of numbers.

Named tuples of arrays: compiled code takes them as they are.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.turning import TURNING

Floats = np.ndarray
Ints = np.ndarray


class Tables(NamedTuple):
    """What a run is of: records as in lattice.arrays. Steps change none but pairs that are searched."""

    bodies: np.ndarray
    joints: np.ndarray
    pairs: np.ndarray
    loads: np.ndarray
    gravity: Floats  # (3,) [mm/ms^2]
    nodes: Ints  # the body of each free box
    points: np.ndarray  # of curves
    images: np.ndarray  # mirrored boxes
    meshes: Any  # mechanics.mesh.Meshes


class State(NamedTuple):
    """Where a step begins: places, rotations; of nodes velocities and angular momenta; of the border (slides
    and spins) slides and rates. And the velocities in its middle, which are solved for."""

    x: Floats  # (bodies, 3) [mm]
    r: Floats  # (bodies, 9)
    v: Floats  # (nodes, 3) [mm/ms]
    l: Floats  # (nodes, 3) [N mm ms]
    s: Floats  # (border,) [mm]
    vb: Floats  # (border,) [mm/ms, rad/ms]
    u: Floats  # (nodes, 6), velocity and angular velocity
    ub: Floats  # (border,)


class Midpoint(NamedTuple):
    """The middle of a step: motion of all bodies, forces and torques on them, contacts, pairs near."""

    motion: Motion
    forces: Floats  # (bodies, 6) [N, N mm]
    touched: Ints  # pairs that touch
    results: Floats  # what each of them does, see mechanics.point, (pairs, forces.WIDE)
    totals: Floats  # (3,) LOST, POWER, NUMERICAL
    near: Ints  # pairs that may touch
    overlaps: np.ndarray  # of pairs that are searched, mechanics.overlap.OVERLAP
    fastest: Floats  # how fast places of free boxes are at most, MIDDLE and ENDS of a step, (2, bodies)


MIDDLE, ENDS = 0, 1
# Of the energies of a state [N mm], see observe.ledger.
KINETIC, ELASTIC, POTENTIAL = 0, 1, 2
# Of Midpoint.totals [N mm/ms]: dissipated, put in by loads, dissipated by the numerical damping of joints.
LOST, POWER, NUMERICAL = 0, 1, 2


class Matrix(NamedTuple):
    """The tangent of a step: a band, bordered by the unknowns of rollers and plates, and its residual."""

    band: Floats  # of the nodes, see linear.band
    border: Floats  # (border, 6 nodes)
    corner: Floats  # (border, border)
    eliminated: Floats  # band^-1 border^T, row by row
    schur: Floats  # Cholesky factor of the corner's Schur complement
    res: Floats  # (6 nodes,)
    resb: Floats  # (border,)
    direction: Floats  # (4, 3) scratch: how a pair's rollers move a point
    unknowns: Ints  # (4,) scratch: which unknowns these are
    couplings: Any  # coupled.Couplings
    mixing: Floats  # changes of the iteration before: as found, as taken, (2, 6 nodes + border)
    offsets: Ints  # how many nodes apart two may be that a joint couples, from 0 on


class Free(NamedTuple):
    """Sheets that hang on nothing, see momentum.keep."""

    label: Ints  # (nodes,) sheet of each node
    loose: np.ndarray  # (sheets,) whether a sheet hangs on nothing
    busy: np.ndarray  # (sheets,) whether it touches something now
    residual: Floats  # (6 nodes,)
    one_with: Ints  # (sheets,) which sheet it is one with now


class Kept(NamedTuple):
    """What contacts did in a run so far."""

    rows: Floats  # (contacts, ROW)
    marks: np.ndarray  # (pairs that there can be,) which have touched


# Of Kept.rows: greatest depth and force; sums over time of both; time in contact; force and depth in the last
# step; whether it acts; when it last ended to; force where the first step of a call of `integrate.run` began;
# what mechanics.turning has of the last step, and where that first step began.
MAX_DEPTH, MAX_FORCE, DEPTH_TIME, FORCE_TIME, TIME = 0, 1, 2, 3, 4
FORCE_NOW, DEPTH_NOW, ACTS, ENDED, FORCE_BEGUN, TURNING_NOW, TURNING_BEGUN = 5, 6, 7, 8, 9, 10, 10 + TURNING
ROW = TURNING_BEGUN + TURNING


class Bounds(NamedTuple):
    """Where bodies may be, (bodies, 3) [mm]."""

    low: Floats
    high: Floats


class Damped(NamedTuple):
    """Joints with a damping time, see integrate.damped."""

    joints: np.ndarray
    band: Floats
    made: Floats  # (2,) the step that the band was factored for, how many steps ago
    off: Floats  # (nodes, 6) velocities to take off


class Workspace(NamedTuple):
    """All arrays of a run."""

    tables: Tables
    state: State
    mid: Midpoint
    matrix: Matrix
    condensed: Any  # condensed.Condensed
    free: Free
    kept: Kept
    bounds: Bounds
    search: Any  # lattice.search.Search
    damped: Damped
    pool: Any  # parallel.Pool


class History(NamedTuple):
    """What the velocities of a step are guessed from: those of the step before the last, and SPANS."""

    u: Floats  # (nodes, 6)
    ub: Floats  # (border,)
    spans: Floats  # (2,) size of the last step; from its middle to that of the one before, 0: there is none


LAST_STEP, BETWEEN = 0, 1


class Control(NamedTuple):
    """What a run counts and is steered by."""

    factored: Floats  # (6,) MADE_FOR, STALE, WHERE, CALM, IMBALANCE, THEN
    counters: Floats  # (COUNTERS,)
    energies: Floats  # (4,) DISSIPATED, DRIVEN, THROUGH_DRIVES, DAMPED_NUMERICALLY [N mm]
    history: History
    pace: Floats  # (5,) LEVEL, MISS, ANEW, FASTEST, MADE


# Of Control.factored: the step that the factor was made for (0: none), whether it is to be made anew, and
# where contacts stand (condensed.APART, PLANES or INSIDE); of a pile that rests, how many steps may yet go by
# without a solve, and what the last one found: what free boxes would change by, and how many pairs touched.
MADE_FOR, STALE, WHERE, CALM, IMBALANCE, THEN = 0, 1, 2, 3, 4, 5
# Of Control.counters. WORST names the body, pair or joint of a failure, STRAIN is that of a joint beyond its
# curve, THROUGH the pair of two sheets that a step would take through each other, or -1.
STEPS, ITERATIONS, FACTORS, TOUCHING, WORST, STRAIN, THROUGH, CLOSE, COUNTERS = 0, 1, 2, 3, 4, 5, 6, 7, 8
# Of Control.energies; the third adds up what drives and loads moved either way.
DISSIPATED, DRIVEN, THROUGH_DRIVES, DAMPED_NUMERICALLY = 0, 1, 2, 3
# Of Control.pace: how often steps are halved now; what velocities may miss their guess by (0: anything);
# whether each step has a factor of its own; the greatest speed so far [mm/ms]; which part of the energy that
# passes through the run contacts may make or lose in one step (0: any).
LEVEL, MISS, ANEW, FASTEST, MADE = 0, 1, 2, 3, 4

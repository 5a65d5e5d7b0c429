"""Records of arrays on which a run of the lattice solver works, and the columns of these arrays.

Records are named tuples of arrays: compiled code takes them as they are.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.over_time import Changing
from mdlgen.mechanics.overlap import MOST_CORNERS
from mdlgen.mechanics.turning import TURNING

Floats = np.ndarray
Ints = np.ndarray


class Tables(NamedTuple):
    """The scene of a run, in records as in lattice.arrays. Steps change only the pairs that are searched, and
    the loads and gravity that `changes` names."""

    bodies: np.ndarray
    joints: np.ndarray
    pairs: np.ndarray
    listed: np.ndarray  # lattice.search.LISTED, of the last pairs in `pairs`, which are searched
    loads: np.ndarray
    gravity: Floats  # (3,) [mm/ms^2]
    nodes: Ints  # the body of each free box
    boxes: Floats  # its most used values, OWN_MASS to OWN_INERTIA, (nodes, OWN)
    moving: Ints  # bodies that turn or slide: rollers and pressed plates
    runs: Ints  # consecutive joints of one sheet: the first, the end, and SHEET, (runs, 3)
    thinnest: float  # half thickness of the thinnest box of sheets that may touch each other [mm]
    points: np.ndarray  # points of curves.
    images: np.ndarray  # mirrored boxes.
    bristles: np.ndarray  # bristles of contact patches where friction sticks, mechanics.bristle.BRISTLE.
    held: np.ndarray  # pairs in these, mechanics.bristle.HELD.
    hinges: np.ndarray  # joints that yield, mechanics.plastic.HINGE.
    shapes: Any  # mechanics.shapes.Shapes
    corners: np.ndarray  # mechanics.corner.CORNER
    changes: Changing  # loads and gravity over time, which each step sets


SHEET = 2  # column of Tables.runs
# Columns of Tables.boxes, a compact copy: a record of a body takes eleven lines of a processor's cache. Mass
# [N ms^2/mm]; half length plus half width, half the diagonal [mm]; three moments of inertia [N mm ms^2].
OWN_MASS, OWN_SIZE, OWN_REACH, OWN_INERTIA, OWN = 0, 1, 2, 3, 6


class State(NamedTuple):
    """State at the beginning of a step, and the velocities in its middle, which are solved for. The border
    has the slides and spins of rollers and plates."""

    x: Floats  # places, (bodies, 3) [mm].
    r: Floats  # rotations, (bodies, 9).
    v: Floats  # velocities, (nodes, 3) [mm/ms].
    l: Floats  # angular momenta, (nodes, 3) [N mm ms].
    s: Floats  # slides, (border,) [mm].
    vb: Floats  # rates, (border,) [mm/ms, rad/ms].
    u: Floats  # velocity and angular velocity in the middle, (nodes, 6).
    ub: Floats  # rates in the middle, (border,).


class Sticks(NamedTuple):
    """Stretches where friction of two sheets sticks; no pairs: it sticks nowhere. See contact.sticking."""

    pairs: np.ndarray  # stretches of the pairs that are searched, mechanics.stick.STRETCH.
    aside: np.ndarray  # their copies during the next search of pairs.
    head: Ints  # (bodies,) first copy of which a box is the first box, -1: none.
    following: Ints  # next copy of the same box.
    half: Floats  # (1,) half of the step [ms].


class Drift(NamedTuple):
    """Distances that sheets have moved, and the last checks of their overlaps; see contact.drift."""

    ends: Ints  # (regions, 2) the sheets of each, -1: it sleeps.
    moved: Floats  # (sheets,) bound on the path of any place of each, summed over steps [mm].
    rates: Floats  # (sheets,) bound on their speed in an iteration [mm/ms].
    looked: Floats  # (regions,) lower bound on both paths before the step of the last check [mm].
    looks: Ints  # (regions,) number of checks.
    listed: Ints  # searched pairs that were near when the list was built.
    list_moved: Floats  # (regions,) lower bound on both paths before the list was built [mm].
    list_holds: Floats  # (3,) MANY, MARGIN, SLACK of the list.


# Columns of Drift.list_holds: number of pairs in the list, the margin within which they were near, and how
# much nearer pairs may have come since, -1: the list is invalid [mm].
MANY, MARGIN, SLACK = 0, 1, 2


class Midpoint(NamedTuple):
    """State in the middle of a step: motion of all bodies, forces on them, contacts and near pairs."""

    motion: Motion
    forces: Floats  # forces and torques, (bodies, 6) [N, N mm].
    touched: Ints  # pairs that touch.
    results: Floats  # results of their contacts, see mechanics.point, (pairs, forces.WIDE).
    rows: Ints  # row of each of them in `results`: pairs without points have none.
    faces: Floats  # results of two boxes of two sheets that are read later, (pairs, FACE).
    totals: Floats  # (2,) LOST of contacts and air, and POWER.
    spent: Floats  # LOST of the joints of each of Tables.runs, and its part NUMERICAL, (runs, 2).
    near: Ints  # pairs that may touch.
    overlaps: np.ndarray  # overlaps of pairs that are searched, mechanics.overlap.OVERLAP.
    spare: np.ndarray  # overlap of one pair between steps, (1,).
    does: Ints  # action of each near pair of two boxes: CLEAR, PRESSES, BY_SIDES of mechanics.overlap.
    lies: np.ndarray  # (pairs,) true where a face of one box lies over the other.
    fastest: Floats  # bound on the speed of free boxes, MIDDLE and ENDS of a step, (2, bodies).
    sticks: Sticks
    drift: Drift


MIDDLE, ENDS = 0, 1
# Columns of Midpoint.faces: force along normals, greatest depth, magnitude of friction along the faces and
# its limit; number of points in the results, 0: none are needed; stored energy, dissipated power.
FACE_FORCE, FACE_DEPTH, FACE_RUBBING, FACE_GRIP, FACE_POINTS, FACE_STORED, FACE_LOST, FACE = range(8)
# Columns of the energies of a state [N mm], see observe.ledger.
KINETIC, ELASTIC, POTENTIAL = 0, 1, 2
# Columns of Midpoint.totals and Midpoint.spent [N mm/ms]: power that is dissipated, that loads put in, and
# that the numerical damping of joints dissipates.
LOST, POWER, NUMERICAL = 0, 1, 1


class Matrix(NamedTuple):
    """The tangent of a step: a band, bordered by the unknowns of rollers and plates, and its residual."""

    band: Floats  # band of the nodes, see linear.band.
    border: Floats  # (border, 6 nodes).
    corner: Floats  # (border, border).
    eliminated: Floats  # band^-1 border^T, row by row.
    schur: Floats  # Cholesky factor of the corner's Schur complement.
    res: Floats  # (6 nodes,).
    resb: Floats  # (border,).
    direction: Floats  # (4, 3) scratch: directions in which a pair's rollers move a point.
    unknowns: Ints  # (4,) scratch: numbers of these unknowns.
    couplings: Any  # coupled.Couplings.
    mixing: Floats  # changes and velocities of iterations (mixing.ROWS, 6 nodes + border).
    gram: Floats  # (MIXED, MIXED) scratch: products of the differences of changes.
    parts: Floats  # (2, MIXED) scratch: mixing coefficient of each, and its scale.
    # Masses and bushings alone, in box axes, used where contacts are in the band. Each column has the blocks
    # of `offsets` alone, (nodes, 6, 6 offsets).
    inner: Floats
    own: Floats  # corner of the rollers alone.
    # Single precision, which is read in half the time: the factor with contacts, and `inner`.
    single_factor: np.ndarray
    single_inner: np.ndarray
    offsets: Ints  # distances in nodes between two nodes that a joint couples, from 0 on.
    # Number of the block of a column for each distance in nodes, (reach + 1,): in the band, and in `inner`.
    slots: Ints
    inner_slots: Ints


class Frozen(NamedTuple):
    """Contact points of an iteration, whose geometry is frozen, and the vectors of its convex problem; see
    integrate.points and integrate.convex."""

    points: Floats  # (capacity, POINT).
    patches: np.ndarray  # PATCH.
    pair: Ints  # pair of each point, (capacity,).
    ends: np.ndarray  # ENDS_OF_POINT of each.
    many: Ints  # (3,) numbers of points, of patches, and of patches with corners.
    lying: Ints  # numbers of the patches that have corners, rising, (patches,).
    of_patches: Floats  # (1,) part of the slope due to patches, where they were evaluated last.
    vectors: Floats  # CHANGE to RESIDUAL of the nodes, (6, 6 nodes).
    border: Floats  # CHANGE to RESIDUAL of the border, (6, border).
    block: Floats  # (1, 6, 6) scratch: decrease of a patch's force per relative motion of its boxes.


# The bodies of a point's pair and their nodes, -1: none.
ENDS_OF_POINT = np.dtype([("a", "i4"), ("b", "i4"), ("one", "i8"), ("two", "i8")])
# Rows of Frozen.vectors: the change of velocities; its product with the matrix of masses and bushings; the
# gradient of the minimised function; the search direction; its product with the same matrix; the residual at
# the beginning of the iteration.
CHANGE, OF_CHANGE, GRADIENT, DIRECTION, OF_DIRECTION, RESIDUAL = 0, 1, 2, 3, 4, 5
# Columns of Frozen.points. First the most used ones, close together in memory: arms from both bodies, kind,
# change of velocity along a direction. Then velocity of the first body against the second; normal to the
# first body; direction that friction is perpendicular to; elastic force and its growth; rate, speed over
# which it damps, share of damping; friction and its speeds; normal force that limits it; initial force.
ARM_A, ARM_B, KIND, ALONG, NOW, NORMAL, SQUARE = 0, 3, 6, 7, 10, 13, 16
SPRING, GROWTH, RATE, OVER, BETA = 19, 20, 21, 22, 23
MU_STATIC, MU_DYNAMIC, STICTION, SLIDING, PRESSING = 24, 25, 26, 27, 28
START, HOLD, FIELD, POINT = 29, 32, 33, 36
# HOLD of a point whose friction depends on the direction: FIELD is its stretch (mechanics.measured).
STRETCHED = -1.0
# Kinds of points: a contact with pressure and friction; a damper alone; a couple about its normal, of SPRING
# at most, with a rolling speed of GROWTH times the angular velocity; a cell of air. The force of a cell has
# changed by SPRING since the iteration began, changes by GROWTH along a direction, and OVER is the damping of
# the cell alone [N ms/mm].
A_PRESSURE, A_DAMPER, A_COUPLE, AIR = 0.0, 1.0, 2.0, 3.0

# Columns of the corners of a PATCH: place along and across the owner's face [mm], stiffness, depth without
# closing, and force at which friction slides; where it does not stick, that force per unit of coefficient.
LENGTHWISE, ACROSS, STIFF, DEPTH_AT_REST, GRIP, CORNER = 0, 1, 2, 3, 4, 5
# Contact of two boxes in integrate.patches.
PATCH = np.dtype(
    [
        ("a", "i4"),  # boxes and region, as of the pair (lattice.search.LISTED).
        ("b", "i4"),
        ("region", "i4"),
        ("pair", "i4"),  # number of the pair among those that are searched.
        ("owner", "i4"),  # body whose face owns the contact, and the other one.
        ("other", "i4"),
        ("one", "i4"),  # nodes of the owner and the other, -1: none.
        ("two", "i4"),
        ("coupled", "i4"),  # coupling of these, -1: none.
        ("count", "i2"),  # number of corners.
        ("side", "i2"),  # side of the owner's face along its normal.
        ("ratio", "f8"),  # k_t/k, 0: friction does not stick [mm^0.5].
        ("high", "f8"),  # height of all corners along the owner's normal [mm].
        ("place", "f8", 3),  # place of the other box in the owner's axes [mm].
        ("now", "f8", 6),  # rate and spin of the owner against the other box at the owner's middle.
        ("along", "f8", 6),  # change of these along a direction.
        ("begun", "f8", 6),  # force and torque on the owner at the beginning of the iteration.
        ("does", "f8", 6),  # force and torque on the owner where they were evaluated last.
        ("corners", "f8", (MOST_CORNERS, CORNER)),
    ]
)


class Free(NamedTuple):
    """Free sheets, which no joint holds, see momentum.keep."""

    label: Ints  # (nodes,) sheet of each node.
    sheet: Ints  # (bodies,) sheet of each body, -1: it is not free.
    loose: np.ndarray  # (sheets,) true where no joint holds a sheet on another body.
    busy: np.ndarray  # (sheets,) true where it, or a sheet that it touches, touches another kind of body.
    alone: np.ndarray  # (sheets,) true where it is loose and touches nothing.
    residual: Floats  # (6 nodes,).
    one_with: Ints  # (sheets,) sheet that represents its group of touching sheets.
    cut: np.ndarray  # (sheets,) true for one half of a sheet, joined to its mirror image.
    normal: Floats  # (3,) normal of the plane that halves it.
    lets: Floats  # (2, sheets + border) BEFORE and AFTER: see momentum.let_go.


# Rows of Free.lets: for the residual at the beginning of an iteration, and for the one after its change.
BEFORE, AFTER = 0, 1


class Kept(NamedTuple):
    """History of the contacts in a run."""

    rows: Floats  # (contacts, ROW).
    marks: np.ndarray  # (all possible pairs,) true where they have touched.


# Columns of Kept.rows: greatest depth and force; their integrals over time; time in contact; force and depth
# in the last step; 1 while it acts; time at which it last ended; force where the first step of a call of
# `integrate.run` began; values of mechanics.turning in the last step, and where that first step began.
MAX_DEPTH, MAX_FORCE, DEPTH_TIME, FORCE_TIME, TIME = 0, 1, 2, 3, 4
FORCE_NOW, DEPTH_NOW, ACTS, ENDED, FORCE_BEGUN, TURNING_NOW, TURNING_BEGUN = 5, 6, 7, 8, 9, 10, 10 + TURNING
ROW = TURNING_BEGUN + TURNING
# Columns of a stored row: its normal force, then the values of mechanics.turning.
PRESSES, TURNS = 0, 1


class Bounds(NamedTuple):
    """Bounds on the places of bodies, (bodies, 3) [mm]."""

    low: Floats
    high: Floats


class Damped(NamedTuple):
    """Joints with a damping time, see integrate.damped."""

    joints: np.ndarray
    band: Floats
    single: np.ndarray  # its factor in single precision, which is read in half the time.
    short: np.ndarray  # (6 nodes,) scratch of that precision.
    made: Floats  # (2,) step for which the band was factored [ms], and number of steps since.
    vectors: Floats  # (2, 6 nodes) PUSH and LEFT.
    place: Floats  # (bodies, 3) places at the end of a step [mm].
    off: Floats  # (nodes, 6) velocities to subtract.


class Film(NamedTuple):
    """Air between sheets, see integrate.air; no films: there is none."""

    films: np.ndarray  # mechanics.film.FILM, one for each contact with air.
    film_of: Ints  # film of each contact, -1: none.
    cells: np.ndarray  # mechanics.film.CELL, of all films.
    flow: Floats  # matrices of Reynolds' equation, (cells, band).
    factor: Floats  # their factors.
    ends: Floats  # factors at the ends of a step.
    vectors: Floats  # (4, cells) PRESSURES, and scratch.
    head: Ints  # first cell of each pair, -1: none.
    listed: Ints  # pairs that have cells.
    many: Ints  # (1,) number of these, 0 where no air acts.
    push: Floats  # (nodes, 6) forces of the pressures on boxes.
    place: Floats  # (bodies, 3) places at the end of a step [mm].
    off: Floats  # (nodes, 6) velocities to subtract at the end of a step.


PRESSURES = 0  # row of Film.vectors


class Islands(NamedTuple):
    """Parts, which are sheets and bodies that turn or slide, and the islands of those that touch; see
    integrate.islands."""

    part: Ints  # (bodies,) part of each body: sheets by their numbers first; -1: it does not move.
    of_border: Ints  # (border,) part of each unknown of the border.
    of_row: Ints  # (contacts,) part of each contact that forces move, -1: they move neither.
    answers: np.ndarray  # (parts,) true where forces move a part; the next arrays are (parts,), too.
    mass: Floats  # mass of a sheet; of a body that turns or slides, referred to a place on its rim [g].
    least: Floats  # least speed that scales the errors of a part [mm/ms].
    top: Ints  # part that represents its island.
    speed: Floats  # greatest speed of its island in the last step [mm/ms].
    given: Floats  # greatest speed of driven surfaces that touch it [mm/ms].
    energy: Floats  # energy of an island, at the part that represents it [N mm].
    scale: Floats  # speed that scales the errors of its step [mm/ms].
    strict: Floats  # divisor of the step's limits for it, relative to the fastest island.
    sums: Floats  # scratch.
    # Parts that may ever touch each other share a group, which has an energy balance of its own.
    group: Ints  # (parts,)
    group_of_row: Ints  # (contacts,)


class Asleep(NamedTuple):
    """Speeds of sheets on each other, and impulses that sleeping sheets miss; see integrate.sleep. No
    `speeds`: no sheets of the scene meet."""

    speeds: Floats  # (sheets,) greatest speed of any place of each since the last check [mm/ms].
    bodies: Ints  # boxes of sheets that sleep.
    missed: Floats  # impulses on them while they sleep, (those boxes, 6).
    may: Floats  # (1,) velocity that such impulses may give a box [mm/ms].
    rows: np.ndarray  # (contacts,) true where both sides of a contact sleep: its results are held.


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
    frozen: Frozen
    film: Film
    islands: Islands
    asleep: Asleep


class History(NamedTuple):
    """Velocities from which those of a step are guessed (integrate.guess): of the step before the last, and
    of the one before that."""

    u: Floats  # (nodes, 6).
    ub: Floats  # (border,).
    earlier: Floats  # (nodes, 6).
    spans: Floats  # (3,) LAST_STEP, BETWEEN, EARLIER [ms].
    missed: Floats  # (sheets, GUESSES) squared error of each guess in a sheet.


# Columns of History.spans: size of the last step; time from its middle to that of the step before, and from
# there to that of the step before that, 0: there is none.
LAST_STEP, BETWEEN, EARLIER = 0, 1, 2
# Columns of History.missed.
HALF, LINE, PARABOLA, GUESSES = 0, 1, 2, 3


class Control(NamedTuple):
    """Counters of a run, its energies and the control of its step."""

    factored: Floats  # (5,) columns MADE_FOR to SPENT.
    counters: Floats  # (COUNTERS,).
    energies: Floats  # (groups, 4) columns DISSIPATED to DAMPED_NUMERICALLY [N mm].
    history: History
    pace: Floats  # (7,) columns LEVEL to FLOOR.


# Columns of Control.factored: step of the factor (0: none) [ms]; 1 where it must be refactored; treatment of
# contacts (condensed.APART, PLANES or INSIDE); number of further steps with treatment INSIDE (see
# integrate.step); number of linear solves beyond one per step that the factor has served INSIDE.
MADE_FOR, STALE, WHERE, TOUGH, SPENT = 0, 1, 2, 3, 4
# Columns of Control.counters. WORST: body, pair or joint of a failure. STRAIN: strain of a joint beyond its
# curve. THROUGH: pair of two sheets that a step would take through each other, or -1. SOLVES: linear solves
# of iterations with frozen contacts. GIVEN_UP: steps that did not converge.
STEPS, ITERATIONS, FACTORS, TOUCHING, WORST, STRAIN, THROUGH, CLOSE, SOLVES, GIVEN_UP = range(10)
COUNTERS = 10
# Columns of Control.energies; the third sums the magnitudes of the energies of drives and loads.
DISSIPATED, DRIVEN, THROUGH_DRIVES, DAMPED_NUMERICALLY = 0, 1, 2, 3
# Columns of Control.pace: present number of halvings; allowed error of guessed velocities, relative to the
# speed of an island (0: any); 1 where each step has a factor of its own; greatest speed so far [mm/ms];
# allowed energy error of contacts in one step, relative to the energy of an island (0: any); limit on changes
# in the fastest island [mm/ms]; round-off of velocities in this step [mm/ms].
LEVEL, MISS, ANEW, FASTEST, MADE, LOOSE, FLOOR = 0, 1, 2, 3, 4, 5, 6

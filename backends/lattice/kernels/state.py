"""What a run of the lattice solver works on, by names; the columns of its arrays of numbers.

Named tuples of arrays: compiled code takes them as they are.
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
    """What a run is of: records as in lattice.arrays. Steps change none but pairs that are searched, and what
    `changes` of loads and gravity."""

    bodies: np.ndarray
    joints: np.ndarray
    pairs: np.ndarray
    listed: np.ndarray  # lattice.search.LISTED, of the last so many pairs, which are searched
    loads: np.ndarray
    gravity: Floats  # (3,) [mm/ms^2]
    nodes: Ints  # the body of each free box
    boxes: Floats  # and what is asked of it most often, OWN_MASS to OWN_INERTIA, (nodes, OWN)
    moving: Ints  # bodies that turn or slide: rollers and pressed plates
    runs: Ints  # joints of one sheet that follow each other: the first, the end, and SHEET, (runs, 3)
    thinnest: float  # half thickness of the thinnest box of sheets that may touch each other [mm]
    points: np.ndarray  # of curves
    images: np.ndarray  # mirrored boxes
    bristles: np.ndarray  # of contact patches where friction sticks, mechanics.bristle.BRISTLE
    held: np.ndarray  # the pairs in these, mechanics.bristle.HELD
    hinges: np.ndarray  # joints that yield, mechanics.plastic.HINGE
    shapes: Any  # mechanics.shapes.Shapes
    corners: np.ndarray  # mechanics.corner.CORNER
    changes: Changing  # loads and gravity over time, which each step sets


SHEET = 2  # column of Tables.runs
# Columns of Tables.boxes, which stand close together: a record of a body takes eleven lines of a processor's
# cache. Mass [N ms^2/mm]; half length and half width together, half the diagonal [mm]; three moments of
# inertia [N mm ms^2].
OWN_MASS, OWN_SIZE, OWN_REACH, OWN_INERTIA, OWN = 0, 1, 2, 3, 6


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


class Sticks(NamedTuple):
    """Where friction of two sheets sticks; no pairs: it does nowhere. See contact.sticking."""

    pairs: np.ndarray  # of pairs that are searched, mechanics.stick.STRETCH
    aside: np.ndarray  # the same while pairs are searched anew
    head: Ints  # (bodies,) and the first of them that a box is the first of, -1: none
    following: Ints  # the next one
    half: Floats  # (1,) half of the step [ms]


class Drift(NamedTuple):
    """How far sheets have moved, and when overlaps of their boxes were looked at; see contact.drift."""

    ends: Ints  # (regions, 2) the sheets of each, -1: it sleeps
    moved: Floats  # (sheets,) places of each at most, added up over steps [mm]
    rates: Floats  # (sheets,) how fast they are at most in an iteration [mm/ms]
    looked: Floats  # (regions,) what both had moved together before the step of the last look, at least [mm]
    looks: Ints  # (regions,) how many looks there were
    listed: Ints  # pairs that are searched and were near when they were listed,
    list_moved: Floats  # (regions,) what both had moved together before, at least [mm]
    list_holds: Floats  # (3,) MANY, MARGIN, SLACK of the list


# Of Drift.list_holds: how many pairs are in the list, the margin that they were near by, and how much nearer
# pairs may have come since, -1: not at all [mm].
MANY, MARGIN, SLACK = 0, 1, 2


class Midpoint(NamedTuple):
    """The middle of a step: motion of all bodies, forces and torques on them, contacts, pairs near."""

    motion: Motion
    forces: Floats  # (bodies, 6) [N, N mm]
    touched: Ints  # pairs that touch
    results: Floats  # what each of them does, see mechanics.point, (pairs, forces.WIDE);
    rows: Ints  # in which of these rows each stands: those without points fill none
    faces: Floats  # what is read later of two boxes of two sheets, (pairs, FACE)
    totals: Floats  # (2,) what contacts and air have LOST, and POWER
    spent: Floats  # what the joints of each of Tables.runs have LOST, and NUMERICAL of it, (runs, 2)
    near: Ints  # pairs that may touch
    overlaps: np.ndarray  # of pairs that are searched, mechanics.overlap.OVERLAP
    spare: np.ndarray  # the same of a pair between steps, (1,)
    does: Ints  # what each near pair of two boxes does: CLEAR, PRESSES, BY_SIDES of mechanics.overlap
    lies: np.ndarray  # and whether a face of one lies over the other, (pairs,)
    fastest: Floats  # how fast places of free boxes are at most, MIDDLE and ENDS of a step, (2, bodies)
    sticks: Sticks
    drift: Drift


MIDDLE, ENDS = 0, 1
# Columns of Midpoint.faces: the force along normals, the greatest depth, friction along the faces by its
# size, the most it can be, how many points stand in the results, 0: none are needed; the energy that is
# stored and the power that is dissipated.
FACE_FORCE, FACE_DEPTH, FACE_RUBBING, FACE_GRIP, FACE_POINTS, FACE_STORED, FACE_LOST, FACE = range(8)
# Of the energies of a state [N mm], see observe.ledger.
KINETIC, ELASTIC, POTENTIAL = 0, 1, 2
# Of Midpoint.totals and Midpoint.spent [N mm/ms]: dissipated, put in by loads; dissipated by the numerical
# damping of joints.
LOST, POWER, NUMERICAL = 0, 1, 1


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
    mixing: Floats  # changes and velocities of iterations (mixing.ROWS, 6 nodes + border)
    gram: Floats  # (MIXED, MIXED) scratch: products of how the changes differed
    parts: Floats  # (2, MIXED) scratch: how much of each is mixed, and its scale
    # masses and bushings alone, in box axes, where contacts stand in the band: of each column the blocks of
    # `offsets` alone, (nodes, 6, 6 offsets)
    inner: Floats
    own: Floats  # and the corner of the rollers alone
    # in single precision, which is read in half the time: the factor where contacts stand in it, and `inner`
    single_factor: np.ndarray
    single_inner: np.ndarray
    offsets: Ints  # how many nodes apart two may be that a joint couples, from 0 on
    # which block of a column is of two nodes so many apart, (reach + 1,): in the band, and in `inner`
    slots: Ints
    inner_slots: Ints


class Frozen(NamedTuple):
    """Contact points of an iteration, whose geometry is frozen, and what the iteration looks for; see
    integrate.points and integrate.convex."""

    points: Floats  # (room, POINT)
    patches: np.ndarray  # PATCH
    pair: Ints  # of each point, (room,)
    ends: np.ndarray  # ENDS_OF_POINT of each
    many: Ints  # (3,) how many points, patches, and patches with corners there are
    lying: Ints  # numbers of the patches that have corners, rising, (patches,)
    of_patches: Floats  # (1,) what patches add to the slope where they were evaluated last
    vectors: Floats  # CHANGE to RESIDUAL of the nodes, (6, 6 nodes)
    border: Floats  # the same of the border, (6, border)
    block: Floats  # (1, 6, 6) scratch: what a patch loses as its owner moves against the other box


# The bodies of a point's pair and their nodes, -1: none.
ENDS_OF_POINT = np.dtype([("a", "i4"), ("b", "i4"), ("one", "i8"), ("two", "i8")])
# Rows of Frozen.vectors: the change of velocities, what masses and bushings make of it, the slope of what is
# made least, the direction that is gone along, what masses and bushings make of that, and the residual as the
# iteration began.
CHANGE, OF_CHANGE, GRADIENT, DIRECTION, OF_DIRECTION, RESIDUAL = 0, 1, 2, 3, 4, 5
# Columns of Frozen.points: arms from both bodies, what it is, its change of velocity along a direction, which
# stand together since that is looked at more often than all else; velocity of the first body against the
# second now; normal to the first body, the direction that friction acts square to; elastic force and its
# growth; rate, speed over which it damps, share of damping; friction and its speeds; the normal force that
# limits it; the force as it began.
ARM_A, ARM_B, KIND, ALONG, NOW, NORMAL, SQUARE = 0, 3, 6, 7, 10, 13, 16
SPRING, GROWTH, RATE, OVER, BETA = 19, 20, 21, 22, 23
MU_STATIC, MU_DYNAMIC, STICTION, SLIDING, PRESSING = 24, 25, 26, 27, 28
START, HOLD, FIELD, POINT = 29, 32, 33, 36
# HOLD of one whose friction goes with a direction: FIELD is its stretch (mechanics.measured).
STRETCHED = -1.0
# What a point is: one that presses and rubs; a damper alone; a couple about its normal, of SPRING at most, of
# a rolling speed of GROWTH times the angular velocity; a cell of air, whose force has changed by SPRING since
# the iteration began, and changes by GROWTH along a direction. Alone it would be damped by OVER [N ms/mm].
A_PRESSURE, A_DAMPER, A_COUPLE, AIR = 0.0, 1.0, 2.0, 3.0

# Columns of the corners of a PATCH: place along and across the owner's face [mm], stiffness, depth if it did
# not close, and the force at which friction slides, for 1 of its coefficient where it does not stick.
LENGTHWISE, ACROSS, STIFF, DEPTH_AT_REST, GRIP, CORNER = 0, 1, 2, 3, 4, 5
# What integrate.patches has of two boxes.
PATCH = np.dtype(
    [
        ("a", "i4"),  # boxes and region, as of the pair (lattice.search.LISTED),
        ("b", "i4"),
        ("region", "i4"),
        ("pair", "i4"),  # and which of those that are searched it is
        ("owner", "i4"),  # the body whose face owns the contact, and the other one
        ("other", "i4"),
        ("one", "i4"),  # nodes of the owner and the other, -1: none
        ("two", "i4"),
        ("coupled", "i4"),  # the coupling of these, -1: none
        ("count", "i2"),  # of corners
        ("side", "i2"),  # of the owner's face along its normal
        ("ratio", "f8"),  # k_t for 1 of k, 0: friction does not stick [mm^0.5]
        ("high", "f8"),  # where all corners are along the owner's normal [mm]
        ("place", "f8", 3),  # of the other box in the owner's axes [mm]
        ("now", "f8", 6),  # rate and spin of the owner against the other box at the owner's middle,
        ("along", "f8", 6),  # and how they change along a direction
        ("begun", "f8", 6),  # force and torque on the owner as the iteration began,
        ("does", "f8", 6),  # and where they were evaluated last
        ("corners", "f8", (MOST_CORNERS, CORNER)),
    ]
)


class Free(NamedTuple):
    """Sheets that hang on nothing, see momentum.keep."""

    label: Ints  # (nodes,) sheet of each node
    sheet: Ints  # (bodies,) the same of each body, -1: it is not free
    loose: np.ndarray  # (sheets,) whether a sheet hangs on nothing
    busy: np.ndarray  # (sheets,) whether it, or a sheet that it touches, touches what is no sheet now
    alone: np.ndarray  # (sheets,) whether it hangs on nothing and touches nothing now
    residual: Floats  # (6 nodes,)
    one_with: Ints  # (sheets,) which sheet it is one with now
    cut: np.ndarray  # (sheets,) whether it is one half of a sheet, which hangs on its image
    normal: Floats  # (3,) of the plane that halves it
    lets: Floats  # (2, sheets + border) BEFORE and AFTER: see momentum.let_go


# Rows of Free.lets: of the residual that an iteration begins with, and of what its change leaves.
BEFORE, AFTER = 0, 1


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
# Of what is stored of a row at a time: its normal force, then what mechanics.turning has.
PRESSES, TURNS = 0, 1


class Bounds(NamedTuple):
    """Where bodies may be, (bodies, 3) [mm]."""

    low: Floats
    high: Floats


class Damped(NamedTuple):
    """Joints with a damping time, see integrate.damped."""

    joints: np.ndarray
    band: Floats
    single: np.ndarray  # its factor in single precision, which is read in half the time
    short: np.ndarray  # (6 nodes,) scratch of that precision
    made: Floats  # (2,) the step that the band was factored for, how many steps ago
    vectors: Floats  # (2, 6 nodes) PUSH and LEFT
    place: Floats  # (bodies, 3) where bodies are at the end of a step [mm]
    off: Floats  # (nodes, 6) velocities to take off


class Film(NamedTuple):
    """Air between sheets, see integrate.air; no films: there is none."""

    films: np.ndarray  # mechanics.film.FILM, one for each contact with air
    film_of: Ints  # of each contact, -1: none
    cells: np.ndarray  # mechanics.film.CELL, of all films
    flow: Floats  # matrices of Reynolds' equation, (cells, band)
    factor: Floats  # factors of them,
    ends: Floats  # and of those of the ends of a step
    vectors: Floats  # (4, cells) PRESSURES, and scratch
    head: Ints  # first cell of each pair, -1: none
    listed: Ints  # pairs that have cells,
    many: Ints  # and how many these are, (1,): none where no air acts
    push: Floats  # (nodes, 6) what pressures do to boxes
    place: Floats  # (bodies, 3) where bodies are at the end of a step [mm]
    off: Floats  # (nodes, 6) velocities to take off at the end of a step


PRESSURES = 0  # row of Film.vectors


class Islands(NamedTuple):
    """Parts, which are sheets and bodies that turn or slide, and the islands of those that touch; see
    integrate.islands."""

    part: Ints  # (bodies,) of each body, sheets by their numbers first; -1: it does not move
    of_border: Ints  # (border,) of each unknown of the border
    of_row: Ints  # (contacts,) of each contact: one of its parts that answers forces, -1: none does
    answers: np.ndarray  # (parts,) whether forces move a part, from here on (parts,)
    mass: Floats  # of a sheet; of what turns or slides, that of a place on its rim [g]
    least: Floats  # the least speed that a part is measured by [mm/ms]
    top: Ints  # which part stands for its island
    speed: Floats  # greatest of its island in the last step [mm/ms]
    given: Floats  # greatest speed of driven surfaces that touch it [mm/ms]
    energy: Floats  # of an island, at the part that stands for it [N mm]
    scale: Floats  # speed by which a step of it is measured [mm/ms]
    strict: Floats  # how many times less than in the fastest island a step may leave in it
    sums: Floats  # scratch
    # parts that may ever touch each other share a group, which has an energy balance of its own
    group: Ints  # (parts,)
    group_of_row: Ints  # (contacts,)


class Asleep(NamedTuple):
    """How fast sheets on each other are, and what those miss that sleep; see integrate.sleep. No `speeds`: no
    sheets of the scene meet."""

    speeds: Floats  # (sheets,) how fast places of each were at most since they were last looked at [mm/ms]
    bodies: Ints  # boxes of sheets that sleep
    missed: Floats  # impulses that they have missed since, (those boxes, 6)
    may: Floats  # (1,) velocity that a box may miss [mm/ms]
    rows: np.ndarray  # (contacts,) whether nothing of a contact is awake: what it does stays as it is


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
    """What the velocities of a step are guessed from (integrate.guess): those of the step before the last,
    and of the one before that."""

    u: Floats  # (nodes, 6)
    ub: Floats  # (border,)
    earlier: Floats  # (nodes, 6)
    spans: Floats  # (3,) LAST_STEP, BETWEEN, EARLIER [ms]
    missed: Floats  # (sheets, GUESSES) squares of what each guess has missed in a sheet


# Of History.spans: size of the last step; from its middle to that of the one before, and from there to that
# of the one before that, 0: there is none.
LAST_STEP, BETWEEN, EARLIER = 0, 1, 2
# Columns of History.missed.
HALF, LINE, PARABOLA, GUESSES = 0, 1, 2, 3


class Control(NamedTuple):
    """What a run counts and is steered by."""

    factored: Floats  # (5,) MADE_FOR, STALE, WHERE, TOUGH, SPENT
    counters: Floats  # (COUNTERS,)
    energies: Floats  # (groups, 4) DISSIPATED, DRIVEN, THROUGH_DRIVES, DAMPED_NUMERICALLY [N mm]
    history: History
    pace: Floats  # (7,) LEVEL, MISS, ANEW, FASTEST, MADE, LOOSE, FLOOR


# Of Control.factored: the step that the factor was made for (0: none), whether it is to be made anew, where
# contacts stand (condensed.APART, PLANES or INSIDE), for how many steps more they stand INSIDE (see
# integrate.step), and how many linear solves beyond one for each step it has served there.
MADE_FOR, STALE, WHERE, TOUGH, SPENT = 0, 1, 2, 3, 4
# Of Control.counters. WORST names the body, pair or joint of a failure, STRAIN is that of a joint beyond its
# curve, THROUGH the pair of two sheets that a step would take through each other, or -1; SOLVES counts linear
# solves of iterations with frozen contacts, GIVEN_UP steps that did not converge.
STEPS, ITERATIONS, FACTORS, TOUCHING, WORST, STRAIN, THROUGH, CLOSE, SOLVES, GIVEN_UP = range(10)
COUNTERS = 10
# Of Control.energies; the third adds up what drives and loads moved either way.
DISSIPATED, DRIVEN, THROUGH_DRIVES, DAMPED_NUMERICALLY = 0, 1, 2, 3
# Of Control.pace: how often steps are halved now; what velocities may miss their guess by, relative to the
# speed of an island (0: anything); whether each step has a factor of its own; the greatest speed so far
# [mm/ms]; which part of the energy of an island its contacts may make or lose in one step (0: any); what
# iterations may leave in the fastest island, and the round-off of velocities in this step [mm/ms].
LEVEL, MISS, ANEW, FASTEST, MADE, LOOSE, FLOOR = 0, 1, 2, 3, 4, 5, 6

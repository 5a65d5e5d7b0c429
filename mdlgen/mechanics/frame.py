"""Inputs of a force law: places and motion of two bodies, their shapes, and the numbers of the law.

Named tuples of numbers and tuples: compiled code passes them by value.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from mdlgen.mechanics.vector import mat, three, vec
from mdlgen.program.kernel import njit

Vector = tuple[float, float, float]
Matrix = tuple[float, ...]  # nine, row by row
Floats = Any  # an array of float64, of any kind


# Columns of the law of a pair record: numbers as of Law, and the coefficient of rolling resistance.
LAW_BETA, LAW_STATIC, LAW_DYNAMIC, LAW_STICTION, LAW_SLIDING, LAW_SMOOTHING, LAW_ROLLING = range(7)
LAW_LEVER, LAW_BEND, LAW = 7, 8, 9

# Columns of a body record for a cylinder (`size`), and for an arc (`arc`, `Plate.shape`): radius, 0 for a
# straight guide, the angle of its middle, and half of the angle that it spans.
RADIUS, WIDTH = 0, 1
ARC_RADIUS, ARC_MIDDLE, ARC_ANGLE = 0, 1, 2


class Motion(NamedTuple):
    """All bodies at one state: places (n, 3) [mm], rotations (n, 9), velocities (n, 3) [mm/ms] and angular
    velocities (n, 3) [rad/ms], global."""

    x: Floats
    r: Floats
    u: Floats
    w: Floats


class Frame(NamedTuple):
    """One body: centre, rotation (body to global), velocity and angular velocity, global."""

    x: Vector
    r: Matrix
    v: Vector
    w: Vector


class Box(NamedTuple):
    """Half lengths along a box's axes, and a bit mask of its sides x_min, x_max, y_min, y_max without a
    neighbour in the sheet."""

    half: Vector
    exposed: int


class Cylinder(NamedTuple):
    """Unit vector along the axis (global), radius and width."""

    axis: Vector
    radius: float
    width: float


class Sector(NamedTuple):
    """The part of a cylinder's round within `angle` [rad] to both sides of `middle`, a unit vector
    perpendicular to the axis; at most a quarter turn, or contact.WHOLE. Forces are displaced by `aside`. A
    sector that `turns` presses in a sheet that passes it (see mechanics.point); a sheet that meets a fixed
    one at an angle has an impact."""

    middle: Vector
    angle: float
    aside: Vector
    turns: bool


class Plate(NamedTuple):
    """A plane or a guide, in its own axes as mechanics.guide has them.

    shape: (radius, middle angle, half angle) of an arc, the radius 0 for a flat plate; half: half of its
    length, width and thickness; top: place of its upper face along its normal; ends: a bit mask of the free
    ones; edge: radii of the edges of its upper and its lower face, and 1 where friction holds bodies on them
    (a static analysis); the last field has sides of the box that stand before its ends (see mechanics.edge).
    """

    shape: Vector
    half: Vector
    top: float
    ends: int
    edge: Vector
    beside: int


class Law(NamedTuple):
    """Numbers of a contact. In order: stiffness k (Eq. 10); 1 if boxes share it (`share: width`); the share
    of damping beta (Eq. 11); coefficients of friction (Eq. 12); the speeds at which friction has its static
    and its dynamic value; the speed at which damping is complete; the radius of the round as which a roller's
    force is spread, 0: the roller's (see mechanics.contact); the lever of friction beyond the surface, which
    is lever z + bend z^2 at a depth z. With a cover the surface of a roller is faster, or slower, than its
    core (see model.covers)."""

    k: float
    shared: bool
    beta: float
    mu_static: float
    mu_dynamic: float
    stiction: float
    sliding: float
    smoothing: float
    spread: float = 0.0
    lever: float = 0.0
    bend: float = 0.0


@njit(cache=True, error_model="numpy", forceinline=True)
def frame_of(motion, k):
    """Frame of body k."""
    return Frame(vec(motion.x, k), mat(motion.r, k), vec(motion.u, k), vec(motion.w, k))


@njit(cache=True, error_model="numpy", forceinline=True)
def held_frame(motion, k):
    """Frame of body k, which does not move."""
    return Frame(vec(motion.x, k), mat(motion.r, k), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@njit(cache=True, error_model="numpy", forceinline=True)
def box_of(body):
    """Box of a body record."""
    return Box(three(body.half), body.exposed)


@njit(cache=True, error_model="numpy", forceinline=True)
def cylinder_of(body):
    """Cylinder of a body record."""
    return Cylinder(three(body.axis), body.size[RADIUS], body.size[WIDTH])


@njit(cache=True, error_model="numpy", forceinline=True)
def law_of(pair):
    """Law of a pair record."""
    row = pair.law
    return Law(
        pair.k,
        pair.shared != 0,
        row[LAW_BETA],
        row[LAW_STATIC],
        row[LAW_DYNAMIC],
        row[LAW_STICTION],
        row[LAW_SLIDING],
        row[LAW_SMOOTHING],
        pair.spread,
        row[LAW_LEVER],
        row[LAW_BEND],
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def scaled(law, stiffness, friction, beta):
    """A law with stiffness and friction multiplied by these factors, and another share of damping."""
    return Law(
        stiffness * law.k,
        law.shared,
        beta,
        friction * law.mu_static,
        friction * law.mu_dynamic,
        law.stiction,
        law.sliding,
        law.smoothing,
        law.spread,
        law.lever,
        law.bend,
    )

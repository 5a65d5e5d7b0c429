"""A strip clamped at y_min as a plane chain of rigid boxes: an independent solution of the same lattice.

The unknowns are the slopes of the boxes below the sheet's plane (minimal coordinates), so the hinges hold
exactly; bushings and contacts of mdlgen's laws do not enter. A row of boxes is one link.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mdlgen.model.tables import CLAMP, JOINT_Y, Floats, Model

# Growth of the load from one equilibrium to the next; and where it starts, over stiffness.
GROWTH, FIRST_LOAD = 1.4, 0.1


@dataclass(frozen=True)
class Chain:
    """n links; the hinge i is before link i, hinge 0 at the clamp (mm, N, g, ms, rad)."""

    length: float
    mass: float
    inertia: float  # about the link's centre
    stiffness: Floats
    damping: Floats
    gravity: float
    reach: Floats  # (n, n): centre of link i over the slopes of links j, cos or sin

    @property
    def count(self) -> int:
        return len(self.stiffness)

    def path(self, slope: Floats) -> Floats:
        """Centres of the links from the clamp: along the sheet and below it [mm], (n, 2)."""
        return np.stack([self.reach @ np.cos(slope), self.reach @ np.sin(slope)], axis=1)

    def hinges(self, slope: Floats, values: Floats) -> Floats:
        """Generalised force of springs or dampers with `values` on slopes or their rates."""
        moment = values * np.diff(slope, prepend=0.0)
        return np.append(moment[1:], 0.0) - moment

    def weight(self, slope: Floats) -> Floats:
        """Generalised force of gravity."""
        return self.mass * self.gravity * self.reach.sum(axis=0) * np.cos(slope)


@dataclass(frozen=True)
class Post:
    """A fixed cylinder below the chain that it hangs over, its top at the hinge 0; without friction.

    Each link is pressed at the point of its lower face that is nearest to the axis, by k z^1.5 with the
    damping of the paper's Eq. 11.
    """

    radius: float
    half: float  # half the thickness of a link
    stiffness: float
    damping: float  # beta
    smoothing: float

    def push(self, chain: Chain, slope: Floats, rate: Floats) -> Floats:
        """Generalised force on the slopes."""
        along = np.stack([np.cos(slope), np.sin(slope)], axis=1)
        down = np.stack([-np.sin(slope), np.cos(slope)], axis=1)
        axis = np.array([0.0, self.radius + self.half])
        centre = chain.path(slope)
        shift = np.einsum("ij,ij->i", axis - centre, along)
        shift = np.clip(shift, -0.5 * chain.length, 0.5 * chain.length)[:, None]
        gap = centre + shift * along + self.half * down - axis
        distance = np.linalg.norm(gap, axis=1)
        depth = np.maximum(self.radius - distance, 0.0)
        if not depth.any():
            return np.zeros_like(slope)
        out = gap / distance[:, None]
        # velocity of the point over the rate of each slope, along the way out
        lever = chain.reach * (out @ down.T)
        lever += np.diag(np.einsum("ij,ij->i", out, shift * down - self.half * along))
        x = np.clip(-(lever @ rate) / self.smoothing, -1.0, 1.0)
        force = self.stiffness * depth**1.5 * (1.0 + self.damping * 0.5 * x * (3.0 - x**2))
        return force @ lever


def half_of(model: Model) -> Chain:
    """The upper half (in y) of a free sheet that is held at its middle, a joint: by symmetry that joint is a
    half-cell hinge, with twice the stiffness."""
    whole = chain_of(model)
    n = whole.count // 2
    twice = np.append(2.0, np.ones(n - 1))
    return replace(
        whole,
        stiffness=twice * whole.stiffness[n:],
        damping=twice * whole.damping[n:],
        reach=whole.reach[:n, :n],
    )


def chain_of(model: Model) -> Chain:
    """The chain that a Model's only sheet is when it bends along y, gravity along its normal downward."""
    sheet, bushings = model.sheets[0], model.bushings
    rows = sheet.n_y
    k, c = np.zeros(rows), np.zeros(rows)
    for row in np.flatnonzero((bushings.kind == JOINT_Y) | (bushings.kind == CLAMP)):
        link = (bushings.b[row] - sheet.first) // sheet.n_x
        k[link] += bushings.k[row, 3]
        c[link] += bushings.c[row, 3]
    body = model.bodies
    reach = sheet.d_y * (np.tri(rows, k=-1) + 0.5 * np.eye(rows))
    return Chain(
        length=sheet.d_y,
        mass=float(body.mass[sheet.first]) * sheet.n_x,
        inertia=float(body.inertia[sheet.first, 0]) * sheet.n_x,
        stiffness=k,
        damping=c,
        gravity=float(-model.gravity @ sheet.rotation[:, 2]),
        reach=reach,
    )


def hang(chain: Chain) -> Floats:
    """Slopes in equilibrium on the branch that starts flat, (n,)."""
    n = chain.count
    k = chain.stiffness
    elastic = np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    slope = np.zeros(n)
    pull = chain.weight(np.zeros(n))
    part = min(1.0, FIRST_LOAD * float(np.linalg.eigvalsh(elastic)[0]) / float(pull.max()))
    while True:
        for _ in range(100):
            load = part * chain.weight(slope)
            residual = elastic @ slope - load
            slope_by = np.linalg.solve(elastic + np.diag(part * pull * np.sin(slope)), residual)
            slope = slope - slope_by
            if np.abs(slope_by).max() < 1e-13:
                break
        if part >= 1.0:
            return slope
        part = min(1.0, GROWTH * part)


def swing(chain: Chain, times: Floats, post: Post | None = None) -> Floats:
    """Slopes at `times` [ms] of the chain released flat and at rest, (t, n); integrated to 1e-9, round a post
    to 1e-6."""
    from scipy.integrate import solve_ivp

    n = chain.count
    gram = chain.mass * chain.reach.T @ chain.reach

    def rates(_, y):
        slope, rate = y[:n], y[n:]
        gap = slope[:, None] - slope[None, :]
        inertia = gram * np.cos(gap) + chain.inertia * np.eye(n)
        force = chain.weight(slope) + chain.hinges(slope, chain.stiffness) + chain.hinges(rate, chain.damping)
        if post is not None:
            force = force + post.push(chain, slope, rate)
        return np.append(rate, np.linalg.solve(inertia, force - (gram * np.sin(gap)) @ rate**2))

    ran = solve_ivp(
        rates,
        (0.0, float(times[-1])),
        np.zeros(2 * n),
        method="DOP853",
        t_eval=np.minimum(times, times[-1]),
        rtol=1e-9 if post is None else 1e-6,
        atol=1e-12 if post is None else 1e-9,
    )
    return ran.y[:n].T


def centres(model: Model, chain: Chain, slope: Floats) -> Floats:
    """Where the boxes are for slopes (n,), global axes [mm], (boxes, 3)."""
    sheet = model.sheets[0]
    along, below = chain.path(slope).T
    first = model.bodies.position[sheet.first : sheet.first + sheet.n_x]
    start = first - 0.5 * sheet.d_y * sheet.rotation[:, 1]
    moved = np.outer(along, sheet.rotation[:, 1]) - np.outer(below, sheet.rotation[:, 2])
    return (start[None] + moved[:, None]).reshape(-1, 3)

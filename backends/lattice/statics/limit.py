"""The limit surface of a sheet's contacts: which forces and couples along a plane friction can hold.

A contact at the place r holds a force t in a convex set K of the plane: a disc of the radius mu N where it
lies flat, an ellipse where its normal is inclined. All contacts together hold the wrenches (F, M) = sum
(t, r x t), Coulomb's limit surface, which is convex. So the part of a wrench w that they hold is

    min sum max -t.(v + omega x r),

with the minimum over all twists q = (v, omega) with w.q = 1, the maximum over t in K, and the sum over all
contacts. It is the power that friction dissipates in a rigid motion, over the power of w (Goyal, Ruina and
Papadopoulos 1991, "Planar sliding with dry friction"). Each twist yields an upper bound of that part, and a
wrench on the surface. The contacts hold the convex hull of these wrenches. A linear program finds the largest
part of w in it, a lower bound. The dual of the program is the next twist. The search ends where both bounds
differ by less than LIMIT_CLOSE.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.tuning import LIMIT_CLOSE, LIMIT_MOST, STEEP
from mdlgen.model.tables import Floats


class Grips(NamedTuple):
    """Forces that contacts can hold along a plane: t = centre + shape e with |e| <= 1, at places on it
    [mm, N]."""

    place: Floats  # (n, 2)
    centre: Floats  # (n, 2)
    shape: Floats  # (n, 2, 2), symmetric

    def at(self, origin: Floats) -> Grips:
        """The same with places relative to `origin`."""
        return self._replace(place=self.place - origin)

    def answer(self, twist: Floats) -> tuple[float, Floats]:
        """Greatest power of forces in these sets at a twist (v_x, v_y, omega), and the wrench of these."""
        x, y = self.place.T
        rate = np.stack([twist[0] - twist[2] * y, twist[1] + twist[2] * x], axis=1)
        along = np.einsum("nij,nj->ni", self.shape, rate)
        size = np.linalg.norm(along, axis=1, keepdims=True)
        unit = np.divide(along, size, out=np.zeros_like(along), where=size > 0.0)
        force = self.centre + np.einsum("nij,nj->ni", self.shape, unit)
        wrench = np.array([*force.sum(axis=0), float((x * force[:, 1] - y * force[:, 0]).sum())])
        return float(wrench @ twist), wrench

    def middle(self) -> Floats:
        """Centre of friction: the mean place of the contacts, weighted by the force that each can hold."""
        most = np.linalg.norm(self.shape, axis=(1, 2))
        return most @ self.place / max(float(most.sum()), 1e-300)

    def reach(self) -> float:
        """Root mean square distance of contacts from the origin [mm]; 1 where all are there."""
        most = np.linalg.norm(self.shape, axis=(1, 2))
        square = float(most @ (self.place**2).sum(axis=1)) / max(float(most.sum()), 1e-300)
        return float(np.sqrt(square)) or 1.0


class Limit(NamedTuple):
    """Part of a wrench that is held, the twist by which it slides, and the error bound of the part."""

    part: float
    twist: Floats  # (3,) by which the wrench works 1
    error: float


def cone(force: Floats, normal: Floats, friction: float) -> tuple[Floats, Floats]:
    """Centre (2,) and shape (2, 2) of the forces that a contact can hold along the plane z = 0 beyond its
    `force` (3,) [N], which is within the cone of friction about its normal (3,)."""
    lean = normal[:2]
    sine, cosine = float(np.hypot(*lean)), float(normal[2])
    if sine < 1e-9:
        return -force[:2], friction * force[2] * np.eye(2)
    within = 1.0 / (1.0 + friction * friction)  # square of the cosine of the cone
    square = within - sine * sine
    if cosine <= 0.0 or square < STEEP * within:
        return np.zeros(2), np.zeros((2, 2))
    one = lean / sine
    two = np.array([-one[1], one[0]])
    long = force[2] * np.sqrt(within * (1.0 - within)) / square
    wide = force[2] * np.sqrt((1.0 - within) / square)
    centre = sine * cosine * force[2] / square * one - force[:2]
    return centre, long * np.outer(one, one) + wide * np.outer(two, two)


def limit(grips: Grips, wrench: Floats) -> Limit:
    """Part of an applied wrench (F_x, F_y, M) [N, N mm], about the origin, that the contacts hold; above 1:
    it is held wholly."""
    from scipy.optimize import linprog

    # a length and a force of the contacts as units: forces and couples count alike
    length = grips.reach()
    power = float(np.linalg.norm(grips.shape, axis=(1, 2)).sum())
    unit = np.array([1.0, 1.0, 1.0 / length])
    size = float(np.linalg.norm(wrench * unit))
    if power == 0.0:
        return Limit(0.0, wrench * unit * unit / size**2, 0.0)
    wanted = -wrench * unit / size
    scaled = Grips(grips.place / length, grips.centre / power, grips.shape / power)
    twists = [sign * axis for axis in np.eye(3) for sign in (1.0, -1.0)] + [wanted]
    known = [scaled.answer(twist)[1] for twist in twists]
    low, high, best = 0.0, np.inf, wanted
    for twist in twists:
        work = float(twist @ wanted)
        if work > 0.0 and (part := scaled.answer(twist)[0] / work) < high:
            high, best = part, twist / work
    for _ in range(LIMIT_MOST):
        # the most of `wanted` that lies between the known wrenches and none at all
        columns = np.column_stack([*known, -wanted])
        found = linprog(
            c=[0.0] * len(known) + [-1.0],
            A_eq=columns,
            b_eq=np.zeros(3),
            A_ub=[[1.0] * len(known) + [0.0]],
            b_ub=[1.0],
            method="highs",
        )
        if not found.success:
            break
        low = max(low, float(found.x[-1]))
        twist = np.asarray(found.eqlin.marginals)
        work = float(twist @ wanted)
        if abs(work) < 1e-12 or high - low <= LIMIT_CLOSE * high:
            break
        twist = twist / work
        most, answer = scaled.answer(twist)
        if most < high:
            high, best = most, twist
        known.append(answer)
    times = power / size
    return Limit(times * high, -best * unit / size, times * max(0.0, high - low))

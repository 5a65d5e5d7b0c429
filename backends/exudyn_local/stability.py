"""Stability of a static balance: its stiffness for all possible motions must have no negative direction."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.exudyn_local.place import owners
from mdlgen.backends.exudyn_local.shipped import jacobian
from mdlgen.backends.exudyn_local.state import Coordinates, Work
from mdlgen.backends.exudyn_local.system import Pattern, System
from mdlgen.mechanics.arm import AXIAL, INERTIA
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.model.tables import Floats

# A balance is stable where a disturbance needs a second or more to grow e-fold [rad/s].
SLOW = 1.0


def falling(system: System, pattern: Pattern, q: Floats, work: Work) -> int:
    """Number of directions in which a balance at q is unstable, by the signs of the pivots of K + SLOW^2 M.

    K is minus the derivative of the generalised forces; Euler parameters are reduced to rotations, along
    which alone they move. -1, unknown, where the factor needed other pivots than the diagonal.
    """
    from scipy.sparse import csc_matrix, csr_matrix
    from scipy.sparse.linalg import splu

    free = system.free
    data = np.zeros(len(pattern.indices))
    owner = owners(system)
    rest = np.zeros(max(1, free))
    at = Coordinates(q.copy(), rest, 1.0)
    jacobian(system.tables, system.elements, at, 1.0, (1.0, 0.0), True, owner, work, data)
    stiffness = csr_matrix((data, pattern.indices, pattern.indptr), shape=(free, free))
    columns, mass = _moves(system, q)
    reduced = columns.T @ stiffness @ columns
    reduced = 0.5 * (reduced + reduced.T)
    reduced.setdiag(reduced.diagonal() + SLOW**2 * mass)
    try:
        factor = splu(
            csc_matrix(reduced),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError:  # exactly singular
        return -1
    if not np.array_equal(factor.perm_r, factor.perm_c):
        return -1
    return int((factor.U.diagonal() < 0.0).sum())


def _moves(system: System, q: Floats):
    """Possible motions as columns (free, m): three translations and three rotations of a box, one of every
    other body; and the inertia of each."""
    from scipy.sparse import csc_matrix

    rows: list[int] = []
    columns: list[int] = []
    values: list[float] = []
    mass: list[float] = []

    def column(entries: list[tuple[int, float]], inertia: float) -> None:
        for at, value in entries:
            rows.append(at)
            columns.append(len(mass))
            values.append(value)
        mass.append(inertia)

    for body in system.bodies:
        n = int(body["first"])
        if n >= 0:
            for i in range(3):
                column([(n + i, 1.0)], float(body["mass"]))
            e0, e1, e2, e3 = body["reference"][3:] + q[n + 3 : n + 7]
            turn = 0.5 * np.array([[-e1, e0, e3, -e2], [-e2, -e3, e0, e1], [-e3, e2, -e1, e0]])
            for axis in range(3):  # about the box's own axes
                column([(n + 3 + i, float(turn[axis, i])) for i in range(4)], float(body["inertia"][axis]))
        for name, inertia in (("slide", body["press"][INERTIA]), ("spin", body["press"][AXIAL])):
            if body[name] >= 0 and (name == "slide" or body["coupled"] != FOLLOWER):
                column([(int(body[name]), 1.0)], float(inertia))
    shape = (system.free, len(mass))
    return csc_matrix((values, (rows, columns)), shape=shape), np.array(mass)

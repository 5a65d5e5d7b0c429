"""Functions of this solver's compiled code that Python calls, and the program in which they are shipped.

No kernel calls an entry: a kernel that other kernels call, too, has a wrapper here.
"""

from __future__ import annotations

from pathlib import Path

from mdlgen.backends.lattice.kernels import forces
from mdlgen.backends.lattice.kernels.contact import search
from mdlgen.backends.lattice.kernels.integrate.integrate import run
from mdlgen.backends.lattice.kernels.integrate.observe import ledger
from mdlgen.backends.lattice.kernels.statics.balance import equilibrium, stands
from mdlgen.mechanics import curve, pair
from mdlgen.mechanics.tree import set_thickness
from mdlgen.program.kernel import LAWS, njit
from mdlgen.program.ship import Program

_near_pairs, _pair_forces, _joint_forces = forces.near_pairs, forces.pair_forces, forces.joint_forces
_look, _remember, _overstretched = search.look, pair.remember, curve.overstretched


@njit(cache=True, error_model="numpy")
def look(pairs, search, x):
    """See search.look."""
    return _look(pairs, search, x)


@njit(cache=True, error_model="numpy")
def remember(bodies, pairs, shapes, motion):
    """See mechanics.pair.remember."""
    _remember(bodies, pairs, shapes, motion)


@njit(cache=True, error_model="numpy")
def overstretched(points, joints, x, r):
    """See mechanics.curve.overstretched."""
    return _overstretched(points, joints, x, r)


@njit(cache=True, error_model="numpy")
def joint_forces(joints, points, motion, f):
    """See forces.joint_forces, without numerical damping; returns the stored energy."""
    stored, _, _ = _joint_forces(joints, points, motion, f, 0.0)
    return stored


@njit(cache=True, error_model="numpy")
def contacts(tables, motion, mid):
    """Contacts of bodies at rest: writes forces, touching pairs and their results into a Midpoint; returns
    how many touch."""
    close = _near_pairs(tables, motion, 0.0, 0.0, mid.near)
    count, _, _ = _pair_forces(tables, mid.near, close, motion, mid.forces, mid.touched, mid.results)
    return count


PROGRAM = Program(
    Path(__file__).resolve().parents[1] / "lattice.program",
    (LAWS, "mdlgen.backends.lattice.kernels"),
    (
        *(run, ledger, equilibrium, stands, look, remember, overstretched, joint_forces, contacts),
        set_thickness,
    ),
)

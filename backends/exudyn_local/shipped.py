"""Functions of this solver's compiled code that Python calls, and the program in which they are shipped.

No kernel calls an entry: a kernel that other kernels call, too, has a wrapper here.
"""

from __future__ import annotations

from pathlib import Path

from mdlgen.backends.exudyn_local.air import air_slopes, begin_air, lay_air
from mdlgen.backends.exudyn_local.between import passed, set_limits
from mdlgen.backends.exudyn_local.forces import end_hinges, forces
from mdlgen.backends.exudyn_local.jacobian import jacobian
from mdlgen.backends.exudyn_local.ledger import ledger
from mdlgen.backends.exudyn_local.place import place_all, set_owners
from mdlgen.mechanics import curve, pair
from mdlgen.mechanics.tree import set_thickness
from mdlgen.program.kernel import LAWS, njit
from mdlgen.program.ship import Program

_overstretched, _remember = curve.overstretched, pair.remember


@njit(cache=True, error_model="numpy")
def begin(bodies, pairs, shapes, at, motion):
    """Updates the memory of pairs at a state, for a step or a run that begins there."""
    place_all(bodies, at, motion)
    _remember(bodies, pairs, shapes, motion)


@njit(cache=True, error_model="numpy")
def overstretched(points, bushings, x, r):
    """See mechanics.curve.overstretched."""
    return _overstretched(points, bushings, x, r)


PROGRAM = Program(
    Path(__file__).with_name("exudyn.program"),
    (LAWS, "mdlgen.backends.exudyn_local"),
    (
        *(forces, jacobian, air_slopes, ledger, begin, begin_air, lay_air),
        *(end_hinges, overstretched, passed, set_limits, set_owners, set_thickness),
    ),
)

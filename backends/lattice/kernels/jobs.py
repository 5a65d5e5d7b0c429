"""What helper threads do: parts of the jobs that the thread of a run begins (see parallel)."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.press_job import press_part
from mdlgen.backends.lattice.kernels.integrate.along import along_part, slope_part
from mdlgen.backends.lattice.kernels.integrate.convex import product_part
from mdlgen.backends.lattice.kernels.integrate.damped import left_part
from mdlgen.backends.lattice.kernels.integrate.points import patches_part
from mdlgen.backends.lattice.kernels.linear.coupled import axes_part
from mdlgen.backends.lattice.kernels.linear.sheets import eliminate_part, factor_part, solve_part
from mdlgen.backends.lattice.kernels.linear.two_colour import part_of
from mdlgen.backends.lattice.kernels.parallel import (
    ALONG,
    AXES,
    ELIMINATE,
    FACTOR,
    KIND,
    OVERSHOOT,
    PATCHES,
    PRESS,
    PRODUCT,
    SLOPE,
    SOLVE,
    done,
    take_as_helper,
)
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def do_part(work, kind, part):
    """Does one part of a job."""
    pool, matrix = work.pool, work.matrix
    if kind == AXES:
        axes_part(work.tables.nodes, work.mid.motion.r, matrix.couplings, part)
    elif kind == FACTOR:
        factor_part(pool, matrix, part)
    elif kind == ELIMINATE:
        eliminate_part(pool, matrix, part)
    elif kind == SOLVE:
        solve_part(pool, matrix, part)
    elif kind == OVERSHOOT:
        left_part(work, part)
    elif kind == PRODUCT:
        product_part(work, part)
    elif kind == ALONG:
        along_part(work, part)
    elif kind == SLOPE:
        slope_part(work, part)
    elif kind == PRESS:
        press_part(work, part)
    elif kind == PATCHES:
        patches_part(work, part)
    else:
        part_of(pool, matrix, kind, part)


@njit(cache=True, error_model="numpy", nogil=True)
def help(work, looks):
    """Takes parts until none was there in so many looks; returns how many it took."""
    pool = work.pool
    taken = 0
    part = take_as_helper(pool, looks)
    while part >= 0:
        do_part(work, pool.words[KIND], part)
        done(pool)
        taken += 1
        part = take_as_helper(pool, looks)
    return taken

"""The matrix of a step of which the linear solves alone are looked at."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.kernels.linear.coupled import Couplings
from mdlgen.backends.lattice.kernels.state import Matrix

NONE = np.zeros(0)


def exact(made: Couplings) -> Couplings:
    """The same with blocks that are solved with in double precision, so that a method is seen to be exact."""
    both = np.stack([made.blocks, made.blocks.transpose(0, 2, 1)], axis=1)
    return made._replace(single=both.copy(), short=made.short.astype(float))


def bare_matrix(
    band: np.ndarray, couplings: Couplings, border: np.ndarray, corner: np.ndarray, inner: np.ndarray
) -> Matrix:
    """A Matrix of these, its factor in double precision, so that a method is seen to be exact."""
    rollers, size = border.shape
    return Matrix(
        band=band,
        border=border,
        corner=corner,
        eliminated=np.zeros((rollers, size)),
        schur=np.zeros((rollers, rollers)),
        res=np.zeros(size),
        resb=np.zeros(rollers),
        direction=NONE,
        unknowns=NONE,
        couplings=couplings,
        mixing=NONE,
        gram=NONE,
        parts=NONE,
        offsets=np.arange(inner.shape[2] // 6),
        slots=NONE,
        inner_slots=NONE,
        inner=inner,
        own=NONE,
        single_factor=np.zeros_like(band),
        single_inner=np.zeros((0, 6, 0), np.float32),
    )

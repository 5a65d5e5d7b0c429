"""Scatter of friction over a sheet: a random field of mean 1, the same whatever the boxes of the sheet are.

    g(x) = sqrt(2/M) sum over M waves of cos(k_m . x + phi_m)

with normal k_m of standard deviation sqrt(2)/L and phi_m uniform is a field of mean 0 and variance 1 with the
correlation exp(-(d/L)^2) of two places at the distance d (Shinozuka and Deodatis, Appl. Mech. Rev. 44, 1991).
Friction is that of its contact times

    exp(s g - s^2/2),    s^2 = ln(1 + c^2),

which is never negative, and has the mean 1 and the standard deviation c, the deviation. Its correlation is
(exp(s^2 exp(-(d/L)^2)) - 1)/c^2, within 0.02 of exp(-(d/L)^2) up to c = 0.3.

A box has the mean of the field over its face, by Gauss's rule of two places along each side in parts of L/2
at most. So the mean of finer boxes is that of a coarse one, within 1 % of the deviation, and a box that is
larger than L has less scatter, as larger samples do.

Numbers are those of the generator PCG64 (O'Neill 2014) as numpy has it, seeded with the seed and the CRC-32
of the sheet's name: the upper 53 bits of each as a number below 1, and normal ones from two of these by Box
and Muller. So sheets of one contact differ, and a sheet has one field for each seed and length.
"""

from __future__ import annotations

import math
import zlib

import numpy as np

from mdlgen.model.tables import Floats, Model, SheetPart

# How many waves a field has: the distribution of their sum has a kurtosis of 3 - 1.5/M, so that it is normal
# within 0.3 %.
WAVES = 512
# Parts of a box along one side at most: the mean over more has less than 3 % of the deviation anyway.
MOST_PARTS = 32


def scatter_of(model: Model) -> Floats | None:
    """Friction of each stored pair relative to that of its contact, (pairs,); None: nothing scatters."""
    frictions, pairs = model.contacts.frictions, model.pairs
    if frictions is None or not (frictions.scatter[:, 0] > 0.0).any():
        return None
    found = np.ones(len(pairs))
    for row in np.flatnonzero(frictions.scatter[:, 0] > 0.0).tolist():
        sheet = next(s for s in model.sheets if s.name == model.contacts.part_a[row])
        deviation, length = frictions.scatter[row].tolist()
        own = pairs.contact == row
        found[own] = field(sheet, deviation, length, int(frictions.seed[row]))[pairs.a[own] - sheet.first]
    return found


def field(sheet: SheetPart, deviation: float, length: float, seed: int) -> Floats:
    """Mean of the field over each box of a sheet, (boxes,). length: L [mm]."""
    waves, phases = _waves(sheet.name, length, seed)
    (x, many_x), (y, many_y) = (_places(lines, length) for lines in (sheet.lines_x, sheet.lines_y))
    spread = math.sqrt(math.log(1.0 + deviation**2))
    along, across = x[:, None] * waves[:, 0], y[:, None] * waves[:, 1] + phases
    # cos(a + b) by its two products; einsum adds up in the same order whatever the number of threads
    g = np.einsum("yk,xk->yx", np.cos(across), np.cos(along))
    g -= np.einsum("yk,xk->yx", np.sin(across), np.sin(along))
    values = np.exp(spread * math.sqrt(2.0 / WAVES) * g - 0.5 * spread**2)
    return values.reshape(sheet.n_y, many_y, sheet.n_x, many_x).mean(axis=(1, 3)).ravel()


def deviation_of_box(wide: float, high: float, length: float) -> float:
    """Standard deviation of the mean over a box with these sides [mm], relative to that of one place: the
    root of the mean of exp(-(d/L)^2) over all pairs of places."""
    return math.sqrt(_alike(wide / length) * _alike(high / length))


def _alike(x: float) -> float:
    """Mean of exp(-(d/L)^2) over pairs of places of a line of length x L."""
    return (math.sqrt(math.pi) * x * math.erf(x) + math.exp(-(x**2)) - 1.0) / x**2


def _waves(name: str, length: float, seed: int) -> tuple[Floats, Floats]:
    """Wave numbers (WAVES, 2) [1/mm] and phases (WAVES,)."""
    source = np.random.PCG64(np.random.SeedSequence([seed, zlib.crc32(name.encode())]))
    one, two, three = ((source.random_raw(WAVES) >> np.uint64(11)) * 2.0**-53 for _ in range(3))
    size = np.sqrt(-2.0 * np.log1p(-one)) * (math.sqrt(2.0) / length)
    turn = 2.0 * np.pi * two
    waves = np.stack([size * np.cos(turn), size * np.sin(turn)], axis=1)
    return waves, np.array(2.0 * np.pi * three, dtype=np.float64)


def _places(lines: Floats, length: float) -> tuple[Floats, int]:
    """Coordinates along one side, and how many of them each box has: those of Gauss's rule."""
    widths = np.diff(lines)
    many = min(MOST_PARTS, math.ceil(float(widths.max()) / (0.5 * length)))
    middles = (np.arange(many) + 0.5) / many
    parts = (middles[:, None] + np.array([-0.5, 0.5]) / (math.sqrt(3.0) * many)).ravel()
    return (lines[:-1, None] + widths[:, None] * parts).ravel(), 2 * many

"""Guesses of the velocities with which the iterations of a step begin, from those of earlier steps.

Three guesses are compared on past steps: a line through the last two velocities, half of that extrapolation,
and a parabola through the last three. For smooth motion the error of the parabola is a tenth of that of the
line. For motion that flutters from step to step it is half as large again, and half of the extrapolation is
best. Each sheet uses the guess with the least error in its last steps. A guess changes the number of
iterations, not their result.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.state import (
    BETWEEN,
    EARLIER,
    GUESSES,
    HALF,
    LAST_STEP,
    LINE,
    OWN_SIZE,
    PARABOLA,
)
from mdlgen.backends.lattice.kernels.tuning import REMEMBERED, SMOOTH
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", forceinline=True)
def _ways(spans, dt):
    """Coefficients of the guesses for the middle of the next step, of dt [ms]. Returns that of the line, for
    the difference of the last two velocities, and two of the parabola, for that and the difference before."""
    if spans[BETWEEN] == 0.0:
        return 0.0, (0.0, 0.0)
    ahead, between, earlier = 0.5 * (dt + spans[LAST_STEP]), spans[BETWEEN], spans[EARLIER]
    line = ahead / between
    if earlier == 0.0:
        return line, (line, 0.0)
    bend = ahead * (ahead + between) / (between + earlier)
    return line, (line + bend / between, -bend / earlier)


@njit(cache=True, error_model="numpy", forceinline=True)
def _best(missed):
    """Guess with the least error for a sheet."""
    best = LINE if missed[LINE] <= missed[HALF] else HALF
    return PARABOLA if missed[PARABOLA] < SMOOTH * missed[best] else best


@njit(cache=True, error_model="numpy", **BORROWS)
def guess_velocities(work, history, dt, any_way):
    """Replaces the velocities of the last step, state.u and state.ub, by guesses for the middle of the next
    one, of dt [ms]; only along lines where not `any_way`."""
    u, ub, label = work.state.u, work.state.ub, work.free.label
    line, parabola = _ways(history.spans, dt)
    sheet, way = -1, (line, 0.0)
    for n in range(u.shape[0]):
        if any_way and label[n] != sheet:
            sheet = label[n]
            best = _best(history.missed[sheet])
            way = parabola if best == PARABOLA else (line if best == LINE else 0.5 * line, 0.0)
        for i in range(6):
            last = history.u[n, i]
            u[n, i] += way[0] * (u[n, i] - last) + way[1] * (last - history.earlier[n, i])
    for i in range(ub.size):
        ub[i] += line * (ub[i] - history.ub[i])


@njit(cache=True, error_model="numpy", **BORROWS)
def add_to_history(work, history, dt, last, last_b):
    """Adds the errors of the guesses for a step of dt [ms] that was taken, and stores its velocities; `last`
    (nodes, 6), `last_b` (border,): velocities of the step before."""
    boxes, label, u = work.tables.boxes, work.free.label, work.state.u
    missed, spans = history.missed, history.spans
    line, parabola = _ways(spans, dt)
    for sheet in range(missed.shape[0]):
        for k in range(GUESSES):
            missed[sheet, k] *= REMEMBERED
    for n in range(label.size):
        size = boxes[n, OWN_SIZE]
        half = straight = bent = 0.0
        for i in range(6):
            before, square = history.u[n, i], 1.0 if i < 3 else size * size
            new, old, older = u[n, i] - last[n, i], last[n, i] - before, before - history.earlier[n, i]
            half += square * (new - 0.5 * line * old) ** 2
            straight += square * (new - line * old) ** 2
            bent += square * (new - parabola[0] * old - parabola[1] * older) ** 2
            history.earlier[n, i], history.u[n, i] = before, last[n, i]
        missed[label[n], HALF] += half
        missed[label[n], LINE] += straight
        missed[label[n], PARABOLA] += bent
    for i in range(last_b.size):
        history.ub[i] = last_b[i]
    spans[EARLIER] = spans[BETWEEN]
    spans[BETWEEN] = 0.5 * (spans[LAST_STEP] + dt)
    spans[LAST_STEP] = dt


@njit(cache=True, error_model="numpy", **BORROWS)
def forget(history):
    """Drops the history: the next step begins with the velocities of the last one."""
    history.spans[BETWEEN] = 0.0

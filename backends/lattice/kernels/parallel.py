"""Parts of a job that the threads of one run take, to the same bits for any number of them.

What the thread of a run would do in a loop over sheets, pairs or rows it offers as a job:

    begin(work.pool, KIND, many)
    part = take(work.pool)
    while part >= 0:
        do_it(work, part)
        part = take(work.pool)
    finish(work.pool, many)

A kernel can be given no function, so the loop stands where the job is begun. Each helper thread waits in
`jobs.help` and takes parts of the same job, which `jobs.do_part` does by its kind: a new job is a KIND here,
a kernel for one part of it, such a loop, and a branch in `do_part`. With no helper this is the loop alone,
from the last part to the first.

Rules for what is a part, by which the bits are the same whoever takes it, and nobody waits for ever:

- It writes where no other part of the job reads or writes. What several parts add up to (forces on a body, a
  dot product, a count) they leave in rows of their own, and the thread of the run adds these in their order
  after `finish`.
- It is one kernel, called by the loop and by `do_part`. Where it is small it may be opened in both, and two
  copies of a loop may be rounded in two ways if it is compiled with `reassoc` or `contract`. So it has
  neither, or is a large function of its own as band.solve is.
- It BORROWS its arrays: what makes arrays can fail, and the job would never end.
- All it reads is reached from the Workspace, or stands in `pool.given`, which is written before `begin`.
- It begins no job itself.

A job costs one or two microseconds: it is worth that from some ten on. Of many small items, as pairs, a
part is a range of them, CHUNK in each: see `chunks` and `items_of`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mdlgen.program.kernel import BORROWS, intrinsic, njit

# Kinds of jobs, see jobs.do_part.
FACTOR, ELIMINATE, SOLVE, FIRST, BACK, ACROSS, SPLIT, STEP, TURN = range(9)
AXES, OVERSHOOT, PRODUCT, ALONG, SLOPE, PRESS, PATCHES = range(9, 16)

# Words of a pool, in lines of the processor's cache by who writes them: the number of the job, times MOST,
# and how many of its parts are left to take, with its kind; how many parts helpers have done; of the thread
# of the run how many helpers there are, the number of the job, and how many parts it took itself, or with no
# helper may still take; whether helpers are to end, and the address of what leaves the processor to another
# thread, 0: it is not known.
TICKET, KIND, DONE, HELPERS, NUMBER, OWN, CLOSED, LEAVE, WORDS = 0, 1, 16, 32, 33, 34, 48, 49, 64
MOST = 1 << 20  # parts of a job
CHUNK = 64  # items of a part, where these are small
# How often the thread of the run looks whether helpers have done their last parts before it leaves its
# processor for a while: on a busy machine one of them may wait for just that.
PATIENCE = 2000


# Of Pool.given: half of a step [ms].
HALF = 4


class Pool(NamedTuple):
    """What the threads of a run share besides what they work on."""

    words: np.ndarray  # (WORDS,)
    given: np.ndarray  # numbers that the parts of a job take, (8,)
    shares: np.ndarray  # what parts of sheets add to sums, (sheets, border + 1, border + 1)
    failed: np.ndarray  # whether a part of a sheet failed, (sheets,)


def empty(sheets: int, border: int) -> Pool:
    """A pool without helpers."""
    return Pool(
        np.zeros(WORDS, np.int64),
        np.zeros(8),
        np.zeros((sheets, border + 1, border + 1)),
        np.zeros(sheets, np.int64),
    )


def _place(context: Any, builder: Any, kinds: Any, values: Any) -> Any:
    """Address of a word."""
    from numba.np.arrayobj import make_array

    words = make_array(kinds[0])(context, builder, values[0])
    return builder.gep(words.data, [values[1]])


@intrinsic
def _load(_typing: Any, words: Any, at: Any) -> Any:
    """A word, and all that its writer wrote before."""
    from numba.core import types

    def make(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return builder.load_atomic(_place(context, builder, signature.args, values), "acquire", 8)

    return types.int64(words, at), make


@intrinsic
def _store(_typing: Any, words: Any, at: Any, value: Any) -> Any:
    """Sets a word, after all that was written before."""
    from numba.core import types

    def make(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        place = _place(context, builder, signature.args, values)
        builder.store_atomic(values[2], place, "release", 8)
        return context.get_dummy_value()

    return types.none(words, at, value), make


@intrinsic
def _add(_typing: Any, words: Any, at: Any, more: Any) -> Any:
    """Adds to a word, after all that was written before; what it was."""
    from numba.core import types

    def make(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        place = _place(context, builder, signature.args, values)
        return builder.atomic_rmw("add", place, values[2], "acq_rel")

    return types.int64(words, at, more), make


@intrinsic
def _replace(_typing: Any, words: Any, at: Any, was: Any, new: Any) -> Any:
    """Sets a word that is still what it was. Returns whether it is."""
    from numba.core import types

    def make(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        place = _place(context, builder, signature.args, values)
        found = builder.cmpxchg(place, values[2], values[3], "acq_rel", "monotonic")
        return builder.extract_value(found, 1)

    return types.boolean(words, at, was, new), make


@intrinsic
def _call(_typing: Any, address: Any) -> Any:
    """Calls a function of the system without arguments that returns a whole number of 32 bits."""
    from llvmlite import ir
    from numba.core import types

    def make(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        kind = ir.FunctionType(ir.IntType(32), [])
        return builder.call(builder.inttoptr(values[0], kind.as_pointer()), [])

    return types.int32(address), make


@njit(cache=True, error_model="numpy", **BORROWS)
def begin(pool, kind, many):
    """Offers a job of `many` parts, less than MOST."""
    words = pool.words
    if words[HELPERS] == 0:
        words[OWN] = many
        return
    words[KIND] = kind
    words[NUMBER] += 1
    words[OWN] = 0
    _store(words, DONE, 0)
    _store(words, TICKET, words[NUMBER] * MOST + many)


@njit(cache=True, error_model="numpy", **BORROWS)
def _taken(words):
    """A part of the job that is on, the last one that is left; -1: none is."""
    while True:
        ticket = _load(words, TICKET)
        left = ticket % MOST
        if left == 0:
            return -1
        if _replace(words, TICKET, ticket, ticket - 1):
            return left - 1


@njit(cache=True, error_model="numpy", **BORROWS)
def take(pool):
    """A part of the job for the thread of the run; -1: none is left."""
    words = pool.words
    if words[HELPERS] == 0:
        words[OWN] -= 1
        return words[OWN]
    part = _taken(words)
    if part >= 0:
        words[OWN] += 1
    return part


@njit(cache=True, error_model="numpy", **BORROWS)
def finish(pool, many):
    """Waits until all parts are done."""
    words = pool.words
    if words[HELPERS] == 0:
        return
    looked = 0
    while _load(words, DONE) + words[OWN] < many:
        looked += 1
        if looked > PATIENCE and words[LEAVE] != 0:
            _call(words[LEAVE])


@njit(cache=True, error_model="numpy", **BORROWS)
def chunks(items):
    """How many parts so many small items make."""
    return (items + CHUNK - 1) // CHUNK


@njit(cache=True, error_model="numpy", **BORROWS)
def items_of(part, items):
    """The first of the items of a part, and the first behind them."""
    return part * CHUNK, min(items, (part + 1) * CHUNK)


@njit(cache=True, error_model="numpy", **BORROWS)
def take_as_helper(pool, looks):
    """A part for a helper, which is to call `done` after it; -1: none was there in so many looks, or helpers
    are to end."""
    words = pool.words
    for _ in range(looks):
        part = _taken(words)
        if part >= 0:
            return part
        if _load(words, CLOSED) != 0:
            break
    return -1


@njit(cache=True, error_model="numpy", **BORROWS)
def done(pool):
    """A helper has done its part."""
    _add(pool.words, DONE, 1)

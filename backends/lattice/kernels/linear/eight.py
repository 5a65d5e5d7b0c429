"""Eight rows of six columns at once, in the vectors of the processor.

A factor consists mostly of sums over the columns of a block, in loops of a few dozen rows. The compiler
cannot exclude that columns overlap in memory, so its code checks that before each loop, which takes as long
as the loop. So these sums are written in LLVM's vectors, which load all numbers before they store any.

Arrays are (6 columns, rows), contiguous along rows, with unused rows behind the last one that counts.
"""

from __future__ import annotations

from typing import Any

from mdlgen.program.kernel import intrinsic

EIGHT = 8


class _Columns:
    """The columns of an array as LLVM values."""

    def __init__(self, context: Any, builder: Any, kind: Any, value: Any):
        from llvmlite import ir
        from numba.np.arrayobj import make_array

        array = make_array(kind)(context, builder, value)
        self._ir, self._builder, self._data = ir, builder, array.data
        self._height = builder.extract_value(array.shape, 1)
        self._one = context.get_data_type(kind.dtype)
        self._eight, self._align = ir.VectorType(self._one, EIGHT), kind.dtype.bitwidth // 8

    def _place(self, column: int, row: Any) -> Any:
        word = self._ir.IntType(64)
        begin = self._builder.mul(self._height, self._ir.Constant(word, column))
        return self._builder.gep(self._data, [self._builder.add(begin, row)])

    def load(self, column: int, row: Any) -> Any:
        """Eight rows of a column."""
        place = self._builder.bitcast(self._place(column, row), self._eight.as_pointer())
        found = self._builder.load(place)
        found.align = self._align
        return found

    def store(self, column: int, row: Any, value: Any) -> None:
        """Sets them."""
        place = self._builder.bitcast(self._place(column, row), self._eight.as_pointer())
        self._builder.store(value, place).align = self._align

    def spread(self, column: int, row: Any, more: int) -> Any:
        """One number of a column, eight times; `more`: rows behind that one."""
        word, index = self._ir.IntType(64), self._ir.IntType(32)
        if more:
            row = self._builder.add(row, self._ir.Constant(word, more))
        none = self._ir.Constant(self._eight, self._ir.Undefined)
        one = self._builder.load(self._place(column, row))
        first = self._builder.insert_element(none, one, self._ir.Constant(index, 0))
        every = self._ir.Constant(self._ir.VectorType(index, EIGHT), [0] * EIGHT)
        return self._builder.shuffle_vector(first, none, every)


def _take_off(source, at, head, target, to):
    for c in range(6):
        for r in range(EIGHT):
            for l in range(6):
                target[c, to + r] -= source[l, head + c] * source[l, at + r]


def _take_off_in_vectors(_typing: Any, source: Any, at: Any, head: Any, target: Any, to: Any) -> Any:
    from numba.core import types

    def make(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        one = _Columns(context, builder, signature.args[0], values[0])
        two = _Columns(context, builder, signature.args[3], values[3])
        rows = [one.load(l, values[1]) for l in range(6)]
        for c in range(6):
            left = two.load(c, values[4])
            for l in range(6):
                product = builder.fmul(one.spread(l, values[2], c), rows[l], flags=("contract",))
                left = builder.fsub(left, product, flags=("contract",))
            two.store(c, values[4], left)
        return context.get_dummy_value()

    return types.none(source, at, head, target, to), make


def _times_triangle(columns, at):
    for r in range(at, at + EIGHT):
        before = [columns[l, r] for l in range(6)]
        for c in range(6):
            columns[c, r] = sum(columns[l, c] * before[l] for l in range(c + 1))


def _times_triangle_in_vectors(_typing: Any, columns: Any, at: Any) -> Any:
    from numba.core import types

    def make(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        own = _Columns(context, builder, signature.args[0], values[0])
        top = context.get_constant(types.int64, 0)
        before = [own.load(l, values[1]) for l in range(6)]
        for c in range(6):
            total = builder.fmul(own.spread(0, top, c), before[0], flags=("contract",))
            for l in range(1, c + 1):
                product = builder.fmul(own.spread(l, top, c), before[l], flags=("contract",))
                total = builder.fadd(total, product, flags=("contract",))
            own.store(c, values[1], total)
        return context.get_dummy_value()

    return types.none(columns, at), make


# Subtracts from the six columns of `target`, in the rows from `to` on, products of the columns of `source`,
# in the rows from `at` on. The factors for the first, second, ... column of `target` are the numbers of the
# column of `source` in the rows `head`, `head` + 1, ...
take_off = intrinsic(_take_off_in_vectors, _take_off)
# Multiplies the rows from `at` on by the transpose of the triangle in the first six rows: column c becomes
# the sum of the columns l up to c, each times its number in the row c.
times_triangle = intrinsic(_times_triangle_in_vectors, _times_triangle)

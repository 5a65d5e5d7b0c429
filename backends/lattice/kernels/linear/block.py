"""Products with a block of 6 x 6 that couples two nodes; the block is stored column by column."""

from __future__ import annotations

from typing import Any

from mdlgen.program.kernel import intrinsic, njit


@njit(cache=True, error_model="numpy", forceinline=True)
def six(v, at):
    """Six numbers of a vector."""
    return v[at], v[at + 1], v[at + 2], v[at + 3], v[at + 4], v[at + 5]


@njit(cache=True, error_model="numpy", forceinline=True)
def column(block, c, x):
    """A column of a block times x."""
    col = block[c]
    return col[0] * x[0] + col[1] * x[1] + col[2] * x[2] + col[3] * x[3] + col[4] * x[4] + col[5] * x[5]


def _add_product(block, x, at, y, to):
    for r in range(6):
        y[to + r] += sum(x[at + c] * block[c, r] for c in range(6))


def _add_product_in_vectors(_typing: Any, block: Any, x: Any, at: Any, y: Any, to: Any) -> Any:
    from numba.core import types

    def make(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        from llvmlite import ir
        from numba.np.arrayobj import make_array

        word, index, kinds = ir.IntType(64), ir.IntType(32), signature.args
        one, double = context.get_data_type(kinds[0].dtype), ir.DoubleType()
        six_of = ir.VectorType(one, 6)
        columns, numbers, sums = (make_array(kinds[k])(context, builder, values[k]).data for k in (0, 1, 3))

        def six_at(data: Any, place: Any, kind: Any, align: int) -> tuple[Any, Any]:
            pointer = builder.bitcast(builder.gep(data, [place]), ir.VectorType(kind, 6).as_pointer())
            found = builder.load(pointer)
            found.align = align
            return pointer, found

        total = None
        for c in range(6):
            _, column = six_at(columns, ir.Constant(word, 6 * c), one, kinds[0].dtype.bitwidth // 8)
            factor = builder.load(builder.gep(numbers, [builder.add(values[2], ir.Constant(word, c))]))
            if one != double:
                factor = builder.fptrunc(factor, one)
            none = ir.Constant(six_of, ir.Undefined)
            first = builder.insert_element(none, factor, ir.Constant(index, 0))
            every = ir.Constant(ir.VectorType(index, 6), [0] * 6)
            product = builder.fmul(builder.shuffle_vector(first, none, every), column, flags=("contract",))
            total = product if total is None else builder.fadd(total, product, flags=("contract",))
        place, before = six_at(sums, values[4], double, 8)
        if one != double:
            total = builder.fpext(total, ir.VectorType(double, 6))
        builder.store(builder.fadd(before, total), place).align = 8
        return context.get_dummy_value()

    return types.none(block, x, at, y, to), make


# Adds to six numbers of y, from `to` on, the product of a block and six numbers of x, from `at` on. The block
# may be of single precision; then so is the product.
add_product = intrinsic(_add_product_in_vectors, _add_product)

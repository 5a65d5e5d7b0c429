"""A hint to the processor that a record will be read soon.

Records of a pile are more than the cache next to a processor holds, and which of them a loop reads it cannot
foresee, so each is waited for. A hint some records ahead has it come meanwhile. It changes no result.
"""

from __future__ import annotations

from typing import Any

from mdlgen.program.kernel import intrinsic

# Bytes of a line of the cache.
LINE = 64


def _hint(_records, _at):
    pass


def _lines(most: int | None) -> Any:
    """As `_hint` in machine code, of that many lines at most."""

    def hint_in_llvm(_typing: Any, records: Any, at: Any) -> Any:
        from llvmlite import ir
        from numba.core import types
        from numba.np.arrayobj import make_array

        def make(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            array = make_array(signature.args[0])(context, builder, values[0])
            byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
            first = builder.bitcast(builder.gep(array.data, [values[1]]), byte)
            kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
            prefetch = builder.module.declare_intrinsic("llvm.prefetch", [byte], kind)
            # to be read, and more than once, as data
            how = [ir.Constant(number, value) for value in (0, 3, 1)]
            for line in range(0, signature.args[0].dtype.size, LINE)[:most]:
                place = builder.gep(first, [ir.Constant(ir.IntType(64), line)])
                builder.call(prefetch, [place, *how])
            return context.get_dummy_value()

        return types.none(records, at), make

    return hint_in_llvm


# `hint` says that the record `at` of an array will be read, `hint_first` that its first eight lines will, as
# those of a patch of four corners.
hint = intrinsic(_lines(None), _hint)
hint_first = intrinsic(_lines(8), _hint)

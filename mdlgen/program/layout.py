"""Arguments of compiled code as words of 8 bytes, in the order in which numba passes them.

An array is: who owns it (2 words, 0: nobody here), how many items, their size, the address, the shape, the
strides. A tuple, with names or without, is its items one after the other; a number is one word. A type is
written as JSON: "f8", "i8", "b1", ["tuple", types], ["array", dtype, dimensions, order, written].
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Callable
from typing import Any

import numpy as np

# A type, or a tuple or a list of types.
Type = Any
Write = Callable[[Any, Any], None]


class Misfit(TypeError):
    """An argument is of another type than the compiled code was made for."""


def described(value: Any) -> Type:
    """The type of an argument. Raises Misfit for what has none here."""
    if isinstance(value, np.ndarray):
        order = "C" if value.flags.c_contiguous else "F" if value.flags.f_contiguous else "A"
        if not value.flags.aligned:
            raise Misfit("an array that is not aligned")
        return ["array", _of_dtype(value.dtype), value.ndim, order, bool(value.flags.writeable)]
    if isinstance(value, tuple):
        return ["tuple", [described(item) for item in value]]
    if isinstance(value, (bool, np.bool_)):
        return "b1"
    if isinstance(value, (int, np.integer)):
        return "i8"
    if isinstance(value, float):
        return "f8"
    raise Misfit(f"a {type(value).__name__}")


def _of_dtype(dtype: np.dtype) -> Any:
    return dtype.str if dtype.names is None else [list(field) for field in dtype.descr]


def _dtype(message: Any) -> np.dtype:
    if isinstance(message, str):
        return np.dtype(message)
    return np.dtype([tuple(tuple(v) if isinstance(v, list) else v for v in field) for field in message])


def words(kind: Type) -> int:
    """Number of words that a type takes."""
    if isinstance(kind, str):
        return 1
    if kind[0] == "tuple":
        return sum(words(item) for item in kind[1])
    return 5 + 2 * kind[2]


def writer(kind: Type, at: int) -> Write:
    """A function that writes an argument of a type into a buffer, from word `at` on. It raises Misfit."""
    if isinstance(kind, str):
        return {"f8": _number, "i8": _whole, "b1": _truth}[kind](at)
    return (_tuple if kind[0] == "tuple" else _array)(kind, at)


def part_writers(kind: Type, at: int) -> Write | list[Write]:
    """A function that writes an argument of a type; for a tuple, one for each of its items."""
    return _items(kind, at) if kind[0] == "tuple" else writer(kind, at)


def _number(at: int) -> Write:
    pack, at = struct.Struct("=d").pack_into, 8 * at

    def write(buffer: Any, value: Any) -> None:
        if not isinstance(value, (float, int, np.floating, np.integer)) or isinstance(value, bool):
            raise Misfit(f"a {type(value).__name__} for a number")
        pack(buffer, at, value)

    return write


def _whole(at: int) -> Write:
    pack, at = struct.Struct("=q").pack_into, 8 * at

    def write(buffer: Any, value: Any) -> None:
        if not isinstance(value, (int, np.integer)) or isinstance(value, bool):
            raise Misfit(f"a {type(value).__name__} for a whole number")
        pack(buffer, at, int(value))

    return write


def _truth(at: int) -> Write:
    pack, at = struct.Struct("=q").pack_into, 8 * at

    def write(buffer: Any, value: Any) -> None:
        if not isinstance(value, (bool, np.bool_)):
            raise Misfit(f"a {type(value).__name__} for a truth value")
        pack(buffer, at, int(value))

    return write


def _items(kind: Type, at: int) -> list[Write]:
    parts: list[Write] = []
    for item in kind[1]:
        parts.append(writer(item, at))
        at += words(item)
    return parts


def _tuple(kind: Type, at: int) -> Write:
    parts = _items(kind, at)
    count = len(parts)

    def write(buffer: Any, value: Any) -> None:
        if not isinstance(value, tuple) or len(value) != count:
            raise Misfit(f"a {type(value).__name__} for a tuple of {count}")
        for part, item in zip(parts, value, strict=True):
            part(buffer, item)

    return write


def _array(kind: Type, at: int) -> Write:
    _, message, dimensions, order, written = kind
    dtype = _dtype(message)
    addressof: Any = ctypes.addressof
    first: Any = ctypes.c_char.from_buffer
    pack, at = struct.Struct(f"={5 + 2 * dimensions}q").pack_into, 8 * at

    def write(buffer: Any, value: Any) -> None:
        if not isinstance(value, np.ndarray) or value.ndim != dimensions:
            raise Misfit(f"a {type(value).__name__} for an array of {dimensions} dimensions")
        flags = value.flags
        if not flags.aligned or (written and not flags.writeable) or value.dtype != dtype:
            raise Misfit(f"an array of {value.dtype} for one of {dtype}")
        if (order == "C" and not flags.c_contiguous) or (order == "F" and not flags.f_contiguous):
            raise Misfit("an array whose items stand in another order")
        if flags.c_contiguous and flags.writeable and value.size:
            data = addressof(first(value))  # in a fifth of the time
        else:
            data = value.ctypes.data
        pack(buffer, at, 0, 0, value.size, value.itemsize, data, *value.shape, *value.strides)

    return write


def reader(kind: Type) -> tuple[int, Callable[[Any], Any]]:
    """Size of a result of a type [bytes], and a function that reads it from a buffer."""
    if kind == "none":
        return 8, lambda buffer: None
    codes = {"f8": "d", "i8": "q", "b1": "?"}
    whole = struct.Struct("@" + "".join(codes[item] for item in (kind[1] if kind[0] == "tuple" else [kind])))
    if isinstance(kind, str):
        return whole.size, lambda buffer: whole.unpack_from(buffer)[0]
    return whole.size, whole.unpack_from

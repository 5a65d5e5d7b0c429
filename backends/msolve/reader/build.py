"""Executes the program of the template with some values, in the stand-in for msolve."""

from __future__ import annotations

from functools import lru_cache
from types import CodeType
from typing import Any, NamedTuple

from mdlgen.backends.msolve.reader.split import Script
from mdlgen.backends.msolve.reader.standin import Simulated, Thing, names
from mdlgen.errors import Place, SpecError

MOST = 5_000_000
"""Objects that a script may make: 50 for each of 100,000 boxes."""


class Made(NamedTuple):
    """All objects in the order in which they were made, and how the run is called."""

    things: list[Thing]
    simulate: dict[str, Any]


def made(script: Script, file: str, most: int = MOST) -> Made:
    """Objects of a script. Raises SpecError where the program does not accept the values. Only the values of
    the file are used, which are literals. The program that is executed is mdlgen's own template, up to the
    simulation."""
    own, things = names(most)
    own |= script.values
    own["__name__"] = "script"
    try:
        exec(_code(script.program), own)
        own["run"](own["build"]())
    except Simulated as simulated:
        return Made(list(things), simulated.arguments)
    except MemoryError:
        raise
    except Exception as error:  # values of any kind and shape can stand in a file
        what = f"{type(error).__name__}: {error}" if not isinstance(error, TypeError) else str(error)
        raise SpecError(f"its values make no model: {what}"[:300], place=Place(file, 1, 1)) from None
    raise AssertionError("the program runs a simulation")


@lru_cache(maxsize=8)
def _code(program: str) -> CodeType:
    return compile(program, "<program of mdlgen>", "exec")

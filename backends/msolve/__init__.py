"""msolve: the Model as a script for MotionSolve's Python interface."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mdlgen.backend import Backend

if TYPE_CHECKING:
    from mdlgen.backends.msolve.reader import Reading
    from mdlgen.model.tables import Model

__all__ = ["BACKEND", "check", "emit", "read"]


def emit(model: Model) -> str:
    """The script; see `mdlgen.backends.msolve.writer.text.emit`."""
    from mdlgen.backends.msolve.writer import text

    return text.emit(model)


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that the script cannot represent."""
    from mdlgen.backends.msolve.writer import text

    text.check(model)


def read(text: str, file: str = "<script>") -> Reading:
    """A script read back, without running it; see `mdlgen.backends.msolve.reader.read`."""
    from mdlgen.backends.msolve import reader

    return reader.read(text, file)


BACKEND = Backend(check=check, emit=emit, read=read)

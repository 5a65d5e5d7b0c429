"""MotionSolve: the Model as an XML deck that the solver reads without MotionView."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mdlgen.backend import Backend

if TYPE_CHECKING:
    from mdlgen.backends.motionsolve.reader import Reading
    from mdlgen.model.tables import Model

__all__ = ["BACKEND", "check", "emit", "read", "validate"]


def emit(model: Model) -> str:
    """The deck; see `mdlgen.backends.motionsolve.writer.text.emit`."""
    from mdlgen.backends.motionsolve.writer import text

    return text.emit(model)


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that the deck cannot represent."""
    from mdlgen.backends.motionsolve.writer import text

    text.check(model)


def read(text: str, file: str = "<deck>") -> Reading:
    """A deck read back; see `mdlgen.backends.motionsolve.reader.read`."""
    from mdlgen.backends.motionsolve import reader

    return reader.read(text, file)


def validate(text: str, file: str = "<deck>") -> list[str]:
    """Errors of a deck, one line each; see `mdlgen.backends.motionsolve.reader.schema.validate`."""
    from mdlgen.backends.motionsolve.reader import schema

    return schema.validate(text, file)


BACKEND = Backend(check=check, emit=emit, read=read, validate=validate)

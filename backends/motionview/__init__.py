"""MotionView: the Model as MDL text, and a script for what that text has no known form for."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mdlgen.backend import Backend

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader import Reading
    from mdlgen.model.tables import Model

__all__ = ["BACKEND", "check", "companion", "companion_reasons", "emit", "read"]


def emit(
    model: Model,
    *,
    set_contact: bool = False,
    only: str | None = None,
    target: str = "2021",
    forces: bool = False,
) -> str:
    """The .mdl text, whole or of the sheets only; see `mdlgen.backends.motionview.writer.text.emit`."""
    from mdlgen.backends.motionview.writer import text

    return text.emit(model, set_contact=set_contact, only=only, target=target, forces=forces)


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that the text cannot represent."""
    from mdlgen.backends.motionview.writer import text

    text.check(model)


def companion(model: Model, *, set_contact: bool = False, only: str | None = None) -> str | None:
    """The Python script to run in MotionView after the text is loaded, or None."""
    from mdlgen.backends.motionview.writer import script

    return script.companion(model, set_contact=set_contact, only=only)


def companion_reasons(model: Model, set_contact: bool = False, only: str | None = None) -> list[str]:
    """Reasons why the script is needed, one line each; empty where it is not."""
    from mdlgen.backends.motionview.writer import script

    return script.reasons(model, set_contact, only)


def read(text: str, file: str = "<text>", folder: Path | None = None) -> Reading:
    """A text read back; see `mdlgen.backends.motionview.reader.read`."""
    from mdlgen.backends.motionview import reader

    return reader.read(text, file, folder)


BACKEND = Backend(check=check, emit=emit, companion=companion, companion_reasons=companion_reasons, read=read)

"""Finds the script that belongs to an MDL file, and checks that it is for the systems in the file."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from mdlgen.verify.inputs.scope import Scope
from mdlgen.verify.inputs.subject import File, Read
from mdlgen.verify.outcome import Verification
from mdlgen.verify.readback import script


def beside(text: Path, scope: Scope) -> tuple[File | None, list[Path]]:
    """The script in the folder of an MDL file, or of the file of its sheets; and the paths that were
    tried."""
    looked = [_script_of(text), *(_script_of(Path(file)) for file in sorted(scope.files))]
    looked = list(dict.fromkeys(looked))
    return next((File.read(path) for path in looked if path.is_file()), None), looked


def _script_of(text: Path) -> Path:
    return text.with_name(f"{text.stem}_mview.py")


def chosen(mine: script.Script, given: File | None, found: Verification) -> script.Script:
    """The script that was given, or the one that mdlgen writes."""
    if given is None:
        return mine
    found.script = str(given.path)
    read = script.read(given.text, str(given.path))
    if read.rest != mine.rest:
        what = "its statements are not those that mdlgen writes; only its numbers may differ"
        found.differs("script", "", f"{given.path}: {what}")
    return read


def taken(mine: script.Script, looked: Iterable[Path], found: Verification) -> None:
    """Notes that a script is due and none is there."""
    if mine != script.NONE:
        names = " nor ".join(str(path) for path in looked)
        found.notes.append(f"there is no {names}: the script that mdlgen writes is taken in its place")


def of_systems(
    mine: script.Script, read: script.Script, given: File | None, reads: list[Read], found: Verification
) -> None:
    """A script is for one system of a host, by its path."""
    if mine.system is None:
        return
    systems = [r.prefix.removesuffix(".") for r in reads]
    are = f"this model has the sheets in {' and '.join(systems)}"
    if read.system not in systems:
        what = f"its SYSTEM is {read.system!r}; {are}"
        if given is not None:
            found.differs("script", "", f"{given.path}: {what}")
        else:
            found.notes.append(f"the script that mdlgen writes must be changed: {what}")
    if len(systems) > 1:
        found.notes.append(f"{are}; the script sets one, and must be run for each with another SYSTEM")

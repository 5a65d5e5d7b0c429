"""A file of another program, recognised by its content."""

from __future__ import annotations

from pathlib import Path

from mdlgen.errors import OutputError
from mdlgen.results.recorded import plt, table
from mdlgen.results.recorded.recording import Recording

BINARY = {
    ".mrf": "multibody results",
    ".abf": "an Altair binary file",
    ".h3d": "an animation",
    ".res": "results of ADAMS",
}
_INSTEAD = "MotionSolve writes the same as text: NAME.plt, which decks and scripts of mdlgen ask for"


def read(path: Path) -> Recording:
    """Raises OutputError, in one line, for a file that cannot be read, is damaged, or of no known form."""
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise OutputError(f"{path}: cannot read: {error.strerror or error}") from None
    kind = BINARY.get(path.suffix.lower())
    if kind is not None or b"\x00" in raw[:4096]:
        what = kind or "a binary file"
        raise OutputError(f"{path}: {what}, whose layout is not public; {_INSTEAD}")
    text = raw.decode("utf-8", "replace")
    if not text.strip():
        raise OutputError(f"{path}: the file is empty")
    if plt.is_plot(text):
        return plt.read(text, path)
    if table.is_table(text):
        return table.read(text, path)
    raise OutputError(
        f"{path}: neither a plot file of MotionSolve (.plt) nor a table (.csv) whose first column is the time"
    )

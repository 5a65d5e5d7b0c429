"""Where the templates and samples lie, and how files are written so that nothing is lost."""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from collections.abc import Mapping
from pathlib import Path

from mdlgen.errors import OutputError

# Of a text that is read whole: some four sheets of 10,000 boxes.
MOST_BYTES = 200_000_000


def _data(folder: str) -> Path:
    here = Path(__file__).resolve().parent
    for place in (here / f"_{folder}", here.parent / folder):
        if place.is_dir():
            return place
    raise OutputError(f"the folder {folder!r} of the installation is missing; install mdlgen again")


def templates() -> Path:
    """Folder of the Jinja templates: inside the installed package, or beside it in a checkout."""
    return _data("templates")


def samples() -> Path:
    """Folder of the sample scenes."""
    return _data("samples")


def cache(name: str) -> Path | None:
    """A folder for what can be made anew, beside the compiled code of the package; None where none can be."""
    folder = Path(__file__).resolve().parent / "__pycache__" / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def read_at_most(path: Path, most: int, named: bool = False) -> bytes:
    """The first `most` bytes of a file; `named`: by another file, so that it must be a plain one.

    Raises OutputError.
    """
    try:
        # without O_NONBLOCK a named pipe that nobody writes to would be waited for
        with open(path, "rb", opener=_at_once if named else None) as stream:
            if named and not stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
                raise OutputError(f"{path}: is not a plain file")
            return stream.read(most)
    except (OSError, ValueError) as error:
        raise OutputError(f"{path}: cannot read: {getattr(error, 'strerror', None) or error}") from None


def _at_once(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _read(path: Path) -> bytes:
    raw = read_at_most(path, MOST_BYTES + 1)
    if len(raw) > MOST_BYTES:
        raise OutputError(f"{path}: is larger than {MOST_BYTES} bytes")
    return raw


def read_text(path: Path) -> str:
    """The UTF-8 text of a file; bytes that are none are shown as replacements. Raises OutputError."""
    text = _read(path).decode("utf-8-sig", errors="replace")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_exactly(path: Path) -> str:
    """As `read_text`, with a byte order mark and line ends as they stand in the file. Raises OutputError."""
    return _read(path).decode("utf-8", errors="replace")


def write_atomic(path: Path, content: str | bytes) -> None:
    """Write `path` through a temporary file in the same folder, fsync and rename.

    An existing file stays whole until the new one is complete. Raises OutputError (exit code 3).
    """
    write_together({path: content})


def write_together(files: Mapping[Path, str | bytes]) -> None:
    """Write several files: all are complete as temporary files before the first is renamed."""
    staged: list[tuple[str, Path]] = []
    path = Path()
    try:
        for path, content in files.items():
            if path.is_symlink():
                raise OutputError(f"{path}: is a symbolic link; name the file itself")
            if path.is_dir():
                raise OutputError(f"{path}: is a folder; name a file")
            data = content.encode("utf-8") if isinstance(content, str) else content
            handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
            staged.append((temporary, path))
            with os.fdopen(handle, "wb") as stream:
                stream.write(data)
                stream.flush()
                os.fsync(stream.fileno())
            os.chmod(temporary, 0o666 & ~_umask())
        for temporary, path in staged:
            os.replace(temporary, path)
    except OSError as error:
        raise OutputError(f"{path}: cannot write: {error.strerror or error}") from None
    finally:
        for temporary, _ in staged:
            with contextlib.suppress(OSError):
                os.unlink(temporary)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask

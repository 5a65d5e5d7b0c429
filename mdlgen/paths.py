"""Folders of templates and samples, and writing of files so that nothing is lost."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import stat
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import BinaryIO

from platformdirs import user_cache_dir

from mdlgen.errors import OutputError

# Content of a file: all of it, or a function that writes it into an open stream.
Content = str | bytes | Callable[[BinaryIO], None]
# Size of a text file that is read whole: some four sheets of 10,000 boxes.
MOST_BYTES = 200_000_000
# Suffix of a file until it is complete, and age from which such a file counts as left over [s].
TEMPORARY, STALE = ".mdlgen~", 3600.0
NOTE = ".together.mdlgen"
# Folders of the user's cache: machine code of shipped programs, numba's code, templates.
CACHED = ("programs", "compiled", "templates")


def _data(folder: str) -> Path:
    here = Path(__file__).resolve().parent
    for place in (here / f"_{folder}", here.parent / folder):
        if place.is_dir():
            return place
    raise OutputError(f"the folder {folder!r} of the installation is missing; install mdlgen again")


def templates() -> Path:
    """Folder of the Jinja templates: inside the installed package, or next to it in a checkout."""
    return _data("templates")


def samples() -> Path:
    """Folder of the sample scenes."""
    return _data("samples")


def user_cache() -> Path:
    """The user's folder for files that can be made again; MDLGEN_CACHE names another one."""
    named = os.environ.get("MDLGEN_CACHE")
    return Path(named) if named else Path(user_cache_dir("mdlgen", appauthor=False))


def cache(name: str) -> Path | None:
    """A folder in the user's cache; None where none can be written."""
    folder = user_cache() / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def _cached() -> list[Path]:
    """Number of cached files."""
    root = user_cache()
    return [path for folder in CACHED for path in (root / folder).rglob("*") if path.is_file()]


def cache_size() -> int:
    """Size of the cached files [bytes]."""
    return sum(path.stat().st_size for path in _cached())


def clear_cache() -> int:
    """Removes what is kept, and nothing else that stands in that folder; how many bytes that was.

    Raises OutputError.
    """
    size = cache_size()
    for folder in CACHED:
        try:
            if (user_cache() / folder).is_dir():
                shutil.rmtree(user_cache() / folder)
        except OSError as error:
            raise OutputError(f"{user_cache() / folder}: cannot be removed: {error.strerror}") from None
    return size


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


def check_folder(folder: Path) -> None:
    """Raises OutputError where `folder` is a symbolic link, or a file stands in its way."""
    try:
        if folder.is_symlink():
            raise OutputError(f"{folder}: is a symbolic link; name the folder itself")
        for part in (folder, *folder.parents):
            if part.exists() and not part.is_dir():
                raise OutputError(f"{part}: is a file; name a folder")
    except (OSError, ValueError) as error:
        raise OutputError(f"{folder}: cannot be a folder: {error}") from None


def write_together(files: Mapping[Path, Content]) -> None:
    """Write several files: all of them, or none. Raises OutputError.

    All are complete as temporary files before the first is renamed. Those of one folder stand in a note there
    while they are renamed, so that a process that is killed between two of them is finished by the next one
    (see `recover`); where a renaming is refused the old files come back.
    """
    staged: list[tuple[Path, Path]] = []
    folders = sorted({path.parent for path in files})
    path = Path()
    try:
        for folder in folders:
            recover(folder)
        for path, content in files.items():
            staged.append((_stage(path, content), path))
        for folder in folders:
            names = {old.name: new.name for old, new in staged if new.parent == folder}
            if len(names) > 1:
                path = folder / NOTE
                os.replace(_stage(path, json.dumps(names)), path)
                _sync(folder)
        _rename(staged)
        for folder in folders:
            _sync(folder)
            with contextlib.suppress(OSError):  # one that stays is of files that are renamed already
                os.unlink(folder / NOTE)
    except OSError as error:
        raise _refused(path, error) from None
    except KeyboardInterrupt:
        for folder in folders:
            recover(folder)
        raise
    finally:
        for temporary, _ in staged:
            with contextlib.suppress(OSError):
                os.unlink(temporary)


def _refused(path: Path, error: OSError) -> OutputError:
    missing = isinstance(error, FileNotFoundError) and not path.parent.exists()
    why = f"there is no folder {path.parent}" if missing else error.strerror or str(error)
    return OutputError(f"{path}: cannot write: {why}")


def recover(folder: Path) -> None:
    """Ends the writing that a killed process had begun in `folder`, and removes old temporary files there.

    Raises OutputError for a note that no such process wrote.
    """
    note = folder / NOTE
    try:
        if not note.is_symlink() and note.is_file():
            _follow(note)
        late = time.time() - STALE
        for left in folder.glob(f".*.*{TEMPORARY}"):
            if left.lstat().st_mtime < late:
                left.unlink()
    except OSError as error:
        raise OutputError(
            f"{note}: the renaming that it lists cannot be completed: {error.strerror or error}"
        ) from None


def _follow(note: Path) -> None:
    try:
        names = json.loads(read_at_most(note, 1_000_000, named=True))
        moves = [(note.parent / old, note.parent / new) for old, new in names.items()]
        right = all(
            re.fullmatch(rf"\.{re.escape(new.name)}\.\w+{re.escape(TEMPORARY)}", old.name)
            and new.parent == old.parent == note.parent
            for old, new in moves
        )
    except (ValueError, AttributeError, TypeError, RecursionError):
        moves, right = [], False
    if not right:
        raise OutputError(
            f"{note}: is not the list of files to rename that an interrupted command leaves; remove it"
        )
    for old, new in moves:
        with contextlib.suppress(FileNotFoundError):  # renamed before
            os.replace(old, new)
    _sync(note.parent)
    with contextlib.suppress(FileNotFoundError):
        note.unlink()


def _stage(path: Path, content: Content) -> Path:
    """A complete temporary file in the folder of `path`."""
    if path.is_symlink():
        raise OutputError(f"{path}: is a symbolic link; name the file itself")
    if path.is_dir():
        raise OutputError(f"{path}: is a folder; name a file")
    handle, temporary = tempfile.mkstemp(TEMPORARY, f".{path.name}.", path.parent)
    try:
        with os.fdopen(handle, "wb") as stream:
            if callable(content):
                content(stream)
            else:
                stream.write(content.encode("utf-8") if isinstance(content, str) else content)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(temporary, 0o666 & ~_umask())
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(temporary)
        raise
    return Path(temporary)


def _rename(staged: list[tuple[Path, Path]]) -> None:
    """Renames all; where one is refused the files that were there before come back. Raises OutputError."""
    kept: list[Path] = []
    undo: list[Callable[[], None]] = []
    path = Path()
    try:
        for temporary, path in staged:
            if len(staged) > 1:
                kept.append(temporary.with_name(f"{temporary.name.removesuffix(TEMPORARY)}_{TEMPORARY}"))
                undo.append(_way_back(path, kept[-1]))
            try:
                os.replace(temporary, path)
            except FileNotFoundError:
                if len(staged) == 1 or temporary.exists():
                    raise  # else another process has followed the note already
    except OSError as error:
        for folder in {path.parent for _, path in staged}:
            with contextlib.suppress(OSError):
                os.unlink(folder / NOTE)
        for back in undo[:-1]:
            with contextlib.suppress(OSError):
                back()
        raise _refused(path, error) from None
    finally:
        for old in kept:
            with contextlib.suppress(OSError):
                os.unlink(old)


def _way_back(path: Path, kept: Path) -> Callable[[], None]:
    """A function that restores `path` as it is now, through another name for it."""
    if not path.exists():
        return lambda: os.unlink(path)
    try:
        os.link(path, kept)
    except OSError:  # no links here: the written file stays
        return lambda: None
    return lambda: os.replace(kept, path)


def _sync(folder: Path) -> None:
    """Makes renamings last, where the system can."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY | getattr(os, "O_DIRECTORY", 0))
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask

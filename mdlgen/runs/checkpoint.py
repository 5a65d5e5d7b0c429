"""Checkpoints: states of a run on the disk, from which it is resumed, and a view of its part so far.

A run consists of passes, each with its own step. The state of a pass at a stored time is written unchanged,
array by array, so that a resumed run takes bitwise identical steps. A pass that has no checkpoint is run
again.
"""

from __future__ import annotations

import time
import zipfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from threading import Event, Lock

import numpy as np

from mdlgen.errors import OutputError
from mdlgen.paths import Content, write_together
from mdlgen.results.result import Result

State = dict[str, np.ndarray]


class Checkpointer:
    """Writes and reads states of the passes of a run in `folder` (None: nothing is written).

    `every` is the time between two states that are written [s]; with the first one stand the files that
    `provenance` gives (name -> text; run.json), None where the folder has them. `part` is a way to the result
    so far, None as long as there is none; `lock` is held while files are written. `free` is set once all is
    loaded and compiled, and compiled code leaves a processor free.
    """

    def __init__(
        self,
        folder: Path | None = None,
        every: float = float("inf"),
        provenance: Callable[[], Mapping[str, str]] | None = None,
    ):
        self.folder, self.every, self._provenance = folder, every, provenance
        self.part: Callable[[], Result] | None = None
        self.lock = Lock()
        self.free = Event()
        self.written = folder is not None and provenance is None
        self._last: dict[int, float] = {}  # time at which each pass was written, or began

    def begin(self, number: int) -> None:
        """A pass of that number begins: the same one in each run of a scene, however many go on at a time."""
        self._last[number] = max(self._last.values(), default=time.monotonic())

    def due(self, number: int) -> bool:
        """True if it is time to write the state of a pass."""
        return self.folder is not None and time.monotonic() - self._last[number] >= self.every

    def save(self, number: int, state: State) -> None:
        """Writes the state of a pass, in place of the one before. Raises OutputError."""
        if self.folder is None:
            return
        # into the file as it is: a second copy in memory may not fit
        write = partial(np.savez, allow_pickle=False, **state)  # pyright: ignore[reportArgumentType]
        files: dict[Path, Content] = {self._path(number): write}
        if self.folder.is_symlink():
            raise OutputError(f"{self.folder}: is a symbolic link; name the folder itself")
        with self.lock:
            if self._provenance is not None:
                self.drop()  # of another run
                files |= {self.folder / name: text for name, text in self._provenance().items()}
                try:
                    self.folder.mkdir(parents=True, exist_ok=True)
                except OSError as error:
                    what = error.strerror or error
                    raise OutputError(f"{self.folder}: cannot make this folder: {what}") from None
            write_together(files)
            self._provenance = None
        self.written = True
        self._last[number] = time.monotonic()

    def load(self, number: int, like: State, names: tuple[str, ...] = ()) -> State | None:
        """The state of a pass, None where none is stored; or those of its arrays with the given `names`.

        It has some of the arrays of `like`, with their types and shapes; where the first axis there has no
        length it has any. Raises OutputError for a file that does not fit.
        """
        if self.folder is None or self._provenance is not None or not self._path(number).exists():
            return None
        path = self._path(number)
        try:
            return _read(path, like, names)
        except (OSError, ValueError, KeyError, zipfile.BadZipFile, EOFError, NotImplementedError) as error:
            raise OutputError(f"{path}: is not a state of this run ({str(error)[:100]})") from None

    def drop(self) -> None:
        """Removes the stored states, of this run or another. Raises OutputError."""
        if self.folder is None or not self.folder.is_dir() or self.folder.is_symlink():
            return
        try:
            for path in (*self.folder.glob("pass_*.npz"), *self.folder.glob(".*"), self.folder / "run.json"):
                path.unlink(missing_ok=True)
            if not any(self.folder.iterdir()):
                self.folder.rmdir()
        except OSError as error:
            raise OutputError(f"{self.folder}: cannot be removed: {error.strerror or error}") from None

    def _path(self, number: int) -> Path:
        assert self.folder is not None
        return self.folder / f"pass_{number}.npz"


def _read(path: Path, like: State, names: tuple[str, ...]) -> State:
    with zipfile.ZipFile(path) as file:
        # what is not compressed is as large as the file: nothing unfolds
        if any(member.compress_type != zipfile.ZIP_STORED for member in file.infolist()):
            raise ValueError("it is compressed")
    found: State = {}
    with np.load(path, allow_pickle=False) as file:
        for name in names or file.files:
            array, wanted = file[name], like[name]
            free = wanted.ndim > 0 and wanted.shape[0] == 0
            if array.dtype != wanted.dtype or array.shape[free:] != wanted.shape[free:]:
                raise ValueError(f"{name} has the type or shape of another run")
            found[name] = array
    return found

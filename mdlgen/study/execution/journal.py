"""The journal of a study: its findings so far, line by line, so that it can resume after an interrupt or
crash.

The first line holds the request. Each other line is a row, on the disk before the next case counts as done. A
last line that was cut off is ignored.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import IO, Any

from mdlgen.errors import OutputError, RefusedError
from mdlgen.paths import check_folder, read_at_most
from mdlgen.study.execution.row import LOST, CaseRow

NAME, FORMAT = "journal.jsonl", 1
MOST_BYTES = 2_000_000_000

Asked = dict[str, Any]


class Journal:
    """The rows of a study in `folder` by index, and what was asked for; `append` writes one more."""

    def __init__(self, folder: Path, asked: Asked, rows: dict[int, CaseRow], stream: IO[bytes]):
        self.folder, self.asked, self.rows, self._stream = folder, asked, rows, stream

    @classmethod
    def create(cls, folder: Path, asked: Asked) -> Journal:
        """A new one. Raises OutputError, and RefusedError where `folder` holds a study already."""
        check_folder(folder)
        path = folder / NAME
        try:
            folder.mkdir(parents=True, exist_ok=True)
            stream = open(path, "xb")  # noqa: SIM115
        except FileExistsError:
            raise RefusedError(
                f"{folder}: holds a {_kind(path)} already; --resume continues it, or name another folder"
            ) from None
        except OSError as error:
            raise OutputError(f"{path}: cannot write: {error.strerror or error}") from None
        found = cls(folder, asked, {}, stream)
        found._hold()
        found._write({"mdlgen": FORMAT, "asked": asked})
        return found

    @classmethod
    def resume(cls, folder: Path) -> Journal:
        """The journal in `folder`, to be continued. Raises OutputError."""
        asked, rows, whole = _read(folder / NAME)
        try:
            stream = open(folder / NAME, "r+b")  # noqa: SIM115
        except OSError as error:
            raise OutputError(f"{folder / NAME}: cannot write: {error.strerror or error}") from None
        found = cls(folder, asked, rows, stream)
        found._hold()
        stream.truncate(whole)
        stream.seek(0, os.SEEK_END)
        return found

    def append(self, row: CaseRow) -> None:
        """Writes a row, which is on the disk when this returns. Raises OutputError."""
        self._write(row.json())
        self.rows[row.index] = row

    def close(self) -> None:
        self._stream.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _write(self, message: dict[str, Any]) -> None:
        line = json.dumps(message, allow_nan=False, separators=(",", ":")).encode("ascii")
        try:
            self._stream.write(line + b"\n")
            self._stream.flush()
            os.fsync(self._stream.fileno())
        except OSError as error:
            raise OutputError(f"{self.folder / NAME}: cannot write: {error.strerror or error}") from None

    def _hold(self) -> None:
        """Keeps other processes out, where the system can."""
        try:
            import fcntl
        except ImportError:
            return
        try:
            fcntl.flock(self._stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self.close()
            raise OutputError(f"{self.folder}: another process is at work on the study there") from None


def read(folder: Path) -> tuple[Asked, dict[int, CaseRow]]:
    """The request and the rows by index of a study that may still be running. Raises OutputError."""
    asked, rows, _ = _read(folder / NAME)
    return asked, rows


def _read(path: Path) -> tuple[Asked, dict[int, CaseRow], int]:
    """As `read`, and the number of bytes in whole lines; lost cases are left out, and will be run again."""
    if not path.is_file():
        raise OutputError(f"{path.parent}: holds no study to continue; mdlgen sweep SPEC -o DIR begins one")
    data = read_at_most(path, MOST_BYTES, named=True)
    whole = data.rfind(b"\n") + 1
    rows: dict[int, CaseRow] = {}
    asked: Asked | None = None
    for number, line in enumerate(data[:whole].splitlines(), 1):
        try:
            record = json.loads(line)
            if asked is None:
                if record["mdlgen"] != FORMAT:
                    raise ValueError("of another mdlgen")
                asked = dict(record["asked"])
                continue
            row = CaseRow.of(record)
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            raise OutputError(f"{path}:{number}: is not a line of a study ({str(error)[:80]})") from None
        if row.kind != LOST:
            rows[row.index] = row
    if asked is None:
        raise OutputError(f"{path}: was cut off before it began; remove it, and start the study again")
    return asked, rows, whole


def _kind(path: Path) -> str:
    """The kind of study that the journal is of, and its progress: for a message."""
    try:
        asked, rows, _ = _read(path)
    except OutputError:
        return "journal"
    return f"{asked.get('what', 'study')!s:.40} ({len(rows)} cases)"

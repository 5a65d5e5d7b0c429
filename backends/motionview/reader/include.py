"""Files that an MDL file includes: they are read only from its own folder or below."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from mdlgen.backends.motionview.reader.report import Notes
from mdlgen.backends.motionview.reader.scanner import statements
from mdlgen.backends.motionview.reader.source import Source
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.errors import OutputError
from mdlgen.paths import MOST_BYTES, read_at_most

MOST_DEEP = 20  # files in files
MOST_FILES = 1000
_NAME = re.compile(r'"([^"\\\n]+)"')
_TOO_MUCH = f"the files that are included in files are more than {MOST_FILES}, or {MOST_BYTES} bytes"


class Unread(Exception):
    """Reason why a file is not read."""


class Includes:
    """Reads a text with the files that it includes; without a folder it reads no file."""

    def __init__(self, source: Source, notes: Notes, folder: Path | None):
        self.notes = notes
        self.folder = folder.resolve() if folder is not None else None
        self.sources = [source]
        self.reasons: dict[int, str] = {}  # why the file of an include is not read, by id of the statement
        self._bytes = 0

    def statements(self) -> Iterator[Statement]:
        """All statements, those of a file in place of the statement that includes it."""
        first = self.sources[0]
        return self._expanded(statements(first, self.notes), self.folder, (Path(first.file).name,))

    def _expanded(
        self, found: Iterator[Statement], folder: Path | None, chain: tuple[str, ...]
    ) -> Iterator[Statement]:
        for statement in found:
            if statement.key != "include" or folder is None:
                yield statement
                continue
            try:
                path, inner = self._open(statement, folder, chain)
            except Unread as reason:
                self.reasons[id(statement)] = str(reason)
                yield statement
                continue
            message = path.relative_to(self.folder or folder).as_posix()
            part = self._part(statements(inner, self.notes, part=True))
            yield from self._expanded(part, path.parent, (*chain, message))

    def _part(self, found: Iterator[Statement]) -> Iterator[Statement]:
        for statement in found:
            if statement.key == "beginmdl":
                message = "*BeginMDL in an included file: how MotionView takes that is not known"
                self.notes.add("warning", "include", statement.place(), message)
            elif statement.key != "endmdl":
                yield statement

    def _open(self, statement: Statement, folder: Path, chain: tuple[str, ...]) -> tuple[Path, Source]:
        """The file that a statement includes. Raises Unread."""
        assert self.folder is not None
        name = _NAME.fullmatch(statement.arg(0))
        if name is None or len(statement.args) != 1:
            raise Unread("")
        path = self._path(name[1], folder)
        text = path.relative_to(self.folder).as_posix()
        if text in chain:
            message = f"{' includes '.join((*chain[chain.index(text) :], text))}"
            self.notes.add("error", "cycle", statement.place(0), message)
            raise Unread("it includes itself")
        if len(chain) > MOST_DEEP:
            raise Unread(f"files stand in files more than {MOST_DEEP} deep")
        try:
            if len(self.sources) > MOST_FILES or self._bytes + path.stat().st_size > MOST_BYTES:
                raise Unread(_TOO_MUCH)
            raw = read_at_most(path, MOST_BYTES - self._bytes, named=True)
        except OSError as error:
            raise Unread(f"it cannot be read: {error.strerror or error}") from None
        except OutputError as error:
            raise Unread(f"it cannot be read: {str(error).rpartition(': ')[2]}") from None
        self._bytes += len(raw)
        beside = Path(self.sources[0].file).parent / text
        inner = Source(raw.decode("utf-8", errors="replace"), str(beside))
        self.sources.append(inner)
        return path, inner

    def _path(self, name: str, folder: Path) -> Path:
        """Path of a file, links followed. Raises Unread for a file outside of the folder of the text."""
        assert self.folder is not None
        pure = PurePosixPath(name)
        if pure.is_absolute() or "\\" in name or ":" in name or "\0" in name:
            raise Unread("only files in the folder of the text or below it are read")
        try:
            path = (folder / pure).resolve()
            inside = path.is_relative_to(self.folder)
            missing = inside and not path.is_file()
        except (OSError, ValueError, RuntimeError) as error:  # a name too long, links in a circle
            raise Unread(f"it cannot be read: {error}") from None
        if not inside:
            raise Unread("only files in the folder of the text or below it are read")
        if missing:
            raise Unread("")
        return path

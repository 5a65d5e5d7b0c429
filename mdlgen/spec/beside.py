"""Resolves the path of a file that a scene names. It is relative to the scene's own file; a scene made in
Python may name any path. Also rewrites the path for use from another folder."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic import ValidationInfo

from mdlgen.errors import SpecError

# In place of a folder: what is made in Python names its own files, which no stranger's text can name.
PYTHON = Path("<python>")


def beside(name: Any, info: ValidationInfo) -> tuple[Any, Path | None]:
    """The name of a file and the folder that it is named from, None: it may not be read."""
    record = info.context or {}
    folder = record.get("folder") if info.context is not None else PYTHON
    if folder != PYTHON or not isinstance(name, str) or not name.strip():
        return name, folder
    path = Path(name).absolute()
    return path.name, path.parent


def named_from(base: Path, data: Any, folder: Path | None) -> None:
    """Names the files of plain data, which are named from `folder`, from another one. Raises SpecError for
    one that is not in it or below."""
    base = Path(os.path.normpath(base.absolute()))
    for path, holder in _holders(data):
        file = _whole(holder["file"], folder)
        if not file.is_relative_to(base):
            message = f"{file} is not in {base} or below, from where a text there could name it"
            raise SpecError(message, path)
        holder["file"] = file.relative_to(base).as_posix()


def holding(data: Any) -> Path | None:
    """The nearest folder in which or below which all files of plain data made in Python are; None: it names
    none, or they have none in common."""
    folders = [_whole(holder["file"], PYTHON).parent for _, holder in _holders(data)]
    try:
        return Path(os.path.commonpath(folders)) if folders else None
    except ValueError:  # on two drives
        return None


def with_whole_names(data: Any) -> None:
    """Names the files of plain data made in Python in full: they are found from wherever it is changed."""
    for _, holder in _holders(data):
        if holder["file"].strip():
            holder["file"] = str(_whole(holder["file"], PYTHON))


def _whole(name: str, folder: Path | None) -> Path:
    base = Path() if folder is None or folder == PYTHON else folder
    return Path(os.path.normpath((base / name).absolute()))


def _holders(data: Any) -> Iterator[tuple[tuple[str | int, ...], dict[str, Any]]]:
    """Places in plain data where meshes and curves name a file."""
    for kind, keys in (("meshes", None), ("materials", ("curve_md", "curve_cd"))):
        table = data.get(kind) if isinstance(data, dict) else None
        for name, part in table.items() if isinstance(table, dict) else ():
            for key in keys or ("",):
                holder = part.get(key) if key and isinstance(part, dict) else part
                if isinstance(holder, dict) and isinstance(holder.get("file"), str):
                    yield (kind, name, *([key] if key else []), "file"), holder

"""Where a file is that a scene names: beside that of the scene; for a scene made in Python anywhere."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import ValidationInfo

# In place of a folder: what is made in Python names its own files, of which no stranger's text tells.
PYTHON = Path("<python>")


def beside(name: Any, info: ValidationInfo) -> tuple[Any, Path | None]:
    """The name of a file and the folder that it is named from, None: it may not be read."""
    record = info.context or {}
    folder = record.get("folder") if info.context is not None else PYTHON
    if folder != PYTHON or not isinstance(name, str) or not name.strip():
        return name, folder
    path = Path(name).absolute()
    return path.name, path.parent

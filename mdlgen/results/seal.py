"""What a run that goes on must have in common with the one that it continues, so that bits agree."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from mdlgen.program.kernel import alone
from mdlgen.version import of, version


def digest(value: Any) -> str:
    """SHA-256 of a Model, or of what it is made of: tables, numbers, words, to the last bit.

    Raises TypeError for anything else.
    """
    found = hashlib.sha256()
    _add(value, found.update)
    return found.hexdigest()


def _add(value: Any, update: Callable[[bytes], None]) -> None:
    if isinstance(value, np.ndarray):
        update(f"{value.dtype.str}{value.shape}".encode())
        update(np.ascontiguousarray(value).tobytes())
    elif is_dataclass(value):
        update(type(value).__name__.encode())
        for field in fields(value):
            update(f".{field.name}=".encode())
            _add(getattr(value, field.name), update)
    elif isinstance(value, (tuple, list)):
        update(f"[{len(value)}".encode())
        for item in value:
            _add(item, update)
    elif isinstance(value, dict):
        update(f"{{{len(value)}".encode())
        for key in sorted(value):
            update(f"{key!r}:".encode())
            _add(value[key], update)
    elif value is None or isinstance(value, (str, bool, int, float, np.generic)):
        update(f"{type(value).__name__}{value!r};".encode())
    else:
        raise TypeError(f"no digest of {type(value).__name__}")


def surroundings(*rooms: str) -> dict[str, str]:
    """What else bits follow from: the code of some rooms, versions of the compiler, the processor."""
    import llvmlite.binding as llvm

    code = hashlib.sha256()
    for room in rooms:
        folder = Path(str(import_module(room).__file__)).parent
        for source in sorted((*folder.rglob("*.py"), *folder.rglob("*.program"))):
            code.update(source.read_bytes())
    return {
        "mdlgen": version(),
        "code": code.hexdigest(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": of("numba"),
        "llvmlite": of("llvmlite"),
        "compiled": "by numba" if alone() else "where the program does not fit",
        "processor": f"{platform.machine()} {llvm.get_host_cpu_name()}",
    }

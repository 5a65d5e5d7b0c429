"""Provenance: all that determines the bits of a run, and a check that another run would have the same.

A run that resumes from a checkpoint or a journal must have the same provenance as the one that it continues.
"""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.program import emit
from mdlgen.program.kernel import alone
from mdlgen.program.native import bitcode_only
from mdlgen.version import if_there, version


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


def provenance(packages: tuple[str, ...]) -> dict[str, str]:
    """Name -> value of all that determines the bits, apart from the Model: the code of some packages,
    versions of Python and of the compiler."""
    code = hashlib.sha256()
    for package in packages:
        found = find_spec(package)
        folder = Path(str(found and found.origin)).parent
        for source in sorted((*folder.rglob("*.py"), *folder.rglob("*.program"), *folder.rglob("*.so"))):
            code.update(source.read_bytes())
    return {
        "mdlgen": version(),
        "code": code.hexdigest(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "compiled": "by numba" if alone() else _compiled(),
        **if_there("numba", "llvmlite"),
    }


def _compiled() -> str:
    """The kind of machine code that the solvers' programs have here."""
    target = None if bitcode_only() else emit.shipped()
    return "from bitcode" if target is None else f"for {target}"


def processor() -> dict[str, str]:
    """The processor, as another name and value: sums may be rounded otherwise on another one."""
    name = emit.processor("model name") or emit.processor("CPU part") or platform.processor()
    return {"processor": f"{platform.machine()} {name}"}


_WORDS = {"model": "a file that the scene names", "code": "the solver's code"}


def check_same(folder: Path, there: Mapping[str, Any], now: Mapping[str, str]) -> None:
    """Raises RefusedError by name where the run in `folder` would not resume with bitwise identical results.

    `there` holds the provenance and the digest of the Model at that time, `now` those of this process.
    """
    for name, value in now.items():
        if there.get(name) != value:
            what = _WORDS.get(name, f"{name} ({str(there.get(name))[:60]}, now {value})")
            raise RefusedError(
                f"{folder}: cannot continue with identical results: {what} has changed; start the run again"
            )

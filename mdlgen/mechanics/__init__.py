"""Compiled force laws shared by the solvers. They hold in any consistent set of units.

Vectors are tuples of three floats, rotation matrices tuples of nine in row order: they live in registers,
so that a law costs no allocation. Every law writes forces and torques about the bodies' centres.
"""

from __future__ import annotations

import contextlib
import hashlib
from pathlib import Path

from numba import config

_HERE = Path(__file__).resolve().parent
_SETTINGS = config.__dict__  # numba makes its settings at run time
_BASE = Path(_SETTINGS["CACHE_DIR"] or _HERE / "__pycache__")


def keep_compiled_code(folder: Path | None = None) -> None:
    """Gives numba a cache folder for exactly these laws and the sources in `folder`, from here on.

    numba notices that a function's own file has changed, but not a file whose functions it calls: a solver
    would go on with an older law without a word. A solver calls this before its kernels are imported.
    """
    digest = hashlib.sha256()
    for source in (*sorted(_HERE.glob("*.py")), *(sorted(folder.glob("*.py")) if folder else ())):
        text = source.read_bytes()
        if b"@njit" in text:
            digest.update(text)
    place = _BASE / f"{folder.name if folder else 'laws'}_{digest.hexdigest()[:16]}"
    with contextlib.suppress(OSError):  # a read-only installation: numba finds its own place
        place.mkdir(parents=True, exist_ok=True)
        _SETTINGS["CACHE_DIR"] = str(place)


keep_compiled_code()

"""Compiled force laws shared by the solvers. They hold in any consistent set of units.

Vectors are tuples of three floats, rotation matrices tuples of nine in row order: they live in registers,
so that a law costs no allocation. Every law writes forces and torques about the bodies' centres.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib
from pathlib import Path

from numba import config

from mdlgen.mechanics.compiling import go_on_unkept

_HERE = Path(__file__).resolve().parent
_SETTINGS = config.__dict__  # numba makes its settings at run time
_BASE = Path(_SETTINGS["CACHE_DIR"] or _HERE / "__pycache__")


def keep_compiled_code(solver: str = "", folder: Path | None = None) -> None:
    """Gives numba a cache folder for exactly these laws and the solver's sources in `folder`, from here on.

    numba notices that a function's own file has changed, but not a file whose functions it calls: a solver
    would go on with an older law without a word. A solver calls this before its kernels are imported, and
    once more, for none, behind them. The laws keep a folder of their own, whoever imports them first.
    """
    laws = _compiled_in(_HERE)
    if folder:
        for law in laws:
            importlib.import_module(f"{__name__}.{law.stem}")
    digest = hashlib.sha256()
    for source in (*laws, *(_compiled_in(folder) if folder else ())):
        digest.update(source.read_bytes())
    place = _BASE / f"{solver or 'laws'}_{digest.hexdigest()[:16]}"
    with contextlib.suppress(OSError):  # a read-only installation: numba finds its own place
        place.mkdir(parents=True, exist_ok=True)
        _SETTINGS["CACHE_DIR"] = str(place)


def _compiled_in(folder: Path) -> list[Path]:
    return [s for s in sorted(folder.glob("*.py")) if s.name != "__init__.py" and b"@njit" in s.read_bytes()]


go_on_unkept()
keep_compiled_code()

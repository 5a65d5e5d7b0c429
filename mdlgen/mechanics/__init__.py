"""Compiled force laws shared by the solvers. They hold in any consistent set of units.

Vectors are tuples of three floats, rotation matrices tuples of nine in row order: they live in registers,
so that a law costs no allocation. Every law writes forces and torques about the bodies' centres.
"""

from __future__ import annotations

import contextlib
import hashlib
from pathlib import Path

from numba import config


def _keep_compiled_code_by_content() -> None:
    """Gives numba a cache folder for exactly these sources.

    numba notices that a function's own file has changed, but not a file whose functions it calls: a solver
    would go on with an older law without a word.
    """
    here = Path(__file__).resolve().parent
    digest = hashlib.sha256()
    for source in sorted(here.glob("*.py")):
        digest.update(source.read_bytes())
    settings = config.__dict__  # numba makes its settings at run time
    folder = Path(settings["CACHE_DIR"] or here / "__pycache__") / f"laws_{digest.hexdigest()[:16]}"
    with contextlib.suppress(OSError):  # a read-only installation: numba finds its own place
        folder.mkdir(parents=True, exist_ok=True)
        settings["CACHE_DIR"] = str(folder)


_keep_compiled_code_by_content()

"""Packages that some commands alone need, and the extra of mdlgen that installs each."""

from __future__ import annotations

# Package -> extra. What a package needs itself is not named here.
EXTRAS = {"exudyn": "exudyn", "matplotlib": "figures", "numba": "compile", "llvmlite": "compile"}


def advice(missing: str) -> str | None:
    """What to do where a package cannot be imported; None: no extra has it."""
    package = missing.partition(".")[0]
    if package not in EXTRAS:
        return None
    return f"needs {package}, which is not installed: pip install 'mdlgen[{EXTRAS[package]}]'"

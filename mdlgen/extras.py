"""Packages that some commands alone need, and the extra of mdlgen that installs each."""

from __future__ import annotations

from importlib.util import find_spec

from mdlgen.errors import OutputError

# Package -> extra. Packages that mdlgen itself needs are not named here.
EXTRAS = {"exudyn": "exudyn", "matplotlib": "figures", "numba": "compile", "llvmlite": "compile"}


def require(package: str) -> None:
    """Raises OutputError where a package is not installed, before work that needs it later on."""
    try:
        there = find_spec(package) is not None
    except ValueError:  # None stands among the modules in its place
        there = False
    if not there:
        raise OutputError(f"this {advice(package)}")


def advice(missing: str) -> str | None:
    """Advice where a package cannot be imported; None: no extra has it."""
    package = missing.partition(".")[0]
    if package not in EXTRAS:
        return None
    return f"needs {package}, which is not installed: pip install 'mdlgen[{EXTRAS[package]}]'"

"""The versions of installed packages, and our own."""

from __future__ import annotations

import contextlib
import functools


@functools.cache
def of(package: str) -> str:
    """The version of an installed package. Raises importlib.metadata.PackageNotFoundError."""
    from importlib import metadata  # a hundredth of a second

    return metadata.version(package)


def if_there(*packages: str) -> dict[str, str]:
    """The versions of those of some packages that are installed, by name."""
    found: dict[str, str] = {}
    for package in packages:
        with contextlib.suppress(ImportError):
            found[package] = of(package)
    return found


def version() -> str:
    """As pyproject.toml has it; `0+unknown` in a checkout that is not installed."""
    try:
        return of("mdlgen")
    except ImportError:
        return "0+unknown"

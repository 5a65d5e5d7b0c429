"""The versions of installed packages, and our own."""

from __future__ import annotations

import functools


@functools.cache
def of(package: str) -> str:
    """The version of an installed package. Raises importlib.metadata.PackageNotFoundError."""
    from importlib import metadata  # a hundredth of a second

    return metadata.version(package)


def version() -> str:
    """As pyproject.toml has it; `0+unknown` in a checkout that is not installed."""
    try:
        return of("mdlgen")
    except ImportError:
        return "0+unknown"

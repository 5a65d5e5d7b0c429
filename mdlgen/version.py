"""The version of the installed package."""

from __future__ import annotations


def version() -> str:
    """As pyproject.toml has it; `0+unknown` in a checkout that is not installed."""
    from importlib import metadata

    try:
        return metadata.version("mdlgen")
    except metadata.PackageNotFoundError:
        return "0+unknown"

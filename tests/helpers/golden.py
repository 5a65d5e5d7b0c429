"""Texts beside those that a reviewer has read."""

from __future__ import annotations

import os
from pathlib import Path

import pytest


def compare(text: str, path: Path) -> None:
    """Fails where the file holds another text, and says how to accept the new one."""
    if os.environ.get("MDLGEN_ACCEPT"):
        path.write_bytes(text.encode("ascii"))
    expected = path.read_bytes().decode("ascii") if path.exists() else ""
    if text != expected:
        pairs = zip(text.splitlines(), expected.splitlines(), strict=False)
        line, (new, old) = next(((k, p) for k, p in enumerate(pairs, 1) if p[0] != p[1]), (0, ("", "")))
        pytest.fail(
            f"{path.name} differs from the text, first in line {line}:\n"
            f"  golden: {old[:200]}\n  text:   {new[:200]}\n"
            "If the new text is right, accept it with\n"
            "  MDLGEN_ACCEPT=1 python -m pytest tests -k golden",
            pytrace=False,
        )

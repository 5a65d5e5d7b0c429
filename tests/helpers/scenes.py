"""The samples, of few boxes each, as texts and as what they hold."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mdlgen.paths import samples
from mdlgen.spec.load import parse

Path_ = tuple[str | int, ...]


def small(path: Path) -> str:
    """A sample of few boxes."""
    return re.sub(r"boxes: \[(\d+), (\d+)\]", fewer, path.read_text("utf-8"))


def fewer(boxes: re.Match[str]) -> str:
    return f"boxes: [{min(int(boxes[1]), 3)}, {min(int(boxes[2]), 5)}]"


# a scene that names files is read from one
TEXTS = [t for path in sorted(samples().rglob("*.yaml")) if "meshes:" not in (t := small(path))]
SCENES = [parse(text, "sample").data for text in TEXTS]


def paths(value: Any, head: Path_ = ()) -> Iterator[Path_]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield (*head, key)
        yield from paths(item, (*head, key))

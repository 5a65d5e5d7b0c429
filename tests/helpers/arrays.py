"""All numbers of a Model, by where they stand in it."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np


def arrays(owner: Any, name: str = "") -> dict[str, np.ndarray]:
    """All numbers of a Model, by where they stand; labels and formulas aside."""
    if dataclasses.is_dataclass(owner):
        found: dict[str, np.ndarray] = {}
        for field in dataclasses.fields(owner):
            found |= arrays(getattr(owner, field.name), f"{name}.{field.name}")
        return found
    if isinstance(owner, dict):
        return {k: v for key in sorted(owner) for k, v in arrays(owner[key], f"{name}.{key}").items()}
    if isinstance(owner, (tuple, list)):
        return {k: v for i, item in enumerate(owner) for k, v in arrays(item, f"{name}.{i}").items()}
    if isinstance(owner, (bool, int, float, np.ndarray)):
        return {name: np.asarray(owner, dtype=float)}
    return {}

"""The sheets as systems of a model: their definition, and the values of one of them."""

from __future__ import annotations

from typing import Any

from mdlgen.model.tables import Model


def definition(model: Model) -> str:
    """Name of the system definition that holds the sheets of a scene."""
    return f"def_sys_{model.name}"


def inside(values: dict[str, Any], prefix: str) -> dict[str, Any]:
    """The values of what stands in one system, with the names that they have in it."""
    if not prefix:
        return values
    return {
        kind: {
            name.removeprefix(prefix): _without(record, prefix)
            for name, record in records.items()
            if name.startswith(prefix)
        }
        for kind, records in values.items()
    }


def _without(value: Any, prefix: str) -> Any:
    if isinstance(value, str):
        return value.replace(prefix, "")
    if isinstance(value, dict):
        return {key: _without(v, prefix) for key, v in value.items()}
    if isinstance(value, (tuple, list)) and value and not isinstance(value[0], float):
        return tuple(_without(v, prefix) for v in value)
    return value

"""A run's tables in an HDF5 file: arrays as datasets under `model/`, all else in one JSON text."""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from mdlgen.model import tables
from mdlgen.results.estimates import Estimate
from mdlgen.results.result import Energy

# What may stand in a file; a name is looked up here and nowhere else.
_CLASSES = {
    **{name: kind for name, kind in vars(tables).items() if isinstance(kind, type) and is_dataclass(kind)},
    "Energy": Energy,
    "Estimate": Estimate,
}
_TEXT = "model/tables"


def put(file: Any, values: dict[str, Any]) -> None:
    """Writes named values: tables, numbers, texts, None, and tuples and mappings of these."""
    text = json.dumps(_encode(values, "model", file))
    file.create_dataset(_TEXT, data=np.bytes_(text.encode("ascii")), track_times=False)


def take(file: Any) -> dict[str, Any]:
    """What `put` wrote. Raises KeyError or TypeError for what this version does not know."""
    return _decode(json.loads(bytes(file[_TEXT][()])), file)


def _encode(value: Any, path: str, file: Any) -> Any:
    if isinstance(value, np.ndarray):
        file.create_dataset(path, data=value, track_times=False)
        return {"array": path}
    if is_dataclass(value):
        held = {f.name: _encode(getattr(value, f.name), f"{path}/{f.name}", file) for f in fields(value)}
        return {"table": type(value).__name__, "of": held}
    if isinstance(value, dict):
        return {"map": {key: _encode(item, f"{path}/{key}", file) for key, item in value.items()}}
    if isinstance(value, (tuple, list)):
        return [_encode(item, f"{path}/{k}", file) for k, item in enumerate(value)]
    return value.item() if isinstance(value, np.generic) else value


def _decode(value: Any, file: Any) -> Any:
    if isinstance(value, list):
        return tuple(_decode(item, file) for item in value)
    if not isinstance(value, dict):
        return value
    if "array" in value:
        return file[value["array"]][()]
    if "map" in value:
        return {key: _decode(item, file) for key, item in value["map"].items()}
    held = {key: _decode(item, file) for key, item in value["of"].items()}
    return _CLASSES[value["table"]](**held)

"""A run's tables in an HDF5 file: arrays as datasets under `model/`, all else in one JSON text."""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from mdlgen.model import tables
from mdlgen.model.parts.kinds import KINDS
from mdlgen.results.estimates import Estimate
from mdlgen.results.result import Chaos, Energy
from mdlgen.results.stored import Stored

# Classes that a file may hold; a name is searched here and nowhere else.
_CLASSES = {
    **{name: kind for name, kind in vars(tables).items() if isinstance(kind, type) and is_dataclass(kind)},
    **{kind.part.__name__: kind.part for kind in KINDS},
    "Chaos": Chaos,
    "Energy": Energy,
    "Estimate": Estimate,
}
_TEXT = "model/tables"
# Stored times and bodies that are compressed together (convention: a tenth of h5py's cache of 1 MiB).
CHUNK = 64
_FORMER = ("rollers", "planes", "guides", "meshes")  # parts of the machine in files of older versions


class Writer:
    """Makes datasets in an open file of h5py, with the groups above them, and without times of writing.

    A run has some 150; h5py's own `create_dataset` takes several times as long for each.
    """

    def __init__(self, file: Any):
        from h5py import h5p  # pyright: ignore[reportAttributeAccessIssue]

        self._file = file.id
        self._made, self._linked = h5p.create(h5p.DATASET_CREATE), h5p.create(h5p.LINK_CREATE)
        self._made.set_obj_track_times(False)
        self._linked.set_create_intermediate_group(True)

    def put(self, name: str, data: Any) -> None:
        """One array, number or row of bytes, by its path."""
        from h5py import h5d, h5s, h5t  # pyright: ignore[reportAttributeAccessIssue]

        if isinstance(data, Stored) and all(data.shape):
            self._put_blocks(name, data)
            return
        array = np.asarray(data, order="C")
        space = h5s.create_simple(array.shape) if array.shape else h5s.create(h5s.SCALAR)
        kind = h5t.py_create(array.dtype, logical=True)
        made = h5d.create(self._file, name.encode("ascii"), kind, space, self._made, self._linked)
        made.write(h5s.ALL, h5s.ALL, array)

    def _put_blocks(self, name: str, stored: Stored) -> None:
        """One of sheets that come in and leave, some times at once, compressed: rows of a sheet that is not
        there are all the same, and take next to nothing."""
        from h5py import h5d, h5p, h5s, h5t  # pyright: ignore[reportAttributeAccessIssue]

        made = h5p.create(h5p.DATASET_CREATE)
        made.set_obj_track_times(False)
        made.set_chunk((*(min(CHUNK, n) for n in stored.shape[:2]), *stored.shape[2:]))
        made.set_shuffle()
        made.set_deflate(1)
        space, kind = h5s.create_simple(stored.shape), h5t.py_create(stored.dtype, logical=True)
        whole = h5d.create(self._file, name.encode("ascii"), kind, space, made, self._linked)
        for begin in range(0, len(stored), CHUNK):
            part = np.ascontiguousarray(stored[begin : begin + CHUNK])
            space.select_hyperslab((begin, *(0 for _ in part.shape[1:])), part.shape)
            whole.write(h5s.create_simple(part.shape), space, part)


def put(file: Any, values: dict[str, Any]) -> None:
    """Writes named values: tables, numbers, texts, None, and tuples and mappings of these."""
    writer = Writer(file)
    text = json.dumps(_encode(values, "model", writer))
    writer.put(_TEXT, np.bytes_(text.encode("ascii")))


def take(file: Any) -> dict[str, Any]:
    """The object that `put` wrote. Raises KeyError or TypeError for content that this version does not
    know."""
    return _decode(json.loads(bytes(file[_TEXT][()])), file)


def _encode(value: Any, path: str, file: Writer) -> Any:
    if isinstance(value, (str, float, int)) and not isinstance(value, np.generic):  # most are
        return value
    if isinstance(value, np.ndarray):
        file.put(path, value)
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
    if value["table"] == "Model" and "machine" not in held:  # of an older version, with a table for each kind
        held["machine"] = sum((held.pop(kind, ()) for kind in _FORMER), ())
    if value["table"] == "Contacts" and "air_viscosity" not in held:  # of an older version
        held["air_viscosity"] = held["air_roughness"] = np.zeros(len(held["part_a"]))
    if value["table"] == "Contacts" and "sticking" not in held:
        held["sticking"] = np.zeros(len(held["part_a"]))
    return _CLASSES[value["table"]](**held)

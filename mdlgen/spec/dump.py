"""A scene made in Python as plain data, and what it is dumped as: with its formulas, nips and piles, so that
the dump reads as the same scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, SerializationInfo

from mdlgen.spec.beside import with_whole_names
from mdlgen.spec.nip import names_of
from mdlgen.spec.pile import names_of as sheets_of
from mdlgen.spec.stream import names_of as sheets_of_stream

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene


def said(scene: Scene, data: dict[str, Any], info: SerializationInfo) -> dict[str, Any]:
    """The fields of a scene with formulas as their texts, and without the parts and contacts that its nips
    and piles make again."""
    of_nips = {roller for name, nip in scene.nips.items() for roller in names_of(name, vars(nip))}
    kept = len(scene.contacts) - scene.contacts_made
    of_piles = {sheet for name, pile in scene.piles.items() for sheet in sheets_of(name, vars(pile))}
    of_piles |= {s for name, own in scene.streams.items() for s in sheets_of_stream(name, vars(own))}
    if of_nips and "rollers" in data:
        data["rollers"] = {name: part for name, part in data["rollers"].items() if name not in of_nips}
    if of_piles and "sheets" in data:
        own = {name: sheet for name, sheet in data["sheets"].items() if name not in of_piles}
        data["sheets"] = {**scene.sheets_of_piles, **own}
    if scene.contacts_made and "contacts" in data:
        data["contacts"] = data["contacts"][:kept]
    if info.exclude_defaults or info.exclude_none or info.exclude_unset:
        # values that are left out here would be filled in from the defaults; the nips already have them
        data.pop("defaults", None)
    for path, formula in scene.formulas.items():
        if path[1:2] and path[1] in {"rollers": of_nips, "sheets": of_piles}.get(str(path[0]), ()):
            continue
        if path[:1] == ("contacts",) and int(path[1]) >= kept:
            continue
        if _put(data, path, formula, info.exclude_defaults) or not info.exclude_defaults:
            continue
        data[str(path[0])] = scene.model_dump(mode=info.mode)[str(path[0])]
    return data


def in_plain_data(given: dict[str, Any]) -> dict[str, Any]:
    """A scene made in Python as the data that a file would have: parts as mappings, without null values and
    without empty tables."""
    data = _plain(given)
    with_whole_names(data)
    # null removes a default, or a value of a nip
    meant = set(data) if data.get("defaults") else {"nips", "rollers", "contacts"} if data.get("nips") else ()
    return {
        kind: table if kind in meant else _without_nulls(table)
        for kind, table in data.items()
        if table is not None and (kind == "sheets" or not isinstance(table, (dict, list)) or table)
    }


def _without_nulls(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nulls(item) for key, item in value.items() if item is not None}
    return [_without_nulls(item) for item in value] if isinstance(value, list) else value


def _plain(value: Any) -> Any:
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json", exclude_unset=True)
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, (list, tuple)) else value


def _put(data: Any, path: tuple[Any, ...], formula: str, new: bool) -> bool:
    """Puts a formula in the place of its value, which may be missing where `new`; whether it could be."""
    node: Any = data
    owner: Any = None
    for depth, key in enumerate(path):
        if isinstance(node, tuple):  # to be written into
            node = owner[path[depth - 1]] = list(node)
        if depth == len(path) - 1:
            break
        owner = node
        try:
            node = node[key]
        except (KeyError, IndexError, TypeError):
            return False
    if isinstance(node, dict) and not new and path[-1] not in node:
        return False
    node[path[-1]] = formula
    return True

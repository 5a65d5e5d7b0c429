"""Expands the shorthand of a scene: rows of parts, nips, piles, streams, contacts by name, and defaults."""

from __future__ import annotations

from typing import Any

from pydantic import Field, model_validator

from mdlgen.errors import did_you_mean
from mdlgen.spec import nip, pile, stream
from mdlgen.spec.contact import Contact
from mdlgen.spec.machine import Roller
from mdlgen.spec.nip import Nip
from mdlgen.spec.rows import expanded
from mdlgen.spec.strict import Strict, fail

Path = tuple[str | int, ...]
# Two keys for one value: the part's own key counts, and the other one in `defaults` does not.
_WORDS = ({"radius", "diameter"},)
_MOST_STEPS = 8  # from what is made to the text: a contact, of a nip, of a row, of the defaults
OF_CONTACTS = tuple(name for name in Contact.model_fields if name not in ("between", "name"))
OF_ROLLERS = tuple(name for name in Roller.model_fields if name not in ("repeat", "mirror"))
OF_NIPS = tuple(name for name in Nip.model_fields if name not in ("repeat", "mirror"))


class Defaults(Strict):
    """Values of keys that contacts, rollers and nips leave out.

    Where a part gives some keys of a mapping such as `press`, the others come from here. `KEY: null` on a
    part leaves the default out.
    """

    contacts: dict[str, Any] = Field(
        default_factory=dict,
        description="keys of every contact, but `between`",
    )
    rollers: dict[str, Any] = Field(
        default_factory=dict,
        description="keys of every roller",
    )
    nips: dict[str, Any] = Field(
        default_factory=dict,
        description="keys of every nip",
    )

    @model_validator(mode="after")
    def _known(self) -> Defaults:
        for kind, given, names in (
            ("contacts", self.contacts, OF_CONTACTS),
            ("rollers", self.rollers, OF_ROLLERS),
            ("nips", self.nips, OF_NIPS),
        ):
            for key in given:
                if key not in names:
                    meant = did_you_mean(key, names) or f"; allowed: {', '.join(names)}"
                    raise fail(f"unknown key {key[:80]!r}{meant}", within=(kind, key))
        return self


def written_out(data: Any, origins: dict[Path, Path]) -> Any:
    """Plain data of a scene with its shorthand written out; `origins` gets the places in the text of values
    that were moved or copied. Data of a wrong form are left for validation."""
    if not isinstance(data, dict):
        return data
    data = expanded(data, origins)
    given = data.get("defaults")
    defaults = given if isinstance(given, dict) else {}
    if isinstance(data.get("nips"), dict) and isinstance(defaults.get("nips"), dict):
        data["nips"] = {
            name: _deep(item, defaults["nips"], ("nips", name), ("defaults", "nips"), origins)
            for name, item in data["nips"].items()
        }
    nip.take_contacts(data, origins)
    contacts = data.get("contacts")
    if isinstance(contacts, dict):
        data["contacts"] = []
        for index, (name, contact) in enumerate(contacts.items()):
            origins["contacts", index] = ("contacts", name)
            origins["contacts", index, "name"] = ("contacts", name)
            named = {**contact, "name": name} if isinstance(contact, dict) else contact
            data["contacts"].append(named)

    def fill(item: Any, kind: str) -> Any:
        own, names = defaults.get(kind), {"rollers": OF_ROLLERS, "contacts": OF_CONTACTS}[kind]
        return _filled(item, own, names, (kind,), {}) if isinstance(own, dict) else item

    nip.written(data, origins, fill)
    pile.written(data, origins, fill)
    stream.written(data, origins)
    of_contacts, of_rollers = defaults.get("contacts"), defaults.get("rollers")
    if isinstance(of_contacts, dict) and isinstance(data.get("contacts"), (list, tuple)):
        data["contacts"] = [
            _filled(item, of_contacts, OF_CONTACTS, ("contacts", k), origins)
            for k, item in enumerate(data["contacts"])
        ]
    if isinstance(of_rollers, dict) and isinstance(data.get("rollers"), dict):
        data["rollers"] = {
            name: _filled(item, of_rollers, OF_ROLLERS, ("rollers", name), origins)
            for name, item in data["rollers"].items()
        }
    return data


def _deep(item: Any, defaults: dict[str, Any], path: Path, source: Path, origins: dict[Path, Path]) -> Any:
    """A mapping, and those in it, with what they do not say themselves."""
    if not isinstance(item, dict):
        return item
    given = {*item, *(word for words in _WORDS if words & set(item) for word in words)}
    item = dict(item)
    for key, value in defaults.items():
        if key not in given:
            item[key] = value
            origins[(*path, key)] = (*source, key)
        elif isinstance(value, dict):
            item[key] = _deep(item.get(key), value, (*path, key), (*source, key), origins)
    return item


def _filled(
    item: Any, defaults: dict[str, Any], names: tuple[str, ...], path: Path, origins: dict[Path, Path]
) -> Any:
    """A part, or a mapping of one, with the defaults for its missing keys."""
    if not isinstance(item, dict):
        return item
    item = dict(item)
    given = {*item, *(word for words in _WORDS if words & set(item) for word in words)}
    for key, value in defaults.items():
        if key not in names:
            continue
        if key not in given:
            item[key] = value
            origins[(*path, key)] = ("defaults", path[0], key)
        elif isinstance(value, dict) and isinstance(item.get(key), dict):
            own = item[key]
            item[key] = {**value, **own}
            for inner in value:
                if inner not in own:
                    origins[(*path, key, inner)] = ("defaults", path[0], key, inner)
    return item


def in_the_text(path: Path, origins: dict[Path, Path]) -> Path:
    """Path in the text of a value of the scene."""
    for _ in range(_MOST_STEPS):
        end = next((end for end in range(len(path), 0, -1) if path[:end] in origins), 0)
        if not end:
            break
        path = origins[path[:end]] + path[end:]
    return path

"""What a scene says once, or by name, written out: contacts by name, and defaults."""

from __future__ import annotations

from typing import Any

from pydantic import Field, model_validator

from mdlgen.errors import did_you_mean
from mdlgen.spec.contact import Contact
from mdlgen.spec.fields import Strict, fail
from mdlgen.spec.machine import Roller

Path = tuple[str | int, ...]
# Of two words for one value a part's own counts, not the default's other one.
_WORDS = ({"radius", "diameter"},)
OF_CONTACTS = tuple(name for name in Contact.model_fields if name not in ("between", "name"))
OF_ROLLERS = tuple(Roller.model_fields)


class Defaults(Strict):
    """What contacts and rollers have where they do not say it themselves.

    A mapping such as `press` is filled key by key where a part gives some of it. `KEY: null` on a part leaves
    the default out.
    """

    contacts: dict[str, Any] = Field(
        default_factory=dict,
        description="keys of every contact, but `between`",
    )
    rollers: dict[str, Any] = Field(
        default_factory=dict,
        description="keys of every roller",
    )

    @model_validator(mode="after")
    def _known(self) -> Defaults:
        for kind, given, names in (
            ("contacts", self.contacts, OF_CONTACTS),
            ("rollers", self.rollers, OF_ROLLERS),
        ):
            for key in given:
                if key not in names:
                    meant = did_you_mean(key, names) or f"; allowed: {', '.join(names)}"
                    raise fail(f"unknown key {key[:80]!r}{meant}", within=(kind, key))
        return self


def written_out(data: Any, origins: dict[Path, Path]) -> Any:
    """Plain data of a scene with its shorthand written out; `origins` gets where values that were moved or
    copied stand in the text. What is not of the right form is left for validation."""
    if not isinstance(data, dict):
        return data
    data = dict(data)
    contacts = data.get("contacts")
    if isinstance(contacts, dict):
        data["contacts"] = []
        for index, (name, contact) in enumerate(contacts.items()):
            origins["contacts", index] = ("contacts", name)
            origins["contacts", index, "name"] = ("contacts", name)
            named = {**contact, "name": name} if isinstance(contact, dict) else contact
            data["contacts"].append(named)
    defaults = data.get("defaults")
    if not isinstance(defaults, dict):
        return data
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


def _filled(
    item: Any, defaults: dict[str, Any], names: tuple[str, ...], path: Path, origins: dict[Path, Path]
) -> Any:
    """A part, or a mapping of one, with what it does not say itself."""
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
    """Where a value of the scene stands in the text."""
    for end in range(len(path), 0, -1):
        if path[:end] in origins:
            return origins[path[:end]] + path[end:]
    return path

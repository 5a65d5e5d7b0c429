"""The spec's schema: JSON schema for editors, and which model stands at a path."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic.json_schema import GenerateJsonSchema

from mdlgen.spec.scene import Scene
from mdlgen.spec.shorthand import OF_CONTACTS, OF_NIPS, OF_ROLLERS


class _Schema(GenerateJsonSchema):
    """Leaves out defaults in internal units silently: in a file they would be text with a unit."""

    ignored_warning_kinds = {"skipped-choice", "non-serializable-default"}  # noqa: RUF012  pydantic's own form


def json_schema() -> dict[str, Any]:
    """JSON schema of a scene file."""
    schema = Scene.model_json_schema(schema_generator=_Schema)
    defaults = schema["$defs"]["Defaults"]["properties"]
    for kind, model, names in (("contacts", "Contact", OF_CONTACTS), ("rollers", "Roller", OF_ROLLERS)):
        refs = {name: {"$ref": f"#/$defs/{model}/properties/{name}"} for name in names}
        defaults[kind] |= {"additionalProperties": False, "properties": refs}
    rollers = {
        name: ref for name, ref in defaults["rollers"]["properties"].items() if name not in ("center", "axis")
    }
    contact = {
        "type": "object",
        "additionalProperties": False,
        "properties": defaults["contacts"]["properties"],
    }
    press = schema["$defs"]["Press"]
    followed = {
        **press,
        "required": [name for name in press["required"] if name not in ("preload", "direction")],
    }
    side = {"name": {"type": "string"}, "contact": contact, **rollers}
    side["press"] = {"anyOf": [followed, {"type": "null"}]}  # of a nip both follow from its force and place
    nip = schema["$defs"]["Nip"]["properties"]
    for name in ("lower", "upper"):
        nip[name] |= {"additionalProperties": False, "properties": side}
    nip["contact"]["anyOf"][0] |= contact
    schema["$defs"]["Pile"]["properties"]["contact"] |= contact
    refs = {name: {"$ref": f"#/$defs/Nip/properties/{name}"} for name in OF_NIPS}
    defaults["nips"] |= {"additionalProperties": False, "properties": refs}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **schema,
        "allOf": [
            _unless_default(schema, "contacts", "Contact"),
            _unless_default(schema, "rollers", "Roller"),
            _unless_pile(schema),
        ],
    }


def _unless_pile(schema: dict[str, Any]) -> dict[str, Any]:
    """Moves the required keys of a sheet to scenes without `piles`: with them an entry may be a part of what
    a pile makes, `stack_2: {turn: 2 deg}`."""
    part = schema["$defs"]["Sheet"]
    ways = part.pop("oneOf")
    part["oneOf"] = [*ways, {"not": {"anyOf": ways}}]  # of several ways to give the mass no two at once
    whole = {"required": part.pop("required"), "anyOf": ways}
    return {"if": {"required": ["piles"]}, "else": _each("sheets", whole)}


def _unless_default(schema: dict[str, Any], kind: str, model: str) -> dict[str, Any]:
    """Removes the required keys of a model, which `defaults` may give, and requires them without defaults.

    With `nips` no key is required: an entry may be a part of what a nip makes, `entry_lower: {mass: 2 g}`.
    """
    part = schema["$defs"][model]
    given = {"between", "center"}  # of each one alone
    own = [name for name in part["required"] if name in given]
    others = [name for name in part["required"] if name not in given]
    del part["required"]
    ways = part.pop("oneOf", None)
    rest = {"required": others} if ways is None else {"required": others, "oneOf": ways}
    if ways is not None:  # of several ways to give one thing no two at once
        part["not"] = {"required": [way["required"][0] for way in ways]}
    defaults = {"required": ["defaults"], "properties": {"defaults": {"required": [kind]}}}
    return {
        "if": {"required": ["nips"]},
        "else": {
            "allOf": [
                _each(kind, {"required": own}),
                {"if": defaults, "else": _each(kind, rest)},
            ]
        },
    }


def _each(kind: str, each: dict[str, Any]) -> dict[str, Any]:
    """A schema of each part of a kind, which stand in a list or a mapping."""
    entries = {"if": {"type": "array"}, "then": {"items": each}, "else": {"additionalProperties": each}}
    return {"properties": {kind: entries}}


def model_at(path: tuple[str | int, ...]) -> type[BaseModel] | None:
    """The model that describes the mapping at `path` of a scene, or None."""
    model: type[BaseModel] | None = Scene
    skip = False
    for key in path:
        if skip:  # a name in a dict, or an index of a list: the model was found one step before
            skip = False
            continue
        if model is None or key not in keys(model):
            return None
        annotation = keys(model)[str(key)].annotation
        model = _model_in(annotation)
        skip = getattr(annotation, "__origin__", None) in (dict, tuple)
    return None if skip else model


def keys(model: type[BaseModel]) -> dict[str, FieldInfo]:
    """The fields of a model, as a file calls them."""
    return {field.alias or name: field for name, field in model.model_fields.items()}


@cache
def example(model: type[BaseModel], key: str) -> str:
    """How the value of a key may look in a file, from its JSON schema; "" where that does not say."""
    schema = model.model_json_schema(schema_generator=_Schema)
    own = schema.get("properties", {}).get(key)
    return _looks(own, schema.get("$defs", {})) if own else ""


@cache
def bounds(path: tuple[str | int, ...], key: str) -> tuple[float, float]:
    """Bounds of a plain number of the mapping at a path, from its JSON schema; infinite where the schema has
    none."""
    model = model_at(path)
    schema = model.model_json_schema(schema_generator=_Schema) if model else {}
    own = schema.get("properties", {}).get(key, {})
    for choice in (own, *own.get("anyOf", ())):
        if "minimum" in choice or "maximum" in choice:
            return choice.get("minimum", -math.inf), choice.get("maximum", math.inf)
    return -math.inf, math.inf


def _looks(schema: dict[str, Any], models: dict[str, Any]) -> str:
    for choice in ("anyOf", "oneOf"):
        if choice in schema:
            return _looks(schema[choice][0], models)
    if schema.get("examples"):
        return str(schema["examples"][0])
    if "const" in schema or "enum" in schema:
        return str(schema.get("const", (schema.get("enum") or [""])[0]))
    kind = schema.get("type")
    if kind == "array":
        items = schema.get("prefixItems") or [schema.get("items", {})] * schema.get("minItems", 1)
        shown = [_looks(item, models) for item in items]
        return f"[{', '.join(shown)}]" if all(shown) else ""
    plain = {"integer": "10", "number": "0.5", "boolean": "true"}
    return plain.get(str(kind), "my_name" if schema.get("pattern") else "")


def _model_in(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for part in get_args(annotation):
        found = _model_in(part)
        if found:
            return found
    return None

"""Every key of a scene file, from the models that read it."""

from __future__ import annotations

import re
import types
from functools import cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from annotated_types import Ge, Gt, Le, Lt
from markdown import NOTE, sentence, table
from pydantic import BaseModel, WithJsonSchema
from pydantic.fields import FieldInfo

from mdlgen.spec.curve import Curve
from mdlgen.spec.friction import Friction
from mdlgen.spec.grading import Graded
from mdlgen.spec.quantities import Default, one_or_two, quantity, ratio
from mdlgen.spec.scene import Scene

HEAD = f"""{NOTE}# Every key of a scene

A scene is a YAML or JSON file. This page lists each key with its unit, its default and its range.
[How a scene is written](scene.md) explains them in words and with pictures.

- *Value* says what the key takes. A quantity is text with a unit: `0.72 g`, `186.7 rad/s`.
  The unit in brackets names the dimension; any unit of that dimension is read.
- *Default* is what counts where the key is left out; empty: nothing, or as the meaning says.
- `NAME` stands for a name of your own: a letter, then letters, digits or `_`, 63 at most.
- `mdlgen schema` prints the same as JSON schema, for editors.

"""
# what may stand in place of a mapping
_SHORT: dict[type[BaseModel], str] = {
    Friction: "number, list [md, cd], or mapping",
    Curve: "list of points, or mapping",
    Graded: "list of lengths, or mapping",
}
# more than the docstring of a model says, by its path
PICTURES = {
    "sheets.NAME": "![A sheet, its axes, edges and boxes](../pictures/sheet.svg)",
    "planes.NAME": "![Which side is the first length of a plane](../pictures/plane.svg)",
    "guides.NAME.line": "![Sides of a straight guide](../pictures/guide_line.svg)",
    "guides.NAME.arc": "![Angles and sides of an arc](../pictures/guide_arc.svg)",
    "rollers.NAME": "![A roller, its axis and its sense of rotation](../pictures/roller.svg)",
}


def page() -> str:
    """reference/keys.md."""
    return HEAD + "\n".join(_section(path, model) for path, model in models())


@cache
def models() -> list[tuple[str, type[BaseModel]]]:
    """(path in a file, model) of each mapping that a scene has, the scene first; a model that stands at
    several paths is listed at the first."""
    found: dict[type[BaseModel], str] = {}
    todo: list[tuple[str, type[BaseModel]]] = [("", Scene)]
    while todo:
        path, model = todo.pop(0)
        if model in found:
            continue
        found[model] = path
        inner = []
        for key, annotation, _ in fields(model):
            inner += [(f"{path}.{key}{more}".lstrip("."), m) for more, m in _models_in(annotation)]
        todo = inner + todo
    return [(path, model) for model, path in found.items()]


def fields(model: type[BaseModel]) -> list[tuple[str, Any, FieldInfo]]:
    """(key as a file has it, annotation with its marks, field) of a model."""
    hints = get_type_hints(model, include_extras=True)
    return [(f.alias or name, hints[name], f) for name, f in model.model_fields.items()]


def _models_in(annotation: Any) -> list[tuple[str, type[BaseModel]]]:
    """Models that an annotation holds, with what leads to them: .NAME in a mapping, .N in a list."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [("", annotation)]
    origin, found = get_origin(annotation), []
    more = ".NAME" if origin is dict else ".N" if origin is tuple else ""
    for part in get_args(annotation):
        found += [(more + rest, m) for rest, m in _models_in(part)]
    return found


def _section(path: str, model: type[BaseModel]) -> str:
    level = "##" if path.count(".") <= 1 else "###"
    title = f"{level} `{path}`" if path else "## The scene"
    words = "\n\n".join(
        " ".join(part.split()) for part in (model.__doc__ or "").split("\n\n") if part.strip()
    )
    either = list(dict.fromkeys(key for way in _either(model) for key in way["required"]))
    rows = [
        (
            f"`{key}`",
            _linked(value(a, f), a),
            f"**one of** {', '.join(either)}" if key in either else shown_default(f),
            describe(f),
        )
        for key, a, f in fields(model)
    ]
    picture = f"{PICTURES[path]}\n\n" if path in PICTURES else ""
    return f"{title}\n\n{words}\n\n{picture}{table(('key', 'value', 'default', 'meaning'), rows)}"


def _either(model: type[BaseModel]) -> list[dict[str, Any]]:
    """Keys of which one is required, as the JSON schema says it."""
    change = model.model_config.get("json_schema_extra")
    schema: dict[str, Any] = {}
    if callable(change):
        change(schema)  # pyright: ignore[reportCallIssue]
    return schema.get("oneOf", schema.get("anyOf", []))


def _linked(text: str, annotation: Any) -> str:
    """With links to the sections of the models that a value holds."""
    there = {model: path for path, model in models()}
    links = []
    for _, model in _models_in(annotation):
        path = there[model]
        anchor = re.sub(r"[^a-z0-9_]", "", path.lower())
        links.append(f"[{path}](#{anchor})")
        text = text.replace("mapping", _SHORT.get(model, "mapping"), 1) if model in _SHORT else text
    return f"{text}: {', '.join(links)}" if links else text


def describe(field: FieldInfo) -> str:
    """What a key means; "" where the code does not say."""
    return sentence(field.description or "")


def shown_default(field: FieldInfo) -> str:
    if field.is_required():
        return "**required**"
    value = field.get_default(call_default_factory=True)
    if value is None or isinstance(value, (dict, BaseModel)) or value == ():
        return ""
    return f"`{_plain(value)}`"


def _plain(value: Any) -> str:
    if isinstance(value, Default):
        return value.text
    if isinstance(value, tuple):
        return f"[{', '.join(_plain(v) for v in value)}]"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value)


def value(annotation: Any, field: FieldInfo | None = None) -> str:
    """What a key takes, with unit and range."""
    marks: list[Any] = list(field.metadata) if field is not None else []
    return _value(annotation, marks)


def _value(annotation: Any, marks: list[Any]) -> str:
    if get_origin(annotation) is Annotated:
        inner, *own = get_args(annotation)
        return _marked(inner, own + marks)
    return _marked(annotation, marks)


def _marked(annotation: Any, marks: list[Any]) -> str:
    for mark in marks:
        if isinstance(mark, quantity):
            several = ", or two" if isinstance(mark, one_or_two) else ""
            limits = f", {mark.allowed()}" if mark.low is not None else ""
            return f"quantity [{mark.unit}]{several}{limits}"
        if isinstance(mark, ratio):
            return f"number or percentage, {mark.low:g} to {mark.high:g}"
        if isinstance(mark, WithJsonSchema) and mark.json_schema is not None:
            return _from_schema(mark.json_schema)
        if isinstance(mark, FieldInfo) and mark.metadata:
            return _marked(annotation, [*mark.metadata, *(m for m in marks if m is not mark)])
    origin, args = get_origin(annotation), get_args(annotation)
    if origin in (Union, types.UnionType):
        # a mark on a union is one of its members
        return ", or ".join(_value(a, marks) for a in args if a is not type(None))
    if origin is Literal:
        return " or ".join(f"`{_plain(a)}`" for a in args)
    if origin is dict:
        return "mapping of names"
    if origin is tuple:
        if args[-1] is Ellipsis:
            item = _value(args[0], [])
            return "list" if item == "mapping" else f"list of: {item}"
        items = [_value(a, []) for a in args]
        if all(item == items[0] for item in items):
            return f"list of {len(items)}: {items[0]}"
        return f"list of {len(items)}: " + "; ".join(items)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return "mapping"
    name = {float: "number", int: "whole number", bool: "`true` or `false`", str: "text"}[annotation]
    return name + _range(marks)


def _range(marks: list[Any]) -> str:
    words = {Ge: ("ge", "at least"), Gt: ("gt", "more than"), Le: ("le", "at most"), Lt: ("lt", "below")}
    found = {kind: getattr(m, words[kind][0]) for m in marks for kind in words if isinstance(m, kind)}
    if Ge in found and Le in found:
        return f", {found[Ge]:g} to {found[Le]:g}"
    return "".join(f", {words[kind][1]} {limit:g}" for kind, limit in found.items())


def _from_schema(schema: dict[str, Any]) -> str:
    if "anyOf" in schema:
        one, *_ = schema["anyOf"]
        if "enum" in one:
            return "direction: `x`, `-z`, ... or a vector `[1, 0, 0]`"
        if "minimum" in one:
            return f"number, or two, {one['minimum']:g} to {one['maximum']:g}"
        if schema["anyOf"][1:] == [{"type": "array", "items": one}]:
            return "text, or a list of texts"
        return "number, or text such as " + " or ".join(
            f"`{example}`" for example in schema.get("examples", []) if isinstance(example, str)
        )
    return "variable of a MotionView model" if "examples" in schema else "name"

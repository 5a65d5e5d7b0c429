"""mdlgen/__init__.pyi: what type checkers see of the package, with the texts that constructors take."""

from __future__ import annotations

from keyword import iskeyword
from typing import Any

import mdlgen
from mdlgen.spec.schema import json_schema

HEAD = '''\
# Written by docs/_generate from the schema of a scene: python docs/_generate
"""Scenes in Python take what a file has: texts with units, numbers, lists, mappings."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

'''
# Parts are made of what a file has; what is read back are the values, in mm, N, g, ms, rad.
FUNCTIONS = """
__version__: str

def load(path: str | Path, overrides: Iterable[str] = ()) -> Scene: ...
def loads(text: str, overrides: Iterable[str] = (), folder: str | Path | None = None) -> Scene: ...
def lower(scene: _Scene) -> Model: ...
def emit(model: Model, backend: str = "motionview") -> str: ...
def solve(
    model: Model,
    solver: str = "auto",
    progress: Callable[[float, float, int, int], None] | None = None,
    check_step: bool = False,
) -> Result: ...
def compare(result: Result, other: Result) -> Comparison: ...
"""
METHODS = {
    "Scene": [
        "def with_(self, changes: Mapping[str, Any] | None = None, **more: Any) -> Scene: ...",
    ]
}
OTHERS = ("Model", "Result")  # not made by users


def stub() -> str:
    """The text of the stub; the same code gives the same bytes."""
    schema = json_schema()
    classes = {name: schema if name == "Scene" else schema["$defs"][name] for name in _made()}
    lines = [HEAD]
    imports = [
        f"from {module} import {name} as {name if name in OTHERS else f'_{name}'}\n"
        for name, module in sorted(mdlgen.CLASSES.items())
    ]
    imports.append("from mdlgen.results.compare import Comparison\n")
    lines += sorted(imports)
    lines.append(FUNCTIONS)
    for name, own in classes.items():
        lines += ["\n", *_class(name, own)]
    return "".join(lines)


def _made() -> list[str]:
    return sorted(name for name in mdlgen.CLASSES if name not in OTHERS)


def _class(name: str, schema: dict[str, Any]) -> list[str]:
    schema = schema if "properties" in schema else schema["anyOf"][0]  # a list is a shorthand of some
    required = set(schema.get("required", ()))
    # of two words for one value either is given, and their models say so
    fields = sorted(schema["properties"].items(), key=lambda item: item[0] not in required)
    lines = [f"class {name}(_{name}):\n", "    def __init__(\n        self,\n        *,\n"]
    for key, own in fields:
        if not iskeyword(key):
            lines.append(f"        {key}: {_type(own)}{'' if key in required else ' = ...'},\n")
    if any(map(iskeyword, schema["properties"])):
        lines.append("        **more: Any,\n")
    lines.append("    ) -> None: ...\n")
    lines += [f"    {line}\n" for line in METHODS.get(name, ())]
    return lines


def _type(schema: dict[str, Any]) -> str:
    """What a constructor takes for a key."""
    return " | ".join(dict.fromkeys(_types(schema)))


def _types(schema: dict[str, Any]) -> list[str]:
    if "anyOf" in schema:
        return [one for each in schema["anyOf"] for one in _types(each)]
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        own = [f"_{name}"] if name in _made() else []
        return [*own, "Mapping[str, Any]"]
    if "enum" in schema or "const" in schema:
        values = schema.get("enum", [schema.get("const")])
        return [f"Literal[{', '.join(map(repr, values))}]".replace("'", '"')]
    kind = schema.get("type")
    if kind == "array":
        items = schema.get("prefixItems") or [schema.get("items", {})]
        inner = dict.fromkeys(one for item in items for one in (_types(item) or ["Any"]))
        return [f"Sequence[{' | '.join(inner)}]"]
    if kind == "object":
        values = [*schema.get("patternProperties", {}).values()]
        more = schema.get("additionalProperties")
        values += [more] if isinstance(more, dict) else []
        inner = dict.fromkeys(one for value in values for one in _types(value)) or ["Any"]
        return [f"Mapping[str, {' | '.join(inner)}]"]
    plain = {"string": "str", "number": "float", "integer": "int", "boolean": "bool", "null": "None"}
    return [plain[str(kind)]] if kind else ["Any"]

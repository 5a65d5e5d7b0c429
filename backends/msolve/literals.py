"""Values as Python writes them, broken over lines where they are long."""

from __future__ import annotations

from typing import Any

WIDTH = 110


def literal(value: Any, indent: int = 0, used: int = 0) -> str:
    """Numbers, texts, lists, tuples and dicts; `used` characters of the first line are taken already."""
    short = _plain(value)
    if used + indent + len(short) < WIDTH or not isinstance(value, (list, tuple, dict)) or not value:
        return short
    inner = " " * (indent + 4)
    if isinstance(value, dict):
        items = [f"{_plain(k)}: {literal(v, indent + 4, len(_plain(k)) + 3)}" for k, v in value.items()]
        ends = "{}"
    else:
        items = [literal(item, indent + 4, 1) for item in value]
        ends = "[]" if isinstance(value, list) else "()"
    if all(isinstance(item, float) for item in value):  # a long column of numbers fills its lines
        items = _filled(items, WIDTH - indent - 6)
    lines = "".join(f"{inner}{item},\n" for item in items)
    return f"{ends[0]}\n{lines}{' ' * indent}{ends[1]}"


def _plain(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_plain(k)}: {_plain(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_plain, value)) + "]"
    if isinstance(value, tuple):
        return "(" + ", ".join(map(_plain, value)) + ("," if len(value) == 1 else "") + ")"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def _filled(items: list[str], width: int) -> list[str]:
    lines, line = [], ""
    for item in items:
        if line and len(line) + len(item) + 2 > width:
            lines.append(line)
            line = ""
        line = f"{line}, {item}" if line else item
    return [*lines, line]

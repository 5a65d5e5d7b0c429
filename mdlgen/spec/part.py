"""Parts that are made elsewhere: a body of the user's own MotionView model, met there by the sheets."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from mdlgen.spec.fields import IDENTIFIER
from mdlgen.spec.strict import Strict, fail

# Variable names of MDL, as deep as systems in systems are written in practice.
_PATH = re.compile(rf"{IDENTIFIER.pattern}(?:\.{IDENTIFIER.pattern}){{0,9}}")


def _path(value: Any) -> str:
    if not isinstance(value, str) or not _PATH.fullmatch(value):
        raise fail(
            f"{str(value)[:80]!r} is not a variable of a MotionView model; "
            "allowed: a name like b_feed, or a path of at most 10 names like MODEL.sys_feed.b_feed"
        )
    return value


def _paths(value: Any) -> tuple[Any, ...]:
    if not isinstance(value, (list, tuple)) or not value:
        raise fail(f"graphics needs at least one name in a list like [gra_feed], got {value!r}"[:200])
    for k, item in enumerate(value):
        if item in value[:k]:
            raise fail(f"the graphic {str(item)[:80]!r} stands twice in the list")
    return tuple(value)


def _true(value: Any) -> Any:
    if value is not True:
        raise fail("a part is a body of your own MotionView model: write external: true")
    return value


EntityPath = Annotated[
    str,
    BeforeValidator(_path),
    WithJsonSchema({"type": "string", "pattern": f"^{_PATH.pattern}$", "examples": ["sys_feed.b_feed"]}),
]


class Part(Strict):
    """A body of the user's MotionView model, of which nothing else is known here."""

    external: Annotated[Literal[True], BeforeValidator(_true)] = Field(
        description="true: the body is one of your own MotionView model; such a scene has no local run"
    )
    body: EntityPath = Field(description="variable of the body there")
    graphics: Annotated[tuple[EntityPath, ...], BeforeValidator(_paths)] = Field(
        description="variables of its graphics that the sheets can touch", json_schema_extra={"minItems": 1}
    )

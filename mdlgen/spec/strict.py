"""The base of every model of the spec, and the errors that its fields raise."""

from __future__ import annotations

from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict
from pydantic_core import PydanticCustomError


class Strict(BaseModel):
    """Extra keys forbidden, no coercion, finite numbers only, frozen after validation."""

    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        allow_inf_nan=False,
        frozen=True,
        validate_default=True,
        serialize_by_alias=True,
        defer_build=True,
    )


Model = TypeVar("Model", bound=BaseModel)


def with_values(owner: Model, **values: Any) -> Model:
    """The same, frozen, object with other values, for a validator that runs after its fields are read: a
    constructor does not hear of another object that is returned."""
    vars(owner).update(values)
    owner.model_fields_set.update(values)
    return owner


def fail(
    message: str, path: tuple[str | int, ...] | None = None, within: tuple[str | int, ...] = ()
) -> PydanticCustomError:
    """An error for pydantic to raise. Where it is not about the field itself, `path` is from the scene's
    root, `within` from the field."""
    return PydanticCustomError("spec", "{text}", {"text": message, "path": path, "within": within})


def fail_all(errors: list[PydanticCustomError]) -> PydanticCustomError:
    """One error for pydantic to raise that stands for several; each is reported on its own."""
    if len(errors) == 1:
        return errors[0]
    first = dict(errors[0].context or {})
    return PydanticCustomError(
        "spec", "{text}", {**first, "several": [dict(e.context or {}) for e in errors]}
    )

"""The spec's schema: JSON schema for editors, and which model stands at a path."""

from __future__ import annotations

from typing import Any, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic.json_schema import GenerateJsonSchema

from mdlgen.spec.scene import Scene


class _Schema(GenerateJsonSchema):
    """Leaves out defaults in internal units silently: in a file they would be text with a unit."""

    ignored_warning_kinds = {"skipped-choice", "non-serializable-default"}  # noqa: RUF012  pydantic's own form


def json_schema() -> dict[str, Any]:
    """JSON schema of a scene file."""
    schema = Scene.model_json_schema(schema_generator=_Schema)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


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


def _model_in(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for part in get_args(annotation):
        found = _model_in(part)
        if found:
            return found
    return None

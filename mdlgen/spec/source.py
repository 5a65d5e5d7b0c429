"""Origin of a scene, and its text: with the comments of the file, and the changes since."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq

from mdlgen.spec.document import Document, parse

_WIDTH = 10_000  # lines are broken where the file breaks them


class Source:
    """The document that a scene was read from, with what was set in it, and the folder of its files.

    No part of what the scene is: any two are equal.
    """

    def __init__(self, document: Document | None = None, folder: Path | None = None):
        self.document, self.folder = document, folder

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Source)

    __hash__ = None  # type: ignore[assignment]


def text_of(document: Document) -> str:
    """The text of a document with the values that it has now; comments stay where their values do."""
    data = document.data
    if document.text and parse(document.text, document.file).data == data:
        return document.text
    yaml = _writer()
    node = yaml.load(document.text) if document.text else None
    return _dumped(yaml, _synced(node, data))


def text_of_data(data: Any) -> str:
    """Plain data as a text; a list of plain values, as a place, is on one line."""
    return _dumped(_writer(), _on_lines(data))


def _on_lines(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _on_lines(item) for key, item in value.items()}
    if not isinstance(value, list):
        return value
    made = CommentedSeq(_on_lines(item) for item in value)
    if not any(isinstance(item, (dict, list)) for item in value):
        made.fa.set_flow_style()
    return made


def _writer() -> YAML:
    yaml = YAML(typ="rt", pure=True)
    yaml.width, yaml.preserve_quotes, yaml.allow_unicode = _WIDTH, True, True
    yaml.indent(mapping=2, sequence=4, offset=2)
    return yaml


def _dumped(yaml: YAML, node: Any) -> str:
    stream = io.StringIO()
    yaml.dump(node, stream)
    return stream.getvalue()


def _synced(node: Any, data: Any) -> Any:
    """A node of a text with the values of plain data; equal values stay as they are written."""
    if isinstance(node, CommentedMap) and isinstance(data, dict):
        for key in [key for key in node if key not in data]:
            del node[key]
        for key, value in data.items():
            node[key] = _synced(node[key], value) if key in node else value
        return node
    if isinstance(node, CommentedSeq) and isinstance(data, list) and len(node) == len(data):
        for k, value in enumerate(data):
            node[k] = _synced(node[k], value)
        return node
    return node if type(data) is not bool and node == data and not isinstance(node, bool) else data

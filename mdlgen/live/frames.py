"""Messages between the server and its worker: a record as JSON, followed by a body of bytes."""

from __future__ import annotations

import json
import struct
from typing import Any

_LENGTHS = struct.Struct(">II")
HEAD = _LENGTHS.size
Frame = tuple[dict[str, Any], bytes]


def packed(record: dict[str, Any], body: bytes = b"") -> bytes:
    head = json.dumps(record, allow_nan=False).encode()
    return _LENGTHS.pack(len(head), len(body)) + head + body


def lengths(head: bytes) -> tuple[int, int]:
    """Lengths of the record and of the body, from the first HEAD bytes."""
    return _LENGTHS.unpack(head)

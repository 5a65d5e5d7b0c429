"""A file NAME.program: one line of JSON with its head, and LLVM bitcode of its parts, compressed.

Shared libraries NAME.TARGET.so in the same folder are made from that bitcode. The file has their digests.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import lzma
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mdlgen.program.layout import Type

FORMAT = 4
MOST_BYTES = 50_000_000


class Unfit(Exception):
    """The reason why a program cannot be used here."""


@dataclass(frozen=True)
class Variant:
    """A compiled entry for arguments of given types."""

    symbol: str
    arguments: tuple[Type, ...]
    result: Type


@dataclass(frozen=True)
class Head:
    """The head of a program file."""

    digest: str  # of the kernels that it was made from, and of their statements alone (program.digests)
    statements: str
    code: str  # SHA-256 of the bytes after the head
    versions: dict[str, str]  # of the packages that made it
    entries: dict[str, tuple[Variant, ...]]
    external: tuple[str, ...]  # functions of the system that it calls
    parts: tuple[int, ...]  # bytes of bitcode of each part
    libraries: dict[str, str]  # SHA-256 of each library, by the name of its target

    def line(self) -> bytes:
        """The first line of the file."""
        message: dict[str, Any] = {
            "format": FORMAT,
            "digest": self.digest,
            "statements": self.statements,
            "code": self.code,
            "versions": self.versions,
            "external": list(self.external),
            "parts": list(self.parts),
            "libraries": self.libraries,
            "entries": {
                name: [[v.symbol, list(v.arguments), v.result] for v in variants]
                for name, variants in self.entries.items()
            },
        }
        return json.dumps(message, separators=(",", ":"), sort_keys=True).encode("ascii") + b"\n"


def library(path: Path, target: str) -> Path:
    """Path of the library of a program for a target."""
    return path.with_name(f"{path.stem}.{target}.so")


def write(path: Path, head: Head, packed: bytes) -> None:
    """Writes a program, of which `packed` is the compressed bitcode."""
    path.write_bytes(head.line() + packed)


def pack(parts: Sequence[bytes]) -> tuple[bytes, str]:
    """Compressed bitcode of the parts of a program, and the digest of that."""
    packed = lzma.compress(b"".join(parts), preset=9 | lzma.PRESET_EXTREME)
    return packed, hashlib.sha256(packed).hexdigest()


def read_head(path: Path) -> Head:
    """The head of a program file. Raises Unfit."""
    return _open(path)[0]


def read(path: Path) -> tuple[Head, list[bytes]]:
    """The head of a program file, and the bitcode of its parts. Raises Unfit for a damaged or other file."""
    head, packed = _open(path)
    if hashlib.sha256(packed).hexdigest() != head.code:
        raise Unfit(f"{path.name} is damaged")
    try:
        whole = lzma.decompress(packed)
    except lzma.LZMAError:
        raise Unfit(f"{path.name} is damaged") from None
    ends = list(itertools.accumulate(head.parts, initial=0))
    if ends[-1] != len(whole):
        raise Unfit(f"{path.name} is damaged")
    return head, [whole[begin:end] for begin, end in itertools.pairwise(ends)]


def _open(path: Path) -> tuple[Head, bytes]:
    try:
        with open(path, "rb") as stream:
            raw = stream.read(MOST_BYTES)
    except FileNotFoundError:
        raise Unfit(f"there is no {path.name}") from None
    except OSError as error:
        raise Unfit(f"{path.name} cannot be read: {error.strerror}") from None
    line, _, packed = raw.partition(b"\n")
    try:
        record = json.loads(line)
        if record["format"] != FORMAT:
            raise Unfit(f"{path.name} is of another form")
        entries = {
            name: tuple(Variant(symbol, tuple(arguments), result) for symbol, arguments, result in variants)
            for name, variants in record["entries"].items()
        }
        external, parts = tuple(record["external"]), tuple(int(size) for size in record["parts"])
        libraries = {str(name): str(digest) for name, digest in record["libraries"].items()}
        digest, statements, code = (str(record[name]) for name in ("digest", "statements", "code"))
        versions = record["versions"]
        return Head(digest, statements, code, versions, entries, external, parts, libraries), packed
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise Unfit(f"{path.name} is damaged") from None

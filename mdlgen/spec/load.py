"""YAML or JSON text -> Scene, with file:line:column in every error."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from pydantic import ValidationError

from mdlgen import paths
from mdlgen.errors import Place, SpecError
from mdlgen.spec.document import MAX_DEPTH as MAX_DEPTH
from mdlgen.spec.document import Document as Document
from mdlgen.spec.document import parse
from mdlgen.spec.limits import DEFAULT, Limits, Tally
from mdlgen.spec.mistakes import Mistakes
from mdlgen.spec.scene import Scene
from mdlgen.spec.setting import set_value
from mdlgen.spec.source import Source

MAX_BYTES = 2_000_000


def load(path: str | Path, overrides: Iterable[str] = (), limits: Limits = DEFAULT) -> Scene:
    """Read a spec file; `overrides` are `PATH=VALUE` texts as of `--set`. Raises SpecError, OutputError."""
    return loads(read(path), str(path), overrides, Path(path).parent, limits)


def read(path: str | Path) -> str:
    """The text of a spec file, not larger than MAX_BYTES. Raises SpecError, OutputError."""
    raw = paths.read_at_most(Path(path), MAX_BYTES + 1)
    if len(raw) > MAX_BYTES:
        raise SpecError(f"larger than {MAX_BYTES} bytes", place=Place(str(path), 1, 1))
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise SpecError("not UTF-8 text", place=Place(str(path), line, 1)) from None


def loads(
    text: str,
    file: str = "scene",
    overrides: Iterable[str] = (),
    folder: Path | None = None,
    limits: Limits = DEFAULT,
) -> Scene:
    """The Scene of a YAML or JSON text; files that it names are looked for in `folder`, None: not at all.

    Raises SpecError with its place.
    """
    return meant(parse(text, file, limits), overrides, folder, limits)


def meant(
    document: Document, overrides: Iterable[str], folder: Path | None, limits: Limits = DEFAULT
) -> Scene:
    """The Scene of a text that has been parsed, in which `overrides` are set; as `loads`."""
    if not isinstance(document.data, dict):
        raise SpecError("a scene is a mapping of keys to values", place=document.place(()))
    if isinstance(overrides, str):  # its letters are no overrides
        raise SpecError(
            f"overrides are a list of texts; write [{overrides[:80]!r}]", place=document.place(())
        )
    mistakes = Mistakes(document)
    for override in overrides:
        try:
            set_value(document, override)
        except SpecError as error:
            mistakes.add(error)
    try:
        origins = document.origins
        context = {"folder": folder, "limits": limits, "tally": Tally(limits), "origins": origins}
        scene = Scene.model_validate(document.data, context=context)
    except ValidationError as error:
        mistakes.take(error)
        raise mistakes.error() from None
    mistakes.unused(scene)
    if mistakes.found:
        raise mistakes.error()
    scene._source = Source(document, folder)
    return scene

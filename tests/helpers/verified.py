"""Texts, scripts and decks to verify."""

from __future__ import annotations

from pathlib import Path

from places import RICH

from mdlgen.model.lower import lower
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify.outcome import Verification
from mdlgen.verify.verification import verify

SMALL = ["sheets.note.boxes=[4,6]"]


def check(spec: Path, overrides: list[str] | None = None, **options) -> Verification:
    scene = load(spec, overrides or [])
    return verify(scene, lower(scene), **options)


def emitted(spec: Path, overrides: list[str] | None = None, **options) -> str:
    return emitter("motionview").emit(lower(load(spec, overrides or [])), **options)


def files(folder: Path) -> tuple[Path, Path]:
    model = lower(load(RICH))
    text, script = folder / "rich.mdl", folder / "rich_mview.py"
    text.write_text(emitter("motionview").emit(model))
    companion = emitter("motionview").companion(model)
    assert companion is not None
    script.write_text(companion)
    return text, script

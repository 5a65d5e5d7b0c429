"""author and revision of a scene: texts of one line, as YAML has them."""

from __future__ import annotations

import pytest

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.paths import samples

SLIDE = samples() / "verify" / "slide.yaml"


@pytest.mark.parametrize(
    ("written", "read"),
    [("B", "B"), ("3", "3"), ("2026-11-23", "2026-11-23"), ("'J. Müller, 2nd'", "J. Müller, 2nd")],
)
def test_they_are_read_as_written(written: str, read: str) -> None:
    scene = mdlgen.loads(SLIDE.read_text("utf-8") + f"author: {written}\nrevision: {written}\n")
    model = mdlgen.lower(scene)
    assert (model.author, model.revision) == (read, read)
    assert mdlgen.loads(scene.to_yaml()).revision == read
    # the text for MotionView has no word of it
    plain = mdlgen.lower(mdlgen.loads(SLIDE.read_text("utf-8")))
    assert mdlgen.emit(model, "motionview") == mdlgen.emit(plain, "motionview")


@pytest.mark.parametrize("wrong", ["''", "true", "[a]", '"a\\nb"', "x" * 101])
def test_what_is_no_line_of_text_is_refused(wrong: str) -> None:
    with pytest.raises(SpecError, match="author"):
        mdlgen.loads(SLIDE.read_text("utf-8") + f"author: {wrong}\n")

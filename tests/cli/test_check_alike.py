"""`mdlgen check` says once what holds of all sheets of a stream."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.paths import samples


def check(*args: str) -> str:
    done = CliRunner().invoke(app, ["check", *args])
    assert done.exit_code == 0, done.output
    return done.output


def test_sheets_that_are_alike_are_described_once(tmp_path: Path) -> None:
    text = (samples() / "stream.yaml").read_text("utf-8")
    spec = tmp_path / "many.yaml"
    spec.write_text(text.replace("count: 3", "count: 12").replace("boxes: [8, 4]", "boxes: [8, 2]"), "utf-8")
    said = check(str(spec)).splitlines()
    (head,) = [line for line in said if "boxes on" in line]
    assert head.startswith("12 sheets infeed_01, infeed_02 to infeed_12: 8 x 2 = 16 boxes on 67 x 127 mm")
    assert sum("one bushing" in line for line in said) == 1
    record: Any = json.loads(check(str(spec), "--json"))
    assert len(record["sheets"]) == 12


def test_a_lint_of_sheets_that_stay_is_told_once() -> None:
    """The first one is there from the start, so that it neither comes in nor leaves."""
    sets = ("sheets.note.boxes=[8,2]", "streams.infeed.out=[]", "require=[]")
    said = check(str(samples() / "stream.yaml"), *(word for value in sets for word in ("--set", value)))
    assert [line.split(":")[0] for line in said.splitlines() if "W102" in line] == [
        "W102 sheets.infeed_1.boxes"
    ]


def test_sheets_that_differ_are_described_each() -> None:
    heads = [line for line in check(str(samples() / "feeder.yaml")).splitlines() if "boxes on" in line]
    assert [head.partition(":")[0] for head in heads] == ["sheet note_1", "sheet note_2"]

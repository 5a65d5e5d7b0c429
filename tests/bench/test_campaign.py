"""The campaign: seed and number determine a scene, and it is one that a user would write. Outcomes are
counted right. A process that crashes or exceeds its limit costs one scene."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import mdlgen
from mdlgen.bench.campaign import workers as pool
from mdlgen.bench.campaign.counts import alike, counts, grouped
from mdlgen.bench.campaign.draw import RANGES, Draw
from mdlgen.bench.campaign.finer import against, finer
from mdlgen.bench.campaign.found import Campaign
from mdlgen.bench.campaign.kinds import KINDS
from mdlgen.bench.campaign.report import page, table
from mdlgen.bench.campaign.row import INACCURATE, NONE, OK, CampaignRow, Finer
from mdlgen.bench.campaign.scene import TRIES, drawn
from mdlgen.bench.campaign.task import Task
from mdlgen.bench.campaign.worker import judged
from mdlgen.bench.campaign.workers import Workers
from mdlgen.checks import lints
from mdlgen.cli import app
from mdlgen.errors import SpecError
from mdlgen.registry import solver
from mdlgen.results.estimates import complete
from mdlgen.results.result import Result

SEED = 11
NUMBERS = (1, 2, 3)
# Lints that a scene would be wrong by: parts that begin in each other, or that miss their contact.
WRONG = {"W112", "W118", "W119", "W120", "W121", "W105", "W114", "W122"}
BLOCK = """
name: block
materials: {p: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  n: {material: p, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1g, boxes: [1, 1], center: [0 mm, 0 mm, 1 mm]}
planes: {t: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [90 mm, 90 mm, 10 mm]}}
contacts: [{between: [n, t], stiffness: 300 N/mm^1.5, friction: 0.3, smoothing: 10 mm/s}]
run: {duration: 25 ms}
"""


@pytest.mark.parametrize("kind", ["", *KINDS])
def test_seed_and_number_decide_a_scene(kind: str) -> None:
    scene = drawn(SEED, 5, kind)
    assert drawn(SEED, 5, kind) == scene
    assert drawn(SEED, 6, kind).text != scene.text != drawn(SEED + 1, 5, kind).text


@pytest.mark.parametrize("kind", ["channel", "nips", "stack"])
def test_friction_sticks_in_every_second_contact_of_the_same_scene(kind: str) -> None:
    plain, sticks = drawn(SEED, 5, kind), drawn(SEED, 5, kind, sticking=True)
    one, two = plain.model().contacts, sticks.model().contacts
    assert np.array_equal(one.stiffness, two.stiffness) and np.array_equal(one.mu_static, two.mu_static)
    assert not one.sticking.any() and (two.sticking[two.sticking > 0.0] >= RANGES["sticking"].low).all()
    entries, given = (
        text.count(word) for text, word in ((plain.text, "friction:"), (sticks.text, "sticking:"))
    )
    assert given == (entries + 1) // 2


def test_kinds_have_their_shares() -> None:
    """Within four standard deviations of a binomial distribution."""
    count = 1000
    kinds = [list(KINDS)[_kind(number)] for number in range(count)]
    total = sum(share for share, _ in KINDS.values())
    assert total == pytest.approx(100.0)
    for kind, (share, _) in KINDS.items():
        part = share / total
        assert kinds.count(kind) == pytest.approx(count * part, abs=4.0 * (count * part * (1 - part)) ** 0.5)


def _kind(number: int) -> int:
    return Draw([SEED, number, 0, 0]).weighted([share for share, _ in KINDS.values()])


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_is_a_scene_that_a_user_would_write(kind: str) -> None:
    for number in NUMBERS:
        scene = drawn(SEED, number, kind)
        assert scene.kind == kind and len(scene.rejected) < 2
        model = scene.model()
        assert 1 <= sum(sheet.count for sheet in model.sheets) <= RANGES["boxes"].high
        assert not [str(lint) for lint in lints(model) if lint.code in WRONG], scene.text
        _check_ranges(scene.text, kind)


def _check_ranges(text: str, kind: str) -> None:
    for key, name in (("thickness", "thickness"), ("duration", "duration"), ("restitution", "restitution")):
        for value in re.findall(rf"^ *{key}: ([-0-9.e]+)", text, re.MULTILINE):
            assert RANGES[name].low <= float(value) <= RANGES[name].high, (kind, key, value)
    for value in re.findall(r"([-0-9.e]+) N/mm\^1\.5", text):
        assert RANGES["stiffness"].low <= float(value) <= RANGES["stiffness"].high, (kind, value)


@pytest.mark.parametrize("kind", ["fall_mesh", "nips"])
def test_written_files_are_the_scene(kind: str, tmp_path: Path) -> None:
    """Also of two scenes in one folder, whose meshes have one name each."""
    for number in NUMBERS:
        drawn(SEED, number, kind).write(tmp_path)
    for number in NUMBERS:
        scene = drawn(SEED, number, kind)
        model = mdlgen.lower(mdlgen.load(tmp_path / f"{scene.name}.yaml"))
        assert np.array_equal(model.bodies.position, scene.model().bodies.position)
        assert len(model.meshes) == len(scene.files)
        for one, other in zip(model.meshes, scene.model().meshes, strict=True):
            assert np.array_equal(one.corners, other.corners)


def test_a_scene_that_the_spec_rejects_is_drawn_again(monkeypatch: pytest.MonkeyPatch) -> None:
    share, made = KINDS["slide"]
    tries: list[int] = []

    def bad(draw: Draw) -> dict[str, Any]:
        tries.append(0)
        found = made(draw)
        return {**found, "gravity": "up"} if len(tries) < 3 else found

    def rejected(draw: Draw) -> dict[str, Any]:
        found = made(draw)
        found["sheets"]["note"]["thickness"] = "90 mm" if len(tries) < 3 else "0.1 mm"
        tries.append(0)
        return found

    monkeypatch.setitem(KINDS, "slide", (share, rejected))
    scene = drawn(SEED, 1, "slide")
    assert len(scene.rejected) == 3 and "thickness" in scene.rejected[0]
    tries.clear()
    monkeypatch.setitem(KINDS, "slide", (share, lambda draw: {**bad(draw), "sheets": {}}))
    with pytest.raises(SpecError):
        drawn(SEED, 1, "slide")
    assert len(tries) == TRIES


ROWS = [
    CampaignRow(1, "nip", OK, boxes=10, cpu_s=1.0),
    CampaignRow(2, "nip", INACCURATE, "the estimate of a is 0.2, above 0.001", cpu_s=2.0),
    CampaignRow(3, "thrown", INACCURATE, "", chaotic=True, cpu_s=3.0, rejected=("thrown: no",)),
    CampaignRow(4, "thrown", NONE, "no convergence at 1.5 ms; box note_1_2 moved most", cpu_s=4.0),
    CampaignRow(5, "arc", NONE, "no convergence at 20 ms; box note_7_2 moved most", cpu_s=5.0),
    CampaignRow(6, "arc", NONE, "above 60 s; stopped", cpu_s=60.0, stopped=True),
    CampaignRow(7, "arc", NONE, "the process crashed: SIGSEGV"),
    CampaignRow(10, "nip", OK, cpu_s=1.0, finer=Finer(20, 3, (("a", 1.6), ("b", 4.0)), ("b",))),
    CampaignRow(20, "nip", OK, cpu_s=1.0, finer=Finer(30, 1, (("c", 3.5),))),
    CampaignRow(30, "nip", OK, cpu_s=1.0, finer=Finer(failed="at an eighth of the step: no convergence")),
]


def test_rows_are_counted() -> None:
    made = counts(ROWS)
    assert (made.scenes, made.ok, made.inaccurate, made.chaotic, made.none) == (10, 4, 2, 1, 4)
    assert (made.stopped, made.rejected) == (1, 1)
    assert (made.median_s, made.most_s) == (2.0, 60.0)
    assert made.part_95_s == pytest.approx(np.quantile([1, 2, 3, 4, 5, 60, 1, 1, 1], 0.95))
    assert (made.finer_scenes, made.finer_failed, made.compared, made.unknown) == (2, 1, 50, 4)
    assert (made.above, made.far, made.apart, made.wrong) == (3, 2, 1, 1)
    assert counts([]).median_s is None


def test_reasons_are_grouped() -> None:
    groups = grouped(ROWS, NONE)
    assert [len(own) for own in groups.values()] == [2, 1, 1]
    assert [row.number for row in groups["no convergence at # ms"]] == [4, 5]
    assert list(grouped(ROWS, INACCURATE)) == ["the estimate of a is #, above #", "chaotic"]
    assert alike("box note_12_6 meets box pile_3_1_2 and nip_1_upper") == "box X meets box X and X"
    assert alike("1.44 N mm of energy, -2.1e-5 %") == alike("7 N mm of energy, 26.1 %")


def test_table_and_page_say_the_counts() -> None:
    found = Campaign(3, 10, 60.0, {"cpu": "a cpu"}, {"mdlgen": "1"}, ROWS)
    for text in (table(found), page(found)):
        assert "| with a result (exit 0) | 4 | 40.0 % |" in text
        assert "| of these chaotic | 1 | 10.0 % |" in text
        assert "- 2: no convergence at # ms: thrown 4, arc 5" in text
        assert "50 quantities have an estimate, 4 have none. 3 (6.0 %) are above 1.5 times" in text
        assert "their estimate, 2 above 3 times. For 1 of the 3 a run" in text
        assert "Where both agree, 1 are above 3 times." in text
        assert "| arc | 3 | 0 | 0 | 3 |" in text
        assert "- nip 10: b: 4 times its estimate, the finer runs do not agree" in text
    assert all(f"`{kind}`" in page(found) for kind in KINDS)
    assert json.loads(json.dumps(found.json()))["counts"]["wrong"] == 1


@pytest.fixture(scope="module")
def block() -> Result:
    return mdlgen.solve(mdlgen.lower(mdlgen.loads(BLOCK)), "lattice")


def test_status_is_judged_as_run_does(block: Result) -> None:
    row = CampaignRow(1, "fall_flat", NONE)
    assert block.ok and judged(row, block).status == OK
    worse = replace(block, error_estimate=0.5, error_estimate_of="sheets.n.position")
    assert judged(row, worse).status == INACCURATE
    assert "sheets.n.position is 0.5, above 0.001" in judged(row, worse).reason
    assert judged(row, replace(block, error_unknown="the error is not known")).status == INACCURATE
    assert judged(row, replace(block, status="inaccurate", error_estimate=None)).status == INACCURATE
    failed = judged(row, block.failed("no convergence"))
    assert (failed.status, failed.reason) == (NONE, "no convergence")


def test_errors_are_compared_with_estimates(block: Result) -> None:
    """Estimates a thousand times too small are found; by runs that differ they cannot be."""
    estimates = complete(block)
    run = solver("lattice").solve
    honest = finer(block, lambda step: run(block.model, step=step))
    assert honest.compared > 0 and not honest.above and not honest.failed
    assert honest.compared + honest.unknown == len(estimates)
    small = {
        name: found if found.value is None else replace(found, value=1e-3 * found.value)
        for name, found in estimates.items()
    }
    wrong = replace(block, estimates=small)
    found = finer(wrong, lambda step: run(block.model, step=step))
    assert found.above and all(times > 1.5 for _, times in found.above)
    fine = run(block.model, step=block.step / 8)
    assert all(each.agree for each in against(wrong, fine, fine))
    assert not all(each.agree for each in against(wrong, fine, block))
    failed = finer(block, lambda step: block.failed("no convergence"))
    assert failed.failed == "at an eighth of the step: no convergence" and not failed.compared


# A scene of some seconds, and one of less than one: number 2 of their kinds is drawn where they are named.
SLOW, QUICK = Task(SEED, 2, False, "lattice", "nips"), Task(SEED, 2, False, "lattice", "fall_flat")


def test_a_scene_above_the_limit_is_stopped_and_counted() -> None:
    with Workers(1, "lattice") as started:
        slow, quick = started.rows([replace(SLOW, limit=1e-3), QUICK])
    assert (slow.status, slow.stopped, slow.kind) == (NONE, True, "nips")
    assert slow.reason == "above 0.001 s; stopped" and slow.boxes > 1
    assert quick.number == 2 and not quick.stopped and quick.status != NONE, quick


def test_a_process_that_is_killed_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    made = pool._Process.send

    def send(self: Any, task: Task) -> None:
        made(self, task)
        if task.kind == "nips":
            self.process.kill()

    monkeypatch.setattr(pool._Process, "send", send)
    with Workers(1, "lattice") as started:
        killed, quick = started.rows([SLOW, QUICK])
    assert killed.status == NONE and not killed.stopped
    assert killed.reason in ("the process crashed: SIGKILL", "the process ended with code 1")
    assert quick.status != NONE


# Scenes of a few boxes of seed 4; the tenth of them is compared with finer steps.
QUICKEST = (250, 78, 83)


def test_a_campaign_of_three_scenes(tmp_path: Path) -> None:
    out, shown = tmp_path / "out", tmp_path / "campaign.md"
    only = [word for number in QUICKEST for word in ("--only", str(number))]
    command = ["bench", "campaign", "--seed", "4", *only, "--workers", "1", "-o", str(out)]
    done = CliRunner().invoke(app, [*command, "--page", str(shown)])
    assert done.exit_code in (0, 4), done.output
    found = json.loads((out / "campaign.json").read_text("utf-8"))
    assert [row["number"] for row in found["rows"]] == sorted(QUICKEST)
    assert (done.exit_code == 4) == any(row["status"] == NONE for row in found["rows"])
    *others, tenth = found["rows"]
    assert tenth["finer"]["compared"] > 0 and not any(row.get("finer") for row in others)
    files = sorted((out / "scenes").glob("*.yaml"))
    assert len(files) == 3
    for file, row in zip(
        sorted(files, key=lambda f: int(f.stem.rpartition("_")[2])), found["rows"], strict=True
    ):
        assert file.stem == f"{row['kind']}_4_{row['number']}"
        mdlgen.lower(mdlgen.load(file))
    assert "# Random scenes" in shown.read_text("utf-8")
    assert (out / "campaign.md").read_text("utf-8") in done.output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["campaign", "impact"], "campaign runs alone"),
        (["campaign", "--quick"], "none of --quick"),
        (["campaign", "--kind", "nib"], "nip"),
        (["campaign", "--solver", "lattise"], "lattice"),
    ],
)
def test_bad_options_are_answered(words: list[str], message: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["bench", *words, "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and message in done.output

"""Words of a page, and the commands that make one: hostile names, what is said, where it is written."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from embedded import embedded
from lxml import html
from ran import transport
from synthetic import moving, small_model
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.report.figures.maps import maps
from mdlgen.report.html.page import page
from mdlgen.results.result import Result

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&{{ 7*7 }}\u2028"


class TestText:
    def test_nothing_is_fetched(self, text: str) -> None:
        tree = html.fromstring(text)
        for element in tree.iter():
            for name in ("src", "href", "action", "data"):
                value = element.get(name) if isinstance(element.tag, str) else None
                assert value is None or value.startswith(("#", "data:")), (element.tag, value)
        own = re.sub(r'<script type="text/plain".*?</script>', "", text, flags=re.DOTALL)
        style = "".join(tree.xpath("//style/text()"))
        assert "{" in style and "@import" not in style and "url(" not in style
        assert set(re.findall(r"https?://[^\"' )]*", own)) == {"http://www.w3.org/2000/svg"}
        # what is drawn with says who made it
        licences = "".join(tree.xpath("//footer//text()"))
        assert "three.js" in licences and "Leon Sorokin" in licences
        policy = tree.xpath("//meta[@http-equiv='Content-Security-Policy']/@content")[0]
        assert policy.startswith("default-src 'none'; ")

    def test_hostile_text_stays_text(self) -> None:
        plain = moving(small_model())
        bad = replace(
            plain,
            source=HOSTILE,
            solver=HOSTILE,
            model=replace(plain.model, name=HOSTILE, parameters=()),
            versions={HOSTILE: HOSTILE},
        )
        expected = html.fromstring(page([plain, plain], ["a", "b"]))
        tree = html.fromstring(page([bad, plain], [HOSTILE, "b"]))
        tags = [e.tag for e in tree.iter() if e.tag in ("script", "img", "iframe", "style", "meta", "link")]
        assert tags == [e.tag for e in expected.iter() if e.tag in ("script", "img", "style", "meta", "link")]
        assert not [e for e in tree.iter() if isinstance(e.tag, str) and e.get("onerror")]
        assert any(HOSTILE in pre.text for pre in tree.xpath("//details/pre"))
        assert embedded(page([bad]))[0]["scene"] == HOSTILE
        assert "49" not in "".join(tree.xpath("//h1//text()"))

    def test_what_was_run_stands_in_it(self, result: Result, text: str) -> None:
        tree = html.fromstring(text)
        message = " ".join(tree.get_element_by_id("run").itertext())
        for value in (result.solver, "balance error", "numpy", "k_tx"):
            assert value in message
        assert str(result.steps) in message
        assert f"{result.energy.balance_error:.4g}" in message
        # both sides of the machine share a row
        events = tree.get_element_by_id("events").xpath(".//tbody/tr")
        places = [cell.text.split(", ") for row in events for cell in row.xpath("./td[3]")]
        assert sum(map(len, places)) == len(result.events) > 2 * len(events) > 8
        said = " ".join(tree.get_element_by_id("events").itertext())
        assert "note slips by" in said and "mm/s on average" in said and "mean_mm_per_s" not in said

    def test_the_map_of_what_joints_bore_stands_in_it(self, result: Result, text: str) -> None:
        section = html.fromstring(text).get_element_by_id("map")
        drawn, found = section.xpath(".//svg"), maps(result)
        assert len(drawn) == len(found) == 4
        for svg, one in zip(drawn, found, strict=True):
            assert svg.get("aria-label") == one.title.replace("\n", ": ")
            cells = svg.xpath("./polygon")
            assert [int(c.get("class")[1:]) for c in cells] == [round(18 * p) for p in one.parts]
            corners = [[tuple(map(float, p.split(","))) for p in c.get("points").split()] for c in cells]
            assert np.abs(np.array(corners) * (1, -1) - one.cells).max() < 1e-3
            (ring,) = svg.xpath("./circle")
            assert (float(ring.get("cx")), -float(ring.get("cy"))) == pytest.approx(tuple(one.place))
        block = moving(small_model("sheets.note.boxes=[1,1]"))
        section = html.fromstring(page([block])).get_element_by_id("map")
        assert not section.xpath(".//svg") and "have no joints" in "".join(section.itertext())

    def test_an_estimate_above_its_tolerance_is_reported_at_the_head(self, result: Result, text: str) -> None:
        assert not html.fromstring(text).xpath("//header//b[@class='bad']")
        assert result.error_estimate is not None
        strict = replace(result.model, run=replace(result.model.run, tolerance=result.error_estimate / 2))
        (bad,) = html.fromstring(page([replace(result, model=strict)])).xpath("//header//b[@class='bad']")
        assert "above the tolerance" in bad.text

    def test_the_head_is_a_title_block(self, result: Result) -> None:
        asked = {"require": ("yaw within 1 deg", "speed above 2 m/s"), "author": "J. Doe", "revision": "B"}
        made = replace(result, model=replace(result.model, **asked), ran_at="2026-11-23T19:57:20+00:00")
        tree = html.fromstring(page([made]))
        block = {row[0].text: row[1].text_content() for row in tree.xpath("//table[@id='block']//tr")}
        assert block["author"] == "J. Doe" and block["revision"] == "B"
        assert block["run at"] == "2026-11-23 19:57:20 UTC" and "lattice" in block["made with"]
        rows = [
            [cell.text_content() for cell in row] for row in tree.xpath("//table[@id='verdicts']/tbody/tr")
        ]
        assert [row[:2] for row in rows] == [["yaw within 1 deg", "pass"], ["speed above 2 m/s", "FAIL"]]
        # before all else
        assert tree.xpath("//table")[0].get("id") == "verdicts"
        assert "author" not in page([result]).partition("</header>")[0]

    def test_lints_stand_in_it(self) -> None:
        result = moving(small_model("materials.eur10.E_md=40000 MPa"))
        message = " ".join(html.fromstring(page([result])).get_element_by_id("lints").itertext())
        assert "W101" in message and "check the unit" in message


class TestCommands:
    def test_report_rebuilds_and_compares(self, result: Result, text: str, tmp_path: Path) -> None:
        other = transport("rollers.motor_1_left.drive.speed=180 rad/s", "run.duration=40 ms")
        result.save(tmp_path / "a")
        other.save(tmp_path / "b")
        run = CliRunner().invoke
        done = run(app, ["report", str(tmp_path / "a")])
        assert done.exit_code == 0, done.output
        assert (tmp_path / "a" / "report.html").read_text("utf-8") == text
        target = tmp_path / "both.html"
        done = run(app, ["report", str(tmp_path / "a"), str(tmp_path / "b"), "-o", str(target)])
        assert done.exit_code == 0, done.output
        tree = html.fromstring(target.read_text("utf-8"))
        rows = {
            "".join(row[0].itertext()): ["".join(cell.itertext()) for cell in row[1:]]
            for row in tree.get_element_by_id("differences").xpath(".//tbody/tr")
        }
        assert rows["motor_1_left.omega"][:2] == ["0.1867", "0.18"]
        travel = [r.summary()["sheets"]["note"]["travel_mm"][0] for r in (result, other)]
        assert rows["sheets.note.travel_mm.x"] == [
            f"{travel[0]:.4g}", f"{travel[1]:.4g}", f"{travel[1] - travel[0]:.4g}",
            f"{100 * (travel[1] / travel[0] - 1):.3g} %",
        ]  # fmt: skip
        # what was set and what came of it stands first, what is alike is folded
        assert tree.xpath("//section[@id='differences']//table")[0].get("id") == "inputs"
        order = list(rows)
        assert order[0] == "motor_1_left.omega" and order.index("sheets.note.travel_mm.x") < 6
        folded = tree.xpath("//section[@id='differences']/details//th/text()")
        assert "sheets.note.boxes" in folded and "wall_s" in folded
        assert "sheets.note.travel_mm.x" not in folded
        assert [run["name"] for run in embedded(target.read_text("utf-8"))] == ["a", "b"]

    def test_runs_of_other_grids_are_distinguished_without_box_distances(self, result: Result) -> None:
        coarse = moving(small_model())
        message = " ".join(
            html.fromstring(page([result, coarse])).get_element_by_id("differences").itertext()
        )
        assert "different boxes" in message

    def test_bad_folders(self, result: Result, tmp_path: Path) -> None:
        run = CliRunner().invoke
        assert run(app, ["report", str(tmp_path / "none")]).exit_code == 3
        result.save(tmp_path / "a")
        assert run(app, ["report", str(tmp_path / "a"), str(tmp_path / "a")]).exit_code == 2
        assert run(app, ["view", str(tmp_path / "none")]).exit_code == 3

    def test_view_makes_the_page_where_it_is_older(
        self, result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        opened: list[str] = []
        monkeypatch.setattr("webbrowser.open", lambda url: opened.append(url) or True)
        result.save(tmp_path)
        target = tmp_path / "report.html"
        for before in (None, "old"):
            if before is not None:
                target.write_text(before)
                # files written at once may bear one time
                newer = target.stat().st_mtime + 1
                os.utime(tmp_path / "result.h5", (newer, newer))
            done = CliRunner().invoke(app, ["view", str(tmp_path)])
            assert done.exit_code == 0, done.output
            assert target.read_text("utf-8").startswith("<!DOCTYPE html>")
        assert opened == [target.resolve().as_uri()] * 2

"""study.html: what it holds, and what a browser makes of it from file://."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import found, tab
from lxml import html
from PIL import Image

from mdlgen.study.analysis.findings import findings
from mdlgen.study.analysis.table import columns
from mdlgen.study.design.task import Task
from mdlgen.study.execution.row import OK, REFUSED, CaseRow
from mdlgen.study.output.page import page

EVIL = "</script><script>alert(1)</script>"
HERE = "a scene & <b>more</b>.yaml"


def study(folder: Path) -> str:
    """The page of a grid of 4 x 3 cases; one is refused, with a reason that looks like markup."""
    task = Task(
        HERE,
        f"name: {EVIL}\n",
        ".",
        sets=("run.duration=2 ms",),
        measures=(("travel", "x"), ("jam", "events.jam > 0"), ("yaw", "y")),
        events=("jam",),
    )
    rows = []
    for k in range(12):
        a, b = k % 4, k // 4
        values = (("contacts.0.friction", f"0.{a + 1}"), ("sheets.note.mass", f"{b + 1.0} g"))
        rows.append(
            CaseRow(
                k, values, OK, "ok", {"travel": float(a * b), "jam": float(a > 2), "yaw": (a - b) * 1e-17}
            )
        )
    rows[7] = CaseRow(7, rows[7].values, REFUSED, EVIL)
    table = columns(rows, ["travel", "jam", "yaw"])
    (folder / "case_3").mkdir(parents=True)
    (folder / "case_3" / "report.html").write_text("kept")
    return page(folder, EVIL, "grid", task, rows, table, findings(task, "grid", rows, table))


def data(text: str) -> dict[str, Any]:
    return json.loads(html.fromstring(text).get_element_by_id("data").text_content())


def test_no_text_becomes_markup(tmp_path: Path) -> None:
    text = study(tmp_path)
    tree = html.fromstring(text)
    assert len(tree.xpath("//script")) == 2 and not tree.xpath("//b[text()='more']")
    assert EVIL in tree.xpath("//section[@id='failed']//td")[1].text_content()
    assert "http" not in text.replace("http://www.w3.org/2000/svg", "").replace("http-equiv", "")


def test_what_is_constant_and_what_acts_together_is_said(tmp_path: Path) -> None:
    tree = html.fromstring(study(tmp_path))
    found = tree.get_element_by_id("found")
    assert tree.get_element_by_id("constant").text_content().strip() == "The same in all cases: yaw 0."
    # nothing else is said of it: it is round-off
    measures = {cell.text for cell in found.xpath(".//tbody//th") if cell.text}
    assert "yaw" not in measures and "travel" in measures
    rows = [[cell.text for cell in row] for row in tree.get_element_by_id("interactions").xpath("./tbody/tr")]
    # travel is the product of both
    assert rows[0][:2] == ["travel", "contacts.0.friction and sheets.note.mass"]
    assert int(rows[0][2].split()[0]) > 5


def test_each_case_says_how_it_is_opened(tmp_path: Path) -> None:
    record = data(study(tmp_path))
    assert record["links"] == ["", "", "", "case_3/report.html", *[""] * 8]
    assert record["commands"][5].startswith(
        "mdlgen run 'a scene & <b>more</b>.yaml' --set 'run.duration=2 ms' --set contacts.0.friction=0.2"
    )
    assert record["kind"][7] == "refused" and record["reason"][7] == EVIL
    roles = {column["name"]: column["role"] for column in record["columns"]}
    assert roles["case"] == "case" and roles["sheets.note.mass"] == "variable" and roles["jam"] == "measure"


@pytest.mark.skipif(found() is None, reason="no Chromium on the path")
def test_a_browser_draws_it_and_opens_a_case(tmp_path: Path) -> None:
    (tmp_path / "study.html").write_text(study(tmp_path), "utf-8")
    with tab(tmp_path / "profile") as browser:
        browser.open(tmp_path / "study.html")
        assert browser.complaints == []
        for wide, tone in ((1400, "light"), (800, "light"), (800, "dark"), (1400, "dark")):
            features = [{"name": "prefers-color-scheme", "value": tone}]
            browser.call("Emulation.setEmulatedMedia", features=features)
            size = {"width": wide, "height": 1000, "deviceScaleFactor": 1, "mobile": False}
            browser.call("Emulation.setDeviceMetricsOverride", **size)
            picture = np.asarray(Image.open(io.BytesIO(browser.picture())).convert("L")).astype(int)
            assert (np.median(picture) < 100) == (tone == "dark")
            assert browser.ask("document.documentElement.scrollWidth") <= wide
        # what marks and colours mean stands at each figure
        legends = "[...document.querySelectorAll('#{} .legend')].map((text) => text.textContent)"
        assert {"a case", "mean of a value", "without measures"} <= set(
            browser.ask(legends.format("response"))
        )
        assert all(browser.ask(legends.format(figure)) for figure in ("map", "parallel"))
        assert len(browser.requests) == 1 and browser.requests[0].startswith("file:")
        # begins with the event
        assert browser.ask("document.getElementById('measure').selectedOptions[0].textContent") == "jam"
        drawn = {
            name: browser.ask(f"document.querySelectorAll('{where}').length")
            for name, where in {
                "points": "#response circle.point",
                "fields": "#map rect.point",
                "lines": "#parallel path.line",
                "crosses": "path.point.failed",
            }.items()
        }
        assert drawn == {"points": 11, "fields": 12, "lines": 12, "crosses": 3}
        browser.ask("document.querySelector('#map [data-row=\"3\"]').dispatchEvent(new Event('click'))")
        assert browser.ask("document.querySelector('#case a').getAttribute('href')") == "case_3/report.html"
        browser.ask("document.querySelector('#parallel [data-row=\"7\"]').dispatchEvent(new Event('click'))")
        assert EVIL in browser.ask("document.getElementById('case').textContent")
        browser.ask("document.getElementById('before').click()")
        assert browser.ask("document.getElementById('number').value") == "6"
        assert "mdlgen run" in browser.ask("document.querySelector('#case pre').textContent")
        assert browser.complaints == []

"""A user's script of 60 lines: it runs, and the strict mode of a type checker finds nothing in it."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
from pathlib import Path

import pytest
from places import ROOT

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.paths import samples
from mdlgen.report.figures.plots import QUANTITIES
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

SCRIPT = Path(__file__).parent / "users" / "nip.py"


def strict(folder: Path, *scripts: Path) -> dict[str, list[str]]:
    """What the strict mode finds in scripts, each by its name."""
    names = [str(script) for script in scripts]
    record = {"typeCheckingMode": "strict", "include": names, "extraPaths": [str(ROOT)]}
    config = folder / "pyrightconfig.json"
    config.write_text(json.dumps(record))
    command = ["basedpyright", "-p", str(config), "--outputjson"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    found = json.loads(done.stdout)
    assert found["summary"]["filesAnalyzed"] == len(scripts)
    lines: dict[str, list[str]] = {script.name: [] for script in scripts}
    for item in found["generalDiagnostics"]:
        lines[Path(item["file"]).name].append(f"{item['range']['start']['line'] + 1}: {item['message']}")
    return lines


@pytest.mark.skipif(shutil.which("basedpyright") is None, reason="basedpyright is not installed")
def test_strict_types_find_nothing_in_a_users_script_and_each_mistake(tmp_path: Path) -> None:
    assert len(SCRIPT.read_text().splitlines()) >= 60
    wrong = tmp_path / "wrong.py"
    text = SCRIPT.read_text()
    for good, bad in (
        ("diameter=", "diametre="),
        ('ramp="2 ms"', "ramp=2"),
        ("friction=0.8", "friction={0.8}"),
        ('sheet.units["travel"]', "sheet.travels"),
    ):
        assert good in text
        text = text.replace(good, bad, 1)
    wrong.write_text(text)
    found = strict(tmp_path, SCRIPT, wrong)
    assert found[SCRIPT.name] == []
    assert len({line.partition(":")[0] for line in found[wrong.name]}) == 4


def test_the_script_runs(tmp_path: Path) -> None:
    spec = importlib.util.spec_from_file_location("users_nip", SCRIPT)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    slow, fast = module.main(tmp_path)
    # 80 rad/s at 7.5 mm, after a ramp of 2 ms; the sheet lags by its creep
    assert slow < fast < 80e-3 * 7.5 * 9.0 and fast == pytest.approx(80e-3 * 7.5 * 9.0, rel=0.01)
    assert (tmp_path / "speed.png").read_bytes().startswith(b"\x89PNG")
    assert "<title>" in (tmp_path / "report.html").read_text("utf-8")
    assert loads((tmp_path / "scene.yaml").read_text()).rollers["motor"].radius == 7.5


@pytest.fixture(scope="module")
def channel() -> Result:
    result = mdlgen.solve(mdlgen.lower(mdlgen.load(samples() / "channel.yaml", ["run.duration=6 ms"])))
    assert result.ok
    return result


@pytest.mark.parametrize("what", QUANTITIES)
def test_each_quantity_is_plotted_with_its_unit(channel: Result, what: str) -> None:
    plot = channel.plot(what)
    (panel,) = plot.figure.axes
    title, unit, found = QUANTITIES[what]
    assert panel.get_ylabel() == unit and title in panel.get_title(loc="left") and panel.lines
    assert {str(line.get_label()) for line in panel.lines} == set(found(channel))
    assert plot._repr_png_() == channel.plot(what)._repr_png_()


def test_a_plot_that_there_is_not(channel: Result) -> None:
    with pytest.raises(SpecError, match="did you mean 'travel'"):
        channel.plot("travle")
    block = mdlgen.solve(mdlgen.lower(mdlgen.load(samples() / "verify" / "hanging.yaml")))
    with pytest.raises(SpecError, match="nothing to plot of nip_force"):
        block.plot("nip_force")


def test_the_page_stands_in_a_frame_of_its_own(channel: Result) -> None:
    shown = channel.show(500)
    html = shown._repr_html_()
    assert html.startswith('<iframe srcdoc="') and 'height="500"' in html
    # five attributes: nothing of the page can end the first
    assert html.count('"') == 10 and "<script" not in html


def test_each_value_has_its_unit(channel: Result) -> None:
    for part in (channel.sheets["note"], channel.rollers["motor"], channel.probes["lead"]):
        values = {name for name in vars(part) if name != "name"}
        assert set(part.units) == values and set(part.shown) <= values
    table = pytest.importorskip("pandas") and channel.to_pandas()
    assert set(table.attrs["units"]) == {"time_ms", *table.columns}
    assert set(table.attrs["units"].values()) == {"ms", "mm", "mm/s", "deg", "rad/s", "N", "N*mm", "W"}
    states = pytest.importorskip("xarray") and channel.to_xarray()
    assert all(states[name].attrs["units"] for name in (*states.data_vars, "time"))


def test_a_sweep_in_python() -> None:
    scene = mdlgen.load(samples() / "verify" / "incline.yaml", ["run.duration=60 ms"])
    runs = scene.sweep({"contacts.0.friction": [0.1, 0.6, -1]}, ["sheets.block.travel_mm.x"])
    assert len(runs) == 3 and "1 failed" in repr(runs)
    kinds = [row.kind for row in runs]
    assert kinds == ["ok", "ok", "refused"] and "contacts.0.friction" in runs.rows[2].status
    slides, sticks = (abs(row.measures["sheets.block.travel_mm.x"] or 0.0) for row in runs.rows[:2])
    assert slides > 10 * sticks
    table = pytest.importorskip("pandas") and scene.sweep({"gravity.0": ["3 m/s^2", "4 m/s^2"]}).to_pandas()
    assert table.attrs["units"] == {"gravity.0": "m/s^2"} and table["gravity.0"].tolist() == [3.0, 4.0]
    with pytest.raises(SpecError, match="give a list of values"):
        scene.sweep({"contacts.0.friction": "0.5"})
    with pytest.raises(SpecError, match="measures are a list"):
        scene.sweep({"contacts.0.friction": [0.5]}, "sheets.block.yaw_deg")
    with pytest.raises(SpecError, match="name what is to differ"):
        scene.sweep({})


def test_check_in_python() -> None:
    scene = mdlgen.load(samples() / "channel.yaml")
    assert scene.check() == []
    (lint,) = scene.with_({"rollers.motor.drive.speed": "-133.333 rad/s"}).check()
    assert lint.code == "W124" and lint.where == "rollers.motor.drive"

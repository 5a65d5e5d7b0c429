"""report.html in a browser, from file://: it draws, plays and asks the network for nothing."""

from __future__ import annotations

import io
import json
from base64 import b64decode
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import Tab, found, tab
from frames import picture_ms
from PIL import Image
from ran import ran, transport
from recordings import plt
from synthetic import moving, small_model

from mdlgen.report.boxes import contact
from mdlgen.report.html.page import page
from mdlgen.results.recorded.against import against
from mdlgen.results.recorded.files import read
from mdlgen.results.result import Result

pytestmark = pytest.mark.skipif(
    found() is None, reason="no Chromium on the path (apt-get install chromium, or set MDLGEN_CHROMIUM)"
)

# coarse and short, with both notes, arms and the rim
FEEDER = (
    "sheets.note_1.boxes=[5,2]",
    "sheets.note_2.boxes=[5,2]",
    "run.duration=6 ms",
    "run.print_step=0.25 ms",
)
COLOURS = ["speed", "strain", "curvature", "contact"]


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tab]:
    with tab(tmp_path_factory.mktemp("profile")) as made:
        yield made


@pytest.fixture(params=["transport", "feeder"])
def result(request: pytest.FixtureRequest) -> Result:
    return transport() if request.param == "transport" else ran("feeder", *FEEDER)


def show(browser: Tab, folder: Path, results: list[Result], fragment: str = "") -> Tab:
    """Opens the page of results; it must not complain, nor ask for anything but itself."""
    path = folder / "report.html"
    path.write_text(page(results), "utf-8")
    browser.complaints.clear()
    browser.requests.clear()
    browser.open(path, fragment)
    return browser


def silent(browser: Tab, folder: Path) -> None:
    browser.ask("new Promise((done) => setTimeout(done, 200))")
    assert browser.complaints == []
    own = (folder / "report.html").resolve().as_uri()
    asked = [url for url in browser.requests if not url.startswith(("blob:", "data:", own))]
    assert asked == []
    assert browser.ask("document.getElementById('no-drawing').hidden")


def drawn(browser: Tab, time: float) -> np.ndarray:
    """Pixels of the canvas at a time, (h, w, 3)."""
    # at once: what is drawn is kept until it has been shown
    url = browser.ask(
        f"mdlgen.seek({time}); mdlgen.stage.now(); document.getElementById('canvas').toDataURL('image/png')"
    )
    return np.asarray(Image.open(io.BytesIO(b64decode(url.split(",", 1)[1]))).convert("RGB")).astype(int)


def test_a_run_is_shown_and_plays(browser: Tab, tmp_path: Path, result: Result) -> None:
    show(browser, tmp_path, [result])
    end = float(result.time[-1])
    first, later = drawn(browser, 0.0), drawn(browser, 0.6 * end)
    # not blank, and not the same picture
    assert (np.abs(first - first[0, 0]).max(axis=2) > 30).mean() > 0.1
    assert (np.abs(first - later).max(axis=2) > 30).mean() > 0.01
    # play advances, and stops at the end
    browser.ask("mdlgen.seek(0); document.getElementById('play').click()")
    browser.until(f"mdlgen.state.time > {0.02 * end}")
    assert browser.ask("document.getElementById('play').textContent") == "pause"
    browser.ask(f"mdlgen.seek({0.998 * end})")
    browser.until("!mdlgen.state.playing")
    assert browser.ask("mdlgen.state.time") == end
    silent(browser, tmp_path)


def test_a_run_is_shown_against_a_recording(browser: Tab, tmp_path: Path) -> None:
    """A figure of each quantity, with the run and the file in it."""
    result = transport()
    file = tmp_path / "note.plt"
    file.write_bytes(plt(result, later=0.5).encode())
    found = against(result, read(file))
    (tmp_path / "report.html").write_text(page([result], (), found), "utf-8")
    browser.complaints.clear()
    browser.requests.clear()
    browser.open(tmp_path / "report.html")
    names = browser.ask("[...document.querySelectorAll('#panels figure')].map((f) => f.dataset.key)")
    assert [f"recorded {apart.name}" for apart in found.quantities] == names[: len(found.quantities)]
    lines = browser.ask("document.querySelector('#panels figure svg').querySelectorAll('path').length")
    assert lines == 6, "x, y and z of both"
    assert browser.ask("document.querySelectorAll('#recorded tbody tr').length") == len(found.quantities)
    assert "would fit better" in browser.ask("document.getElementById('recorded').textContent")
    silent(browser, tmp_path)


def test_colour_modes_switch(browser: Tab, tmp_path: Path, result: Result) -> None:
    at = 0.6 * float(result.time[-1])
    show(browser, tmp_path, [result], f"#t={at}&view=xy")
    assert browser.ask("mdlgen.state.time") == at
    seen = []
    for k, name in enumerate(COLOURS):
        browser.ask(
            f"(() => {{const list = document.getElementById('colour'); list.value = {k};"
            "list.dispatchEvent(new Event('change'))})()"
        )
        assert browser.ask("document.getElementById('colour').selectedOptions[0].text") == name
        most = browser.ask("mdlgen.runs[0].animation.colours[mdlgen.state.colour].most")
        shown = float(browser.ask("document.querySelector('#legend .ends').lastChild.textContent").split()[0])
        assert shown == pytest.approx(most, rel=1e-4)
        seen.append(drawn(browser, at))
    for k in range(len(seen)):
        for other in seen[:k]:
            assert (np.abs(seen[k] - other).max(axis=2) > 30).mean() > 0.002
    silent(browser, tmp_path)


def test_a_box_in_a_nip_has_the_colour_of_its_force(browser: Tab, tmp_path: Path) -> None:
    result = transport()
    forces, _ = contact(result, np.arange(len(result.time)))
    # when the box that bears most of the run bears it
    greatest = float(result.time[forces.max(axis=1).argmax()])
    show(browser, tmp_path, [result], f"#t={greatest}&view=xy&colour=contact")
    browser.ask("mdlgen.check('machine', false)")
    colours = {tuple(c) for c in drawn(browser, greatest).reshape(-1, 3)}
    # yellow-green of the ramp's upper end; a flat picture lit from above
    assert any(r > 120 and g > 160 and b < 90 for r, g, b in colours)


def test_the_figures_have_the_numbers_of_the_summary(browser: Tab, tmp_path: Path, result: Result) -> None:
    show(browser, tmp_path, [result])
    record = json.loads(
        browser.ask(
            "JSON.stringify([...document.querySelectorAll('.key[data-last]')].map("
            "(key) => [key.closest('figure').dataset.key, key.dataset.name, Number(key.dataset.last), "
            "key.textContent]))"
        )
    )
    last = {(key, name): (value, text) for key, name, value, text in record}
    result.save(tmp_path)
    summary = json.loads((tmp_path / "summary.json").read_text("utf-8"))
    for name, sheet in summary["sheets"].items():
        for k, axis in enumerate("xyz"):
            value, shown = last["displacement", f"{name} {axis}"]
            # four-byte numbers
            assert value == pytest.approx(sheet["travel_mm"][k], rel=1e-6, abs=1e-9)
            assert float(shown.split()[-1]) == pytest.approx(sheet["travel_mm"][k], rel=1e-4, abs=1e-9)
            value, _ = last["speed", f"{name} {axis}"]
            assert value == pytest.approx(sheet["speed_mm_per_s"][k], rel=1e-6, abs=1e-6)
        assert last["yaw", name][0] == pytest.approx(sheet["yaw_deg"], rel=1e-6, abs=1e-9)
    for name, roller in summary["rollers"].items():
        assert last["omega", name][0] == pytest.approx(roller["omega_rad_per_s"], rel=1e-6)
        assert last["force", name][0] == pytest.approx(roller["nip_force_n"], rel=1e-6)
    paths = browser.ask("document.querySelectorAll('figure svg path').length")
    # those over the sheet's length have no value at the end
    over_length = 3 * len(summary["sheets"])
    assert (
        paths == len(record) + over_length == browser.ask("document.querySelectorAll('figure .key').length")
    )
    # a line is hidden by its name
    browser.ask("document.querySelector('.key').click()")
    assert browser.ask("document.querySelectorAll('figure svg path').length") == paths - 1


def test_the_keyboard_is_enough(browser: Tab, tmp_path: Path) -> None:
    show(browser, tmp_path, [transport()])
    browser.ask("document.getElementById('canvas').focus()")
    browser.press("ArrowRight")
    assert browser.ask("mdlgen.state.time") == pytest.approx(0.25)
    browser.press("End")
    assert browser.ask("mdlgen.state.time") == 50
    browser.press("c")
    assert browser.ask("mdlgen.state.colour") == 1
    for key, view in zip("1234", ("xz", "yz", "xy", "iso"), strict=True):
        browser.press(key)
        assert browser.ask("mdlgen.state.view") == view
    browser.press("Home")
    browser.press(" ")
    browser.until("mdlgen.state.time > 0.5")
    browser.press(" ")
    assert not browser.ask("mdlgen.state.playing")
    # every control has a name for those who hear the page
    assert browser.ask(
        "[...document.querySelectorAll('button, select, input')].every((e) => "
        "e.textContent.trim() || e.ariaLabel || e.labels?.length)"
    )


def test_dragging_turns_the_picture(browser: Tab, tmp_path: Path) -> None:
    show(browser, tmp_path, [transport()], "#view=xz")
    before = drawn(browser, 0.0)
    for kind, x, y in (("mousePressed", 500, 400), ("mouseMoved", 620, 460), ("mouseReleased", 620, 460)):
        browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)
    assert (np.abs(drawn(browser, 0.0) - before).max(axis=2) > 30).mean() > 0.01
    assert browser.ask("mdlgen.state.view") is None


@pytest.mark.parametrize("sample", ["channel", "cantilever"])
def test_guides_and_static_runs_are_shown(browser: Tab, tmp_path: Path, sample: str) -> None:
    result = ran(sample, *(["sheets.note.boxes=[2,8]"] if sample == "cantilever" else []))
    show(browser, tmp_path, [result])
    picture = drawn(browser, result.time[-1])
    # not blank: what is not of the colour of the ground
    assert (np.abs(picture - picture[0, 0]).max(axis=2) > 30).mean() > 0.01
    silent(browser, tmp_path)


def test_two_runs_in_one_page(browser: Tab, tmp_path: Path) -> None:
    other = transport("rollers.motor_1_left.drive.speed=180 rad/s", "run.duration=40 ms")
    show(browser, tmp_path, [transport(), other])
    one = drawn(browser, 40.0)
    browser.ask("mdlgen.choose(1)")
    assert browser.ask("mdlgen.state.time") == 40
    assert (np.abs(drawn(browser, 40.0) - one).max(axis=2) > 30).mean() > 0.001
    assert browser.ask("document.querySelectorAll('figure[data-key=displacement] path').length") == 6
    silent(browser, tmp_path)


def test_a_picture_of_600_boxes_takes_little_more_than_one_of_6(browser: Tab, tmp_path: Path) -> None:
    """All its pixels, without a graphics card; tests/helpers/frames.py tells the times."""
    took: dict[str, list[float]] = {"[2,3]": [], "[20,30]": []}
    for _ in range(2):
        for boxes, times in took.items():
            show(browser, tmp_path, [moving(small_model(f"sheets.note.boxes={boxes}"), 500)])
            times.append(picture_ms(browser))
            silent(browser, tmp_path)
    few, many = (min(times) for times in took.values())
    assert many < 4.0 * few

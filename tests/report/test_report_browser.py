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


def two_frames(browser: Tab) -> None:
    """What was asked for is drawn."""
    browser.ask("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


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
    lines = browser.ask("document.querySelector('#panels figure').querySelectorAll('.key').length")
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
        assert shown == pytest.approx(most, rel=1e-3)  # four figures
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
            read = float(shown.removesuffix(" mm").split()[-1])
            assert read == pytest.approx(sheet["travel_mm"][k], rel=1e-3, abs=1e-6)
            value, _ = last["speed", f"{name} {axis}"]
            assert value == pytest.approx(sheet["speed_mm_per_s"][k], rel=1e-6, abs=1e-6)
        assert last["yaw", name][0] == pytest.approx(sheet["yaw_deg"], rel=1e-6, abs=1e-9)
    for name, roller in summary["rollers"].items():
        assert last["omega", name][0] == pytest.approx(roller["omega_rad_per_s"], rel=1e-6)
        assert last["force", name][0] == pytest.approx(roller["nip_force_n"], rel=1e-6)
    seen = "[...mdlgen.charts].flatMap((one) => one.plot.series.slice(1)).filter((s) => s.show).length"
    lines = browser.ask(seen)
    # those over the sheet's length have no value at the end; what does not change is words
    over_length = 3 * len(summary["sheets"])
    flat = browser.ask("document.querySelectorAll('.constant .key').length")
    assert lines == len(record) + over_length - flat and flat > 0
    assert "Yaw, constant" in browser.ask("document.getElementById('panels').innerText")
    # a line is hidden by its name
    browser.ask("document.querySelector('button.key').click()")
    assert browser.ask(seen) == lines - 1


def test_figures_have_one_span_and_one_cursor(browser: Tab, tmp_path: Path) -> None:
    show(browser, tmp_path, [transport()])
    spans = (
        "JSON.stringify([...mdlgen.charts].filter((c) => c.overTime).map((c) => [c.plot.scales.x.min, "
        "c.plot.scales.x.max]))"
    )
    browser.ask("document.querySelector('[data-key=speed]').scrollIntoView()")
    over = "document.querySelector('[data-key=speed] .u-over')"
    frame = json.loads(browser.ask(f"JSON.stringify({over}.getBoundingClientRect().toJSON())"))
    y, places = frame["top"] + 50, [frame["left"] + part * frame["width"] for part in (0.2, 0.4, 0.6)]

    def mouse(kind: str, x: float, buttons: int = 1, modifiers: int = 0) -> None:
        more = {"button": "left" if buttons else "none", "buttons": buttons, "clickCount": int(buttons > 0)}
        browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, modifiers=modifiers, **more)

    # a drag is the span of all of them
    for kind, x in (("mousePressed", places[0]), ("mouseMoved", places[2]), ("mouseReleased", places[2])):
        mouse(kind, x)
    two_frames(browser)
    assert np.allclose(json.loads(browser.ask(spans)), [10.0, 30.0], atol=0.2)
    # with shift it moves
    for kind, x in (("mousePressed", places[2]), ("mouseMoved", places[1]), ("mouseReleased", places[1])):
        mouse(kind, x, 1, 8)
    two_frames(browser)
    moved = np.array(json.loads(browser.ask(spans)))
    assert np.allclose(moved, [14.0, 34.0], atol=0.3)
    # the pointer is at one time in all, and the values beside the names are those there
    mouse("mouseMoved", places[1], 0)
    two_frames(browser)
    cursors = browser.ask(
        "[...new Set([...mdlgen.charts].filter((c) => c.overTime).map((c) => "
        "c.plot.posToVal(c.plot.cursor.left, 'x').toFixed(1)))].length"
    )
    assert cursors == 1
    value = float(browser.ask("document.querySelector('[data-key=speed] .key span').textContent"))
    result = transport()
    at = int(np.abs(result.time - (moved[0, 0] + 0.4 * np.ptp(moved[0]))).argmin())
    assert value == pytest.approx(result.sheet_motion(0)[1][at, 0] * 1000.0, rel=1e-2)
    # a click is the time of the animation; the keyboard has all of it, too
    for kind in ("mousePressed", "mouseReleased"):
        mouse(kind, places[1])
    assert browser.ask("mdlgen.state.time") == pytest.approx(result.time[at], abs=0.3)
    browser.ask("document.querySelector('[data-key=speed] .plot').focus()")
    browser.press("0")
    two_frames(browser)
    assert np.allclose(json.loads(browser.ask(spans)), [0.0, 50.0])
    assert "note x from 0 to" in browser.ask(
        "document.querySelector('[data-key=speed] .plot').getAttribute('aria-label')"
    )
    silent(browser, tmp_path)


def in_space(browser: Tab) -> set[str]:
    """Names that are seen over the picture."""
    return set(
        browser.ask(
            "[...document.querySelectorAll('#labels span')].filter((s) => s.style.visibility === 'visible')"
            ".map((s) => s.textContent)"
        )
    )


def test_two_runs_with_verdicts_in_each_width_and_tone(browser: Tab, tmp_path: Path) -> None:
    """What a review looks at first is in sight, and the page is as wide as the window."""
    require = 'require=["yaw within 1 deg", "speed above 1.3 m/s"]'
    slower = "rollers.motor_1_left.drive.speed=180 rad/s"
    try:
        show(browser, tmp_path, [transport(require), transport(require, slower)], "#view=xy&t=45")
        for wide, tone in ((1400, "light"), (800, "light"), (800, "dark"), (1400, "dark")):
            features = [{"name": "prefers-color-scheme", "value": tone}]
            browser.call("Emulation.setEmulatedMedia", features=features)
            browser.call(
                "Emulation.setDeviceMetricsOverride",
                **{"width": wide, "height": 1000, "deviceScaleFactor": 1, "mobile": False},
            )
            two_frames(browser)
            whole = np.asarray(Image.open(io.BytesIO(browser.picture())).convert("L")).astype(int)
            assert (np.median(whole) < 100) == (tone == "dark")
            assert browser.ask("document.documentElement.scrollWidth") <= wide
            assert {"note", "counter_1_left"} <= in_space(browser)
            first = browser.ask("document.getElementById('verdicts').getBoundingClientRect().bottom")
            assert 0 < first < 400
            picture = drawn(browser, 45.0)
            assert (picture[0, 0].mean() < 100) == (tone == "dark")
            assert (np.abs(picture - picture[0, 0]).max(axis=2) > 30).mean() > 0.05
        verdicts = browser.ask("document.getElementById('verdicts').innerText")
        assert verdicts.count("pass") == 3 and verdicts.count("FAIL") == 1
        # the other run is a ghost on the same clock
        browser.ask("mdlgen.under(-1)")
        assert (np.abs(picture - drawn(browser, 45.0)).max(axis=2) > 20).mean() > 0.001
        # what is under the pointer is described with its values at the time
        place = json.loads(
            browser.ask(
                "document.getElementById('stage').scrollIntoView(); JSON.stringify((() => {"
                "const part = mdlgen.runs[0].parts.find((p) => p.name === 'counter_1_left');"
                "const frame = document.getElementById('canvas').getBoundingClientRect();"
                "const [x, y] = mdlgen.stage.project(mdlgen.stage.where(part));"
                "return [x + frame.left, y + frame.top]; })())"
            )
        )
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=place[0], y=place[1])
        browser.until("!document.getElementById('tip').hidden")
        said = browser.ask("document.getElementById('tip').innerText")
        assert "counter_1_left (roller)" in said and "rad/s" in said and "force" in said
        silent(browser, tmp_path)
    finally:
        browser.call("Emulation.clearDeviceMetricsOverride")
        browser.call("Emulation.setEmulatedMedia", features=[])


def test_it_prints_on_few_pages(browser: Tab, tmp_path: Path) -> None:
    """transport_4x4 as it is: at most four pages of A4, the view as a picture, light from a dark page."""
    from pypdfium2 import PdfDocument

    browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    try:
        show(browser, tmp_path, [ran("transport_4x4")], "#t=30")
        sheets = b64decode(browser.call("Page.printToPDF", paperWidth=8.27, paperHeight=11.69)["data"])
        pages = PdfDocument(sheets)
        assert 1 < len(pages) <= 4
        first = np.asarray(pages[0].render(scale=1).to_pil().convert("RGB")).astype(int)
        assert np.median(first) > 230, "printed light"
        words = "".join(page.get_textpage().get_text_range() for page in pages)
        for word in ("made with", "Displacement of the sheet", "Yaw, constant", "What was run"):
            assert word in words
        # the picture: the note's yellow at its place, the machine, and no black
        top = first[: first.shape[0] // 2]
        yellow = (top[..., 0] > 180) & (top[..., 1] > 180) & (top[..., 2] < 110)
        assert yellow.mean() > 0.02 and (top.max(axis=2) < 30).mean() < 0.02
        # figures have lines in colour
        lower = first[first.shape[0] // 2 :]
        assert (np.ptp(lower, axis=2) > 60).mean() > 0.005
        # as it was, on the screen
        assert drawn(browser, 30.0)[0, 0].mean() < 100
        silent(browser, tmp_path)
    finally:
        browser.call("Emulation.setEmulatedMedia", features=[])


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
    browser.ask("mdlgen.under(-1)")
    one = drawn(browser, 40.0)
    browser.ask("mdlgen.choose(1)")
    assert browser.ask("mdlgen.state.time") == 40
    assert (np.abs(drawn(browser, 40.0) - one).max(axis=2) > 30).mean() > 0.001
    assert browser.ask("document.querySelectorAll('figure[data-key=displacement] .key').length") == 6
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

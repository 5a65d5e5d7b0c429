"""The page of `mdlgen live` in a browser: a slider is dragged, the file edited, two designs compared."""

from __future__ import annotations

import io
import json
import statistics
from base64 import b64decode
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import Tab, found, tab
from living import SMALL, Live, live, scene
from PIL import Image

pytestmark = pytest.mark.skipif(
    found() is None, reason="no Chromium on the path (apt-get install chromium, or set MDLGEN_CHROMIUM)"
)
SPEED = "rollers.motor_1_left.drive.speed"
READY = "document.documentElement?.dataset.ready === 'yes'"
DRAWN = "document.documentElement.dataset.shown?.endsWith('full')"
FULL = f"{READY} && mdlgen.session().busy === null && {DRAWN}"
# From a slider to the picture, and between two pictures while it is dragged, in times that the solver itself
# took for the run that was shown, a search of several passes: so what else the machine has to do slows both.
LATENCY, BETWEEN = 1.5, 1.5


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tab]:
    with tab(tmp_path_factory.mktemp("profile")) as made:
        yield made


def show(browser: Tab, made: Live, complete: bool = True) -> None:
    """Opens the page; until the full run is shown, or the first state."""
    browser.call("Page.navigate", url="about:blank")  # the page of another test asks no more
    browser.until("location.href === 'about:blank'")
    browser.complaints.clear()
    browser.requests.clear()
    browser.call("Page.navigate", url=made.address)
    browser.until(FULL if complete else READY)


def silent(browser: Tab, made: Live) -> None:
    """It did not complain, nor ask anyone but its own server."""
    assert browser.complaints == []
    own = ("blob:", "data:", made.address)
    assert [url for url in browser.requests if not url.startswith(own)] == []
    assert browser.ask("document.getElementById('no-drawing').hidden")


def pixels(browser: Tab) -> np.ndarray:
    url = browser.ask("mdlgen.stage.now(); document.getElementById('canvas').toDataURL('image/png')")
    return np.asarray(Image.open(io.BytesIO(b64decode(url.split(",", 1)[1]))).convert("RGB")).astype(int)


def slide(browser: Tab, path: str, part: float, held: bool = False) -> None:
    """Puts a slider at a part of its span, as a hand does."""
    browser.ask(
        f"(() => {{ const {{ slider }} = mdlgen.rows.get('{path}');"
        f"slider.value = Number(slider.min) + {part} * (slider.max - slider.min);"
        "window.begun = performance.now(); slider.dispatchEvent(new Event('input'));"
        f"if (!{json.dumps(held)}) slider.dispatchEvent(new Event('change')); }})()"
    )


def drawn(browser: Tab, first: int) -> list[dict[str, Any]]:
    """What was drawn from the `first` picture on, and how long after the slider was put [ms]."""
    text = f"mdlgen.live.log.slice({first}).map((one) => ({{ ...one, at: one.at - window.begun }}))"
    return json.loads(browser.ask(f"JSON.stringify({text})"))


def quiet(browser: Tab) -> None:
    browser.ask("new Promise((done) => setTimeout(done, 150))")  # what was turned has been asked for
    browser.until(FULL)


def solved(browser: Tab) -> float:
    """Seconds that the solver took for the run that is shown, with the estimate of its error."""
    return float(browser.ask("mdlgen.session().run.solved_s"))


def test_a_slider_is_dragged(browser: Tab, tmp_path: Path) -> None:
    """transport_4x4, 60 boxes: the picture follows; how fast, in times of the solver's own."""
    spec = scene(tmp_path, "transport_4x4", ("boxes: [10, 20]", "boxes: [6, 10]"))
    with live(spec) as made:
        show(browser, made)
        before = pixels(browser)
        took, solving = [], []
        for k in range(5):
            first = browser.ask("mdlgen.live.log.length")
            slide(browser, SPEED, 0.35 + 0.05 * k)
            browser.until(f"mdlgen.live.log.length > {first}")
            took.append(drawn(browser, first)[0]["at"] / 1000.0)
            quiet(browser)
            solving.append(solved(browser))
        assert min(np.divide(took, solving)) < LATENCY, (took, solving)
        # another picture: the left drive is slower, and the note turns
        assert (np.abs(pixels(browser) - before).max(axis=2) > 30).mean() > 0.01
        # dragged for so long that some drafts are drawn, and the full run after it
        long = 1000 * max(2.0, 6.0 * statistics.median(solving))  # some four pictures at that bound
        first = browser.ask("mdlgen.live.log.length")
        browser.ask(
            f"(async () => {{ const {{ slider }} = mdlgen.rows.get('{SPEED}');"
            "const begun = window.begun = performance.now();"
            f"for (let k = 0; performance.now() - begun < {long}; k += 1) {{"
            "slider.value = 130 + (2 * k) % 60; slider.dispatchEvent(new Event('input'));"
            "await new Promise((done) => setTimeout(done, 30)); }"
            "slider.dispatchEvent(new Event('change')); })()"
        )
        during = [one["at"] / 1000.0 for one in drawn(browser, first)]
        quiet(browser)
        gaps = np.diff([0.0, *during])
        assert len(during) >= 3 and np.median(gaps) < BETWEEN * statistics.median(solving), (during, solving)
        kinds = [one["kind"] for one in drawn(browser, first)]
        assert "draft" in kinds and kinds[-1] == "full"
        # the value of the slider is that of the run
        value = browser.ask(f"mdlgen.rows.get('{SPEED}').field.value")
        assert made.get("state")["turned"] == {SPEED: value}
        silent(browser, made)
    print(f"slider to picture {took} s, pictures while it is dragged {during} s, solver {solving} s")


@pytest.mark.parametrize("wide", [1400, 800])
@pytest.mark.parametrize("tone", ["light", "dark"])
def test_the_page_is_drawn(browser: Tab, tmp_path: Path, wide: int, tone: str) -> None:
    features = [{"name": "prefers-color-scheme", "value": tone}]
    browser.call("Emulation.setEmulatedMedia", features=features)
    browser.call(
        "Emulation.setDeviceMetricsOverride", width=wide, height=1000, deviceScaleFactor=1, mobile=False
    )
    try:
        with live(scene(tmp_path)) as made:
            show(browser, made)
            picture = pixels(browser)
            assert (picture[0, 0].mean() < 100) == (tone == "dark")
            assert (np.abs(picture - picture[0, 0]).max(axis=2) > 30).mean() > 0.02
            whole = np.asarray(Image.open(io.BytesIO(browser.picture())).convert("L")).astype(int)
            assert (np.median(whole) < 100) == (tone == "dark")
            # as wide as the window; values beside the picture where there is room, else below
            assert browser.ask("document.documentElement.scrollWidth") <= wide
            beside = "document.getElementById('values').getBoundingClientRect().right <="
            beside += "document.getElementById('animation').getBoundingClientRect().left"
            assert browser.ask(beside) == (wide == 1400)
            assert "travel" in browser.ask("document.getElementById('headline').innerText")
            assert browser.ask("document.querySelectorAll('#panels figure').length") > 5
            silent(browser, made)
    finally:
        browser.call("Emulation.clearDeviceMetricsOverride")
        browser.call("Emulation.setEmulatedMedia", features=[])


def test_edits_mistakes_and_values_are_shown(browser: Tab, tmp_path: Path) -> None:
    spec = scene(tmp_path)
    text = spec.read_text("utf-8") + "require: [speed above 300 mm/s]\n"
    spec.write_text(text, "utf-8")
    field = "mdlgen.rows.get('parameters.speed').field"
    errors = "[...document.querySelectorAll('#errors p')].map((p) => p.innerText)"
    with live(spec) as made:
        show(browser, made)
        assert browser.ask("document.querySelector('#groups details').open")  # the parameters
        assert browser.ask(f"{field}.value") == "1400.25 mm/s"
        assert "pass speed above 300 mm/s" in browser.ask("document.getElementById('headline').innerText")
        # an edit
        spec.write_text(text.replace("1400.25 mm/s", "200 mm/s"), "utf-8")
        browser.until(f"{field}.value === '200 mm/s'")
        # the field is there before its run is
        browser.until("document.getElementById('headline').innerText.includes('FAIL speed above 300 mm/s')")
        quiet(browser)
        # a mistake, at its line; the run before stays
        spec.write_text(text.replace("mass: 0.72 g", "mass: 0.72 N"), "utf-8")
        browser.until(f"{errors}.length === 1")
        assert "sheets.note.mass: '0.72 N' has the wrong unit" in browser.ask(errors)[0]
        # the message may come before the text of the file
        browser.until("document.querySelector('#lines .wrong')?.innerText.includes('mass: 0.72 N')")
        number = browser.ask("Number(document.querySelector('#lines .wrong').dataset.line)")
        assert f"{spec}:{number}:" in browser.ask(errors)[0]
        assert "speed" in browser.ask("document.getElementById('headline').innerText")
        spec.write_text(text, "utf-8")
        browser.until(f"{errors}.length === 0")
        quiet(browser)
        # a value that is wrong says so beside its field
        browser.ask(
            "(() => { const { field } = mdlgen.rows.get('sheets.note.mass'); field.value = '3 N';"
            "field.dispatchEvent(new Event('change')); })()"
        )
        browser.until("mdlgen.rows.get('sheets.note.mass').field.getAttribute('aria-invalid') === 'true'")
        assert "wrong unit" in browser.ask("mdlgen.rows.get('sheets.note.mass').wrong.innerText")
        browser.ask("document.getElementById('reset').click()")
        browser.until(f"{errors}.length === 0")
        # a slider by the keyboard, and the value is written back
        browser.ask("mdlgen.rows.get('parameters.speed').slider.focus()")
        browser.press("ArrowLeft")
        browser.until("'parameters.speed' in mdlgen.session().turned")
        quiet(browser)
        value = browser.ask(f"{field}.value")
        assert value != "1400.25 mm/s"
        assert browser.ask("document.getElementById('command').innerText") == (
            f"mdlgen run {spec} --set 'parameters.speed={value}'"
        )
        browser.ask("document.getElementById('write').click()")
        browser.until("Object.keys(mdlgen.session().turned).length === 0")
        assert spec.read_text("utf-8") == text.replace("1400.25 mm/s", value)
        # every control has a name for those who hear the page
        assert browser.ask(
            "[...document.querySelectorAll('button, select, input, progress, pre, #canvas, .plot')]"
            ".every((e) => e.textContent.trim() || e.ariaLabel || e.labels?.length)"
        )
        silent(browser, made)


def test_two_designs_are_overlaid(browser: Tab, tmp_path: Path) -> None:
    with live(scene(tmp_path, "transport_nips", SMALL[0], ("duration: 50 ms", "duration: 20 ms"))) as made:
        show(browser, made)
        browser.ask("document.getElementById('pin').click()")
        paths = "document.querySelectorAll('figure[data-key=displacement] .key').length"
        one = pixels(browser)
        assert browser.ask(paths) == 6
        slide(browser, "parameters.speed", 0.1)
        quiet(browser)
        both = pixels(browser)
        browser.ask("document.getElementById('ghost').click()")
        without = pixels(browser)
        # the pinned note stands where it was, in another colour; without it there is less to see
        assert (np.abs(both - without).max(axis=2) > 20).mean() > 0.005
        assert (np.abs(one - without).max(axis=2) > 20).mean() > 0.005
        assert "pinned (as in the file)" in browser.ask("document.getElementById('pinned').innerText")
        browser.ask("document.getElementById('pin').click()")
        assert browser.ask(paths) == 3 and browser.ask("document.getElementById('pinned').hidden")
        silent(browser, made)


def test_a_long_run_grows_and_has_a_bar(browser: Tab, tmp_path: Path) -> None:
    long = ("duration: 50 ms", "duration: 200000 ms")
    with live(scene(tmp_path, "transport_nips", SMALL[0], long)) as made:
        show(browser, made, complete=False)
        ends: list[float] = []
        for _ in range(3):
            last = ends[-1] if ends else 0.0
            browser.until(f"mdlgen.runs.length && mdlgen.runs[0].animation.time.at(-1) > {last}")
            ends.append(browser.ask("mdlgen.runs[0].animation.time.at(-1)"))
        assert 0.0 < ends[0] < ends[1] < ends[2] <= 200000.0
        browser.until("!document.getElementById('progress').hidden")
        assert 0.0 < browser.ask("document.getElementById('progress').value") <= 1.0
        browser.ask(
            "(() => { const { field } = mdlgen.rows.get('run.duration'); field.value = '6 ms';"
            "field.dispatchEvent(new Event('change')); })()"
        )
        quiet(browser)
        assert browser.ask("mdlgen.runs[0].animation.time.at(-1)") == 6
        assert browser.ask("document.getElementById('progress').hidden")
        silent(browser, made)

"""The page of a scene as it begins, in a browser, from file://: names, axes, scale, words at the pointer."""

from __future__ import annotations

import io
import json
from base64 import b64decode
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import Tab, found, tab
from PIL import Image

from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.report.html.preview import preview
from mdlgen.spec.load import load

pytestmark = pytest.mark.skipif(
    found() is None, reason="no Chromium on the path (apt-get install chromium, or set MDLGEN_CHROMIUM)"
)
ZONE = "sheets.note.zones.worn={x: [-33.5 mm, 0 mm], y: [0 mm, 63.5 mm], stiffness: 0.3}"
RICH = Path(__file__).parents[1] / "helpers" / "rich.yaml"


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tab]:
    with tab(tmp_path_factory.mktemp("profile")) as made:
        yield made


def four(*sets: str) -> Model:
    return lower(load(samples() / "transport_4x4.yaml", sets))


def show(browser: Tab, folder: Path, model: Model, fragment: str = "") -> Path:
    path = folder / "preview.html"
    path.write_text(preview(model), "utf-8")
    browser.complaints.clear()
    browser.requests.clear()
    browser.open(path, fragment)
    wait_until_drawn(browser)
    return path


def wait_until_drawn(browser: Tab) -> None:
    """What was asked for is drawn."""
    browser.ask("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def silent(browser: Tab, path: Path) -> None:
    assert browser.complaints == []
    asked = [u for u in browser.requests if not u.startswith(("blob:", "data:", path.resolve().as_uri()))]
    assert asked == [] and browser.ask("document.getElementById('no-drawing').hidden")


def pixels(browser: Tab) -> np.ndarray:
    url = browser.ask("mdlgen.stage.now(); document.getElementById('canvas').toDataURL('image/png')")
    return np.asarray(Image.open(io.BytesIO(b64decode(url.split(",", 1)[1]))).convert("RGB")).astype(int)


def names(browser: Tab) -> list[str]:
    return browser.ask(
        "[...document.querySelectorAll('#labels span')].filter((s) => s.style.visibility === 'visible')"
        ".map((s) => s.textContent)"
    )


def over(browser: Tab, name: str, off: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> str:
    """What the page says with the pointer on the middle of a part, or `off` it [mm]."""
    place = browser.ask(
        f"JSON.stringify((() => {{const part = mdlgen.scene.parts.find((p) => p.name === '{name}');"
        f"const at = part.at.map((value, k) => value + {list(off)}[k]);"
        "const frame = document.getElementById('canvas').getBoundingClientRect();"
        "const [x, y] = mdlgen.stage.project(at); return [x + frame.left, y + frame.top];})())"
    )
    x, y = json.loads(place)
    browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
    wait_until_drawn(browser)
    return browser.ask(
        "document.getElementById('tip').hidden ? '' : document.getElementById('tip').innerText"
    )


@pytest.mark.parametrize("wide", [1400, 800])
@pytest.mark.parametrize("tone", ["light", "dark"])
def test_names_axes_and_scale(browser: Tab, tmp_path: Path, wide: int, tone: str) -> None:
    features = [{"name": "prefers-color-scheme", "value": tone}]
    browser.call("Emulation.setEmulatedMedia", features=features)
    browser.call(
        "Emulation.setDeviceMetricsOverride", width=wide, height=1000, deviceScaleFactor=1, mobile=False
    )
    try:
        path = show(browser, tmp_path, four())
        picture = pixels(browser)
        ground = picture[-1, -1]
        assert (ground.mean() < 100) == (tone == "dark")
        assert (np.abs(picture - picture[0, 0]).max(axis=2) > 30).mean() > 0.05
        # arrows of drives and presses in their colours
        for colour in ((0, 114, 178), (0, 158, 115)):
            assert (np.abs(picture - np.array(colour)).max(axis=2) < 40).sum() > 50
        assert {"note", "motor_1_left", "counter_2_right", "support"} <= set(names(browser))
        axes = "[...document.querySelectorAll('#axes text')].map((t) => t.textContent).sort().join('')"
        assert browser.ask(axes) == "gxyz"
        length = browser.ask("document.querySelector('#scale').innerText")
        drawn = browser.ask("document.querySelector('#scale').getBoundingClientRect().width")
        per = browser.ask("mdlgen.stage.pixelsPerMm()")
        assert length.endswith(" mm") and float(length[:-3]) * per == pytest.approx(drawn, abs=3)
        # the page is as wide as the window
        assert browser.ask("document.documentElement.scrollWidth") <= wide
        silent(browser, path)
    finally:
        browser.call("Emulation.clearDeviceMetricsOverride")
        browser.call("Emulation.setEmulatedMedia", features=[])


def test_what_is_under_the_pointer(browser: Tab, tmp_path: Path) -> None:
    path = show(browser, tmp_path, four(ZONE), "#view=xz")
    said = over(browser, "counter_2_left")
    assert "counter_2_left (roller)" in said and "pressed along -z by 3.19 N" in said
    assert "contact with motor_2_left: 0.219 mm deep" in said
    browser.ask("mdlgen.view('xy')")
    wait_until_drawn(browser)
    browser.ask("document.getElementById('machine').click()")
    said = over(browser, "note", (3.3, 3.2, 0.0))  # in a box, not between four
    assert "note (sheet)" in said and "zone worn: 50 boxes" in said
    assert "contact with motor_1_left: 0.0484 mm deep" in said and "box " in said
    # a box of the zone says so
    place = "mdlgen.stage.pick(...mdlgen.stage.project([-23, 41, 0])).box"
    box = browser.ask(place)
    assert box in [i + 10 * j for i in range(5) for j in range(10, 20)]
    browser.ask(f"mdlgen.tell({{ box: {box} }}, 10, 10)")
    assert " in worn" in browser.ask("document.getElementById('tip').innerText")
    # beside all parts there is nothing to say
    assert browser.ask("mdlgen.tell(mdlgen.stage.pick(2, 2), 2, 2); document.getElementById('tip').hidden")
    silent(browser, path)


def test_warnings_are_at_their_parts(browser: Tab, tmp_path: Path) -> None:
    path = show(browser, tmp_path, lower(load(RICH)))
    assert {"low \u26a0", "high \u26a0", "side \u26a0"} <= set(names(browser))
    assert "W111" in over(browser, "side")
    assert "3 warnings" in browser.ask("document.querySelector('header').innerText")
    # a row of the table finds its part
    browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=5, y=5)
    wait_until_drawn(browser)
    browser.ask("document.querySelector('#lints [data-part=low]').click()")
    assert browser.ask("document.querySelector('#labels .chosen').dataset.part") == "low"
    assert browser.ask("document.querySelector('#labels .mate') !== null")
    silent(browser, path)


def test_it_prints_with_its_picture(browser: Tab, tmp_path: Path) -> None:
    from pypdfium2 import PdfDocument

    path = show(browser, tmp_path, four())
    pages = PdfDocument(
        b64decode(browser.call("Page.printToPDF", paperWidth=8.27, paperHeight=11.69)["data"])
    )
    assert len(pages) <= 3
    first = np.asarray(pages[0].render(scale=1).to_pil().convert("RGB")).astype(int)
    red, green, blue = np.moveaxis(first[: len(first) // 2], 2, 0)
    # the note in its colour, names beside it, and no black
    assert ((green > red + 60) & (green > blue)).mean() > 0.02
    assert (first[: len(first) // 2].max(axis=2) < 30).mean() < 0.02
    assert "motor_1_left" in pages[0].get_textpage().get_text_range()
    silent(browser, path)


def test_views_colours_and_switches(browser: Tab, tmp_path: Path) -> None:
    path = show(browser, tmp_path, four(ZONE))
    whole = pixels(browser)
    seen = []
    for k in range(browser.ask("mdlgen.scene.animation.colours.length")):
        browser.ask(f"mdlgen.colour({k})")
        seen.append(pixels(browser))
    assert len(seen) == 2 and (np.abs(seen[0] - seen[1]).max(axis=2) > 30).mean() > 0.01
    assert "how deep boxes are in rollers" in browser.ask("document.getElementById('legend').innerText")
    browser.ask("mdlgen.colour(0)")
    assert browser.ask("document.getElementById('legend').innerText").split("\n") == ["note", "note: worn"]
    browser.ask("document.getElementById('arrows').click()")
    assert (np.abs(whole - pixels(browser)).max(axis=2) > 30).sum() > 100
    browser.ask("document.getElementById('names').click()")
    assert names(browser) == []
    browser.ask("document.getElementById('canvas').focus()")
    for key, view in zip("1234", ("xz", "yz", "xy", "iso"), strict=True):
        browser.press(key)
        assert browser.ask("mdlgen.state.view") == view
    silent(browser, path)

"""How long a picture of the page takes in a headless Chromium, without a graphics card.

As a program, `python tests/helpers/frames.py [COLUMNS ROWS STATES]`, it prints that for a note in
`transport_4x4`, of 20 x 30 boxes at 500 states by default.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from browser import Tab, tab
from synthetic import moving, small_model

from mdlgen.report.html.page import page

# Moved, drawn, and a pixel read back, since only that tells that it is done: 30 pictures at other times each,
# after 10 to get warm. Of these the fastest quarter, since what else a machine does only adds.
PICTURE = """(() => {
  const took = [];
  for (let k = 0; k < 40; k += 1) {
    const begun = performance.now();
    mdlgen.seek(k); mdlgen.stage.now();
    took.push(performance.now() - begun);
  }
  return took.slice(10).sort((a, b) => a - b)[7];
})()"""
# Between two pictures that are shown while it plays, browser and page included: the median of 60.
SHOWN = """new Promise((done) => {
  mdlgen.seek(0); mdlgen.play(true);
  const took = [];
  let last = performance.now();
  requestAnimationFrame(function next(now) {
    took.push(now - last); last = now;
    if (mdlgen.state.time > 45) mdlgen.seek(0);
    if (took.length < 70) requestAnimationFrame(next);
    else { mdlgen.play(false); done(took.slice(10).sort((a, b) => a - b)[30]); }
  });
})"""


def picture_ms(browser: Tab) -> float:
    """Of an open page, all of whose pixels are drawn."""
    assert browser.ask(
        "(() => {const c = document.getElementById('canvas'); mdlgen.stage.now();"
        "return c.width === Math.floor(c.clientWidth * devicePixelRatio)})()"
    )
    return browser.ask(PICTURE)


def main(columns: int = 20, rows: int = 30, states: int = 500) -> None:
    result = moving(small_model(f"sheets.note.boxes=[{columns},{rows}]"), states)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "report.html"
        path.write_text(page([result]), "utf-8")
        with tab(Path(folder) / "profile") as browser:
            browser.open(path)
            width, height = browser.ask(
                "(({width, height}) => [width, height])(document.getElementById('canvas'))"
            )
            print(f"{columns * rows} boxes, {states} states: page {path.stat().st_size / 1e6:.1f} MB")
            print(f"{width} x {height} pixels: {picture_ms(browser):.1f} ms a picture (goal: 50)")
            shown = browser.ask(SHOWN)
    print(f"{shown:.1f} ms between pictures shown as it plays; load of this machine {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))

"""Makes the pictures of the manual: `python docs/_generate/pictures.py [NAME ...]`.

One PNG for each sample, `note`, an animation of transport_4x4, and `start`, a scene before it is run.
`recycler` makes the animation of README.md, too. All of them are drawn by mdlgen itself; the drawings of
geometry, *.svg, are made by hand.
"""

from __future__ import annotations

import io
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

import mdlgen
from mdlgen.report.figures.start import still
from mdlgen.report.figures.stills import stills
from mdlgen.results.result import Result

ROOT = Path(__file__).resolve().parent.parent.parent
TARGET = ROOT / "docs" / "pictures"
# when a sample shows what it is for [ms]; half of the run where none is given
AT = {
    "transport_4x4": 30.0,
    "transport_nips": 30.0,
    "transport_4x2": 110.0,
    "transport_tilted": 60.0,
    "tilt_correction": 60.0,
    "channel": 32.0,
    "diverter": 125.0,
    "duplex": 125.0,
    "guide_joint": 20.0,
    "feeder": 400.0,
    "feeder_one": 400.0,
    "recycler": 262.0,
    "spring_plate": 20.0,
}
COLOURS, WIDTH = 48, 640
# of an animation: the time between two pictures in the run and on the screen [ms], and its width
EVERY, SHOWN, WIDE = {"note": 1.0, "recycler": 6.0}, 70, {"note": 480, "recycler": 640}


def run(name: str) -> Result:
    found = mdlgen.solve(mdlgen.lower(mdlgen.load(ROOT / "samples" / f"{name}.yaml")))
    if not found.ok:
        raise SystemExit(f"{name}: {found.status}")
    return found


def drawn(result: Result, times: list[float], width: int) -> list[Image.Image]:
    """Pictures at times [ms], all of one frame."""
    found = []
    for content in stills(result, times).values():
        image = Image.open(io.BytesIO(content)).convert("RGB")
        height = round(width * image.height / image.width)
        found.append(image.resize((width, height), Image.Resampling.LANCZOS))
    return found


def sample(name: str) -> None:
    result = run(name)
    end = float(result.time[-1])
    time = min(AT.get(name, end / 2), end)
    image = drawn(result, [time], WIDTH)[0].quantize(COLOURS, dither=Image.Dither.NONE)
    path = TARGET / "samples" / f"{name.replace('/', '_')}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    image.save(path, optimize=True)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1000} kB, {time:g} ms")
    if name in EVERY:
        animated(name, result)


def note() -> None:
    """An animated GIF of transport_4x4."""
    animated("note", run("transport_4x4"))


def animated(name: str, result: Result) -> None:
    """An animated GIF of a run; notes that have left lie where they did."""
    times = np.arange(0.0, float(result.time[-1]) + 1e-9, EVERY[name])
    images = drawn(replace(result, stays=None), times.tolist(), WIDE[name])
    # notes begin slow and end fast: colours of all times
    wide, high = images[0].size
    every = Image.new("RGB", (wide, high * len(images)))
    for k, image in enumerate(images):
        every.paste(image, (0, k * high))
    palette = every.quantize(2 * COLOURS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    frames = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    path = TARGET / f"{name}.gif"
    frames[0].save(
        path, save_all=True, append_images=frames[1:], duration=SHOWN, loop=0, optimize=True, disposal=1
    )
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1000} kB, {len(frames)} pictures")


def start() -> None:
    """A still of transport_4x4 as it begins, as mdlgen preview draws it."""
    content = still(mdlgen.lower(mdlgen.load(ROOT / "samples" / "transport_4x4.yaml")))
    path = TARGET / "start.png"
    image = Image.open(io.BytesIO(content)).convert("RGB")
    image.quantize(2 * COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1000} kB")


def main() -> None:
    names = sys.argv[1:]
    if not names:
        sys.path.insert(0, str(Path(__file__).resolve().parent))
        from gallery import names as every

        names = ["note", "start", *every()]
    for name in names:
        own = {"note": note, "start": start}.get(name)
        own() if own else sample(name)


if __name__ == "__main__":
    main()

"""Coverage-guided fuzz of the parsers, with atheris (which nothing else here needs).

python -m pip install atheris
python tests/helpers/fuzz_atheris.py scene -max_total_time=600
python tests/helpers/fuzz_atheris.py text -max_total_time=600
python tests/helpers/fuzz_atheris.py stl -max_total_time=600
python tests/helpers/fuzz_atheris.py obj -max_total_time=600
"""

from __future__ import annotations

import sys
from functools import partial

import atheris
from pydantic_core import PydanticCustomError

with atheris.instrument_imports(include=["mdlgen"]):
    from mdlgen.backends.motionview.reader import read
    from mdlgen.errors import MdlgenError
    from mdlgen.paths import samples
    from mdlgen.spec.limits import Tally
    from mdlgen.spec.load import loads
    from mdlgen.spec.solid import signed_volume, solid


def scene(raw: bytes) -> None:
    try:
        loads(raw.decode("utf-8", errors="replace"), "fuzz.yaml")
    except MdlgenError as error:
        assert "\n" not in str(error)


def text(raw: bytes) -> None:
    try:
        read(raw.decode("utf-8", errors="replace"), "fuzz.mdl")
    except MdlgenError as error:
        assert "\n" not in str(error)


def mesh(name: str, raw: bytes) -> None:
    try:
        found = solid(raw, name, "mm", Tally())
    except PydanticCustomError as error:
        assert "\n" not in error.message()
    else:
        assert signed_volume(found.corners, found.triangles) > 0.0


def start(kind: str, folder: str) -> None:
    """What the fuzzer begins with: a sample, the text of one, or a mesh."""
    from pathlib import Path

    from solids import ascii_stl, binary, brick, cylinder, obj

    import mdlgen

    if kind in ("stl", "obj"):
        for number, made in enumerate((brick(4.0, 6.0, 10.0), cylinder(7.5, 5.0, 8))):
            forms = [obj(*made).encode()] if kind == "obj" else [binary(*made), ascii_stl(*made).encode()]
            for form, raw in enumerate(forms):
                Path(folder, f"{number}_{form}.{kind}").write_bytes(raw)
        return
    for path in sorted(samples().rglob("*.yaml")):
        if kind == "scene":
            Path(folder, path.name).write_bytes(path.read_bytes())
        elif path.stem in ("drop", "flip"):
            Path(folder, f"{path.stem}.mdl").write_text(mdlgen.emit(mdlgen.lower(mdlgen.load(path))))


if __name__ == "__main__":
    import tempfile

    kind, *options = sys.argv[1:]
    with tempfile.TemporaryDirectory() as corpus:
        start(kind, corpus)
        targets = {"scene": scene, "text": text, **{k: partial(mesh, f"fuzz.{k}") for k in ("stl", "obj")}}
        atheris.Setup([sys.argv[0], *options, corpus], targets[kind])
        atheris.Fuzz()

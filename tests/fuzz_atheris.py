"""Coverage-guided fuzz of the two parsers, with atheris (which nothing else here needs).

python -m pip install atheris
python tests/fuzz_atheris.py scene -max_total_time=600
python tests/fuzz_atheris.py text -max_total_time=600
"""

from __future__ import annotations

import sys

import atheris

with atheris.instrument_imports(include=["mdlgen", "backends"]):
    from backends.motionview.reader import read
    from mdlgen.errors import MdlgenError
    from mdlgen.paths import samples
    from mdlgen.spec.load import loads


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


def start(kind: str, folder: str) -> None:
    """What the fuzzer begins with: a sample, or the text of one."""
    from pathlib import Path

    import mdlgen

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
        atheris.Setup([sys.argv[0], *options, corpus], {"scene": scene, "text": text}[kind])
        atheris.Fuzz()

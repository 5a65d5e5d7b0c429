"""The manual: its commands and scenes run as printed, its generated pages are those of the code, and no key,
result or link is missing."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from places import ROOT
from ran import transport
from recordings import plt
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.paths import samples
from mdlgen.results.io.series import series
from mdlgen.results.result import Result

DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(p for p in DOCS.rglob("*.md") if "_build" not in p.parts)]
BLOCK = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?", re.IGNORECASE)
# Printed numbers are those of one machine: another one has other round-off, and grids are coarse.
NEAR = 0.02

sys.path.insert(0, str(DOCS / "_generate"))
import outputs  # noqa: E402  the generator's own modules
import pages  # noqa: E402
import scene as keys  # noqa: E402


def blocks(page: Path) -> Iterator[tuple[str, str, str]]:
    """Language, what stands behind it, and content of each fenced block."""
    for found in BLOCK.finditer(page.read_text("utf-8")):
        yield found[1], found[2].strip(), found[3]


def pattern(line: str) -> re.Pattern[str]:
    """Matches what is printed: spaces are alike, `...` is anything, numbers are looked at apart."""
    parts = []
    for piece in line.split("..."):
        words = [re.escape(word) for word in re.split(f"({NUMBER.pattern})", " ".join(piece.split()))]
        words = ["([-+0-9.e]+)" if k % 2 else word.replace("\\ ", r"\s+") for k, word in enumerate(words)]
        parts.append(r"\s*".join(words))
    return re.compile(".*?".join(parts) + r"\s*")


def check_printed(expected: str, printed: str, where: str) -> None:
    """Raises where a line that the page prints is not printed, in order; a line `...` stands for any."""
    lines, at = printed.splitlines(), 0
    for line in expected.splitlines():
        if line.strip() == "...":
            continue
        wanted, match = pattern(line), None
        numbers = NUMBER.findall(line.replace("...", " "))
        while at < len(lines) and match is None:
            match = wanted.fullmatch(lines[at].strip())
            if match is not None and not _near(numbers, match.groups()):
                match = None
            at += 1
        assert match is not None, f"{where}: not printed: {line!r}\nprinted was:\n{printed}"


def _near(numbers: list[str], found: tuple[str, ...]) -> bool:
    """Within NEAR, or by one in the last of printed decimals, which may round either way."""
    for text, other in zip(numbers, found, strict=True):
        decimals = len(text.partition(".")[2]) if "e" not in text else 0
        last = 10.0**-decimals if decimals else 0.0
        if abs(float(other) - float(text)) > max(NEAR * abs(float(text)), 1.001 * last, 1e-11):
            return False
    return True


def play(page: Path, folder: Path) -> int:
    """Does what a page says in an empty folder; returns how many commands and programs were run."""
    count, printed = 0, ""
    for language, more, content in blocks(page):
        where = page.name
        if language == "yaml" and (name := re.match(r"# ([\w/]+\.yaml)\n", content)):
            path = folder / name[1]
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content, "utf-8")
        elif language == "sh":
            printed = ""
            for line in content.splitlines():
                command, *args = shlex.split(line)
                assert command == "mdlgen", f"{where}: {line}"
                done = CliRunner().invoke(app, args)
                wanted = int(more.removeprefix("exit=")) if more else 0
                assert done.exit_code == wanted, f"{where}: {line}\n{done.output}"
                printed += done.output
                count += 1
        elif language == "python":
            stream = io.StringIO()
            with contextlib.redirect_stdout(stream):
                exec(compile(content, where, "exec"), {})
            printed = stream.getvalue()
            count += 1
        elif language == "text":
            check_printed(content, printed, where)
    return count


PLAYED = [
    *sorted(p for p in (DOCS / "tutorials").glob("*.md") if p.stem != "index"),
    *(DOCS / "reference" / name for name in ("scene.md", "python.md")),
]


@pytest.mark.parametrize("page", PLAYED, ids=lambda p: p.stem)
def test_a_page_runs_as_printed(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert play(page, tmp_path) >= 1


def test_the_commands_of_the_readme_print_what_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The table of six commands: the first code of a row is a command, what it prints follows."""
    page = ROOT / "README.md"
    (scene,) = (content for language, _, content in blocks(page) if language == "yaml")
    monkeypatch.chdir(tmp_path)
    Path("one_nip.yaml").write_text(scene, "utf-8")
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", lambda url: opened.append(url) or True)
    rows = re.findall(r"^\| `mdlgen (.*?)` \| (.*) \|$", page.read_text("utf-8"), re.MULTILINE)
    assert len(rows) == 6
    for line, says in rows:
        done = CliRunner().invoke(app, shlex.split(line))
        assert done.exit_code == 0, f"{line}\n{done.output}"
        for inline in re.findall(r"`([^`]+)`", says):
            if inline.startswith("mdlgen "):
                assert CliRunner().invoke(app, shlex.split(inline)[1:]).exit_code == 0, inline
            else:
                check_printed(inline, done.output, line)
    pages = [tmp_path / "out" / "one_nip" / name for name in ("preview.html", "report.html")]
    assert opened == [page.as_uri() for page in pages]


# Commands in examples that need what a test has not at hand; each is run by another file of tests.
ELSEWHERE = {
    "bench": "test_bench.py, test_validation.py, test_campaign.py, test_tuning_bench.py",
    "cache": "test_packaging.py",
    "live": "tests/live",
    "run --resume": "test_keep.py",
    "calibrate samples/cantilever.yaml --measured decay.csv": "test_calibrate.py",
    "sweep scene.yaml": "test_sweep_cluster.py, with a scheduler",
}
EXAMPLES = [
    page
    for page in PAGES
    if re.search(r"^ {4,}mdlgen [^\n]*$", page.read_text("utf-8"), re.MULTILINE)
    and page.parent.name in ("how-to", "motionview", "reference")
]


@pytest.fixture(scope="module")
def worked_in(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with samples of few boxes and short runs, and the results that examples speak of. (With boxes
    of 5 x 6 the note rattles, and whether a search for its step ends is a matter of chance.)"""
    folder = tmp_path_factory.mktemp("examples")
    shutil.copytree(samples(), folder / "samples")
    for name in ("transport_4x4", "tilt_correction", "cantilever"):
        file = folder / "samples" / f"{name}.yaml"
        text = re.sub(r"boxes: \[\d+, \d+\]", "boxes: [6, 6]", file.read_text("utf-8"))
        file.write_text(re.sub(r"duration: \d+ ms", "duration: 4 ms", text), "utf-8")
    shutil.copy(folder / "samples" / "transport_4x4.yaml", folder / "scene.yaml")
    with contextlib.chdir(folder):
        for name, step in (("coarse", 0.2), ("fine", 0.1), ("coarse_step", 0.2), ("fine_step", 0.1)):
            run(f"run samples/transport_4x4.yaml --set run.step={step}ms -o out/{name}")
        whole = "--set run.tolerance=0.005 --set run.duration=50ms"
        run(f"run samples/transport_4x4.yaml {whole} -o out/transport_4x4")
    # what MotionSolve would have left
    found = plt(Result.load(folder / "out" / "transport_4x4"))
    (folder / "transport_4x4.plt").write_text(found, "ascii", newline="")
    return folder


@pytest.mark.parametrize("page", EXAMPLES, ids=lambda p: p.stem)
def test_examples_of_other_pages_run(
    page: Path, worked_in: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Indented commands, each page in a folder of its own."""
    shutil.copytree(worked_in, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda url: True)
    lines = re.findall(r"^ {4,}mdlgen ((?!.*OPTIONS\])[^\n]*)$", page.read_text("utf-8"), re.MULTILINE)
    for line in lines:
        if not line.startswith(tuple(ELSEWHERE)):
            run(line)


def run(line: str) -> None:
    done = CliRunner().invoke(app, shlex.split(line))
    assert done.exit_code == 0, f"mdlgen {line}\n{done.output}"


def test_what_is_printed_is_compared() -> None:
    check_printed("a 1.00 mm\n...\nc", "a 1.01  mm\nb\nc\n", "")
    check_printed("a 0.21 mm, ... N", "a 0.22 mm, 3 N", "")
    for expected in ("a 1.101 mm", "a 2 mm", "c\na 1 mm", "a 1 mm b"):
        with pytest.raises(AssertionError):
            check_printed(expected, "a 1 mm\nb\nc\n", "")


def test_generated_pages_are_those_of_the_code() -> None:
    stale = [name for name, text in pages.pages().items() if (DOCS / name).read_text("utf-8") != text]
    assert not stale, "run `python docs/_generate`"


def test_every_key_of_a_scene_is_described() -> None:
    found = keys.models()
    assert len(found) > 25
    bare = [
        f"{path}.{key}" for path, model in found for key, _, f in keys.fields(model) if not keys.describe(f)
    ]
    assert bare == []
    assert all(model.__doc__ for _, model in found)
    # no model of the schema is left out
    names = {model.__name__ for _, model in found}
    assert set(mdlgen_schema()["$defs"]) <= names


def mdlgen_schema() -> dict[str, Any]:
    from mdlgen.spec.schema import json_schema

    return json_schema()


def dotted(value: Any, path: str = "") -> Iterator[str]:
    if isinstance(value, dict) and path not in ("estimates", "estimate_scales"):
        for key, item in value.items():
            yield from dotted(item, f"{path}.{key}" if path else key)
    else:
        yield path


def test_every_number_of_a_run_is_described() -> None:
    described = [outputs.pattern(key) for key in outputs.SUMMARY]
    result = transport()
    record = result.summary()
    left = [key for key in dotted(record) if not any(p.fullmatch(key) for p in described)]
    assert [key for key in left if key not in ("estimates", "estimate_scales")] == []
    columns = [outputs.pattern(key) for key in outputs.SERIES]
    assert [name for name in series(result) if not any(p.fullmatch(name) for p in columns)] == []
    # and each of the plain ones is there
    plain = [key for key in outputs.SUMMARY if not re.search("[A-Z]{4,}|^strain$|^rules$", key)]
    assert [key for key in plain if key not in set(dotted(record))] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_and_pictures_of_a_page_are_there(page: Path) -> None:
    text = re.sub(r"^```.*?^```", "", page.read_text("utf-8"), flags=re.DOTALL | re.MULTILINE)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        path, _, anchor = target.partition("#")
        if "://" in target or target.startswith("mailto:"):
            continue
        place = (page.parent / path).resolve() if path else page
        assert place.exists(), f"{page.name}: {target}"
        if anchor and place.suffix == ".md":
            titles = re.findall(r"^#{1,4} (.*)$", place.read_text("utf-8"), re.MULTILINE)
            assert anchor in {slug(title) for title in titles}, f"{page.name}: {target}"


def slug(title: str) -> str:
    """The anchor that MyST and GitHub give to a title."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title).lower().replace("`", "")
    return re.sub(r"[^\w\- ]", "", text).strip().replace(" ", "-")


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_every_command_and_option_that_a_page_names_is_there(page: Path) -> None:
    import typer

    group: Any = typer.main.get_command(app)
    general = {o for p in group.params for o in p.opts}
    text = page.read_text("utf-8")
    lines = re.findall(r"`mdlgen ([a-z]+(?: [^`]*)?)`", text)
    lines += re.findall(r"^ {4,}mdlgen ([a-z]+ .*)$", text, re.MULTILINE)
    for line in lines:
        name, _, rest = line.partition(" ")
        assert name in group.commands, f"{page.name}: mdlgen {line}"
        known = {o for p in group.commands[name].params for o in (*p.opts, *p.secondary_opts)} | general
        words = shlex.split(rest.partition("&&")[0].rstrip("\\ "))
        for option in (word for word in words if re.fullmatch("--?[a-z][a-z-]*", word)):
            assert option in known, f"{page.name}: mdlgen {line}: {option}"


def test_every_sample_has_its_picture() -> None:
    for path in samples().rglob("*.yaml"):
        name = path.relative_to(samples()).with_suffix("").as_posix().replace("/", "_")
        assert (DOCS / "pictures" / "samples" / f"{name}.png").is_file(), name

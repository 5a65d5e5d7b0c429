"""The wheel carries templates and samples, and works from another folder; the README's examples run."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import mdlgen

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Folder with the unpacked wheel."""
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(folder), str(ROOT)], check=True
    )
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "site")
    return folder / "site"


def run_installed(installed, folder, *args):
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    return subprocess.run(
        [sys.executable, "-m", "mdlgen", *args],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_wheel_works_from_another_folder(installed, tmp_path):
    made = run_installed(installed, tmp_path, "new", "scene")
    assert made.returncode == 0, made.stderr
    text = run_installed(installed, tmp_path, "mdl", "scene/transport_4x4.yaml", "-o", "note.mdl")
    assert text.returncode == 0, text.stderr
    assert (tmp_path / "note.mdl").read_text() == mdlgen.emit(
        mdlgen.lower(mdlgen.load(ROOT / "samples" / "transport_4x4.yaml")), "motionview"
    )


def test_the_wheel_carries_what_the_page_is_made_of(installed):
    report = installed / "mdlgen" / "_templates" / "report"
    of = ("page.html.j2", "player.js", "third_party/three.module.min.js", "third_party/LICENSE")
    assert all((report / name).is_file() for name in of)
    assert (installed / "mdlgen" / "py.typed").is_file()


def test_the_readmes_first_scene_loads():
    blocks = re.findall(r"```yaml\n(.*?)```", (ROOT / "README.md").read_text("utf-8"), re.DOTALL)
    scene, sheets, guides, rims, parts = blocks
    model = mdlgen.lower(mdlgen.loads(scene))
    assert len(scene.splitlines()) == 10
    assert mdlgen.emit(model, "motionview")
    # a sheet with lengths, a zone and a shape of its own, in place of the plain one
    note = YAML(typ="safe").load(scene) | {"name": "own"}
    note["sheets"]["note"] |= YAML(typ="safe").load(sheets)["sheets"]["note"]
    own = mdlgen.lower(mdlgen.loads(json.dumps(note)))
    assert own.sheets[0].zones and own.sheets[0].bend is not None and all(own.sheets[0].graded)
    assert mdlgen.emit(own, "motionview")
    # guides in the same scene
    more = YAML(typ="safe").load(scene)
    told = YAML(typ="safe").load(guides)
    more |= {"guides": told["guides"], "contacts": more["contacts"] + told["contacts"]}
    assert len(mdlgen.lower(mdlgen.loads(json.dumps(more))).guides) == 2
    # a rim and an arm in the same scene
    turned, told = YAML(typ="safe").load(scene), YAML(typ="safe").load(rims)["rollers"]
    plain = {"axis": "y", "radius": "5 mm", "width": "5 mm", "mass": "1 g"}
    for name, part in told.items():
        turned["rollers"][name] = {"center": ["0 mm", "0 mm", "50 mm"], **plain, **part}
    made = mdlgen.lower(mdlgen.loads(json.dumps(turned)))
    assert made.roller("feed").rim is not None and made.roller("skim").arm is not None
    # the part of a machine of the user's own, in the same scene
    contact = "contacts: [{between: [note, feed], stiffness: 300 N/mm^1.5}, "
    imported = mdlgen.lower(mdlgen.loads(scene.replace("contacts: [", parts + contact)))
    assert [part.body for part in imported.externals] == ["MODEL.sys_feed.b_feed"]


def test_the_readmes_two_commands_are_one_line_each():
    blocks = re.findall(
        r"^```sh\n(.*?)^```", (ROOT / "README.md").read_text("utf-8"), re.DOTALL | re.MULTILINE
    )
    assert len(blocks) >= 2
    assert all(len(block.strip().splitlines()) == 1 for block in blocks[:2])

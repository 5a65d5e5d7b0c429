"""The wheel carries templates and samples, and works from another folder; examples of the manual load."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from places import ROOT
from ruamel.yaml import YAML

import mdlgen
from mdlgen.checks import lints
from mdlgen.spec.load import loads


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


def test_the_wheel_installs_one_package_and_leaves_nothing_behind(installed, tmp_path):
    """After it ran and was uninstalled, the environment is as it was before."""
    assert {path.name.split("-")[0] for path in installed.iterdir()} == {"mdlgen"}
    assert (installed / "mdlgen" / "backends" / "lattice" / "run.py").is_file()
    (wheel,) = installed.parent.glob("*.whl")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "venv"], check=True)
    python = next(p for p in (tmp_path / "venv").glob("*/python*") if p.stem == "python")
    (site,) = (tmp_path / "venv").glob("**/site-packages")
    # what it needs is taken from here, by a file that is there before and after
    here = [path for path in sys.path if path.endswith("site-packages")]
    (site / "needs.pth").write_text("\n".join(here))
    surroundings = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONPYCACHEPREFIX")}
    surroundings |= {"MDLGEN_CACHE": str(tmp_path / "cache"), "PYTHONDONTWRITEBYTECODE": ""}

    def call(*args: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*args], cwd=tmp_path, env=surroundings, capture_output=True, text=True, check=False
        )

    def pip(*args: str | Path) -> None:
        done = call(sys.executable, "-m", "pip", "--python", python, *args)
        assert done.returncode == 0, done.stderr

    before = sorted(site.rglob("*"))
    pip("install", "-q", "--no-deps", "--no-index", wheel)
    place = call(python, "-c", "import mdlgen.backends.lattice as l; print(l.__file__)")
    assert place.stdout.startswith(str(site)), place.stderr
    scene = site / "mdlgen" / "_samples" / "transport_4x4.yaml"
    ran = call(python, "-m", "mdlgen", "mdl", scene, "-o", "note.mdl")
    assert ran.returncode == 0 and (tmp_path / "note.mdl").is_file(), ran.stderr
    pip("uninstall", "-q", "-y", "mdlgen")
    assert sorted(site.rglob("*")) == before


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


def yaml_blocks(page: str) -> list[str]:
    return re.findall(r"```yaml\n(.*?)```", (ROOT / page).read_text("utf-8"), re.DOTALL)


def test_the_readmes_first_scene_has_no_lint():
    (scene,) = yaml_blocks("README.md")
    model = mdlgen.lower(mdlgen.loads(scene))
    assert lints(model) == []
    assert mdlgen.emit(model, "motionview")


def test_the_manuals_pieces_of_scenes_load():
    scene, *pieces = (YAML(typ="safe").load(block) for block in yaml_blocks("docs/reference/scene.md"))
    formulas, graded, zones, shape, rims, nips, piles, streams, guides, meshes, named, parts = pieces

    def lowered(**more):
        return mdlgen.lower(mdlgen.loads(json.dumps({**scene, **more})))

    # a sheet with lengths, a zone and a shape of its own, in place of the plain one
    note = {**scene["sheets"]["note"], "size": ["67 mm", "127 mm"], "boxes": [10, 20]}
    for piece in (graded, zones, shape):
        note |= piece["sheets"]["note"]
    own = lowered(sheets={"note": note})
    assert own.sheets[0].zones and own.sheets[0].bend is not None and all(own.sheets[0].graded)
    assert mdlgen.emit(own, "motionview")
    assert len(lowered(guides=guides["guides"], contacts=scene["contacts"] + guides["contacts"]).guides) == 2
    plain = {
        "center": ["0 mm", "0 mm", "50 mm"],
        "axis": "y",
        "radius": "5 mm",
        "width": "5 mm",
        "mass": "1 g",
    }
    turned = {name: {**plain, **part} for name, part in rims["rollers"].items()}
    made = lowered(rollers=scene["rollers"] | turned)
    assert made.roller("feed").rim is not None and made.roller("skim").arm is not None
    with_pile = {"sheets": piles["sheets"], "piles": piles["piles"]}
    floor = {
        "floor": {"center": ["0 mm", "0 mm", "-5 mm"], "normal": "z", "size": ["99 mm", "200 mm", "10 mm"]}
    }
    pile = lowered(**with_pile, planes=floor, rollers={}, contacts=piles["contacts"], probes={})
    assert {sheet.name for sheet in pile.sheets} == {f"cassette_{k}" for k in range(1, 21)}
    stream = lowered(
        sheets=streams["sheets"], streams=streams["streams"], contacts=streams["contacts"], probes={}
    )
    assert [sheet.enters for sheet in stream.sheets][:1] == [0.0] and len(stream.sheets) == 20
    # values that follow from parameters, and rollers and contacts that a nip makes
    motor = {**scene["rollers"]["motor"], **formulas["rollers"]["motor"], "radius": "radius"}
    driven = lowered(parameters=formulas["parameters"], rollers={**scene["rollers"], "motor": motor})
    assert driven.roller("motor").speed == pytest.approx(1.4 / 7.5)  # rad/ms
    wide = {**scene["sheets"]["note"], "size": ["67 mm", "127 mm"], "boxes": [10, 20]}
    gripped = mdlgen.loads(
        json.dumps({**scene, **nips, "sheets": {"note": wide}, "rollers": {}, "contacts": []})
    )
    assert {name for name in gripped.rollers if name.startswith("entry_")} == {
        f"entry_{side}_{end}" for side in ("left", "right") for end in ("lower", "upper")
    }
    # contacts by name, and what all of them have
    grips = mdlgen.loads(json.dumps({**scene, **named})).contacts
    assert {contact.friction.static for contact in grips} == {0.8}
    # meshes lie beside the samples; the mesh turns with a roller of the scene
    files = {**scene, "meshes": meshes["meshes"], "contacts": scene["contacts"] + meshes["contacts"]}
    assert len(mdlgen.lower(loads(json.dumps(files), "scene", (), ROOT / "samples")).meshes) == 2
    feed = {"between": ["note", "feed"], "stiffness": "300 N/mm^1.5", "friction": 0}
    imported = lowered(parts=parts["parts"], contacts=[*scene["contacts"], feed])
    assert [part.body for part in imported.externals] == ["MODEL.sys_feed.b_feed"]


def test_the_readme_is_one_screen():
    lines = (ROOT / "README.md").read_text("utf-8").splitlines()
    assert len(lines) <= 150
    assert [line for line in lines if len(line) > 120 and not line.startswith("|")] == []


def test_the_readmes_two_commands_are_one_line_each():
    blocks = re.findall(
        r"^```sh\n(.*?)^```", (ROOT / "README.md").read_text("utf-8"), re.DOTALL | re.MULTILINE
    )
    assert len(blocks) >= 2
    assert all(len(block.strip().splitlines()) == 1 for block in blocks[:2])

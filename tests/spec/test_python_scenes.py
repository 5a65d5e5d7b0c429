"""Scenes in Python: changed, written and read back; results by name."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.paths import samples
from mdlgen.spec.document import parse
from mdlgen.spec.load import load, loads
from mdlgen.spec.scene import Scene
from mdlgen.units import exact_quantity, parse_quantity

SAMPLES = sorted(samples().rglob("*.yaml"))
NIPS = samples() / "transport_nips.yaml"
RICH = Path(__file__).parents[1] / "helpers" / "rich.yaml"
# Formulas in all kinds of places, of words that others follow from, and at values that are defaults.
MORE = [
    "parameters.w=8 %",
    "parameters.heavy=84.61 g/m^2",
    "sheets.note.grammage=heavy*1.01",
    "gravity=[0 m/s^2, 0 m/s^2, -9.81 m/s^2 + w*(0 m/s^2)]",
    "run.duration=radius/speed*9.3",
    "contacts.rest.friction=3*w",
    "contacts.rest.restitution=0.5 + 0*w",
    "nips.nip_*_*.force=nip_force*1.1",
    "nips.nip_*_*.lower.drive={surface_speed: speed, direction: +x, ramp: 5 ms}",
    "nips.nip_*_*.lower.diameter=2*radius",
    "rollers.counter_1_left.mass=0.4 g*(1 + w)",
    "rollers.free={center: [0 mm, 20 mm, -radius - 1 mm], axis: [1, 2, 0], diameter: 2*radius/3, mass: 1 g}",
    "defaults.rollers.press={direction: -z, stiffness: 1 N/mm, preload: 1 N}",
    "rollers.free.press=null",
    "nips.nip_*_*.lower.press=null",
    "probes.p={sheet: note, at: [radius, 2 mm]}",
    # values in other units, and without a space
    "sheets.note.thickness=100um",
    "nips.nip_*_*.upper.mass=0.00039kg",
    "nips.nip_*_*.upper.press.stiffness=319 N/m",
]


def same(one: Scene, other: Scene, without: tuple[str, ...] = ()) -> None:
    for name in type(one).model_fields:
        if name not in without:
            assert getattr(one, name) == getattr(other, name), name


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda p: p.stem)
def test_a_scene_is_written_as_it_was_read(sample: Path) -> None:
    assert load(sample).to_yaml() == sample.read_text("utf-8")


@pytest.mark.parametrize("sample", [*SAMPLES, RICH], ids=lambda p: p.stem)
def test_what_is_dumped_is_the_same_scene(sample: Path) -> None:
    scene = load(sample)
    again = Scene.model_validate(scene.model_dump())
    same(scene, again, ("meshes",))
    assert (again.formulas, again.amounts) == (scene.formulas, scene.amounts)
    for name, mesh in scene.meshes.items():
        # it is named from its own folder, and found from anywhere
        assert again.meshes[name].model_copy(update={"file": mesh.file}) == mesh
        assert mesh.file.endswith(again.meshes[name].file)
    # to the last bit, through a text of a file, too
    same(again, mdlgen.loads(again.to_yaml(), folder=again.folder))


@pytest.mark.parametrize("how", [{}, {"mode": "json"}, {"exclude_defaults": True}, {"exclude_none": True}])
@pytest.mark.parametrize("more", [[], MORE], ids=["plain", "more"])
def test_a_dump_has_parameters_formulas_and_nips(more: list[str], how: dict[str, Any]) -> None:
    scene = load(NIPS, more)
    dumped = scene.model_dump(**how)
    assert dumped["parameters"]["speed"] == "1400.25 mm/s" and len(scene.formulas) > 40
    assert not any(name.startswith(("motor_", "counter_")) for name in dumped["rollers"] or {})
    again = Scene.model_validate(dumped)
    # defaults are in the parts; an entry that is left out would be filled in from them
    same(again, scene, ("defaults",) if {"exclude_defaults", "exclude_none"} & set(how) else ())
    assert (again.formulas, again.amounts) == (scene.formulas, scene.amounts)
    same(loads(again.to_yaml()), again)
    change = {"parameters.speed": "900 mm/s", "parameters.nip_force": "4 N", "nips.nip_1_left.at.2": "1 mm"}
    same(again.with_(change), scene.with_(change), ("defaults",))
    assert again.with_(change).rollers != again.rollers


def test_parts_of_a_dump() -> None:
    scene = load(NIPS)
    assert Scene.model_validate_json(scene.model_dump_json()) == scene
    assert sorted(scene.model_dump(include={"name", "rollers"})) == ["name", "rollers"]
    assert "run" not in scene.model_dump(exclude={"run"})
    # a part that is added to it is added to the scene
    dumped = scene.model_dump()
    dumped["rollers"]["free"] = mdlgen.Roller(
        center=["0 mm", "0 mm", "-20 mm"], axis="y", radius="5 mm", width="5 mm", mass="1 g"
    )
    assert set(Scene.model_validate(dumped).rollers) == {*scene.rollers, "free"}


def values(data: Any) -> Iterator[Any]:
    inner = data.values() if isinstance(data, dict) else data if isinstance(data, list) else None
    if inner is None:
        yield data
    for item in inner or ():
        yield from values(item)


def test_the_text_of_a_dump_has_no_nulls() -> None:
    scene = Scene.model_validate(load(samples() / "feeder.yaml").model_dump())
    text = scene.to_yaml()
    assert None not in set(values(parse(text, "s").data)) and loads(text) == scene
    assert "    center: [0 mm, 0 mm, -15.05 mm]\n" in text
    # but where one leaves out a default, or what a nip has
    left = load(NIPS, MORE)
    text = Scene.model_validate(left.model_dump()).to_yaml()
    assert loads(text) == left and left.rollers["free"].press is None


def test_shorthand_in_python() -> None:
    """Parameters, defaults, nips, rows and contacts by name do what they do in a file."""
    side = {"radius": "r", "mass": "1 g", "contact": {"stiffness": "300 N/mm^1.5"}}
    given: dict[str, Any] = {
        "name": "short",
        "parameters": {"r": "7 mm", "v": "600 mm/s"},
        "materials": {"p": mdlgen.Material(E_md="3.5 GPa", E_cd="1.1 GPa")},
        "sheets": {
            "note": mdlgen.Sheet(
                material="p", size=["60 mm", "40 mm"], thickness="0.1 mm", grammage="80 g/m^2", boxes=[6, 4]
            )
        },
        "defaults": {"rollers": {"width": "8 mm"}, "contacts": {"friction": 0.5}},
        "nips": {
            "entry": mdlgen.Nip(
                at=["0 mm", "0 mm", "0 mm"],
                force="3 N",
                lower={**side, "drive": {"speed": "v/r"}},
                upper=side,
            )
        },
        "rollers": {
            "free_*": mdlgen.Roller(
                center=["10 mm", "0 mm", "-9 mm"],
                axis="y",
                radius="5 mm",
                width="5 mm",
                mass="1 g",
                repeat=mdlgen.Repeat(count=2, step=["20 mm", "0 mm", "0 mm"]),
            )
        },
        "contacts": {
            "slide": mdlgen.Contact(between=["note", "free_*"], stiffness="100 N/mm^1.5", friction=0.1)
        },
    }
    scene = Scene(**given)
    assert set(scene.rollers) == {"entry_lower", "entry_upper", "free_1", "free_2"}
    assert [c.name for c in scene.contacts] == ["slide", "entry_lower", "entry_upper"]
    assert scene.rollers["entry_lower"].width == 8.0
    for made in (scene, loads(scene.to_yaml()), Scene.model_validate(scene.model_dump())):
        same(made, scene)
        drive = made.with_({"parameters.v": "900 mm/s"}).rollers["entry_lower"].drive
        assert drive is not None and drive.speed == pytest.approx(0.9 / 7.0, rel=1e-15)
    rough = scene.with_({"defaults.contacts.friction": 0.7, "rollers.free_2.mass": "2 g"})
    assert [c.friction.static for c in rough.contacts] == [0.1, 0.7, 0.7]
    assert [rough.rollers[f"free_{k}"].mass for k in (1, 2)] == [1.0, 2.0]


def test_a_text_names_files_from_the_folder_that_it_is_written_into(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    for name in ("lobe.obj", "ramp.stl"):
        (tmp_path / "parts" / name).write_bytes((samples() / "meshes" / name).read_bytes())
    (tmp_path / "paper.csv").write_text("0, 0 MPa\n0.01, 30 MPa\n")
    text = (samples() / "pick.yaml").read_text("utf-8").replace("meshes/", "parts/")
    given = mdlgen.loads(text, ['materials.paper.curve_md={"file": "paper.csv"}'], folder=tmp_path)
    assert given.folder == tmp_path and "paper.csv" in given.to_yaml() and "# " in given.to_yaml()
    # a scene of Python names its files from the nearest folder that has them all
    made = Scene.model_validate(given.model_dump()).with_({"run.duration": "5 ms"})
    assert made.folder == tmp_path / "parts"
    for scene in (given, made):
        for folder in (scene.folder, tmp_path, tmp_path.parent):
            again = mdlgen.loads(scene.to_yaml(folder), folder=folder)
            same(again, scene, ("meshes", "materials"))
            curves = [one.materials["paper"].curve_md for one in (again, scene)]
            assert curves[0] is not None and curves[1] is not None and curves[0].points == curves[1].points
            assert mdlgen.lower(again).meshes[0].volume == mdlgen.lower(scene).meshes[0].volume
    with pytest.raises(SpecError, match=r"lobe\.obj is not in .* or below"):
        made.to_yaml(tmp_path / "elsewhere")
    assert mdlgen.Scene.model_validate(load(NIPS).model_dump()).folder is None


def test_files_are_found_from_where_a_scene_is_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "paper.csv").write_text("0, 0 MPa\n0.01, 30 MPa\n")
    given = load(samples() / "pick.yaml")
    monkeypatch.chdir(tmp_path)
    scene = Scene.model_validate(given.model_dump())
    curve: Any = mdlgen.Curve
    paper: Any = mdlgen.Material
    scene = scene.with_({"rollers.pick.drive.speed": "50 rad/s"}).with_({"run.duration": "5 ms"})
    drive = scene.rollers["pick"].drive
    assert drive is not None and drive.speed == 0.05 and mdlgen.lower(scene).meshes[0].file == "lobe.obj"
    made = paper(curve_md=curve(file="paper.csv"), curve_cd={"file": str(tmp_path / "paper.csv")})
    again = type(made).model_validate(made.model_dump())
    assert again.curve_md.points == made.curve_cd.points == ((0.0, 0.0), (0.01, 30.0))
    # a text of a stranger still names files of its own folder only
    with pytest.raises(SpecError, match="is not a file in the folder of the spec or below"):
        loads(scene.to_yaml().replace("lobe.obj", str(tmp_path / "lobe.obj")), folder=tmp_path)


@pytest.mark.parametrize("unit", ["mm", "rad/s", "m/s^2", "deg", "N*mm/rad", "g", "ms", "um"])
def test_a_value_is_written_so_that_it_reads_back(unit: str) -> None:
    rng = np.random.default_rng(3)
    values = [parse_quantity(f"{v!r} {unit}", unit) for v in rng.lognormal(0.0, 5.0, 2000).tolist()]
    back = [parse_quantity(exact_quantity(v, unit), unit) for v in values]
    assert back == values
    assert exact_quantity(parse_quantity(f"186.7 {unit}", unit), unit) == f"186.7 {unit}"


def test_values_are_changed_and_what_follows_follows() -> None:
    scene = load(NIPS)
    faster = scene.with_({"parameters.speed": "900 mm/s", "sheets.note.boxes": [4, 6]}, name="faster")
    drive = faster.rollers["motor_1_left"].drive
    assert drive is not None and drive.speed == pytest.approx(0.12, rel=1e-15)
    assert faster.sheets["note"].boxes == (4, 6) and faster.name == "faster"
    assert scene.sheets["note"].boxes == (10, 20) and scene.name == "transport_nips"
    same(loads(faster.to_yaml()), faster)
    text, before = faster.to_yaml(), NIPS.read_text("utf-8")
    assert "# row 1 is 20 mm behind the leading edge" in text and "speed: speed/radius" in text
    # comments, too, stand where they stood
    assert text.count("#") == before.count("#")
    many = scene.with_({"nips.*.force": "4 N"})
    assert {nip.force for nip in many.nips.values()} == {4.0}
    with pytest.raises(SpecError, match="did you mean 'note'"):
        scene.with_({"sheets.nte.boxes": [1, 1]})
    with pytest.raises(SpecError, match="wrong unit"):
        scene.with_({"sheets.note.mass": "3 mm"})


def test_a_scene_made_of_parts() -> None:
    # texts with units where the types say what they become
    material: Any = mdlgen.Material
    sheet: Any = mdlgen.Sheet
    roller: Any = mdlgen.Roller
    contact: Any = mdlgen.Contact
    low = ["0 mm", "0 mm", "-7.5 mm"]
    scene = Scene(
        name="made",
        materials={"p": material(E_md="3.5 GPa", E_cd="1.1 GPa")},
        sheets={
            "note": sheet(
                material="p", size=["60 mm", "40 mm"], thickness="0.1 mm", grammage="80 g/m^2", boxes=[6, 4]
            )
        },
        rollers={"motor": roller(center=low, axis="y", diameter="15 mm", width="8 mm", mass="1 g")},
        contacts=(contact(between=["note", "motor"], stiffness="300 N/mm^1.5", friction=0.5),),
    )
    plain = roller(center=low, axis="y", diameter="15 mm", width="8 mm", mass="1 g")
    assert (plain.radius, plain.diameter) == (7.5, None)  # by itself, too
    assert scene.rollers["motor"].radius == 7.5 and scene.sheets["note"].mass == pytest.approx(0.192)
    same(loads(scene.to_yaml()), scene)
    turning = scene.with_({"rollers.motor.drive.speed": "60 rad/s"})
    drive = turning.rollers["motor"].drive
    assert drive is not None and drive.speed == 0.06
    assert len(mdlgen.lower(turning).rollers) == 1


def test_an_override_is_no_text() -> None:
    with pytest.raises(SpecError, match="overrides are a list of texts"):
        mdlgen.load(NIPS, "run.duration=3 ms")


def test_results_by_name() -> None:
    scene = load(samples() / "transport_4x4.yaml").with_(
        {"sheets.note.boxes": [4, 6], "run.duration": "2 ms", "run.tolerance": 0.05}
    )
    result = mdlgen.solve(mdlgen.lower(scene))
    assert result.ok
    record = result.summary()
    note, motor, lead = result.sheets["note"], result.rollers["motor_1_left"], result.probes["lead"]
    np.testing.assert_allclose(note.travel, record["sheets"]["note"]["travel_mm"])
    np.testing.assert_allclose(note.speed, record["sheets"]["note"]["speed_mm_per_s"])
    assert note.yaw == pytest.approx(record["sheets"]["note"]["yaw_deg"])
    assert motor.speed == pytest.approx(record["rollers"]["motor_1_left"]["omega_rad_per_s"])
    assert motor.nip_force == pytest.approx(record["rollers"]["motor_1_left"]["nip_force_n"])
    np.testing.assert_allclose(lead.displacement, record["probes"]["lead"]["displacement_mm"], atol=1e-12)
    assert note.position.shape == (len(result.time), 3) and motor.force.shape == result.time.shape
    assert " mm/s, yaw " in repr(note) and " rad/s, center [" in repr(motor)
    with pytest.raises(KeyError):
        result.sheets["nte"]
    pandas = pytest.importorskip("pandas")
    table = result.to_pandas()
    assert isinstance(table, pandas.DataFrame) and table.index.name == "time_ms"
    np.testing.assert_array_equal(table["note.x_mm"], note.position[:, 0])

"""A scene as it begins: what is known of its parts, arrows of the right size and sense, page and still."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.report.arrows import Arrow, arrows
from mdlgen.report.begin import depths, known, met, of_no_part
from mdlgen.report.figures.start import still
from mdlgen.report.html.preview import preview
from mdlgen.spec.load import load

RICH = Path(__file__).parents[1] / "helpers" / "rich.yaml"
ZONE = "sheets.note.zones.worn={x: [-33.5 mm, 0 mm], y: [0 mm, 63.5 mm], stiffness: 0.3, thickness: 0.12 mm}"


def model(sample: str, *sets: str) -> Model:
    return lower(load(samples() / f"{sample}.yaml", sets))


def arrow(scene: Model, part: str, kind: str) -> Arrow:
    (found,) = [a for a in arrows(scene) if (a.part, a.kind) == (part, kind)]
    return found


def data(page: str) -> dict[str, Any]:
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def test_how_deep_parts_are() -> None:
    rows = {(row.one, row.other): row for row in met(model("transport_4x4"))}
    # by hand: 7.5 mm + 0.05 mm - 7.5016 mm, and the rollers with the note between them
    assert rows["note", "motor_1_left"].deep == pytest.approx(0.0484, abs=1e-12)
    assert rows["note", "motor_1_left"].says == "0.0484 mm deep" and rows["note", "motor_1_left"].pairs == 40
    gap = rows["motor_1_left", "counter_1_left"].deep
    upper = rows["note", "counter_1_left"].deep
    assert gap is not None and upper is not None
    assert gap == pytest.approx(-(0.1 - 0.0484 - upper), abs=1e-9) and rows["note", "support"].says == "apart"
    # k z^1.5 + k_s z = f + W on the motor roller, where no note is between (rollers of row 2)
    deep = rows["motor_2_left", "counter_2_left"].deep
    assert deep is not None
    # the carrier has a thousandth of the roller's mass
    assert 30.5 * deep**1.5 == pytest.approx(3.19 - 0.319 * deep + 1.001 * 0.39 * 9.81e-3, rel=1e-3)


def test_how_deep_sheets_and_plates_are() -> None:
    rows = {(row.one, row.other): row.deep for row in met(model("spring_plate"))}
    assert rows["note_1", "note_2"] == pytest.approx(0.002, abs=1e-9)
    assert (rows["note_3", "plate"] or 0.0) > 0.002
    assert rows["feed", "plate"] == 0.0 and rows["note_1", "note_3"] == 0.0
    # of meshes the depth is not computed, and of rims it depends on how they stand
    assert {row.says for row in met(model("pick")) if row.other != "plate"} == {"depth not computed"}
    (rim,) = [row for row in met(model("feeder")) if (row.one, row.other) == ("feed", "reject")]
    assert rim.deep is None


def test_a_body_of_the_users_own_model_is_named_without_a_depth() -> None:
    scene = model(
        "transport_4x4",
        "parts.feed={external: true, body: b_feed, graphics: [gra_feed]}",
        "contacts.6.between=[note, feed]",
    )
    (row,) = [row for row in met(scene) if row.other == "feed"]
    assert (row.deep, row.says, row.pairs) == (None, "depth not computed", 200)
    assert "<td>feed</td>" in preview(scene) and still(scene).startswith(b"\x89PNG")


def test_how_deep_boxes_are() -> None:
    deep = depths(model("transport_4x4"))
    assert deep.shape == (200,) and deep.max() == pytest.approx(0.0484, abs=1e-4)
    # both rollers of row 1 stand on two rows of boxes and over the line between two columns
    assert (deep > 0.0).sum() == 8
    assert not depths(model("cantilever")).any()


def test_what_is_known_of_parts() -> None:
    parts = {part.name: part for part in known(model("transport_4x4", ZONE))}
    assert parts["note"].kind == "sheet" and "zone worn: 50 boxes" in parts["note"].facts
    motor = "driven at 186.7 rad/s, surface 1400 mm/s, ramp 5 ms"
    assert motor in parts["motor_1_left"].facts and parts["motor_1_left"].at == (13.5, -20.5, -7.5016)
    assert any("pressed along -z by 3.19 N" in fact for fact in parts["counter_1_left"].facts)
    assert parts["grip"].kind == "probe" and parts["grip"].at == pytest.approx((13.5, 20.5, 0.0), abs=1e-12)
    # the name of a plate stands where the other parts are
    assert parts["support"].at == pytest.approx((-30.15, -60.325, -0.3016), abs=1e-9)
    assert {part.kind for part in known(model("channel"))} >= {"guide"}
    assert "turns with pick" in {p.name: p for p in known(model("pick"))}["lobe"].facts


def test_lints_are_at_their_parts() -> None:
    scene = lower(load(RICH))
    found = {part.name: [lint.code for lint in part.lints] for part in known(scene) if part.lints}
    assert found == {"high": ["W104"], "low": ["W113"], "side": ["W111"]} and of_no_part(scene) == []
    # that of a contact is at both of its parts, that of a material at none
    soft = model("transport_4x4", "contacts.6.stiffness=0.00001 N/mm^1.5")
    assert {p.name for p in known(soft) if "W133" in [lint.code for lint in p.lints]} == {"note", "support"}
    thick = model("transport_4x4", "materials.eur10.E_md=10 kPa")
    (code,) = {lint.code for lint in of_no_part(thick)}
    assert code not in {lint.code for part in known(thick) for lint in part.lints}


def test_arrows_point_where_surfaces_go() -> None:
    scene = model("transport_4x4")
    drive = arrow(scene, "motor_1_left", "drive")
    # from where the roller faces the note, along its way
    assert drive.at == pytest.approx([13.5, -20.5 - 2.5 - 0.16 * drive.way[0], -0.0016], abs=1e-9)
    np.testing.assert_allclose(drive.way / np.linalg.norm(drive.way), [1.0, 0.0, 0.0], atol=1e-12)
    assert drive.says == "its surface moves at 1400 mm/s"
    back = model("transport_4x4", "rollers.motor_1_left.drive.speed=-93.35 rad/s")
    turned = arrow(back, "motor_1_left", "drive")
    # half as fast, half as long
    np.testing.assert_allclose(turned.way, -0.5 * drive.way, rtol=1e-9, atol=1e-12)
    press = arrow(scene, "counter_1_left", "press")
    np.testing.assert_allclose(press.at + press.way, [13.5, -20.5, 10.0 + 0.0016 - 6e-6], atol=1e-5)
    np.testing.assert_allclose(press.way / np.linalg.norm(press.way), [0.0, 0.0, -1.0])
    assert press.says == "pressed by a spring with 3.19 N, 0.319 N/mm"
    # a roller that carries a mesh faces what the mesh meets
    assert arrow(model("pick"), "pick", "drive").way[0] > 0.0


def test_arrows_of_plates_speeds_and_loads() -> None:
    plate = arrow(model("spring_plate"), "plate", "press")
    assert plate.way[2] > 0.0 and (plate.at + plate.way)[2] < -2.0  # up, below the plate of 2 mm
    motion = arrow(lower(load(RICH)), "one", "motion")
    assert motion.says == "begins with 1122 mm/s"
    load_ = arrow(model("verify/tension"), "strip", "load")
    np.testing.assert_allclose(load_.way / np.linalg.norm(load_.way), [1.0, 0.0, 0.0], atol=1e-12)
    assert arrows(model("cantilever")) == []


def test_an_arrow_is_closed_and_has_its_length() -> None:
    solid = Arrow("a", "press", np.array([1.0, 2.0, 3.0]), np.array([0.0, 3.0, 4.0]), "").solid(0.5)
    way = np.array([0.0, 0.6, 0.8])
    along = (solid.points - [1.0, 2.0, 3.0]) @ way
    assert (along.min(), along.max()) == pytest.approx((0.0, 5.0), abs=1e-12)
    across = np.linalg.norm(solid.points - [1.0, 2.0, 3.0] - along[:, None] * way, axis=1)
    assert across.max() == pytest.approx(0.25, rel=1e-12)
    # seen from outside counterclockwise: the volume of the shaft and of the cone, as polygons of 48 sides
    a, b, c = (solid.points[solid.triangles[:, k]] - [1.0, 2.0, 3.0] for k in range(3))
    volume = float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) / 6
    circle = 24 * np.sin(2 * np.pi / 48)
    assert volume == pytest.approx(circle * (0.1**2 * (5.0 - 0.75) + 0.25**2 * 0.75 / 3), rel=1e-9)


def test_the_page_has_all_of_it() -> None:
    scene = model("transport_4x4", ZONE)
    page = preview(scene, "name: <b>\n")
    assert page == preview(model("transport_4x4", ZONE), "name: <b>\n")
    drawn = data(page)
    assert [part["name"] for part in drawn["parts"]] == [part.name for part in known(scene)]
    note = drawn["parts"][0]
    assert "motor_1_left: 0.0484 mm deep" in note["contacts"] and len(drawn["sheets"][0]["zones"][0][1]) == 50
    assert [c["name"] for c in drawn["animation"]["colours"]] == ["sheet", "depth", "thickness"]
    assert [key for key, _ in drawn["keys"]["sheet"]] == ["note", "note: worn"]
    assert {m["kind"] for m in drawn["animation"]["meshes"]} == {"roller", "mark", "plane", "drive", "press"}
    assert "not run" in page and "no warnings" in page and "&lt;b&gt;" in page and "<b>\n" not in page
    assert "3 warnings" in preview(lower(load(RICH)))


def test_every_sample_has_a_page() -> None:
    for sample in sorted(samples().rglob("*.yaml")):
        scene = lower(load(sample))
        assert len(data(preview(scene))["parts"]) == len(known(scene)) > 0, sample


@pytest.mark.parametrize("sample", ["transport_4x4", "channel", "verify/drop", "cantilever"])
def test_a_still_is_drawn(sample: str) -> None:
    scene = model(sample)
    picture = still(scene)
    assert picture == still(scene)
    pixels = np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")).astype(int)
    assert pixels.shape == (768, 960, 3)
    tones = {tuple(p) for p in pixels.reshape(-1, 3)}
    assert (np.abs(pixels - 255).max(axis=2) > 30).mean() > 0.02
    # axes x and z in their colours, in both views
    for tone in ((213, 94, 0), (0, 114, 178)):
        assert min(max(abs(a - b) for a, b in zip(tone, t, strict=True)) for t in tones) < 25


def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", lambda url: opened.append(url) or True)
    spec = str(samples() / "transport_4x4.yaml")
    run = CliRunner().invoke
    done = run(app, ["preview", spec, "--set", "sheets.note.boxes=[4,6]", "--no-browser"])
    assert done.exit_code == 0 and done.stdout == "out/transport_4x4/preview.html\n" and opened == []
    page = Path("out/transport_4x4/preview.html").read_text("utf-8")
    assert "24 boxes" in page and "# --set sheets.note.boxes=[4,6]" in page
    assert run(app, ["preview", spec]).exit_code == 0
    assert opened == [Path("out/transport_4x4/preview.html").resolve().as_uri()]
    for name, start in (("start.png", b"\x89PNG"), ("start.html", b"<!DOCTYPE")):
        assert run(app, ["preview", spec, "-o", name]).exit_code == 0
        assert Path(name).read_bytes().startswith(start)
    assert len(opened) == 1
    done = run(app, ["preview", spec, "-o", "start.gif"])
    assert done.exit_code == 2 and "there are: .png, .html" in done.stderr
    assert not Path("start.gif").exists()

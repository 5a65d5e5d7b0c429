"""Nips, rows and mirror images: what is said once is the same scene, and begins in balance."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from arrays import arrays
from one_nip import ONE, SHEET

from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load, loads
from mdlgen.spec.scene import Scene
from mdlgen.spec.schema import json_schema
from mdlgen.spec.shorthand import OF_NIPS
from mdlgen.verify.verification import verify

FILE = samples() / "transport_nips.yaml"
NIPS = FILE.read_text("utf-8")
FOUR = samples() / "transport_4x4.yaml"
LEANING = "nips.entry.normal=[0.5,0,0.8660254037844386]"


def plain(model: Model) -> dict[str, np.ndarray]:
    """Numbers of a Model without what only one of two ways to say it has: which entry of the scene a pair of
    parts is of, and from where on its slide a roller's place is counted."""
    rows, pairs = model.contacts, model.pairs
    order = sorted(range(len(rows)), key=lambda k: (rows.part_a[k], rows.part_b[k]))
    contacts = {
        f.name: np.array(getattr(rows, f.name))[order]
        for f in dataclasses.fields(rows)
        if f.name not in ("entry", "part_a", "part_b", "share", "name", "frictions")
    }
    kept = sorted(
        (int(a), int(b), rows.part_a[c], rows.part_b[c])
        for a, b, c in zip(pairs.a, pairs.b, pairs.contact, strict=True)
    )
    rollers = []
    for r in model.rollers:
        if r.press is not None:
            way = r.press.direction
            press = dataclasses.replace(r.press, touch=0.0, start=0.0)
            ends = {f"{r.name}.{n}": r.center + getattr(r.press, n) * way for n in ("touch", "start")}
            contacts |= ends
            r = dataclasses.replace(r, press=press, center=np.zeros(3))
        rollers.append(r)
    rest = dataclasses.replace(model.with_parts(rollers), parameters=(), unfollowed=())
    found = {k: v for k, v in arrays(rest).items() if not k.startswith((".contacts", ".pairs"))}
    return (
        found | contacts | {"pairs": np.array([p[:2] for p in kept])} | arrays(model.pairs.margin, "margin")
    )


def away(one: Model, other: Model) -> dict[str, float]:
    a, b = plain(one), plain(other)
    assert a.keys() == b.keys()
    return {key: float(np.abs(a[key] - b[key]).max(initial=0.0)) for key in a}


def test_the_sample_is_transport_4x4_in_at_most_45_lines() -> None:
    assert NIPS.count("\n") <= 45
    nips = load(FILE)
    typed = away(lower(nips), lower(load(FOUR)))
    # heights are typed to four digits there, and follow from the force here
    assert max(typed.values()) < 1e-5
    low = nips.rollers["motor_1_left"].center[2]
    press = nips.rollers["counter_1_left"].press
    assert press is not None
    sets = [f"rollers.motor_*.center.2={low!r} mm", f"rollers.counter_*.press.preload={press.preload!r} N"]
    same = away(lower(nips), lower(load(FOUR, [*sets, "name=transport_nips"])))
    # places are of 100 mm: their last bits
    assert max(same.values()) < 1e-13


def test_one_part_of_a_row_is_set_alone() -> None:
    """Also in a mapping within it, which the entry of the row has once."""
    scene = load(
        FILE, ["nips.nip_2_left.lower.drive.ramp=1 ms", "nips.nip_1_right.upper.press.stiffness=2 N/mm"]
    )
    ramps = {name: r.drive.ramp for name, r in scene.rollers.items() if r.drive is not None}
    assert ramps == {"motor_1_left": 5.0, "motor_1_right": 5.0, "motor_2_left": 1.0, "motor_2_right": 5.0}
    stiff = [name for name, r in scene.rollers.items() if r.press is not None and r.press.stiffness == 2.0]
    assert stiff == ["counter_1_right"]


def test_a_preload_beside_a_force_is_answered() -> None:
    """It follows from the force, and would be passed over."""
    for path in ("nips.nip_1_left.upper.press.preload", "rollers.counter_1_left.press.preload"):
        with pytest.raises(SpecError) as error:
            load(FILE, [f"{path}=1 N"])
        assert "the preload of counter_1_left follows from the force of nip" in error.value.message
        assert "give that, as force: 3.194847641 N" in error.value.message and error.value.others == ()
    # of defaults, it is that of other rollers
    spring = "{press: {direction: -z, stiffness: 2 N/mm, preload: 1 N}}"
    scene = loads(ONE + f"defaults: {{rollers: {spring}}}\n", "s", ["nips.entry.lower.press=null"])
    press = scene.rollers["entry_upper"].press
    assert press is not None and press.stiffness == 0.3 and 2.9 < press.preload < 3.0


def test_a_nip_of_no_sheet_is_of_the_only_one() -> None:
    scene = loads(ONE, "s", ["nips.entry.sheet=null"])
    assert scene.rollers == loads(ONE).rollers and len(scene.contacts) == 3


def test_it_runs_as_transport_4x4_does_with_names_of_its_own() -> None:
    nips, four = load(FILE), load(FOUR)
    assert set(nips.rollers) == set(four.rollers)
    made = {frozenset(pair[1:]): nips.contacts[pair[0]] for pair in nips.contact_pairs()}
    for index, a, b in four.contact_pairs():
        own = made.pop(frozenset((a, b)))
        between = {"between": four.contacts[index].between, "name": None}
        assert own.model_copy(update=between) == four.contacts[index]
    assert not made


def test_the_text_has_force_and_speed_as_values_that_move_what_follows() -> None:
    few = "sheets.note.boxes=[5,6]"
    scene = load(FILE, [few])
    model = lower(scene)
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []
    assert found.perturbed is not None and found.perturbed.largest < 1e-12
    text = emitter("motionview").emit(model)
    assert "*SetReal( ds_parameters.real_nip_force, 3.194847641 )" in text
    pressed = text.replace("real_nip_force, 3.194847641", "real_nip_force, 4.0").replace("1400.25", "2800.5")
    values = emitter("motionview").read(pressed).values["datasets"]
    depth = (4.0 / 300.0) ** (2 / 3)
    for row in ("1_left", "1_right", "2_left", "2_right"):
        assert values[f"ds_motor_{row}"]["real_z"] == pytest.approx(-7.55 + depth, rel=1e-14)
        assert values[f"ds_motor_{row}"]["real_omega"] == pytest.approx(373.4, rel=1e-14)
        assert values[f"ds_counter_{row}"]["real_z"] == pytest.approx(5.05 - depth, rel=1e-14)
        # at 4 N the two rollers meet through the note
        gained = 0.319 * (0.1 - 2 * depth) - 30.5 * (2 * depth - 0.1) ** 1.5 + 1.001 * 0.39e-3 * 9.81
        assert values[f"ds_counter_{row}"]["real_f"] == pytest.approx(4.0 - gained, rel=1e-13)
    # rollers begin where they balance, with the note between them and without: as of a scene of that force
    heavier = lower(load(FILE, [few, "parameters.nip_force=4 N", "parameters.speed=2800.5 mm/s"]))
    for roller in heavier.rollers:
        if roller.press is not None:
            begins = values[f"ds_{roller.name}"]
            assert begins["real_touch"] == pytest.approx(roller.press.touch, abs=1e-14)
            assert begins["real_start"] == pytest.approx(roller.press.start, abs=1e-14)
            before = model.roller(roller.name).press
            assert before is not None and abs(roller.press.touch - before.touch) > 1e-3
    point = emitter("motionview").read(pressed).values["points"]["p_counter_2_left"]
    assert point[2] == pytest.approx(
        heavier.bodies.position[heavier.roller("counter_2_left").body, 2], abs=1e-13
    )


FORCE, TWO = "parameters: {force: 1 N}\n", "nips.entry.force=force"
STIFF = "nips.entry.upper.press.stiffness=3 N/mm"


@pytest.mark.parametrize(
    ("sets", "follows"),
    [
        # a nip places its rollers in balance whatever its force is
        ((), {"touch"}),
        (("nips.entry.normal=-z",), {"touch"}),
        # the two meet through a sheet of 10 um
        (("sheets.note.thickness=10 um",), {"touch"}),
        (("nips.entry.contact=null",), set()),
        # a roller that is pressed elsewhere, by the other one or by the sheet
        (("sheets.note.center=[0 mm, 90 mm, 0 mm]",), {"touch", "push", "root", "start"}),
        (("rollers.entry_upper.center=[0 mm, 0 mm, 5.3 mm]",), {"touch", "push", "root", "start"}),
        (("rollers.entry_upper.center=[0 mm, 0 mm, 5.05 mm]", STIFF), {"touch", "push", "root", "start"}),
        # by both
        (("rollers.entry_upper.center=[0 mm, 0 mm, 5.3 mm]", "sheets.note.thickness=10 um"), set()),
    ],
)
def test_a_start_follows_where_one_contact_holds_the_roller(sets: tuple[str, ...], follows: set[str]) -> None:
    scene = loads(ONE + FORCE, "s", [TWO, *sets])
    model = lower(scene)
    assert {p.member for p in model.parameters if p.follows} == follows
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []
    # where nothing is a formula it is a number, as it is written
    assert not any(p.follows for p in lower(load(FOUR)).parameters)


@pytest.mark.parametrize(
    ("more", "sets"),
    [
        ("", ()),
        ("gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]\n", ()),
        ("", ("nips.entry.force=0.4 N", "sheets.note.thickness=0.3 mm")),
        ("", ("nips.entry.contact=null",)),
        ("", ("nips.entry.upper.press.carrier_mass=20 g",)),
        ("", ("nips.entry.normal=-z",)),
        # a sheet that stands on its edge, and one that leans
        ("", ('sheets.note.rotation=["0 deg","90 deg","0 deg"]', "nips.entry.normal=x")),
        ("", ('sheets.note.rotation=["0 deg","30 deg","0 deg"]', LEANING)),
        ("", ("nips.entry.at=[3 mm, 2 mm, 5 mm]", "sheets.note.center=[0 mm, 0 mm, 5 mm]")),
        ("parameters: {f: 1 N}\n", ("nips.entry.force=3*f + 0.5 N", "nips.entry.upper.radius=2 mm*f/1 N")),
        ("defaults: {contacts: {restitution: 0.3}}\n", ("nips.entry.force=1.5 N",)),
    ],
)  # fmt: skip
def test_a_nip_begins_in_balance_with_its_force_on_both_sides(more: str, sets: tuple[str, ...]) -> None:
    scene = loads(ONE + more, "s", sets)
    model = lower(scene)
    force, sheet = scene.nips["entry"].force, scene.sheets["note"]
    upper, lower_ = model.roller("entry_upper"), model.roller("entry_lower")
    assert upper.press is not None
    # its spring, its weight and the sheet hold it where the nip has put it: the last bits of a place
    assert abs(upper.press.start) < 1e-13
    normal = np.array(scene.nips["entry"].normal)
    at = np.array(scene.nips["entry"].at)
    for roller, side, k in ((upper, 1.0, 200.0), (lower_, -1.0, 300.0)):
        depth = roller.radius + sheet.thickness / 2 - side * (roller.center - at) @ normal
        assert k * depth**1.5 == pytest.approx(force, rel=1e-9)  # of a depth of 0.01 mm
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []


def test_rollers_with_fixed_axes_press_by_their_place() -> None:
    scene = loads(ONE, "s", ["nips.entry.upper.press=null"])
    assert scene.rollers["entry_upper"].press is None
    assert scene.rollers["entry_upper"].center[2] == pytest.approx(5.05 - (3 / 200) ** (2 / 3), rel=1e-15)


def test_what_stands_under_rollers_counts() -> None:
    scene = loads(ONE, "s", ["rollers.entry_upper.mass=9 g", "rollers.entry_lower.drive.speed=7 rad/s"])
    assert scene.rollers["entry_upper"].mass == 9.0
    upper = lower(scene).roller("entry_upper")
    assert upper.press is not None and abs(upper.press.start) < 1e-13
    drive = scene.rollers["entry_lower"].drive
    assert drive is not None and drive.speed == 0.007


def test_a_pattern_meets_the_rollers_of_nips() -> None:
    scene = load(FILE, ["rollers.motor_*.radius=8 mm", "rollers.counter_?_left.width=4 mm"])
    assert {roller.radius for name, roller in scene.rollers.items() if "motor" in name} == {8.0}
    widths = {name: roller.width for name, roller in scene.rollers.items() if "counter" in name}
    assert widths == {name: 4.0 if name.endswith("left") else 5.0 for name in widths} and len(widths) == 4
    with pytest.raises(SpecError, match="nothing here fits 'moter_\\*'; there are: motor_1_left"):
        load(FILE, ["rollers.moter_*.radius=8 mm"])


def test_what_stands_under_contacts_counts() -> None:
    """By the names that check and lints have for them, and patterns."""
    sets = ["contacts.entry_lower.stiffness=100 N/mm^1.5", "contacts.entry.restitution=0.2"]
    scene = loads(ONE, "s", [*sets, "contacts.entry_*.friction={static: 0.3, dynamic: 0.2}"])
    assert [(c.name, c.stiffness, c.friction.dynamic, c.restitution) for c in scene.contacts] == [
        ("entry", 30.0, 1.0, 0.2),
        ("entry_lower", 100.0, 0.2, 0.5),
        ("entry_upper", 200.0, 0.2, 0.5),
    ]
    # the roller stands deeper in the sheet on a softer contact
    depth = (3.0 / 100.0) ** (2 / 3)
    assert scene.rollers["entry_lower"].center[2] == pytest.approx(-7.55 + depth, rel=1e-14)
    assert loads(scene.to_yaml()) == scene and Scene.model_validate(scene.model_dump()) == scene
    own = "contacts: {rub: {between: [note, entry_other], stiffness: 9 N/mm^1.5, friction: 0}}\n"
    place = "center: [0 mm, 0 mm, 9 mm], axis: y, radius: 3 mm, width: 3 mm, mass: 1 g"
    other = f"rollers: {{entry_other: {{{place}}}}}\n"
    both = loads(ONE + own + other, "s", ["contacts.*.restitution=0.3"])
    assert [c.name for c in both.contacts] == ["rub", "entry", "entry_lower", "entry_upper"]
    assert {c.restitution for c in both.contacts} == {0.3}


@pytest.mark.parametrize(
    ("set_", "text"),
    [
        (
            "contacts.0.friction=0.3",
            "there is no '0' in contacts; there are: entry, entry_lower, entry_upper",
        ),
        ("contacts.entri.friction=0.3", "did you mean 'entry'?"),
        ("contacts.entry_lower.friction=rough", "contacts.entry_lower.friction: 'rough'"),
        ("contacts.entry_lower.stifness=1 N", "unknown key 'stifness'; did you mean 'stiffness'?"),
        ("contacts.x_*.friction=0", "nothing here fits 'x_*'; there are: entry, entry_lower, entry_upper"),
        ("rollers.motr.radius=3 mm", "there is no 'motr' in rollers; there are: entry_lower, entry_upper"),
    ],
)
def test_a_set_of_what_a_nip_has_not(set_: str, text: str) -> None:
    with pytest.raises(SpecError) as error:
        loads(ONE, "s", [set_])
    assert text in str(error.value) and error.value.others == ()


def test_rows_and_mirror_images() -> None:
    text = SHEET + """rollers:
  "idler_*_*":
    center: [1 mm, 5 mm, -9 mm]
    axis: y
    radius: 3 mm
    width: 4 mm
    mass: 1 g
    repeat: {count: 3, step: [pitch, 0 mm, 0.5 mm], names: [in, mid, out]}
    mirror: {across: y, at: 2 mm}
  far: {center: [80 mm, 0 mm, -9 mm], axis: y, radius: 3 mm, width: 4 mm, mass: 1 g,
        drive: {speed: 9 rad/s}, press: {direction: x, stiffness: 1 N/mm, preload: 1 N},
        mirror: {across: x, names: [a, b]}}
planes:
  plate: {center: [0 mm, 0 mm, -30 mm], normal: z, size: [9 mm, 9 mm, 1 mm],
          repeat: {count: 2, step: [20 mm, 0 mm, 0 mm]}}
parameters: {pitch: 10 mm}
"""  # fmt: skip
    scene = loads(text)
    assert list(scene.rollers)[:6] == [f"idler_{k}_{m}" for k in ("in", "mid", "out") for m in (1, 2)]
    assert scene.rollers["idler_out_2"].center == (21.0, -1.0, -8.0)
    assert scene.rollers["idler_out_2"].axis == (0.0, 1.0, 0.0)
    # the image of a rotation about y across x turns the other way
    image = scene.rollers["far_b"]
    assert image.center[0] == -80.0 and image.axis == (0.0, -1.0, 0.0)
    assert image.press is not None and image.press.direction == (-1.0, 0.0, 0.0)
    assert [scene.planes[n].center[0] for n in ("plate_1", "plate_2")] == [0.0, 20.0]
    assert loads(text, "s", ["parameters.pitch=3 mm"]).rollers["idler_out_1"].center[0] == 7.0


@pytest.mark.parametrize(
    ("old", "new", "path", "text"),
    [
        ("force: 3 N", "force: 3 mm", "nips.entry.force", "expected a unit like 'N'"),
        ("force: 3 N", "force: 0.001 N", "nips.entry.force", "at least 0 N"),
        ("    force: 3 N\n", "", "nips.entry", "the key 'force' is missing"),
        ("diameter: 15 mm", "diametre: 15 mm", "nips.entry.lower.diametre", "did you mean 'diameter'"),
        ("mass: 1 g", "mass: 1 N", "nips.entry.lower.mass", "wrong unit"),
        ("stiffness: 200 N/mm^1.5", "stiffness: 200 N/mm", "nips.entry.upper.contact.stiffness",
         "wrong unit"),
        ("stiffness: 200 N/mm^1.5, ", "", "nips.entry.upper.contact", "'stiffness' is missing"),
        ("stiffness: 30 N/mm^1.5", "stifness: 30 N/mm^1.5", "nips.entry.contact.stifness",
         "mean 'stiffness'"),
        ("at: [0 mm, 0 mm,", "at: [0 mm, 0 mn,", "nips.entry.at.1", "unknown unit"),
        ("    at:", "    sheet: nte\n    at:", "nips.entry.sheet", "did you mean 'note'"),
        ("mass: 1 g,", "mass: 1 g, press: {stiffness: 1 N/mm},", "nips.entry.upper.press", "fixed axis"),
        ("friction: 0}", "friction: 0, share: pair}", "nips.entry.upper.contact.share", "share: width only"),
        ("    at:", "    repeat: {count: 0}\n    at:", "nips.entry.repeat.count",
         "greater than or equal to 1"),
    ],
)  # fmt: skip
def test_a_mistake_is_where_it_stands(old: str, new: str, path: str, text: str) -> None:
    assert old in ONE
    with pytest.raises(SpecError) as raised:
        loads(ONE.replace(old, new, 1), "s.yaml")
    errors = [raised.value, *raised.value.others]
    found = [e for e in errors if ".".join(map(str, e.path)) == path and text in e.message]
    assert found, [str(e) for e in errors]
    assert found[0].place is not None and found[0].place.file == "s.yaml" and found[0].place.line > 3


def test_defaults_of_nips_reach_inside() -> None:
    rest = "{radius: 5 mm, width: 6 mm, mass: %s, press: {stiffness: 0.3 N/mm}, "
    rest += "contact: {stiffness: 200 N/mm^1.5%s}}"
    upper, said = rest % ("4 g", ", friction: 0"), rest % ("1 g", "")
    assert upper in ONE
    short = ONE.replace(upper, "{mass: 4 g, contact: {friction: 0}}")
    scene = loads(short + f"defaults: {{nips: {{upper: {said}}}}}\n")
    assert scene.rollers == loads(ONE).rollers and scene.contacts == loads(ONE).contacts
    wrong = said.replace("radius: 5 mm", "radius: 5 N")
    wrong = said.replace("radius: 5 mm", "radius: 5 N")
    with pytest.raises(SpecError) as raised:
        loads(short + f"defaults: {{nips: {{upper: {wrong}}}}}\n", "s.yaml")
    assert raised.value.others == ()
    assert raised.value.path == ("defaults", "nips", "upper", "radius")


def test_the_schema_knows_nips() -> None:
    schema = json_schema()
    nip = schema["$defs"]["Nip"]["properties"]
    assert set(nip) == {*OF_NIPS, "repeat", "mirror"}
    lower_ = nip["lower"]["properties"]
    assert {"name", "contact", "radius", "diameter", "drive", "press"} <= set(lower_)
    assert "center" not in lower_
    assert lower_["contact"]["properties"]["stiffness"] == {"$ref": "#/$defs/Contact/properties/stiffness"}
    assert "nips" in schema["properties"] and schema["$defs"]["Defaults"]["properties"]["nips"]["properties"]

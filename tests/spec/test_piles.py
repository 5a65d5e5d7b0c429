"""Piles: sheets on each other that a scene says once."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads
from mdlgen.spec.scene import Scene

PILE = """
name: pile
parameters: {thick: 0.1 mm}
materials: {paper: {E_md: 3530 MPa, E_cd: 1113 MPa}}
sheets:
  other: {material: paper, size: [67 mm, 127 mm], thickness: thick, mass: 1 g, boxes: [2, 2],
    center: [0 mm, 0 mm, 9 mm]}
  note: {material: paper, size: [67 mm, 127 mm], thickness: thick, mass: 0.72 g, boxes: [3, 4],
    center: [1 mm, 2 mm, thick/2]}
piles:
  cassette: {of: note, count: 4, contact: {stiffness: 20000 N/mm^1.5, friction: 0.15}}
planes: {floor: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 200 mm, 10 mm]}}
contacts: [{between: ["cassette_*", floor], stiffness: 300 N/mm^1.5, friction: 0.3}]
run: {duration: 2 ms, print_step: 0.1 ms}
"""
NAMES = [f"cassette_{k}" for k in range(1, 5)]
ASKEW = ("piles.cassette.jitter=0.3 mm", "piles.cassette.turn=0.5 deg")


def pile(*sets: str) -> Scene:
    return loads(PILE, "pile", sets)


def test_sheets_lie_on_each_other_by_number_from_the_lowest() -> None:
    scene = pile("parameters.thick=0.2 mm", "piles.cassette.gap=0.01 mm")
    assert list(scene.sheets) == ["other", *NAMES]
    for k, name in enumerate(NAMES):
        assert scene.sheets[name].center == pytest.approx((1.0, 2.0, 0.1 + 0.21 * k), abs=1e-12)
        assert scene.sheets[name].mass == 0.72 and scene.sheets[name].boxes == (3, 4)


def test_each_touches_the_next_one() -> None:
    scene = pile("defaults={contacts: {restitution: 0.2}}")
    made = scene.contacts[1:]
    assert [c.between for c in made] == list(pairwise(NAMES))
    assert {(c.stiffness, c.restitution, c.friction.dynamic) for c in made} == {(20000.0, 0.2, 0.15)}
    assert [c.name for c in made] == ["_".join(pair) for pair in pairwise(NAMES)]


@pytest.mark.parametrize(
    "rotation",
    [
        "[0 deg, 0 deg, 30 deg]",
        "[0 deg, 90 deg, 0 deg]",
        "[90 deg, 0 deg, 90 deg]",
        "[10 deg, -20 deg, 30 deg]",
    ],
)
def test_a_pile_stands_along_the_normal_of_its_first_sheet(rotation: str) -> None:
    model = lower(pile(f"sheets.note.rotation={rotation}", "contacts=[]", *ASKEW))
    first, *rest = (sheet for sheet in model.sheets if sheet.name in NAMES)
    for k, sheet in enumerate(rest, 1):
        away = first.rotation.T @ (sheet.center - first.center)
        assert away[2] == pytest.approx(0.1 * k, abs=1e-12) and 0.0 < np.abs(away[:2]).max() <= 0.3
        turned = first.rotation.T @ sheet.rotation
        assert turned[2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
        assert 0.0 < abs(np.degrees(np.arctan2(turned[1, 0], turned[0, 0]))) <= 0.5


def test_the_same_seed_gives_the_same_places() -> None:
    def places(*sets: str) -> list[tuple[float, ...]]:
        return [sheet.center for sheet in pile(*ASKEW, *sets).sheets.values()]

    assert places() == places("piles.cassette.seed=1") != places("piles.cassette.seed=2")
    # a longer pile has the same ones below
    assert places("piles.cassette.count=6")[:5] == places()


def test_one_sheet_may_differ_and_a_pattern_meets_all() -> None:
    scene = pile("sheets.cassette_3.mass=0.9 g", "sheets.cassette_*.boxes=[2, 2]")
    assert [scene.sheets[name].mass for name in NAMES] == [0.72, 0.72, 0.9, 0.72]
    assert {scene.sheets[name].boxes for name in NAMES} == {(2, 2)}
    assert pile("sheets.note.mass=2 g").sheets["cassette_4"].mass == 2.0


def test_a_dump_and_a_text_are_the_same_scene() -> None:
    scene = pile(*ASKEW)
    again = Scene.model_validate(scene.model_dump())
    assert again == scene and again.model_dump() == scene.model_dump()
    assert list(scene.model_dump()["sheets"]) == ["note", "other"]
    assert again.with_({"piles.cassette.count": 2}).sheets.keys() == {"other", *NAMES[:2]}
    assert loads(again.to_yaml()) == scene


def test_a_pile_at_rest_carries_itself() -> None:
    """Each carries what lies on it: the floor has four weights."""
    model = lower(pile("run.duration=30 ms", "run.tolerance=0.01", *ASKEW, "sheets.other.center.2=90 mm"))
    result = mdlgen.solve(model)
    assert result.ok, result.status
    on_floor = sum(result.contact_force[-1, :4])
    assert on_floor == pytest.approx(4 * 0.72 * 9.81e-3, rel=0.05)


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("piles.cassette.count=0", "piles.cassette.count: Input should be greater than or equal to 1, got 0"),
        ("piles.cassette.of=nte", "piles.cassette.of: there is no sheet 'nte'; did you mean 'note'?"),
        ("piles.cassette.contact.frction=3", "unknown key 'frction'; did you mean 'friction'?"),
        ("piles.cassette.contact=null", "contact: expected a mapping of keys to values, got None"),
        ("piles.cassette.contact.between=[note, floor]", "leave between out"),
        ("piles.cassette.jitter=-1 mm", "-1 mm is outside what is allowed: at least 0 mm"),
        ("sheets.note.boxes=[3]", "sheets.note.boxes: expected a list of 2 whole numbers"),
        ("sheets.note.thickness=q", "sheets.note.thickness: 'q': there is no parameter 'q'"),
        ("sheets.note.clamp={edge: x_min}", "sheet note is clamped"),
        ("sheets.cassette_2.mss=1 g", "sheets.cassette_2.mss: unknown key 'mss'; did you mean 'mass'?"),
        ("contacts.0.between=[note, floor]", "there is no part 'note'"),
    ],
)
def test_a_mistake_is_reported_once_where_it_is(value: str, said: str) -> None:
    with pytest.raises(SpecError) as error:
        pile(value)
    text = str(error.value)
    assert said in text and text.count(said) == 1

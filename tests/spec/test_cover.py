"""Covers of rollers: what follows from them, what is refused, and what is said."""

from __future__ import annotations

import pytest

import mdlgen
from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.covers import levers, speed_ratio
from mdlgen.paths import samples
from mdlgen.report.overview import overview
from mdlgen.rubber.contact import loaded
from mdlgen.spec.load import parse
from mdlgen.spec.mistakes import located

SAMPLE = samples() / "rubber_nip.yaml"
COVER = "nips.feed.lower.cover"


def scene(*sets):
    return mdlgen.load(SAMPLE, sets)


def test_stiffness_speed_and_place_follow_from_the_cover():
    found = scene()
    model = mdlgen.lower(found)
    roller, cover = model.roller("feed_lower"), model.roller("feed_lower").cover
    assert cover is not None
    nip = loaded((found.rollers["feed_lower"].cover.layer(10.0),), 1 / 10 + 1 / 8, 10.0 / 20.0)
    k = found.contacts[0].stiffness
    assert k * nip.covers[0].depth ** 1.5 == pytest.approx(10.0, rel=1e-9)  # the force of the nip
    # the roller stands that deep in the sheet
    assert -roller.center[2] == pytest.approx(10.0 + 0.05 - cover.depth, rel=1e-9)
    # friction stands at R (1 + gain) from the axis at that depth
    lever, bend = levers(model)
    assert lever[0] * cover.depth + bend[0] * cover.depth**2 == pytest.approx(10.0 * cover.gain, rel=1e-9)
    assert (lever[1], bend[1]) == (0.0, 0.0)  # of the roller without a cover


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_laws_of_a_run_are_within_what_check_says(share):
    found = scene()
    cover = mdlgen.lower(found).roller("feed_lower").cover
    layer = found.rollers["feed_lower"].cover.layer(10.0)
    nip = loaded((layer,), 1 / 10 + 1 / 8, share * 0.5)
    force = found.contacts[0].stiffness * nip.covers[0].depth ** 1.5
    assert abs(force / (10.0 * share) - 1.0) <= cover.misfit * (1 + 1e-9)
    assert abs(speed_ratio(cover, 10.0 * share) - 1.0 - nip.covers[0].gain) <= cover.gain_misfit * (1 + 1e-9)
    assert 0.01 < cover.misfit < 0.1


def test_foam_is_slower_and_a_user_may_give_the_stiffness():
    foam = mdlgen.lower(scene(f"{COVER}.poisson=0.2")).roller("feed_lower").cover
    assert foam.gain < -0.02
    model = mdlgen.lower(scene("contacts.feed_lower.stiffness=50 N/mm^1.5"))
    cover = model.roller("feed_lower").cover
    lever, bend = levers(model)
    depth = (10.0 / 50.0) ** (2 / 3)  # of the law that is given
    assert lever[0] * depth + bend[0] * depth**2 == pytest.approx(10.0 * cover.gain, rel=1e-9)


def test_it_is_said_by_check():
    found = overview(mdlgen.lower(scene()))["covers"]["feed_lower"]
    assert found["facing"] == "feed_upper"
    assert found["modulus_mpa"] == pytest.approx(1.69, abs=0.005)
    assert found["nip_width_mm"] == pytest.approx(2.16, abs=0.01)
    assert found["speed_ratio"] == pytest.approx(1.0196, abs=1e-4)
    assert "covers" not in overview(mdlgen.lower(mdlgen.load(samples() / "verify/drop.yaml", ())))


@pytest.mark.parametrize("output", ["motionview", "motionsolve", "msolve"])
def test_texts_refuse_it_by_name_and_say_what_to_write(output):
    with pytest.raises(RefusedError, match=r"feed_lower has a cover.*1\.0196 times.*N/mm\^1\.5"):
        mdlgen.emit(mdlgen.lower(scene()), output)


def test_a_refused_cover_is_named_where_it_stands_in_the_text():
    """Rollers and contacts of a nip stand under nips."""
    text = SAMPLE.read_text(encoding="utf-8")
    with pytest.raises(RefusedError) as caught:
        mdlgen.emit(mdlgen.lower(scene()), "motionview")
    found = located(caught.value, parse(text, "f.yaml"))
    line = next(k for k, line in enumerate(text.splitlines(), 1) if "cover: {" in line)
    assert str(found).startswith(f"f.yaml:{line}:14: {COVER}: MotionView text: feed_lower has a cover")
    contact = located(SpecError("of it", ("contacts", 0, "friction")), parse(text, "f.yaml"))
    assert contact.path == ("nips", "feed", "lower", "contact", "friction")


def test_a_cover_that_is_set_in_part_is_named_in_its_nip():
    with pytest.raises(SpecError) as caught:
        scene("rollers.feed_lower.cover.modulus=0.01 MPa", "rollers.feed_lower.cover.hardness=null")
    assert f":19:7: {COVER}: a force of 10 N presses the cover" in str(caught.value)


@pytest.mark.parametrize(
    ("sets", "message"),
    [
        ((f"{COVER}.modulus=2 MPa",), "exactly one of hardness and modulus"),
        ((f"{COVER}.hardness=40",), "has no unit; expected"),
        ((f"{COVER}.hardness=98 ShA",), "5 to 95 ShA"),
        ((f"{COVER}.thickness=10 mm",), "is not below the radius"),
        ((f"{COVER}.poisson=0.6",), "allowed: 0 to 0.5"),
        ((f"{COVER}.modulus=0.01 MPa", f"{COVER}.hardness=null"), "nip wider than 1 of the radius"),
    ],
)
def test_wrong_values_are_one_line(sets, message):
    with pytest.raises(SpecError) as caught:
        scene(*sets)
    assert message in str(caught.value)


def test_stiffness_is_missing_where_there_is_no_cover():
    with pytest.raises(SpecError, match="neither note nor feed_upper has a cover"):
        scene("nips.feed.upper.contact={friction: 0.3}")
    with pytest.raises(SpecError, match="the key 'stiffness' is missing"):
        scene("nips.feed.lower.cover=null")


def test_lints_of_covers():
    codes = {
        "W147": (f"{COVER}.hardness=15 ShA", "nips.feed.force=3 N"),
        "W148": (f"{COVER}.hardness=20 ShA", f"{COVER}.poisson=0.2", f"{COVER}.thickness=1 mm"),
        "W149": ("nips.feed.force=60 N", f"{COVER}.hardness=25 ShA"),
        "W150": ("nips.feed.contact={friction: 0.3}",),
    }
    clean = {lint.code for lint in lints(mdlgen.lower(scene()))}
    assert not clean
    for code, sets in codes.items():
        assert code in {lint.code for lint in lints(mdlgen.lower(scene(*sets)))}, code


def test_a_cover_that_nothing_meets_needs_no_force():
    """It has no nip, and nothing is said of it."""
    far = (
        "{center: [0 mm, 0 mm, 300 mm], axis: y, radius: 8 mm, width: 20 mm, mass: 3 g,"
        " cover: {thickness: 2 mm, hardness: 60 ShA, poisson: 0.45}}"
    )
    model = mdlgen.lower(scene(f"rollers={{far: {far}}}"))
    assert model.roller("far").cover is None and model.roller("feed_lower").cover is not None

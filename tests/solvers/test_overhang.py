"""Statics of the fast solver: sheets over the edge of a table, and what friction holds of them."""

from __future__ import annotations

import re

import pytest
from asked import as_asked

import mdlgen
from mdlgen.bench.oracles import overhang
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")

ASIDE = (((0, 0.49), True), ((0, 0.502), False), ((-0.42, 0), True), ((0.42, 0), True), ((0.51, 0), False))
HELD = "at rest friction holds sheets on fixed planes alone"
LEAST = 2.0**-12  # the least part of a load that is tried: 1, then a quarter of it, six times
NOTHING = f"no balance was found above 0 % of the load: at {100 * LEAST:.3g} %"

HANGS = """
name: overhang
materials: {{p: {{E_md: 3530 MPa, E_cd: 3530 MPa, D_md: {bend} N*mm, D_cd: {bend} N*mm}}}}
sheets:
  n: {{material: p, size: [{length} mm, 20 mm], thickness: {thick} mm, mass: {mass!r} g, boxes: [{boxes}, 1],
       layout: plate, center: [{middle!r} mm, 0 mm, {high!r} mm]}}
planes: {{table: {{center: [-150 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 100 mm, 10 mm], mass: 100 g}}}}
contacts: [{{between: [n, table], stiffness: 100 N/mm^1.5, friction: {mu}}}]
run: {{analysis: static}}
probes: {{tip: {{sheet: n, edge: x_max}}}}
"""


def hangs(
    out: float,
    length: float,
    thick: float = 0.1,
    bend: float = 0.4,
    size: float = 5.0,
    mu: float = 0.5,
    aside: tuple[float, float] = (0.0, 0.0),
):
    """A strip of 80 g/m^2 at 0.1 mm of which `out` is beyond the edge of a table; boxes of a size [mm];
    `aside`: parts of the weight over the edge and along it."""
    text = HANGS.format(
        bend=bend, length=length, thick=thick, mass=80e-6 * length * 20 * thick / 0.1, mu=mu,
        boxes=round(length / size), middle=out - 0.5 * length, high=0.5 * thick,
    )  # fmt: skip
    lean = f"gravity: [{9.81 * aside[0]!r} m/s^2, {9.81 * aside[1]!r} m/s^2, -9.81 m/s^2]"
    return mdlgen.solve(lower(loads(f"{text}{lean}\n")), "lattice")


@pytest.mark.parametrize(
    "out, length, thick, bend",
    [
        (20, 200, 0.1, 0.4),
        (40, 200, 0.1, 0.4),
        (60, 200, 0.1, 0.4),
        (80, 200, 0.1, 0.4),
        (90, 200, 0.1, 0.4),  # only its other end stands on the table
        (100, 300, 0.1, 0.4),
        (110, 300, 0.1, 0.4),
        (60, 300, 0.15, 1.35),
        (97, 300, 0.15, 1.35),
        (50, 260, 0.08, 0.2),
    ],
)
def test_a_sheet_hangs_over_the_edge_of_a_table(out: float, length: float, thick: float, bend: float) -> None:
    """The heavy elastica, which leaves the table before the edge; boxes of 5 mm are off by 1 % or 0.03 mm."""
    result = hangs(out, length, thick, bend)
    assert as_asked(result), result.status
    # the round of the edge is touched a radius before the end of the plate
    radius = result.model.planes[0].edges[0]
    exact = overhang.overhang(80e-6 * 20 * thick / 0.1 * 9.81e-3, bend * 20, length, out + radius)
    tip = result.anchor_motion(0)[0][-1]
    assert 0.5 * thick - tip[2] == pytest.approx(exact.sag, rel=0.01, abs=0.03)
    assert tip[0] + radius == pytest.approx(exact.reach, abs=0.2)
    # all of it stands on the table, whose edge pushes upwards
    assert result.contact_force[-1, 0] == pytest.approx(80e-6 * 20 * length * thick / 0.1 * 9.81e-3, rel=1e-5)


def test_the_sag_comes_to_the_elastica_on_finer_grids() -> None:
    exact = overhang.overhang(80e-6 * 20 * 9.81e-3, 0.4 * 20, 300, 110.1).sag
    tips = [float(hangs(110, 300, size=size).anchor_motion(0)[0][-1, 2]) for size in (10, 2.5)]
    off = [abs((0.05 - tip) / exact - 1) for tip in tips]
    assert off[1] < 0.003 < off[0]


def test_a_sheet_with_more_over_the_edge_than_on_the_table_falls() -> None:
    """At any part of its weight: it turns about the edge, and its other end leaves the table.

    Which box is left with the most at the last part, the other end or the one at the edge, is a matter of
    rounding.
    """
    result = hangs(130, 200)
    assert not result.usable
    assert re.fullmatch(rf"{NOTHING} \S+ N are left on n_(0|14)_0; {HELD}", result.status), result.status


@pytest.mark.parametrize(("out", "stands"), [(97, True), (103, False)])
def test_a_rigid_sheet_tips_where_half_of_it_is_over_the_edge(out: float, stands: bool) -> None:
    """A thousand times as stiff, a strip of 200 mm."""
    result = hangs(out, 200, bend=400.0)
    assert result.ok == stands, result.status
    if stands:  # flat: a cantilever of this stiffness would sag by q l^4/(8 D) = 0.02 mm
        tip = result.anchor_motion(0)[0][-1]
        assert tip[[0, 2]] == pytest.approx([out, 0.05], abs=0.1)  # the depths of its rear and of the edge
    else:
        assert NOTHING in result.status


@pytest.mark.parametrize(("aside", "stands"), ASIDE)
def test_a_sheet_over_an_edge_slides_at_its_friction(aside: tuple[float, float], stands: bool) -> None:
    """Along the edge all of 0.5 is left; over it the edge pushes outwards, which takes a part."""
    result = hangs(60, 200, aside=aside)
    assert result.ok == stands, result.status
    if not stands:
        weight = 0.32 * 9.81e-3  # of 80 g/m^2, 200 mm by 20 mm [N]
        pull = (
            f"sheet n slides on plane table: {weight * max(aside):.3g} N pull it along, and friction holds "
        )
        assert result.status.startswith(pull), result.status
        assert float(result.status.removeprefix(pull).split()[0]) <= 0.5 * weight * (1 + 5e-3)  # three digits


def test_what_friction_cannot_hold_slides() -> None:
    """A strip that lies on a table under a gravity that leans by atan 0.2."""
    text = HANGS.format(
        bend=0.4, length=100, thick=0.1, mass=0.16, boxes=10, middle=-100.0, high=0.05, mu="{mu}"
    ).replace("name: overhang", "name: overhang\ngravity: [2 m/s^2, 0 m/s^2, -10 m/s^2]")
    holds, slides = (
        mdlgen.solve(lower(loads(text.replace("{mu}", mu))), "lattice") for mu in ("0.21", "0.19")
    )
    assert as_asked(holds), holds.status
    assert not as_asked(slides)
    assert "sheet n slides on plane table: 0.00032 N pull it along" in slides.status
    assert "friction holds 0.000304 N" in slides.status

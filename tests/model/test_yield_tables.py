"""Sheets that yield, as scenes, tables and texts; creases with a stiffness per length."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import mdlgen
from mdlgen.backends.lattice import scope as of_lattice
from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.io import tree
from mdlgen.spec.load import load

SAMPLE = samples() / "crease.yaml"
FOLD = "sheets.strip.shape={start: flat, folds: [{along: x, at: 5 mm, angle: 20 deg, crease: 0.05 N/rad}]}"
ELASTIC = "materials.eur10.yield=null"


def model(*sets: str) -> Model:
    return lower(load(SAMPLE, sets))


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center", "plate"])
@pytest.mark.parametrize("columns", [6, 24])
def test_the_yield_moment_of_a_line_is_that_of_the_sheet(layout: str, columns: int) -> None:
    """D kappa_y per width, on any grid, with H/k from the slope beyond."""
    found = model(f"sheets.strip.layout={layout}", f"sheets.strip.boxes=[{columns},3]")
    plastic, table = found.plastic, found.bushings
    line = (plastic.axis == 1) & (table.node[plastic.bushing, 0] == columns)
    assert plastic.moment[line].sum() == pytest.approx(0.4 * 0.1 * 10.0, rel=1e-12)
    own = table.k[plastic.bushing, 3 + plastic.axis]
    assert plastic.hardening / (own + plastic.hardening) == pytest.approx(0.05, rel=1e-12)
    across = (plastic.axis == 0) & (table.node[plastic.bushing, 1] == 2)
    assert plastic.moment[across].sum() == pytest.approx(0.242 * 0.1 * 30.0, rel=1e-12)
    assert len(plastic) == (table.kind < 2).sum()


def test_md_and_cd_have_their_own_and_clamps_yield_as_half_a_cell() -> None:
    both = "materials.eur10.yield={curvature: [0.1 1/mm, 0.2 1/mm], hardening: [0.05, 50 %]}"
    found = model(
        both, "sheets.strip.clamp={edge: x_min}", "sheets.strip.boxes=[6,2]", "rollers={}", "contacts=[]"
    )
    plastic, table = found.plastic, found.bushings
    along = plastic.axis == 1
    half = along & (table.kind[plastic.bushing] == 2)
    assert plastic.moment[half].sum() == pytest.approx(0.4 * 0.1 * 10.0, rel=1e-12)
    assert plastic.moment[half] / table.k[plastic.bushing[half], 4] == pytest.approx(0.1 * 2.5, rel=1e-12)
    across = plastic.axis == 0
    assert plastic.moment[across].sum() == pytest.approx(0.242 * 0.2 * 30.0, rel=1e-12)
    ratio = plastic.hardening[across] / table.k[plastic.bushing[across], 3]
    assert ratio == pytest.approx(1.0, rel=1e-12)


def test_without_the_key_there_is_nothing_that_yields() -> None:
    """And the tables are bitwise the same as with it."""
    elastic, yields = model(ELASTIC), model()
    assert len(elastic.plastic) == 0 and elastic.sheets[0].yields is None
    for name in ("k", "c", "origin"):
        assert np.array_equal(getattr(elastic.bushings, name), getattr(yields.bushings, name))


@pytest.mark.parametrize("output", ["motionview", "motionsolve", "msolve"])
def test_texts_refuse_it_by_name_and_place(output: str) -> None:
    with pytest.raises(RefusedError, match="the material of strip has a yield curvature") as error:
        mdlgen.emit(model(), output)
    assert error.value.path == ("materials", "eur10", "yield")
    assert mdlgen.emit(model(ELASTIC), output)


def test_statics_refuses_it() -> None:
    static = "run={analysis: static, duration: 1 ms}"
    with pytest.raises(RefusedError, match="where it comes to rest depends on the way there"):
        of_lattice.check(model(static))
    of_lattice.check(model(static, ELASTIC))


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("{curvature: 0.1 1/mm}", "the key 'hardening' is missing"),
        ("{curvature: 0.1 mm, hardening: 0.1}", "'0.1 mm' has the wrong unit"),
        ("{curvature: 0 1/mm, hardening: 0.1}", "more than 0 1/mm"),
        ("{curvature: 0.1 1/mm, hardening: 1}", "allowed: 0.01 to 0.99"),
        ("{curvature: [1 1/m, 2 1/m, 3 1/m], hardening: 0.1}", "a list of two, MD and CD"),
    ],
)
def test_what_is_wrong_with_it_is_said_in_a_line(value: str, message: str) -> None:
    with pytest.raises(SpecError, match=message):
        load(SAMPLE, [f"materials.eur10.yield={value}"])


def test_a_curvature_is_a_number_with_a_unit_or_a_formula() -> None:
    written = ("100 1/m", "0.1 1/mm", "1/(10 mm)", "1e-1 1 / mm")
    read = [load(SAMPLE, [f"materials.eur10.yield.curvature={text}"]) for text in written]
    assert [lower(scene).sheets[0].yields for scene in read] == [pytest.approx((0.1, 0.1), rel=1e-12)] * 4


def test_a_scene_is_written_as_it_was_read() -> None:
    scene = load(SAMPLE, [FOLD])
    assert mdlgen.Scene.model_validate(scene.model_dump(mode="json")) == scene


def test_lints_tell_of_coarse_grids_and_thin_rollers() -> None:
    def codes(*sets: str) -> set[str]:
        return {lint.code for lint in lints(model(*sets))} & {"W145", "W146"}

    assert codes() == {"W146"}
    assert codes("rollers.rod.radius=10 mm") == set()  # and half of the thickness
    assert codes("rollers.rod.radius=10 mm", "sheets.strip.boxes=[5,1]") == {"W145"}
    assert codes(ELASTIC) == set()


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center", "plate"])
@pytest.mark.parametrize("columns", [6, 12, 24])
def test_a_crease_is_in_series_with_the_sheet(layout: str, columns: int) -> None:
    """1/k = L/(D w) + 1/(K_c w), and only in bending across it."""
    sets = (f"sheets.strip.layout={layout}", f"sheets.strip.boxes=[{columns},2]", ELASTIC)
    creased, plain = model(*sets, FOLD), model(*sets)
    on = plain.bushings.node[:, 0] == 2 * (columns // 2 + columns // 6)
    on &= plain.bushings.kind == 0
    k = creased.bushings.k[on, 4].sum()
    assert 1.0 / k == pytest.approx(30.0 / columns / (0.4 * 10.0) + 1.0 / (0.05 * 10.0), rel=1e-12)
    others = [0, 1, 2, 3]
    assert np.array_equal(creased.bushings.k[:, others], plain.bushings.k[:, others])
    assert np.array_equal(creased.bushings.k[~on, 4], plain.bushings.k[~on, 4])


def test_the_sheet_at_a_crease_yields_as_elsewhere() -> None:
    plastic, table = model(FOLD).plastic, model(FOLD).bushings
    on = (table.node[plastic.bushing, 0] == 40) & (plastic.axis == 1)
    assert plastic.moment[on].sum() == pytest.approx(0.4 * 0.1 * 10.0, rel=1e-12)
    # beyond, the sheet alone goes on: 1/h times its elastic compliance, and the crease
    k, hard = table.k[plastic.bushing[on], 4].sum(), plastic.hardening[on].sum()
    assert 1.0 / k + 1.0 / hard == pytest.approx(1.0 / (0.05 * 0.4 * 10.0) + 2.0, rel=1e-12)


def test_factor_and_stiffness_per_length_exclude_each_other() -> None:
    with pytest.raises(SpecError, match="stiffness and crease are both given"):
        load(SAMPLE, [FOLD, "sheets.strip.shape.folds.0.stiffness=0.5"])


def test_models_of_older_files_are_elastic() -> None:
    found = model(ELASTIC)

    class Held:
        """What a file of an older version has: no table of what yields."""

        def put(self, name: str, array: Any) -> None:
            self.arrays[name] = array

        def __init__(self) -> None:
            self.arrays: dict[str, Any] = {}

    held = Held()
    text = tree._encode(found, "model", held)  # pyright: ignore[reportArgumentType, reportPrivateUsage]
    del text["of"]["plastic"]
    arrays = {name: {(): array} for name, array in held.arrays.items()}
    read = tree._decode(text, arrays)  # pyright: ignore[reportPrivateUsage]
    assert len(read.plastic) == 0 and replace(read, plastic=found.plastic).name == found.name

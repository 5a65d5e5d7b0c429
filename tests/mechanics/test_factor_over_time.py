"""Factors over time: their mean over a span, and what they write where forces are read."""

from __future__ import annotations

import numpy as np
import pytest

import mdlgen
from mdlgen.mechanics.over_time import LAW, changing, mean_factor, set_to, weight_changes
from mdlgen.mechanics.pack import gravity, pack_loads

pytestmark = pytest.mark.usefixtures("as_python")

SCENE = """
name: pushed
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
gravity_profile: [[1 ms, 0.5], [2 ms, 1]]
materials: {paper: {E_md: 1 GPa, E_cd: 1 GPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets: {block: {material: paper, size: [10 mm, 10 mm], thickness: 1 mm, mass: 2 g, boxes: [1, 1]}}
loads:
  - {sheet: block, at: [0 mm, 0 mm], force: [3 N, 0 N, 0 N]}
  - {sheet: block, edge: x_max, moment: [0 N*mm, 4 N*mm, 0 N*mm], profile: [[0 ms, -1], [4 ms, 1], [5 ms, 1]]}
run: {duration: 10 ms}
"""


def _law(*corners: tuple[float, float]) -> np.ndarray:
    law = np.zeros(1, LAW)
    law["corners"], law["drive"][0, : 2 * len(corners)] = len(corners), np.ravel(corners)
    return law


def test_a_mean_is_the_integral_of_the_corners():
    """Against a sum over a grid that has all corners."""
    corners = [(1.0, 2.0), (1.5, -1.0), (4.0, 0.5), (4.001, 3.0)]
    time, factor = np.array(corners).T
    for begin, end in ((0.0, 0.5), (0.0, 1.2), (1.0, 4.0), (1.2, 1.3), (1.2, 6.0), (3.0, 4.0005), (7.0, 9.0)):
        grid = np.unique([begin, end, *time[(time > begin) & (time < end)]])
        whole = np.trapezoid(np.interp(grid, time, factor), grid)
        # round-off of a few sums
        assert mean_factor(_law(*corners)[0], begin, end) == pytest.approx(whole / (end - begin), rel=1e-12)


def test_a_constant_factor_is_itself_to_the_bit():
    law = _law((0.0, 0.7), (1.0, 0.7))[0]
    assert [mean_factor(law, begin, begin + 0.1) for begin in (0.0, 0.95, 3.3)] == pytest.approx(
        [0.7] * 3, 1e-15
    )
    assert mean_factor(law, 0.3, 0.3) == 0.7


def test_what_changes_is_written_where_forces_are_read():
    model = mdlgen.lower(mdlgen.loads(SCENE))
    loads, weight = pack_loads(model), gravity(model)
    found = changing(model, loads, weight)
    assert weight_changes(found)
    assert weight == pytest.approx([0.0, 0.0, -0.5 * 9.81e-3])  # as the run begins
    assert loads["moment"][1] == pytest.approx([0.0, -4.0, 0.0])
    set_to(found, loads, weight, 3.0, 5.0)
    # from 0.5 to 1 in 1 ms, and 1 in another
    assert loads["moment"][1] == pytest.approx([0.0, 4.0 * 0.875, 0.0])
    assert weight == pytest.approx([0.0, 0.0, -9.81e-3])
    assert loads["force"][0].tolist() == [3.0, 0.0, 0.0]  # one without a profile


def test_a_law_that_is_rewritten_is_read_at_the_next_call():
    model = mdlgen.lower(mdlgen.loads(SCENE))
    loads, weight = pack_loads(model), gravity(model)
    found = changing(model, loads, weight)
    own = found.laws[found.laws["entry"] == 1]
    assert len(own) == 1
    row = int(np.flatnonzero(found.laws["entry"] == 1)[0])
    found.laws["corners"][row] = 2
    found.laws["drive"][row, :4] = [0.0, 2.0, 1.0, 2.0]
    set_to(found, loads, weight, 8.0, 8.0)
    assert loads["moment"][1] == pytest.approx([0.0, 8.0, 0.0])


def test_a_scene_without_factors_has_no_laws():
    model = mdlgen.lower(mdlgen.loads(SCENE, ["gravity_profile=null", "loads.1.profile=null"]))
    loads, weight = pack_loads(model), gravity(model)
    found = changing(model, loads, weight)
    assert not model.changes
    assert model.loads.profiles == ()
    assert (found.laws.size, found.acts.size) == (0, 0)
    assert not weight_changes(found)


def test_statics_have_the_factor_of_the_start():
    text = SCENE.replace("block: {material", "block: {clamp: {edge: x_min}, material").replace(
        "[1, 1]", "[4, 1]"
    )
    model = mdlgen.lower(mdlgen.loads(text, ["run.analysis=static"]))
    loads, weight = pack_loads(model), gravity(model)
    found = changing(model, loads, weight)
    assert found.laws.size == 0
    assert weight == pytest.approx([0.0, 0.0, -0.5 * 9.81e-3])
    assert loads["moment"][-1, 1] == pytest.approx(-4.0)

"""Poisson's effect in the tables: bushings of a plate, couplings around corners; what is refused by name."""

from __future__ import annotations

import numpy as np
import pytest

import mdlgen
from mdlgen.checks import lints as found_by
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.spec.load import load, loads

EDGES = [f", clamp: {{edge: {edge}}}" for edge in ("x_min", "x_max", "y_min", "y_max")]
UNEVEN = (
    ", grading: {x: [1, 2, 3, 2], y: [1, 3, 2]}"
    ", zones: {z: {x: [-20 mm, 5 mm], y: [-20 mm, 20 mm], stiffness: 3}}"
)


def sheet(more: str = "", poisson: float | None = 0.4, boxes: str = "[4, 3]", rest: str = "") -> Model:
    given = "" if poisson is None else f", poisson: {poisson}"
    return lower(
        loads(f"""
name: patch
materials: {{p: {{E_md: 2000 MPa, E_cd: 1500 MPa, D_md: 100 N*mm, D_cd: 60 N*mm{given}{rest}}}}}
sheets:
  n: {{material: p, size: [60 mm, 40 mm], thickness: 0.6 mm, mass: 1 g, boxes: {boxes}, layout: plate{more}}}
""")
    )


def test_without_it_nothing_changes() -> None:
    plain = sheet(poisson=None)
    none = sheet(poisson=0.0)
    assert not len(plain.corners) and not len(none.corners)
    assert (plain.bushings.k == none.bushings.k).all() and (plain.bushings.c == none.bushings.c).all()


def stiffness(model: Model, along: int) -> tuple[np.ndarray, np.ndarray]:
    """Of all joints together by their elongations (along 0) or turns (1), and whether each is along y."""
    corners, k = model.corners, model.bushings.k
    along_y = model.bushings.kind == 1
    along_y[corners.joint[:, 2:][corners.joint[:, 2:] >= 0]] = True
    own = np.where(along_y, k[:, 3 if along else 1], k[:, 4 if along else 0])
    whole, values = np.diag(own), corners.bend if along else corners.stretch
    for n in range(4):
        x, y = corners.joint[:, n // 2], corners.joint[:, 2 + n % 2]
        met = (x >= 0) & (y >= 0)
        np.add.at(whole, (x[met], y[met]), values[met, n])
        np.add.at(whole, (y[met], x[met]), values[met, n])
    return whole, along_y


@pytest.mark.parametrize("more", ["", UNEVEN, *EDGES])
@pytest.mark.parametrize("poisson", [0.4, 1.1])  # sqrt(E_md/E_cd) is 1.15
def test_no_state_is_without_energy(more: str, poisson: float) -> None:
    """Even next to what the material allows: each quarter of a box has that of the plate or the strip."""
    for along in (0, 1):
        whole, _ = stiffness(sheet(more, poisson), along)
        scale = np.sqrt(np.diag(whole))
        least = np.linalg.eigvalsh(whole / np.outer(scale, scale)).min()
        ratio = poisson * np.sqrt(0.75 if along == 0 else 0.6)
        assert least > 0.5 * (1.0 - ratio)


@pytest.mark.parametrize("more", ["", UNEVEN])
def test_uniform_tension_and_bending_are_those_of_a_strip(more: str) -> None:
    """Along x, with joints along y free to contract: E s and D of what was given, nu_md times the strain
    across; on a graded grid too, but for zones."""
    more = more.partition(", zones")[0]
    model, plain = sheet(more), sheet(more, None)
    half, bushings = model.bodies.half, model.bushings
    for along in (0, 1):
        whole, along_y = stiffness(model, along)
        axis = along_y.astype(int)
        rows = np.arange(len(bushings))
        length = half[bushings.a, axis][rows] + half[bushings.b, axis][rows]
        sign = np.where(along_y, -1.0 if along else 1.0, 1.0)  # of a turn about x against one about y
        strain = sign * np.where(along_y, -0.4, 1.0) * length
        force = whole @ strain
        alone = plain.bushings.k[:, 4 if along else 0] * length
        # joints along x have the force of the strip but in the end columns, whose outer half is no plate
        inner = ~along_y
        assert force[inner] == pytest.approx(alone[inner], rel=1e-12)
        ends = np.isin(bushings.node[:, 0], [1, 2 * model.sheets[0].n_x - 1])
        assert np.abs(force[along_y & ~ends]).max() < 1e-12 * np.abs(force).max()


def test_a_row_of_boxes_is_a_strip() -> None:
    row, plain = sheet(boxes="[4, 1]"), sheet(poisson=None, boxes="[4, 1]")
    assert not len(row.corners) and (row.bushings.k == plain.bushings.k).all()
    assert "W141" in [lint.code for lint in found_by(row)]
    assert "W141" not in [lint.code for lint in found_by(sheet())]
    assert "W141" not in [lint.code for lint in found_by(plain)]


def test_dampers_are_those_of_the_strip() -> None:
    """Damping times of all bushings stay as they are; corners have the geometric mean."""
    times = ", damping: {time: [4 ms, 1 ms]}"
    model, plain = sheet(rest=times), sheet(poisson=None, rest=times)
    k, c = model.bushings.k, model.bushings.c
    assert np.allclose(c / k, plain.bushings.c / plain.bushings.k, rtol=1e-12, atol=0)
    corners = model.corners
    assert np.allclose(corners.bend_damping, 2.0 * corners.bend, rtol=1e-12, atol=0)
    assert np.allclose(corners.stretch_damping, 2.0 * corners.stretch, rtol=1e-12, atol=0)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (
            "materials.film.poisson=1.0",
            r"poisson: 1 is too large; allowed is less than sqrt\(E_md/E_cd\) = 1,",
        ),
        (
            "materials.film.D_cd=4 N*mm",
            r"sheet film: poisson: 0.38 is too large; .* sqrt\(D_md/D_cd\) = 0.3062",
        ),
        ("materials.film.k_ty=0 N*mm/rad", "poisson needs a bending stiffness along x and y above 0"),
        ("materials.film.poisson=-0.1", "-0.1 is outside what is allowed"),
    ],
)
def test_what_a_material_cannot_have_is_said(change: str, says: str) -> None:
    with pytest.raises(SpecError, match=says):
        load(samples() / "saddle.yaml", [change])


def test_other_layouts_and_curves_are_refused() -> None:
    with pytest.raises(SpecError, match="poisson acts with layout plate only"):
        load(samples() / "cantilever.yaml", ["materials.eur10.poisson=0.2"])
    curve = "curve_md={points: [[0, 0 MPa], [1 %, 20 MPa]]}"
    with pytest.raises(SpecError, match="poisson and curve_md are both given"):
        load(
            samples() / "saddle.yaml",
            ["materials.film.E_md=null", f"materials.film.{curve}"],
        )


@pytest.mark.parametrize("target", ["motionview", "motionsolve", "msolve"])
def test_texts_refuse_it(target: str) -> None:
    with pytest.raises(RefusedError, match="the material of sheet n has poisson, which couples bushings"):
        mdlgen.emit(sheet(), target)

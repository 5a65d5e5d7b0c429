"""Rollers on meshes: against planes and arcs, at rest, braked, in balance; what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from laws import pair_force
from ran import solved
from roller_scenes import DOWN, MASS, RADIUS, SOLVERS, G, K, N, depth, press, scene, spun
from solids import binary, brick, cylinder, halved, prism

from mdlgen.backends.lattice.arrays import build
from mdlgen.errors import SpecError
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.point import OUT
from mdlgen.model.lower import lower
from mdlgen.model.tables import CYLINDER_MESH, Model
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify.verification import verify

PART = "meshes: {part: {file: part.stl}}"


def hollow(radius: float, facets: int) -> tuple[np.ndarray, np.ndarray]:
    """A block with a groove along y, its lowest line in the origin, of so many facets over 120 deg; the
    middles of its facets touch the round."""
    turn = math.radians(120) / facets
    angles = math.radians(270 - 60) + turn * np.arange(facets + 1)
    groove = radius / math.cos(turn / 2) * np.stack([np.cos(angles), np.sin(angles)], axis=1) + [0, radius]
    block = [(groove[-1, 0], -20.0), (groove[0, 0], -20.0)]
    return prism([*block, *groove], 60)


def flat() -> tuple[np.ndarray, np.ndarray]:
    """A plate whose upper face is z = 0, in many triangles."""
    corners, triangles = brick(120, 60, 10)
    for _ in range(3):
        corners, triangles = halved(corners, triangles)
    return corners - [0, 0, 5], triangles


def rod(radius: float, facets: int) -> tuple[np.ndarray, np.ndarray]:
    """A cylinder along y whose highest line is in the origin; facets touch the round in their middles."""
    corners, triangles = cylinder(radius / math.cos(math.pi / facets), 60, facets)
    turn = math.pi / 2 + math.pi / facets
    c, s = math.cos(turn), math.sin(turn)
    corners = corners @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return corners - [0, 0, radius], triangles


def made(tmp_path: Path, solid: tuple[np.ndarray, np.ndarray], *sets: str, **given: str) -> Model:
    (tmp_path / "part.stl").write_bytes(binary(*solid))
    file = tmp_path / "scene.yaml"
    file.write_text(scene(PART, **given))
    return lower(load(file, sets))


def law(model: Model, at: np.ndarray) -> np.ndarray:
    """What the pair does with the roller at a place, and all still."""
    system = build(model)
    count, out = len(system.bodies), np.zeros(OUT)
    x, r = np.zeros((count, 3)), np.tile(np.eye(3).ravel(), (count, 1))
    x[:-1], r[:-1] = model.bodies.position, model.bodies.rotation.reshape(-1, 9)
    x[int(system.pairs["a"][0])] = at
    still = np.zeros((count, 3))
    pair_force(system.bodies, system.pairs[0], system.shapes, Motion(x, r, still, still), out)
    return out


# -- the law


def test_on_a_flat_mesh_it_is_that_of_a_plane(tmp_path: Path) -> None:
    """Whatever triangles the face is made of, skew to the axis and over a part of the width."""
    model = made(tmp_path, flat())
    for x, y, z in ((0.0, 0.0, 0.08), (7.123, -3.21, 0.02), (-30.4, 11.0, 0.3), (1.0, 30.0, 0.1)):
        out = law(model, np.array([x, y, RADIUS - z]))
        share = min(1.0, (38.0 - abs(y)) / 16)
        assert out[2] == pytest.approx(share * K * z**1.5, rel=1e-5)  # corners are of single precision
        assert out[15] == pytest.approx(z, rel=1e-5) and abs(out[0]) < 1e-5 * out[2]
    skew = made(tmp_path, flat(), axis="[0.6, 0.8, 0]")
    assert law(skew, np.array([3.0, 2.0, 9.9]))[2] == pytest.approx(K * 0.1**1.5, rel=1e-5)


@pytest.mark.parametrize(("facets", "off"), [(40, 0.07), (160, 0.006), (640, 1e-3)])
def test_in_a_groove_of_facets_it_is_that_of_an_arc(facets: int, off: float, tmp_path: Path) -> None:
    """z = distance + r - R in the mean; off by what the facets are off the round (R turn^2/8), and by the
    contact's own width."""
    model = made(tmp_path, hollow(30.0, facets))
    sag = 30.0 * (math.radians(120) / facets) ** 2 / 8
    z, errors = 0.1, []
    for angle in np.radians(np.linspace(-9.0, 9.0, 19)):
        away = (20.0 + z) * np.array([math.sin(angle), 0.0, -math.cos(angle)])
        out = law(model, np.array([0.0, 0.0, 30.0]) + away)
        assert abs(out[15] - z) <= 0.5 * sag + 1e-3 * z
        force = np.array([out[0], out[2]]) @ [-math.sin(angle), math.cos(angle)]
        errors.append(force / (K * z**1.5) - 1)
    assert np.abs(errors).max() < off


@pytest.mark.parametrize(("facets", "off"), [(120, 0.09), (480, 0.006)])
def test_on_a_round_of_facets_it_is_that_of_two_cylinders(facets: int, off: float, tmp_path: Path) -> None:
    model = made(tmp_path, rod(30.0, facets))
    z, errors = 0.1, []
    for angle in np.radians(np.linspace(-9.0, 9.0, 19)):
        away = (40.0 - z) * np.array([math.sin(angle), 0.0, math.cos(angle)])
        out = law(model, np.array([0.0, 0.0, -30.0]) + away)
        force = np.array([out[0], out[2]]) @ [math.sin(angle), math.cos(angle)]
        errors.append(force / (K * z**1.5) - 1)
    assert np.abs(errors).max() < off


def test_it_gives_back_what_it_stores(tmp_path: Path) -> None:
    """The force is the gradient of the energy: over facets, in a groove, beside an edge, in a corner of two
    faces."""
    trough = prism([(-20, -8), (20, -8), (0, -0.5), (-20, 14)], 60)
    for solid, places in (
        (hollow(30.0, 24), [(0.3, 10.08), (2.0, 9.95), (-4.1, 9.8)]),
        (flat(), [(60.5, 9.9), (62.0, 9.4), (59.8, 9.95)]),
        (trough, [(3.0, 8.2), (0.0, 9.3), (4.0, 7.5)]),
    ):
        model = made(tmp_path, solid)
        touched = 0
        for x, z in places:
            at = np.array([x, 0.0, z])
            out = law(model, at)
            touched += out[12] > 0.0
            for axis in (0, 2):
                step = 1e-6 * np.eye(3)[axis]
                slope = (law(model, at + step)[13] - law(model, at - step)[13]) / 2e-6
                assert out[axis] == pytest.approx(-slope, rel=1e-4, abs=1e-5 * max(out[12], 1e-3))
        assert touched >= 2


def test_an_edge_that_comes_in_counts_at_least_five_sixths_of_its_depth(tmp_path: Path) -> None:
    model = made(tmp_path, flat())
    for aside in (0.5, 2.0, 4.0, 6.0):
        deep = 0.1
        at = np.array([60.0 + aside, 0.0, math.sqrt((RADIUS - deep) ** 2 - aside**2)])
        found = law(model, at)[15]
        assert 0.82 * deep <= found <= 1.01 * deep


# -- runs


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("analysis", ["static", "transient"])
@pytest.mark.parametrize("shape", ["flat", "hollow", "round"])
def test_a_pressed_roller_rests_on_a_mesh(shape: str, analysis: str, solver: str, tmp_path: Path) -> None:
    solid = {"flat": flat(), "hollow": hollow(30.0, 161), "round": rod(30.0, 480)}[shape]
    model = made(tmp_path, solid, f"run.analysis={analysis}", more=press(), gravity=DOWN)
    assert model.contacts.kind.tolist() == [CYLINDER_MESH]
    result = solved(model, solver)
    z = depth(N + 1.001 * MASS * G)
    rel = 1e-4 if shape == "flat" else 5e-3
    assert 10.0 - result.position[-1, model.roller("r").body, 2] == pytest.approx(z, rel=rel)
    assert result.contact_force[-1, 0] == pytest.approx(K * z**1.5, rel=rel)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_mesh_brakes_a_roller(solver: str, tmp_path: Path) -> None:
    """omega = omega_0 - mu N R t/I, as on a plane."""
    sunk = 0.04
    model = made(
        tmp_path, flat(), "run.step=0.02 ms", more=spun(60.0), center=f"[0 mm, 0 mm, {10 - sunk} mm]"
    )
    result = solved(model, solver)
    omega = result.spin[:, model.roller("r").body, 1]
    slows = 0.3 * K * sunk**1.5 * RADIUS / (0.5 * MASS * RADIUS**2)
    turning = result.time > 0.2
    slope = np.polyfit(result.time[turning], omega[turning], 1)[0]
    assert slope == pytest.approx(-slows, rel=2e-4)


# -- what is written, and what is refused


def test_text_and_deck_say_the_contact(tmp_path: Path) -> None:
    (tmp_path / "part.stl").write_bytes(binary(*flat()))
    (tmp_path / "scene.yaml").write_text(scene(PART, press()))
    spec = load(tmp_path / "scene.yaml")
    model = lower(spec)
    text = emitter("motionview").emit(model)
    assert '*Contact( con_r_part, "Roller r / Mesh part", POISSON' in text
    assert "1, gcyl_r, false" in text and "1, gcad_part, false" in text
    assert verify(spec, model, perturb=False).ok


def test_what_is_not_modelled_is_refused(tmp_path: Path) -> None:
    (tmp_path / "part.stl").write_bytes(binary(*flat()))
    file = tmp_path / "scene.yaml"
    file.write_text(scene(PART, "rim: {sectors: [{from: 0 deg, to: 90 deg, friction: 2}]}"))
    with pytest.raises(SpecError, match="a mesh meets round rollers only"):
        load(file)
    other = "  q: {center: [0 mm, 0 mm, -30 mm], axis: y, radius: 5 mm, width: 9 mm, mass: 1 g}\nmeshes"
    file.write_text(scene(PART).replace("meshes", other).replace("part.stl}", "part.stl, on: q, mass: 1 g}"))
    with pytest.raises(SpecError, match="part is on a roller, and such a mesh touches sheets only"):
        load(file)

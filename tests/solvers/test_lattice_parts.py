"""Parts of the fast solver: folded bushings, and which pairs are near."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest

import mdlgen
from mdlgen.backends.lattice.arrays import System, build
from mdlgen.backends.lattice.kernels import entries, forces, tuning
from mdlgen.backends.lattice.kernels.integrate import room
from mdlgen.mechanics.bushing import bushing, bushing_pair
from mdlgen.mechanics.frame import Frame, Motion
from mdlgen.mechanics.vector import exp_rotation
from mdlgen.model.lower import lower
from mdlgen.model.tables import BOX_CYLINDER, Model
from mdlgen.paths import samples
from mdlgen.spec.load import load, loads

pytestmark = pytest.mark.usefixtures("as_python")


def model(name: str, *overrides: str) -> Model:
    return lower(load(samples() / f"{name}.yaml", overrides))


@pytest.mark.parametrize("angle", [1e-6, 1e-3, 0.5, 2.5])
def test_a_folded_pair_of_bushings_has_the_forces_of_the_two(angle: float) -> None:
    rng = np.random.default_rng(3)

    def vector(scale: float = 1.0) -> np.ndarray:
        return scale * rng.normal(size=3)

    def plain(values: np.ndarray) -> tuple[float, ...]:
        return tuple(float(v) for v in np.ravel(values))

    def turned(v: np.ndarray) -> np.ndarray:
        return np.array(exp_rotation(plain(v))).reshape(3, 3)

    xa, va, wa, xb, vb, wb, ra, rb, e = (vector() for _ in range(9))
    fa = turned(vector())
    fb = turned(angle * vector() / 2) @ fa
    k, kt, c, ct = (rng.uniform(1, 5, 3) for _ in range(4))
    two, as_stiff = np.zeros(11), 0.0
    for sign in (1.0, -1.0):
        force, on_b, on_a, energy, power = bushing(
            Frame(*(plain(v) for v in (xa, fa, va, wa))),
            plain(fa @ (ra + sign * e)),
            Frame(*(plain(v) for v in (xb, fb, vb, wb))),
            plain(fb @ (rb + sign * e)),
            *(plain(v) for v in (k, kt, c, ct)),
        )
        two += np.array([*force, *on_b, *on_a, energy, power])
        as_stiff += bushing(
            Frame(*(plain(v) for v in (xa, fa, va, wa))),
            plain(fa @ (ra + sign * e)),
            Frame(*(plain(v) for v in (xb, fb, vb, wb))),
            plain(fb @ (rb + sign * e)),
            *(plain(v) for v in (k, kt, k, kt)),
        )[4]
    force, on_b, on_a, energy, power, _, _, per_time = bushing_pair(
        Frame(*(plain(v) for v in (xa, fa, va, wa))),
        plain(fa @ ra),
        Frame(*(plain(v) for v in (xb, fb, vb, wb))),
        plain(fb @ rb),
        plain(e),
        *(plain(2 * v) for v in (k, kt, c, ct)),
    )
    folded = np.array([*force, *on_b, *on_a, energy, power])
    assert np.abs(folded - two).max() <= 1e-13 * np.abs(two).max()
    assert per_time == pytest.approx(as_stiff, rel=1e-13)


def into_rollers(system: System, x: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Whether the corners or the middles of the sides of a box, or of its faces, are in a roller, of each
    pair."""
    found = np.zeros(len(system.pairs), bool)
    points = np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))
    for p in np.flatnonzero(system.pairs["kind"] == BOX_CYLINDER):
        box, roller = (system.bodies[system.pairs[p][end]] for end in "ab")
        a, b = system.pairs[p]["a"], system.pairs[p]["b"]
        out = x[a] + (points * box["half"]) @ r[a].reshape(3, 3).T - x[b]
        along = out @ roller["axis"]
        off = np.linalg.norm(out - along[:, None] * roller["axis"], axis=1)
        found[p] = ((off < roller["size"][0]) & (np.abs(along) < 0.5 * roller["size"][1])).any()
    return found


def test_what_touches_after_a_step_was_near_before_it() -> None:
    system = build(mdlgen.lower(load(samples() / "transport_4x4.yaml")))
    rng = np.random.default_rng(3)
    state, mid, _ = room.empty(system, forces.WIDE)
    model = mdlgen.lower(load(samples() / "transport_4x4.yaml"))
    count, ahead = len(model.bodies.name), 0.25
    x, r, motion, near = state.x, state.r, mid.motion, mid.near
    seen = 0
    for _ in range(20):
        x[:count], r[:count] = model.bodies.position, model.bodies.rotation.reshape(-1, 9)
        r[count] = np.eye(3).ravel()
        motion.x[:], motion.r[:] = x, r
        x[system.nodes, 2] += rng.uniform(-0.1, 0.6, len(system.nodes))
        u = state.u
        u[:, :3] = rng.normal(size=(len(u), 3)) * (1.4, 0.2, 1.4)
        u[:, 3:] = rng.normal(size=(len(u), 3)) * 0.1
        forces.place(system.tables, ahead, 0.0, state, motion)
        begun = Motion(x, r, motion.u, motion.w)
        close = forces.near_pairs(system.tables, begun, tuning.FAR, ahead, near)
        listed = set(near[:close].tolist())
        assert close < 0.7 * len(system.pairs)
        still = np.zeros_like(x)
        many = entries.contacts(system.tables, Motion(motion.x, motion.r, still, still), mid)
        sure = set(np.flatnonzero(into_rollers(system, motion.x, motion.r)).tolist())
        assert sure and sure <= listed
        assert set(mid.touched[:many].tolist()) <= listed
        seen += many
    assert seen > 500


OVER_AN_EDGE = """
name: over
materials: {p: {E_md: 3000 MPa, E_cd: 1500 MPa}}
sheets: {n: {material: p, size: [6.8 mm, 10 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [2, 1]}}
planes:
  t: {normal: z, center: [50 mm, 0 mm, -0.5 mm], size: [100 mm, 90 mm, 1 mm], mass: 1 g, edge_radius: 0.1 mm}
contacts: [{between: [n, t], stiffness: 100 N/mm^1.5, friction: 0}]
run: {duration: 1 ms, margin: 20 mm}
"""


def test_a_box_that_takes_the_edge_over_from_its_neighbour_is_looked_at() -> None:
    """Its lowest corner is beside the round and above the face yet. (Its force was not stored.)"""
    model = mdlgen.lower(loads(OVER_AN_EDGE, "over"))
    system = build(model)
    state, mid, _ = room.empty(system, forces.WIDE)
    slope, x, r, count = 0.3, state.x, state.r, len(model.bodies.name)
    x[:count], r[:count] = model.bodies.position, model.bodies.rotation.reshape(-1, 9)
    r[count] = np.eye(3).ravel()
    cos, sin = math.cos(slope), math.sin(slope)
    on_edge = np.array([0.1, 0.0, -0.1]) + (0.1 - 0.01 + 0.05) * np.array([-sin, 0.0, cos])
    still = np.zeros_like(x)
    for shift in np.linspace(-0.1, 0.1, 21):
        for node, side in zip(system.nodes, (-1.7, 1.7), strict=True):
            x[node] = on_edge + (shift + side) * np.array([cos, 0.0, sin])
            r[node] = np.array([cos, 0.0, -sin, 0.0, 1.0, 0.0, sin, 0.0, cos])
        mid.forces[:] = 0.0
        entries.contacts(system.tables, Motion(x, r, still, still), mid)
        assert mid.forces[system.nodes, 2].sum() == pytest.approx(100 * 0.01**1.5 * cos, rel=0.03)


def test_bushings_fold_where_two_stand_side_by_side() -> None:
    system = build(model("transport_4x4"))
    assert (len(system.joints), system.folded, system.reach, system.border) == (370, 370, 10, 8)
    central = build(model("transport_4x4", "sheets.note.layout=center_to_center"))
    assert (len(central.joints), central.folded) == (370, 0)

"""A note that is dropped flat onto a table comes to rest, with settings that nobody chose.

While it is flat each of its boxes is a ball of its own mass: it leaves with c times the speed at which it
comes (Eq. 11 with a sharp sign; bench.oracles.impact has what the smoothing speed adds), less what its weight
takes over the greatest depth z on the way out, v1^2 = c^2 (v0^2 + 2 g z) - 2 g z. So it bounces for at most
t = t0 (1 + c)/(1 - c), t0 = sqrt(2 h/g), and rests (m g/k)^(2/3) deep.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.bench.oracles import impact as oracle
from mdlgen.model.lower import lower
from mdlgen.registry import solver
from mdlgen.spec.load import loads

G, K, SMOOTH = 9.81e-3, 100.0, 1e-3  # [mm/ms^2], [N/mm^1.5], [mm/ms]
STIFF = {
    "edge_to_edge": "k_tx: 0.15 N*mm/rad, k_ty: 0.185 N*mm/rad, k_tz: 5 N*mm/rad",
    "center_to_center": "D_md: 0.4 N*mm, D_cd: 0.24 N*mm",
    "plate": "D_md: 0.4 N*mm, D_cd: 0.24 N*mm",
}


def landed(height, c, boxes="[5, 10]", layout="edge_to_edge", time=150.0):
    """The note of transport_4x4, `height` [mm] above a table."""
    text = f"""
name: landing
materials: {{eur10: {{E_md: 3530 MPa, E_cd: 1113 MPa, {STIFF[layout]}}}}}
sheets:
  note: {{material: eur10, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: {boxes},
          layout: {layout}, center: [0 mm, 0 mm, {height + 0.05!r} mm]}}
planes: {{table: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [227 mm, 300 mm, 10 mm], mass: 681 g}}}}
contacts: [{{between: [note, table], stiffness: 100 N/mm^1.5, restitution: {c}, friction: 0.3}}]
run: {{duration: {time!r} ms, print_step: 0.5 ms}}
"""
    return mdlgen.solve(lower(loads(text)), "lattice")


def bounced(height, c, time, mass):
    """Height of a ball of Eq. 11 at times [ms]; nan within its contacts. And the ratio of the speeds at which
    it leaves for the first time and at which it came."""
    speed, at = math.sqrt(2 * G * height), math.sqrt(2 * height / G)
    found = np.where(time < at, height - 0.5 * G * time**2, np.nan)
    first = None
    while speed > 2e-2 and at < time[-1]:
        hit = oracle.impact(mass, K, speed, c, SMOOTH)
        lifted = 2.0 * G * hit.depth / speed**2
        left = math.sqrt(max(hit.restitution**2 * (1.0 + lifted) - lifted, 0.0))
        first = left if first is None else first
        speed, at = left * speed, at + hit.time
        since = time - at
        found = np.where((since > 0.0) & (since < 2 * speed / G), speed * since - 0.5 * G * since**2, found)
        at += 2 * speed / G
    assert first is not None
    return found, first


@pytest.mark.parametrize("c", [0.0, 0.2, 0.5, 0.8])
@pytest.mark.parametrize("height", [1.0, 3.0, 10.0])
def test_a_note_that_falls_flat_comes_to_rest(height, c):
    fall = math.sqrt(2 * height / G)
    last = fall * (1 + c) / (1 - c)
    result = landed(height, c, time=math.ceil(min(last, 200.0) + 40.0))
    assert as_asked(result), result.status
    assert result.error_estimate is not None and result.error_estimate <= 1e-3
    count = result.model.sheets[0].count
    z, v = result.position[:, :count, 2] - 0.05, result.velocity[:, :count, 2]
    # no box ever has more energy than at the start: in flight, since contacts store some of it
    free = z.min(axis=1) > 0.0
    energy = (G * z + 0.5 * v**2).mean(axis=1) / (G * height)
    assert energy[free].max() < 1.0 + 2e-3
    # the first rebound, by the energy in flight: what one impact may make goes with tolerance and c
    exact, left = bounced(height, c, result.time, 0.72 / count)
    hop = free & (result.time > fall) & (result.time < fall + max(left, 0.1) * fall)
    if hop.any():
        assert math.sqrt(energy[hop].mean()) == pytest.approx(left, abs=1.5e-3 if c >= 0.2 else 2e-2)
    else:
        assert left == 0.0
    first = ~np.isnan(exact) & (result.time < fall * (1 + 2 * c + 2 * c**2)) & free
    assert np.abs(z.mean(axis=1) - exact)[first].max() < 5e-3 * height
    if last > 200.0:
        return
    # at rest, where it has bounced for as long as the sum has it
    mass = 0.72 / count
    still = result.time > last + 20.0
    assert still.sum() > 10
    assert np.abs(v[still]).max() < 1e-3
    assert z[still] == pytest.approx(-((mass * G / K) ** (2 / 3)), abs=1e-5 if c < 0.8 else 1e-3)
    before = (result.time > fall) & (result.time < last - 6.0)
    assert not before.any() or z[before].max() > 2e-3


@pytest.mark.parametrize("layout", ["plate", "center_to_center"])
def test_it_comes_to_rest_whatever_its_joints_are(layout):
    result = landed(3.0, 0.5, layout=layout, time=120.0)
    assert as_asked(result), result.status
    z = result.position[-1, :50, 2] - 0.05
    assert z == pytest.approx(-((0.72 / 50 * G / K) ** (2 / 3)), abs=1e-5)


def test_steps_are_short_in_impacts_alone():
    """Some fifty steps in each of a dozen impacts, on top of what the flight takes."""
    result = landed(3.0, 0.5, time=150.0)
    base = 150.0 / result.step
    assert as_asked(result) and base < result.steps < base + 1500


def test_a_block_at_a_step_of_the_users_own_bounces_right():
    """A contact of 0.1 ms between two steps of 1 ms."""
    result = landed(3.0, 0.7, boxes="[1, 1]", time=60.0)
    assert as_asked(result), result.status
    for step in (1.0, 0.1):
        forced = solver("lattice").solve(result.model, step=step)
        assert as_asked(forced), forced.status
        assert forced.position[-1, 0, 2] == pytest.approx(result.position[-1, 0, 2], abs=0.05)

"""Bent channels drawn at random, which a nip pushes a sheet through and out of.

    python tests/helpers/channels.py 30 1

runs 30 of them, seed 1, with default settings, and prints what fails, and how much energy each run made or
lost.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator

import numpy as np

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

SCENE = """
name: channel_{n}
materials: {{p: {{E_md: {e_md:.0f} MPa, E_cd: {e_cd:.0f} MPa, D_md: {d_md:.4g} N*mm, D_cd: {d_cd:.4g} N*mm}}}}
sheets:
  n: {{material: p, size: [{long:.1f} mm, {wide:.1f} mm], thickness: {thick:.2f} mm,
      grammage: {weight:.0f} g/m^2, boxes: [{boxes}, {rows}],
      layout: edge_to_edge, center: [0 mm, 0 mm, 0 mm]}}
nips:
  in:
    at: [{nip:.1f} mm, 0 mm, 0 mm]
    force: {force:.1f} N
    lower: {{radius: 8 mm, width: 30 mm, mass: 15 g,
            drive: {{surface_speed: {speed:.0f} mm/s, direction: +x, ramp: 3 ms}},
            contact: {{stiffness: 500 N/mm^1.5, friction: 0.9}}}}
    upper: {{radius: 6 mm, width: 30 mm, mass: 8 g, press: {{stiffness: 0.5 N/mm}},
            contact: {{stiffness: 500 N/mm^1.5, friction: 0.3}}}}
    contact: {{stiffness: 500 N/mm^1.5, friction: 0.3}}
guides:
  outer: {{arc: {{center: [{x:.2f} mm, 0 mm, {z:.2f} mm], axis: -y, radius: {outer:.2f} mm, from: -90 deg,
          to: {end:.0f} deg, side: inside}}, width: 70 mm}}
  inner: {{arc: {{center: [{x:.2f} mm, 0 mm, {z:.2f} mm], axis: -y, radius: {inner:.2f} mm, from: -90 deg,
          to: {end:.0f} deg, side: outside}}, width: 70 mm}}
contacts:
  - {{between: [n, [outer, inner]], stiffness: {k:.0f} N/mm^1.5, friction: {mu:.2f}, restitution: 0.3,
     smoothing: 5 mm/s}}
run: {{duration: {time:.0f} ms, margin: 40 mm}}
"""


def channels(count: int, seed: int) -> Iterator[str]:
    """Scenes of channels of all radii, gaps, lengths and angles, and of papers and cards in them."""
    random = np.random.default_rng(seed)
    for n in range(count):
        thick, long, boxes = random.uniform(0.08, 0.25), random.uniform(50, 90), int(random.integers(10, 24))
        e_md = random.uniform(2500, 4500)
        d_md = e_md * thick**3 / 12
        gap, middle = random.uniform(max(0.6, 4 * thick), 3.0), random.uniform(14, 60)
        turn, speed = random.uniform(20, 120), random.uniform(400, 1500)
        nip = random.uniform(0.2, 0.35) * long
        x = max(0.5 * long, nip) + random.uniform(3, 8)
        outer = middle + 0.5 * gap
        # the sheet comes in between both faces, and the run ends as all of it is out
        z = outer - random.uniform(0.35, 0.65) * gap
        way = x - nip + middle * math.radians(turn) + long
        yield SCENE.format(
            n=n,
            e_md=e_md,
            e_cd=0.5 * e_md,
            d_md=d_md,
            d_cd=0.5 * d_md,
            long=long,
            wide=random.uniform(35, 65),
            thick=thick,
            weight=800 * thick,
            boxes=boxes,
            rows=int(random.integers(1, 4)),
            nip=nip,
            force=random.uniform(2, 6),
            speed=speed,
            x=x,
            z=z,
            outer=outer,
            inner=middle - 0.5 * gap,
            end=turn - 90,
            k=10 ** random.uniform(1.5, 3),
            mu=random.uniform(0.05, 0.3),
            time=min(way / speed * 1e3, 120.0),
        )


def study(count: int, seed: int) -> int:
    """Runs them, prints a line each, and returns how many have no result."""
    failed = 0
    for text in channels(count, seed):
        scene = loads(text)
        result = mdlgen.solve(lower(scene), "lattice")
        failed += not result.ok
        energy = result.energy
        print(f"{scene.name}: {result.status}, energy {100 * energy.balance_error:.3f} %", flush=True)
    return failed


if __name__ == "__main__":
    COUNT, SEED = (int(word) for word in (*sys.argv[1:], "30", "1")[:2])
    print(f"{study(COUNT, SEED)} of {COUNT} without a result")

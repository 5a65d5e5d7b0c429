"""Bending of sheets: guessed from the modulus, rolled up, swinging, in all layouts."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.checks import lints
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import load
from mdlgen.verify.verification import verify

CANTILEVER, ROLLUP = samples() / "cantilever.yaml", samples() / "verify" / "rollup.yaml"
GUESSED = ("materials.eur10.D_md=null", "materials.eur10.D_cd=null")


def model(path, *overrides):
    return lower(load(path, overrides))


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center", "plate"])
def test_bending_that_nobody_gave_is_that_of_a_solid_plate(layout: str) -> None:
    layout = f"sheets.note.layout={layout}"
    guessed = model(CANTILEVER, *GUESSED, layout)
    d_md, d_cd = 3530 * 0.1**3 / 12, 1113 * 0.1**3 / 12
    given = model(
        CANTILEVER, f"materials.eur10.D_md={d_md!r} N*mm", f"materials.eur10.D_cd={d_cd!r} N*mm", layout
    )
    assert np.allclose(guessed.bushings.k, given.bushings.k, rtol=1e-14)
    assert "W116" in {lint.code for lint in lints(guessed)}
    assert "W116" not in {lint.code for lint in lints(given)}


@pytest.mark.parametrize("layout", ["edge_to_edge", "plate"])
def test_the_text_guesses_too(layout: str) -> None:
    scene = load(CANTILEVER, (*GUESSED, "sheets.note.boxes=[2,3]", f"sheets.note.layout={layout}"))
    found = verify(scene, lower(scene))
    assert found.ok, found.all_differences()[:3]


@pytest.mark.parametrize(
    ("boxes", "solver"),
    [("[20,1]", "lattice"), ("[40,2]", "lattice"), ("[8,1]", "exudyn"), ("[20,1]", "exudyn")],
)
def test_the_end_moment_closes_the_strip(boxes: str, solver: str) -> None:
    """On any grid: rigid boxes turn by the same angle at each hinge, and half of it at the clamp."""
    result = mdlgen.solve(model(ROLLUP, f"sheets.strip.boxes={boxes}"), solver)
    assert as_asked(result), result.status
    tip = result.summary()["probes"]["tip"]["displacement_mm"]
    assert tip == pytest.approx([-200.0, 0.0, 0.0], abs=1e-6 * 200)


def test_the_lowest_frequency_of_a_cantilever() -> None:
    """1.855428 Hz for D = 0.242 N mm; a lattice of 20 boxes is 0.115 % below it (oracles), 0.3 % allowed.

    The strip starts with the velocity of the mode, so that hardly anything else moves; its hinges are not
    damped, and what the integration damps falls with its step.
    """
    m = model(
        CANTILEVER,
        "sheets.note.boxes=[1,20]",
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        "materials.eur10.D_md=0.242 N*mm",
        "materials.eur10.D_cd=0.242 N*mm",
        "materials.eur10.damping={ratio: 0}",
        "run={analysis: transient, duration: 560 ms, print_step: 1 ms, step: 0.5 ms}",
        "sheets.note.velocity=[0 m/s, 0 m/s, 1e-3 m/s]",
    )
    y = (m.bodies.position[:20, 1] - m.bodies.position[0, 1] + 3.175) / 127.0
    beta = 1.875104068711961
    part = (math.sinh(beta) - math.sin(beta)) / (math.cosh(beta) + math.cos(beta))
    shape = np.cosh(beta * y) - np.cos(beta * y) - part * (np.sinh(beta * y) - np.sin(beta * y))
    velocity = m.bodies.velocity.copy()
    velocity[:20, 2] = 1e-3 * shape
    slope = np.gradient(shape, y * 127.0)
    spin = m.bodies.spin.copy()
    spin[:20, 0] = 1e-3 * slope
    result = mdlgen.solve(replace(m, bodies=replace(m.bodies, velocity=velocity, spin=spin)), "lattice")
    assert as_asked(result), result.status
    lift = (result.position[:, :20, 2] - m.bodies.position[:20, 2]) @ shape
    signs = np.flatnonzero(np.diff(np.sign(lift[1:])) != 0) + 1
    crossings = [
        result.time[k] + (result.time[k + 1] - result.time[k]) * lift[k] / (lift[k] - lift[k + 1])
        for k in signs
    ]
    # from the start, through zero at half a period and at a whole one
    assert len(crossings) == 2
    assert 1e3 / crossings[1] == pytest.approx(1.855428, rel=3e-3)

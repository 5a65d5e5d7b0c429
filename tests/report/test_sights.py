"""Sensors as the page draws them in space: where they see along, and when they are covered."""

from __future__ import annotations

import numpy as np
import pytest

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.report.animation import animation, at_the_start
from mdlgen.report.html.labels import labels
from mdlgen.report.sights import covered, sights
from mdlgen.results.begun import begun_of

LINE = {"line": [["70 mm", "-9 mm", "3 mm"], ["70 mm", "9 mm", "3 mm"]], "direction": "-z", "reach": "6 mm"}


def model(**changes: object):
    return lower(mdlgen.load("samples/register.yaml").with_(changes))


def test_a_rod_goes_where_a_sensor_sees() -> None:
    ((sensor, beam),) = sights(model())
    assert sensor.name == "eye"
    low, high = beam.points.min(axis=0), beam.points.max(axis=0)
    assert (low[2], high[2]) == pytest.approx((-5.0, 5.0))
    assert 0.5 * (low + high)[:2] == pytest.approx((70.0, 0.0), abs=1e-9)
    ((_, outline),) = sights(model(**{"sensors.eye": LINE}))
    thick = np.ptp(beam.points[:, 0])
    assert np.ptp(outline.points, axis=0) == pytest.approx((0.0, 18.0, 6.0), abs=1.01 * thick)


def test_the_page_knows_when_each_was_covered() -> None:
    own = model()
    run = begun_of(own)
    run.time = np.array([90.0])
    times = ((20.0, "covered"), (50.0, "cleared"), (70.0, "covered"))
    run.reactions = tuple({"time_ms": t, "kind": kind, "sensor": "eye", "sheet": "note"} for t, kind in times)
    assert covered(run, "eye") == [[20.0, 50.0], [70.0, 90.0]] and covered(run, "ear") == []
    drawn = next(mesh for mesh in animation(run, np.array([0]), {})["meshes"] if mesh["kind"] == "sensor")
    assert (drawn["name"], drawn["spans"]) == ("eye", [[20.0, 50.0], [70.0, 90.0]])
    assert [m["spans"] for m in at_the_start(own, [])["meshes"] if m["kind"] == "sensor"] == [[]]
    part = next(part for part in labels(own)["parts"] if part["name"] == "eye")
    assert (part["kind"], part["at"], part["facts"]) == ("sensor", [70.0, 0.0, 0.0], ["a beam, 10 mm long"])

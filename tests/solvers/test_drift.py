"""What is known of pairs of boxes without a look: that it is what a look would find."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.integrate import passes
from mdlgen.backends.lattice.integrate.passes import Watch
from mdlgen.backends.lattice.kernels.state import MANY, MIDDLE, Workspace
from mdlgen.backends.lattice.kernels.tuning import FAR
from mdlgen.backends.lattice.search import many_searched
from mdlgen.mechanics.frame import Frame
from mdlgen.mechanics.overlap import APART, OVERLAPS, holds
from mdlgen.paths import samples

STEP = 0.1  # [ms]
SOFT = "{stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 1 mm/s}"
# A pile whose uppermost note slides off, or whose notes come to rest.
PILE = [
    *("piles.cassette.count=4", "sheets.note.boxes=[3,4]", "contacts.pick.between=[cassette_4, pick]"),
    *("probes.lead.sheet=cassette_4", "require=[]", f"piles.cassette.contact={SOFT}", "run.sleep=false"),
    *("contacts.floor.stiffness=100 N/mm^1.5", "run.duration=30 ms", "run.print_step=0.1 ms"),
]
REST = ["rollers.pick.press=null", "rollers.pick.drive=null", "rollers.pick.center=[0 mm, 0 mm, 250 mm]"]
FED = ["rollers.pick.center=[0 mm, 0 mm, 12.8 mm]", "rollers.pick.drive={speed: 25 rad/s, ramp: 10 ms}"]


def frame(work: Workspace, body: int) -> Frame:
    x, r, none = work.mid.motion.x[body], work.mid.motion.r[body], (0.0, 0.0, 0.0)
    return Frame(tuple(x.tolist()), tuple(r.tolist()), none, none)


def near(work: Workspace) -> set[int]:
    """Pairs that are searched and closer than FAR, in the axes of the first box."""
    many = many_searched(work.search)
    one, two = (work.search.listed[end][:many] for end in "ab")
    x, r, half = work.mid.motion.x, work.mid.motion.r.reshape(-1, 3, 3), work.tables.bodies["half"]
    place = np.einsum("kji,kj->ki", r[one], x[two] - x[one])
    turn = np.einsum("kji,kjl->kil", r[one], r[two])
    out = half[one] + np.einsum("kil,kl->ki", np.abs(turn), half[two]) + FAR
    return set((work.search.first + np.flatnonzero((np.abs(place) < out).all(axis=1))).tolist())


@pytest.mark.parametrize("sets", [REST, FED], ids=["rest", "fed"])
def test_what_is_known_holds(sets: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """In the middle of each step: overlaps that were not looked at, and the list of near pairs."""
    model = mdlgen.lower(mdlgen.load(samples() / "pile.yaml", [*PILE, *sets]))
    system = lattice.build(model, fold=True)
    kept: list[Workspace] = []
    make = passes.arrays
    monkeypatch.setattr(passes, "arrays", lambda *args: kept.append(make(*args)) or kept[0])
    known = steps = 0

    def look(*_: Any) -> None:
        nonlocal known, steps
        work, steps = kept[0], steps + 1
        drift, first, listed = work.mid.drift, work.search.first, work.search.listed
        for k in (drift.listed[: int(drift.list_holds[MANY])] - first).tolist():
            own, overlap = listed[k], work.mid.overlaps[k : k + 1].view(np.recarray)[0]
            if overlap.state not in (APART, OVERLAPS) or overlap.look != drift.looks[own["region"]]:
                continue
            known += 1
            if steps % 10 == 0:
                assert holds.py_func(overlap, frame(work, own["a"]), frame(work, own["b"]), 0.0)
        if steps % 50 == 0:
            # velocities of the middle are gone by now: pairs that are near without them
            assert near(work) <= set(drift.listed[: int(drift.list_holds[MANY])].tolist())
        assert np.isfinite(work.mid.fastest[MIDDLE]).all()

    result = lattice.one_pass(model, system, STEP, Watch(progress=look, sleeps=False))
    assert as_asked(result), result.status
    assert steps == 300 and known > 10_000
    looks = kept[0].mid.drift.looks
    # what rests is looked at in few of its steps, what slides in each
    assert looks.min() < 0.6 * steps if sets is REST else looks.max() >= steps

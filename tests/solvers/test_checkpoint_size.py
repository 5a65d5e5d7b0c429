"""What a checkpoint has of arrays that have room."""

from __future__ import annotations

from pathlib import Path

import pytest
from cutting import Cut, Cutting, written_with

import mdlgen
from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.kernels import forces
from mdlgen.paths import samples


def test_room_for_pairs_is_not_kept(tmp_path: Path) -> None:
    """A pile has room for so many pairs that writing all of it would take more memory than a machine has."""
    model = mdlgen.lower(
        mdlgen.load(
            samples() / "pile.yaml", ["piles.cassette.count=20", "run.duration=2 ms", "run.step=0.1 ms"]
        )
    )
    system = lattice.build(model, fold=True)
    room = 2 * len(system.pairs) * forces.WIDE * 8  # bytes, for what each does in a step and in a solve
    with pytest.raises(Cut):
        lattice.solve(model, keep=Cutting(tmp_path / "c", written_with, 3))
    assert (tmp_path / "c" / "pass_0.npz").stat().st_size < 0.1 * room

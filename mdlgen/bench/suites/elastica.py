"""The static drop of a clamped note (paper section 2.2.1) over the rows, against the heavy elastica."""

from __future__ import annotations

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import chain
from mdlgen.bench.oracles import elastica as oracle
from mdlgen.registry import REFERENCE
from mdlgen.results.result import Result

SAMPLE = "cantilever"
# Error of the lattice itself over the drop: 0.77 % at 10 rows for Gamma = 7, second order in the rows;
# twice that for the range of stiffness below.
LATTICE = 1.6
STIFFNESS = ("0.242 N*mm", "0.1 N*mm", "0.5 N*mm")


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """10, 20 and 40 rows of 2 and of 10 columns, and two other stiffnesses."""
    grids = [(2, 10), (2, 20), (2, 40), *(() if quick else ((10, 10), (10, 20), (10, 40)))]
    if solver == REFERENCE:  # 400 boxes would take minutes
        grids = [grid for grid in grids if grid != (10, 40)]
    made = [_case(columns, rows, STIFFNESS[0]) for columns, rows in grids]
    return made + [_case(2, 40, bending) for bending in STIFFNESS[1:]]


def _case(columns: int, rows: int, bending: str) -> BenchCase:
    sets = (f"sheets.note.boxes=[{columns},{rows}]",)
    if bending != STIFFNESS[0]:
        sets = (*sets, f"materials.eur10.D_cd={bending}")
    return BenchCase("elastica", f"{columns} columns, {rows} rows, D {bending}", Run(SAMPLE, sets), drop)


def drop(result: Result, _: Result | None) -> list[Finding]:
    """Drop of the tip against the continuum, and of the lattice against the exact chain."""
    model = result.model
    length, rows = model.sheets[0].size[1], model.sheets[0].n_y
    exact = oracle.drop(oracle.gamma(model)) * length
    found = -float(result.anchor_motion(0)[0][-1, 2])
    link = chain.chain_of(model)
    slope = chain.hang(link)
    own = link.length * float(np.sin(slope).sum())
    return [
        Finding(
            "drop of the tip, over that of the heavy elastica",
            abs(found / exact - 1),
            LATTICE / rows**2,
            {"drop_mm": found, "elastica_mm": exact, "chain": abs(found / own - 1)},
        )
    ]

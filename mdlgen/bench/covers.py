"""The validation page of rubber covers: `python -m mdlgen.bench.covers > docs/validation/rubber.md`."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mdlgen.bench.oracles.annulus import Nip, Ring, nip
from mdlgen.bench.oracles.rolling import gain
from mdlgen.rubber.contact import Squeezed, loaded
from mdlgen.rubber.hardness import modulus
from mdlgen.rubber.layer import Layer

E = 1.7  # [MPa]
# Radius, thickness, Poisson's ratio, radius of the other roller (inf: a flat face), depth [mm].
CASES = (
    (10.0, 3.0, 0.49, 8.0, 0.10),
    (10.0, 3.0, 0.49, 8.0, 0.20),
    (10.0, 3.0, 0.4999, 8.0, 0.20),
    (10.0, 3.0, 0.3, 8.0, 0.20),
    (10.0, 1.0, 0.4999, 8.0, 0.10),
    (10.0, 5.0, 0.49, 8.0, 0.20),
    (10.0, 3.0, 0.49, math.inf, 0.10),
)
FRICTIONS = (0.1, 0.3, 0.8, math.inf)
HEAD = """# Rubber covers

Made by `python -m mdlgen.bench.covers`. All numbers are of E = 1.7 MPa; lengths are in mm.

## Against finite elements

The nip of `mdlgen/rubber` and a ring of finite elements (`mdlgen/bench/oracles/annulus.py`), at the same
line load. Both have small strains and no friction. The elements have
the true circles of both rollers. The half-width of the elements is known to an element, 0.06 mm.

| R | t | nu | other R | load N/mm | depth, elements | depth, formula | half-width | formula |\
 speed ratio, elements | formula |
|---|---|---|---|---|---|---|---|---|---|---|
"""
ROLLING = """
## Friction in the nip

The speed ratio of a sheet that does not stretch and that rolls without a pull, with Coulomb friction in
the nip (`mdlgen/bench/oracles/rolling.py`), under the pressure without
friction. A run has the first column. The difference to the others is the error of that.

| R | t | nu | without friction | 0.1 | 0.3 | 0.8 | all sticks |
|---|---|---|---|---|---|---|---|
"""
REST = """
Solid rubber of this thickness hardly changes. Thin covers and foam come nearer to 1 where the nip sticks.

## Hardness

| Shore A | E by Gent MPa | E by Ruess MPa |
|---|---|---|
"""
PUBLISHED = """
Gent's relation follows from the durometer: `tests/rubber/test_layer.py` derives it from the spring and
the cone of ASTM D2240. Ruess' relation, lg E = 0.0235 S - 0.6403, is
said to hold from 30 to 60 degrees.

## Published measurements

No table of measured nip widths or speed ratios could be read, so no number is compared with a
measurement. These were found, as abstracts only:

- A. N. Gent, *On the relation between indentation hardness and Young's modulus*, 1958.
- Iizuka and Yamaura, *Analysis of flexible media transport characteristics of crown roller*, ICCES 7
  (2008) 23-42. Their Green's functions are those of a rubber roller with
  a rigid core in polar coordinates, in plane strain, as here. They report that velocity ratios agree
  with experiments.
- JSME, Trans. C, *Analysis of surface strain of a paper in a nip roller mechanics with a rubber-layered
  roller and a steel roller*: the ratio depends on the load, and the strain
  of the paper on the nip width alone.
- JSME MIPE 2009, 143: measured velocity ratios of a short rubber roller on a flat plate; soft rubber
  needs a friction that depends on the load.
- TAGA 1996, *stripe width versus load for a rubber covered press roller*, with nine sets of measurements
  from 0.13 to 0.46 inch on a roller of 3 inch.
- Rubber covered rolls: Hahn and Levinson (a ring, by Airy's function), Spengos (experiments), Batra
  (1980, large strains), Parish (1958, 1961), Good (2001).

The sign is the known one: a sheet goes faster than the core's surface on nearly incompressible covers,
and slower on compressible ones.
"""


def page() -> str:
    """The page."""
    return (
        HEAD + "".join(_against()) + ROLLING + "".join(_rolling()) + REST + "".join(_hardness()) + PUBLISHED
    )


def _both(case: tuple[float, ...]) -> tuple[Ring, Nip, Squeezed]:
    radius, thickness, nu, other, depth = case
    ring = Ring(radius, thickness, E, nu, 1.0, fine=16, deep=32)
    found = nip(ring, other, depth)
    curvature = 1.0 / radius + (0.0 if math.isinf(other) else 1.0 / other)
    formula = loaded((Layer(E, nu, thickness, radius),), curvature, found.load)
    assert formula is not None, "the cases are narrow"
    return ring, found, formula


def _against() -> Iterator[str]:
    for case in CASES:
        _, found, formula = _both(case)
        cover, other = formula.covers[0], "flat" if math.isinf(case[3]) else f"{case[3]:g}"
        yield (
            f"| {case[0]:g} | {case[1]:g} | {case[2]:g} | {other} | {found.load:.3f} | {found.depth:.3f} | "
            f"{cover.depth:.3f} | {found.half:.2f} | {formula.half:.2f} | {1.0 + found.gain:.4f} | "
            f"{1.0 + cover.gain:.4f} |\n"
        )


def _rolling() -> Iterator[str]:
    for case in CASES[1:5]:
        ring, found, _ = _both(case)
        ratios = " | ".join(f"{1.0 + gain(ring, found, friction):.4f}" for friction in FRICTIONS)
        yield f"| {case[0]:g} | {case[1]:g} | {case[2]:g} | {1.0 + found.gain:.4f} | {ratios} |\n"


def _hardness() -> Iterator[str]:
    for shore in (20, 30, 40, 50, 60, 70, 80):
        other = f"{10.0 ** (0.0235 * shore - 0.6403):.2f}" if 30 <= shore <= 60 else "outside"
        yield f"| {shore} | {modulus(shore):.2f} | {other} |\n"


if __name__ == "__main__":
    print(page(), end="")

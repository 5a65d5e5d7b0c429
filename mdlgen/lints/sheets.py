"""Lints of sheets: their material, boxes and clamps."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.tables import (
    Model,
)

PAPER_MODULUS = (100.0, 20000.0)  # MPa: from tissue to oriented board
DENSITY = (0.05, 20.0)  # g/cm^3: from foam to tungsten
MAX_ASPECT = 5.0  # of a box; a longer one bends in one way much more coarsely than in the other


def modulus(model: Model) -> Iterator[Lint]:
    low, high = PAPER_MODULUS
    names = {s.name for s in model.sheets if s.count > 1}
    for row in model.parameters:
        if row.data_set in names and row.member in ("E_md", "E_cd") and not low <= row.value <= high:
            where = ".".join(map(str, row.path or (row.data_set, row.member)))
            yield Lint(
                "W101",
                where,
                f"{row.value:g} MPa is an unusual modulus for paper ({low:g} to {high:g} MPa)",
                "check the unit (MPa = N/mm^2)",
            )


def aspect(model: Model) -> Iterator[Lint]:
    """A sheet with one box across is meant not to bend that way, so the shape of its boxes is no finding."""
    for sheet in model.sheets:
        if min(sheet.n_x, sheet.n_y) == 1:
            continue
        lengths = 2 * model.bodies.half[sheet.first : sheet.first + sheet.count, :2]
        aspects = np.maximum(lengths[:, 0] / lengths[:, 1], lengths[:, 1] / lengths[:, 0])
        worst = int(np.argmax(aspects))
        (d_x, d_y), aspect = lengths[worst].tolist(), float(aspects[worst])
        if aspect > MAX_ASPECT:
            counts, one = [sheet.n_x, sheet.n_y], [sheet.n_x, sheet.n_y]
            counts[int(d_y > d_x)] = math.ceil(counts[int(d_y > d_x)] * aspect / MAX_ASPECT)
            one[int(d_y > d_x)] = 1
            yield Lint(
                "W102",
                f"sheets.{sheet.name}.boxes",
                f"boxes of {d_x:.3g} mm x {d_y:.3g} mm are {aspect:.3g} times as long as wide",
                f"take {counts} boxes, or {one} where the sheet bends one way only",
            )


def idle_in_plane(model: Model) -> Iterator[Lint]:
    for sheet in model.sheets:
        if sheet.layout == "plate" and sheet.in_plane and sheet.count > 1:
            yield Lint(
                "W115",
                f"sheets.{sheet.name}.layout",
                "k_tz of its material does not act in layout plate, where it follows from E_md and E_cd",
                "leave k_tz out, or take another layout",
            )


def idle_poisson(model: Model) -> Iterator[Lint]:
    coupled = set(model.corners.sheet.tolist())
    for number, sheet in enumerate(model.sheets):
        if "nu_md" in sheet.derived and number not in coupled:
            yield Lint(
                "W141",
                f"sheets.{sheet.name}.boxes",
                f"poisson does not act on {sheet.n_x} x {sheet.n_y} boxes: one row is a strip, free across",
                "take two boxes or more along x and along y, or leave poisson out",
            )


def idle_clamp(model: Model) -> Iterator[Lint]:
    touched = set(model.contacts.part_a)
    for sheet in model.sheets:
        boxes = slice(sheet.first, sheet.first + sheet.count)
        acts = (
            np.any(model.most_gravity)
            or any(sheet.first <= body < sheet.first + sheet.count for body in model.loads.body)
            or np.any(model.bodies.velocity[boxes])
            or np.any(model.bodies.spin[boxes])
            or sheet.name in touched
        )
        if sheet.clamp is not None and not acts:
            yield Lint(
                "W103",
                f"sheets.{sheet.name}.clamp",
                "nothing acts on the clamped sheet: no gravity, load or contact",
                "give gravity, a load or a contact",
            )


def density(model: Model) -> Iterator[Lint]:
    for sheet in model.sheets:
        volume = sheet.outline[0] * sheet.outline[1] * sheet.thickness / 1e3  # cm^3
        density = sheet.derived["m"] * sheet.count / volume
        if not DENSITY[0] <= density <= DENSITY[1]:
            yield Lint(
                "W114",
                f"sheets.{sheet.name}.mass",
                f"{density:.3g} g/cm^3 is not in {DENSITY[0]:g} to {DENSITY[1]:g}; paper has some 0.8 g/cm^3",
                "check the units of mass, size and thickness",
            )


def guessed_bending(model: Model) -> Iterator[Lint]:
    for sheet in model.sheets:
        given = {p.member for p in model.parameters if p.data_set == sheet.name}
        ways = [way for way, names in (("x", {"k_ty", "D_md"}), ("y", {"k_tx", "D_cd"})) if not names & given]
        if ways and sheet.count > 1:
            yield Lint(
                "W116",
                f"sheets.{sheet.name}.material",
                f"bending along {' and '.join(ways)} is guessed from modulus and thickness, E s^3/12; "
                "paper is softer or stiffer by its layers",
                "measure how far it hangs, and let mdlgen calibrate find D_md and D_cd",
            )

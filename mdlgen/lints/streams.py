"""Lints of sheets that come in and leave during a run."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.tables import Floats, Model, SheetPart

_NUMBER = re.compile(r"_0*[1-9]\d*$")


def taken_entry(model: Model) -> Iterator[Lint]:
    """A sheet that comes in where the one before it still is, at the velocity with which that came."""
    late = sorted((s for s in model.sheets if math.isfinite(s.enters)), key=lambda s: s.enters)
    for k, sheet in enumerate(late):
        if sheet.enters == 0.0 or sheet.enters > model.run.duration:
            continue
        for before in late[:k]:
            after = sheet.enters - before.enters
            low, high = _extent(model, before)
            way = after * before.velocity
            own_low, own_high = _extent(model, sheet)
            if (low + way >= own_high).any() or (own_low >= high + way).any():
                continue
            size = float(np.linalg.norm(way))
            yield Lint(
                "W178",
                f"sheets.{sheet.name}.enters",
                f"it comes in at {sheet.enters:g} ms, {after:g} ms after {before.name}, which is {size:.3g} "
                "mm on by then at its own speed and still in its place",
                _later(model, sheet, before, after),
            )
            break


def _later(model: Model, sheet: SheetPart, before: SheetPart, after: float) -> str:
    """The remedy: how much later the sheet could come in."""
    speed = float(np.linalg.norm(before.velocity))
    if speed == 0.0:
        return "give the sheet a velocity, or let the next one come in elsewhere"
    way = before.velocity / speed
    low, high = _extent(model, before)
    own_low, own_high = _extent(model, sheet)
    clear = np.where(way > 0.0, own_high - low, high - own_low)
    times = clear[np.abs(way) > 1e-9] / np.abs(before.velocity[np.abs(way) > 1e-9])
    return f"let it come in {max(after, math.ceil(float(times.min()))):g} ms after that, or later"


def never_there(model: Model) -> Iterator[Lint]:
    """A sheet that comes in after the end of the run, or when a rule says so, of which the scene has none."""
    orders = [order for rule in model.reactions.rules for order in rule.orders]
    called = {sheet for order in orders for sheet in order.sheets}
    for k, sheet in enumerate(model.sheets):
        if math.isnan(sheet.enters) and k in called:
            continue
        if math.isnan(sheet.enters):
            yield Lint(
                "W179",
                f"sheets.{sheet.name}.by_rule",
                "it comes in when a rule says so, and no rule of the scene does",
                "let a rule do it, as do: {enter: NAME}, or give every and count of its stream, or enters",
            )
        elif sheet.enters >= model.run.duration:
            yield Lint(
                "W179",
                f"sheets.{sheet.name}.enters",
                f"it comes in at {sheet.enters:g} ms, and the run ends at {model.run.duration:g} ms",
                "give a longer run.duration, or fewer sheets",
            )


def never_out(model: Model) -> Iterator[Lint]:
    """Planes that no box of a sheet comes beyond, by the bounds in which the run watches them."""
    for sheet in model.sheets:
        boxes = slice(sheet.first, sheet.first + sheet.count)
        low, high = model.pairs.low[boxes], model.pairs.high[boxes]
        reached = [
            bool((high[:, axis] > at).all() if side > 0.0 else (low[:, axis] < at).all())
            for axis, at, side in sheet.out
        ]
        if sheet.out and not any(reached) and not sheet.out_at_rest:
            axis, at, side = sheet.out[0]
            most = float(high[:, axis].min() if side > 0.0 else low[:, axis].max())
            yield Lint(
                "W180",
                f"sheets.{sheet.name}.out",
                f"nothing moves it beyond {'xyz'[axis]} = {at:g} mm in the run: its last box comes to "
                f"{most:.4g} mm at most",
                "give a plane that it passes, or a longer run.duration",
            )


def _extent(model: Model, sheet: SheetPart) -> tuple[Floats, Floats]:
    """Low and high corner of a sheet as it comes in [mm]."""
    boxes = slice(sheet.first, sheet.first + sheet.count)
    reach = np.einsum("nij,nj->ni", np.abs(model.bodies.rotation[boxes]), model.bodies.half[boxes])
    at = model.bodies.position[boxes]
    return (at - reach).min(axis=0), (at + reach).max(axis=0)


def first_of_each(model: Model, found: Iterable[Lint]) -> Iterator[Lint]:
    """The findings, those of sheets of a stream once: of the first of these."""
    numbered = {s.name: _NUMBER.sub("", s.name) for s in model.sheets if _NUMBER.search(s.name)}
    # the first one of a stream does not pass where it comes in at the start, to stay
    passing = {numbered[s.name] for s in model.sheets if s.passes and s.name in numbered}
    streams = {name: stem for name, stem in numbered.items() if stem in passing}
    if not streams:
        yield from found
        return
    names = re.compile(r"\b(" + "|".join(map(re.escape, streams)) + r")\b")
    seen: set[tuple[str, str]] = set()
    for lint in found:
        # such findings differ from sheet to sheet by the number, and by the time at which it comes in
        place = names.sub(lambda word: streams[word[1]], lint.where)
        text = place if place != lint.where else names.sub(lambda word: streams[word[1]], str(lint))
        if (lint.code, text) not in seen:
            seen.add((lint.code, text))
            yield lint

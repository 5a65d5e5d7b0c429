"""Lints over a Model: inputs that are allowed, but probably not meant. Each has a code and a remedy.

A lint is a function in `mdlgen/lints`, a line in CHECKS, and its meaning in `mdlgen/explain.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mdlgen.lints import (
    air,
    contacts,
    cost,
    covers,
    creep,
    damping,
    drives,
    friction,
    gates,
    idle,
    missing,
    over_time,
    parameters,
    planes,
    reactions,
    sheets,
    start,
    streams,
    ways,
    yielding,
)
from mdlgen.lints.lint import Lint
from mdlgen.model.once import Once
from mdlgen.model.tables import Model


def lints(model: Model) -> list[Lint]:
    """All findings, sorted by code and place."""
    return list(_found(model))


@Once
def _found(model: Model) -> list[Lint]:
    found = {lint for check in CHECKS for lint in check(model)}
    ordered = sorted(found, key=lambda lint: (lint.code, lint.where, lint.message))
    return list(streams.first_of_each(model, ordered))


CHECKS: tuple[Callable[[Model], Iterator[Lint]], ...] = (
    sheets.modulus,
    sheets.aspect,
    sheets.idle_in_plane,
    sheets.idle_poisson,
    sheets.idle_clamp,
    contacts.coarse_boxes,
    contacts.deep_nip,
    contacts.deep_stack,
    contacts.smoothing,
    contacts.idle_rolling,
    idle.idle_roller,
    idle.idle_drive,
    idle.untouched,
    missing.unfaced,
    missing.unmet,
    missing.on_each_other,
    idle.free_static,
    start.interference,
    sheets.density,
    sheets.guessed_bending,
    damping.damping,
    parameters.parameters,
    cost.costly,
    ways.against,
    ways.away,
    ways.apart,
    streams.taken_entry,
    streams.never_there,
    streams.never_out,
    planes.sinks,
    planes.crosswise,
    air.no_gas,
    air.still,
    creep.on_slope,
    creep.stopped,
    friction.coarse_scatter,
    drives.weak_motor,
    drives.strong_limiter,
    drives.weak_limiter,
    drives.fast_steps,
    drives.lone_shaft,
    drives.fast_target,
    yielding.coarse,
    yielding.bent_beyond,
    covers.hardness,
    covers.strain,
    covers.wide,
    covers.through,
    reactions.sees_nothing,
    reactions.never,
    reactions.fights,
    reactions.dead_end,
    gates.sweeps,
    gates.through_sheets,
    gates.turned_away,
    gates.unused,
    gates.late,
    gates.unbalanced,
    gates.soft,
    over_time.factors,
    over_time.far_start,
)

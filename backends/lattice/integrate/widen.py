"""A pass that continues after a body has left its bounds: on pairs that are chosen with a wider margin.

The pairs of boxes and parts come first among the pairs, in an order that does not depend on the margin. So
new ones are inserted between the others, and all other data of a step is carried over unchanged. A run that
widens its margin takes the same steps as a run with all pairs from its start.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Concatenate, ParamSpec

import numpy as np

from mdlgen.backends.lattice.arrays import System, build
from mdlgen.backends.lattice.integrate.films import films
from mdlgen.backends.lattice.integrate.there import There
from mdlgen.backends.lattice.integrate.work import bounds_of
from mdlgen.backends.lattice.kernels.state import MANY, Kept, Workspace
from mdlgen.backends.lattice.symmetry.find import find
from mdlgen.backends.lattice.symmetry.mirror import halve
from mdlgen.mechanics.frame import Motion
from mdlgen.model.tables import BOX_BOX, Ints, Model
from mdlgen.results.result import Result

P = ParamSpec("P")

# Arrays of a Midpoint that have a row for each pair; a step fills them before it reads them.
OF_PAIRS = ("touched", "results", "rows", "faces", "near", "does", "lies")


class UnhalvedError(Exception):
    """Raised where a scene with the pairs of this Model is not its own mirror image: boxes reach parts on the
    other side."""

    def __init__(self, model: Model):
        super().__init__()
        self.model = model


def begins_again(
    one: Callable[Concatenate[Model, System, P], Result],
) -> Callable[Concatenate[Model, System, P], Result]:
    """Wraps a pass of a halved scene: it begins again with both sides where a wider margin requires it."""

    @wraps(one)
    def either(model: Model, system: System, *args: P.args, **named: P.kwargs) -> Result:
        try:
            return one(model, system, *args, **named)
        except UnhalvedError as found:
            wide = found.model
        return one(wide, _built(wide, system), *args, **named)

    return either


def _built(model: Model, like: System) -> System:
    """The System of a Model, with its bushings folded as in `like`."""
    return build(model, fold=like.folded > 0)


def system_of(model: Model, like: System) -> System:
    """The System of a Model that differs by its pairs, halved as `like`. Raises UnhalvedError."""
    whole, mirror = _built(model, like), like.mirror
    if mirror is None:
        return whole
    found = find(model, whole)
    if found is None or found.at != mirror.at or not np.array_equal(found.normal, mirror.normal):
        raise UnhalvedError(model)
    return halve(whole, found)


def places(old: System, new: System) -> Ints:
    """Places of the pairs of boxes and parts of one System among those of the other."""
    mine, other = (_keys(s.pairs[: s.search.first], len(s.bodies)) for s in (old, new))
    order = np.argsort(other)
    return order[np.searchsorted(other[order], mine)]


def _keys(pairs: np.ndarray, bodies: int) -> Ints:
    return (pairs["row"] * bodies + pairs["a"]) * bodies + pairs["b"]


def marks_of(marks: np.ndarray, old: Model, new: Model) -> np.ndarray:
    """The marks of the pairs that have touched, by the numbers that pairs have in the new Model."""
    count = len(old.bodies.name)
    keys = []
    for model in (old, new):
        pairs = model.pairs
        listed = model.contacts.kind[pairs.contact] != BOX_BOX
        keys.append(((pairs.contact * count + pairs.a) * count + pairs.b)[listed])
    before, after = keys
    order = np.argsort(after)
    at = order[np.searchsorted(after[order], before)]
    moved = np.zeros(len(marks) - len(before) + len(after), bool)
    moved[at] = marks[: len(before)]
    moved[len(after) :] = marks[len(before) :]  # of pairs of boxes, which no margin chooses
    return moved


def besides(whole: System, beside: np.ndarray, at: Ints, motion: Motion) -> np.ndarray:
    """Memory of pairs of boxes and parts: unchanged for those at the numbers `at`, from the state for new
    ones."""
    from mdlgen.backends.lattice.kernels import entries

    pairs = whole.pairs[: whole.search.first].copy()
    entries.remember(whole.bodies, pairs, whole.tables.shapes, motion)
    pairs["beside"][at] = beside
    return pairs["beside"].copy()


def carried_over(model: Model, work: Workspace, system: System, there: There, marks: np.ndarray) -> Workspace:
    """The workspace with the pairs of this System; all other arrays are carried over."""
    from mdlgen.backends.lattice.kernels import entries, forces
    from mdlgen.backends.lattice.kernels.integrate import room

    _, blank, _ = room.empty(system, forces.WIDE)
    drift, many = work.mid.drift, len(system.pairs)
    drift.listed[: int(drift.list_holds[MANY])] += system.search.first - work.search.first
    condensed = work.condensed._replace(
        mine=np.zeros(many, np.int64),
        seen=np.zeros(many, np.bool_),
        looked=np.zeros_like(work.condensed.looked),  # a step lists its pairs before it reads them
        touched=np.zeros(many, np.int64),
        results=np.zeros((many + 1, forces.WIDE)),
    )
    entries.look(system.pairs, system.search, work.search.place.copy())
    film = films(model, system)
    return work._replace(
        tables=system.tables,
        mid=work.mid._replace(**{name: getattr(blank, name) for name in OF_PAIRS}),
        condensed=condensed,
        kept=Kept(work.kept.rows, marks),
        bounds=bounds_of(model, there),
        search=system.search,
        frozen=room.frozen(system, len(film.cells)),
        film=film,
    )

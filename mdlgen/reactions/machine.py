"""A machine along a run: the times at which its sensors are read, their readings, the rules that act, and on
which parts.

A solver asks `ahead` up to which time it may step, and reports the time it is at by `look`. A step ends where
the edge of a sensor, or a condition on places, is predicted from the current velocities. With an acceleration
a that is off by a h^2 / 2, second order in the step h. An event that was not predicted is found within the
step that passed it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.conditions import CLOCK, condition
from mdlgen.formulas import Amount
from mdlgen.model.tables import Model, Order
from mdlgen.reactions.known import of_states
from mdlgen.reactions.sensing import FAR, Eye, Passing, Poses, between
from mdlgen.reactions.sight import Sight
from mdlgen.reactions.stays import Stays
from mdlgen.reactions.wording import in_words
from mdlgen.units import PER_SECOND

# An event less than this part of a step ahead counts as reached: times are found to that accuracy
# (convention; the time of an event is wrong by less than this part of what the step does to it).
SOON = 1e-3
# A sheet is skipped while it could not reach a sensor at twice the speed of the fastest part and twice the
# acceleration of gravity (convention: a still faster sheet is found within the steps that passed it).
SAFE = 2.0
HALVINGS = 24  # of a step, to a time within it: to 6e-8 of it
# Times that rules at one time may set off each other: more go in a circle (convention).
MOST_AT_ONCE = 100
# Steps ahead at most to which a condition of times alone is looked at, and in which a sensor is not looked at
# (convention: a look costs as much as a small step, so a part of it then).
AHEAD = 64
_PLAIN = ("true", "fired", "state", "ended", "timed")  # what of a stage is kept as it is


class RunawayError(Exception):
    """Rules set off each other at one time, without an end."""


class _Edge(NamedTuple):
    """A change of a sensor: its number, the time [ms], and the poses of the sheet there."""

    eye: int
    sheet: int
    time: float
    poses: Poses


@dataclass
class _Stage:
    """All that changes along a run."""

    sights: list[Sight]
    true: list[bool]  # true if each rule held at its last evaluation
    fired: list[int]  # how often each acted
    state: str
    pending: list[tuple[float, int]] = field(default_factory=list)  # times [ms] and rules that are due then
    ended: bool = False
    timed: float = 0.0  # up to when no condition of times alone changes [ms], unless something else does


class Machine:
    """Sensors and rules of a Model along one pass of a run."""

    def __init__(self, model: Model, slowest: float):
        """`slowest`: a speed that sheets are looked for with at least [mm/ms]."""
        table = model.reactions
        self._model, self._slowest = model, slowest
        self._gravity = float(np.linalg.norm(model.gravity))
        self._eyes = [Eye(model, sensor) for sensor in table.sensors]
        self._number = {sensor.name: k for k, sensor in enumerate(table.sensors)}
        self._rules = table.rules
        self._conditions = [condition(rule.when) for rule in table.rules]
        self._amounts = {name: Amount(value, dimension) for name, value, dimension in table.amounts}
        self._amounts["pi"] = Amount(math.pi, (0.0, 0.0, 0.0, 0.0))
        self._of_states = of_states(model)
        named = [set(c.expression.names) for c in self._conditions]
        self._moving = [k for k, names in enumerate(named) if names & self._of_states.keys()]
        clocked = [any(n == CLOCK or n.endswith(".since") for n in names) for names in named]
        self._clocked = [k for k, timed in enumerate(clocked) if timed and k not in self._moving]
        self._turning = {part.name for part, moving in model.gates if moving.turns}
        count = len(self._rules)
        self._stage = _Stage([Sight() for _ in self._eyes], [False] * count, [0] * count, table.begins)
        self._before: tuple[float, Poses] | None = None
        self.log: list[dict[str, Any]] = []
        self._stays = Stays(model)
        self._named_stays = any(names & self._stays.words for names in named)
        self._turned = False  # whether a sheet has come in or left since the last look, of which rules ask

    @property
    def ended(self) -> bool:
        """True if a rule ended the run."""
        return self._stage.ended

    @property
    def there(self) -> NDArray[np.bool_] | None:
        """A mask of the sheets in the machine, (sheets,); None: all."""
        return self._stays.there

    @there.setter
    def there(self, sheets: NDArray[np.bool_] | None) -> None:
        if self._stays.turn(sheets):
            self._turned = self._named_stays
            for sight in self._stage.sights:
                sight.looks = 0.0  # a sheet that comes in, or leaves, does not move there

    # -- when to look

    def ahead(self, t: float, step: float, poses: Poses) -> float:
        """Time from t on up to which steps of a length may be taken before the next `look` [ms]: at least a
        part of one step."""
        stage, until = self._stage, math.inf
        if self._turned:
            return t + SOON * step
        if stage.pending:
            until = min(time for time, _ in stage.pending)
        for k, eye in enumerate(self._eyes):
            sight = stage.sights[k]
            if sight.looks <= t + step:
                sight.looks = self._next(eye, sight, t, step, poses)
            until = min(until, sight.looks)
        if self._moving:
            until = min(until, t + step)
            at = self._first(lambda ahead: self._changed(self._moving, t + ahead, poses.after(ahead)), step)
            until = min(until, t + at)
        if self._clocked:
            if stage.timed <= t + step:
                stage.timed = self._next_time(t, step, poses)
            until = min(until, stage.timed)
        return max(until, t + SOON * step)

    def _next(self, eye: Eye, sight: Sight, t: float, step: float, poses: Poses) -> float:
        """Time of the next reading of a sensor: where it changes within the step, at its end where it is
        near, or as soon as a sheet can be there."""
        if self._changes(eye, sight, poses):
            return t  # by a sheet that has just come in, or left
        off = self._off(eye, poses)
        away = abs(off - (eye.hysteresis if sight.covered else 0.0))
        free = self._free(away, max(self._fastest(eye, poses), self._slowest))
        if free > step:
            return t + min(free, AHEAD * step)
        if not self._rules:
            return t + step  # nothing acts at that time; it is found within the step
        return t + self._first(lambda ahead: self._changes(eye, sight, poses.after(ahead)), step)

    def _free(self, away: float, speed: float) -> float:
        """Time in which a sheet does not come from a distance at a speed [mm, mm/ms] to a sensor [ms]."""
        v, a = SAFE * speed, SAFE * self._gravity
        root = math.sqrt(v * v + 2.0 * a * away)
        return 2.0 * away / (v + root) if root > 0.0 else math.inf

    def _first(self, changed: Callable[[float], bool], step: float) -> float:
        """Time until a change [ms]; the step, where there is no change in it."""
        if not changed(step):
            return step
        low, high = 0.0, step
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if changed(middle) else (middle, high)
        return high

    def _off(self, eye: Eye, poses: Poses) -> float:
        least, found = eye.at_least(poses), FAR
        for k in sorted(self._seen(eye), key=least.__getitem__):
            if least[k] >= found:
                break
            found = min(found, _nearest(eye, k, poses))
        return found

    def _seen(self, eye: Eye) -> list[int]:
        """The sheets that a sensor may see now."""
        there = self.there
        return eye.sheets if there is None else [k for k in eye.sheets if there[k]]

    def _changes(self, eye: Eye, sight: Sight, poses: Poses) -> bool:
        least, sees = eye.at_least(poses), False
        for k in self._seen(eye):
            if not sees and least[k] < eye.hysteresis:
                off = _nearest(eye, k, poses)
                sees = off < eye.hysteresis if sight.covered else off <= 0.0
        return sees != sight.covered

    def _fastest(self, eye: Eye, poses: Poses) -> float:
        """Speed of what a sensor sees, at most [mm/ms]."""
        most = 0.0
        for boxes in (eye.boxes[k] for k in self._seen(eye)):
            x, y, z = self._model.bodies.half[boxes].T
            # about the box's own axes: one that is long across turns about its length in a bend
            spins = poses.w[boxes, None, :] @ poses.r[boxes].reshape(-1, 3, 3)
            p, q, s = np.abs(spins[:, 0]).T
            turns = np.sqrt((q * z + s * y) ** 2 + (s * x + p * z) ** 2 + (p * y + q * x) ** 2)
            most = max(most, float((np.linalg.norm(poses.u[boxes], axis=1) + turns).max()))
        return most

    def _next_time(self, t: float, step: float, poses: Poses) -> float:
        """When a condition of times alone changes next, or as far ahead as that was looked for."""
        for k in range(AHEAD):
            first = t + k * step

            def changed(ahead: float, first: float = first) -> bool:
                return self._changed(self._clocked, first + ahead, poses)

            if changed(step):
                return first + self._first(changed, step)
        return t + AHEAD * step

    # -- events

    def look(self, t: float, step: float, poses: Poses) -> list[Order]:
        """The orders due at the time t [ms], for a solver with steps of that length.

        Raises RunawayError.
        """
        stage = self._stage
        if self._turned:
            stage.timed, self._turned = 0.0, False
        edges = {self._eyes[edge.eye].name: edge for edge in self._edges(t, step, poses)}
        for edge in edges.values():
            self._see(edge)
        seen = {name: edge.time for name, edge in edges.items()}
        orders: list[Order] = []
        acted: set[int] = set()
        soon, held = SOON * step, list(stage.true)
        for _ in range(MOST_AT_ONCE):
            if self._rules:
                self._judge(t, poses.after(soon), soon, seen)
            due = sorted(entry for entry in stage.pending if entry[0] <= t + soon)
            if edges or acted or stage.true != held:
                stage.timed = 0.0
            if not due:
                self._before = (t, poses.copy()) if self._eyes else None
                return orders
            stage.pending = [entry for entry in stage.pending if entry[0] > t + soon]
            acted |= {rule for _, rule in due}
            for _time, rule in due:
                orders += self._act(rule, t)
        names = " and ".join(f"rules.{rule}" for rule in sorted(acted))
        raise RunawayError(f"{names} set off each other at {t:.6g} ms without an end")

    def _edges(self, t: float, step: float, poses: Poses) -> list[_Edge]:
        """The sensors that change at the time t, or changed in the step that ends there."""
        found = []
        for k, eye in enumerate(self._eyes):
            sight = self._stage.sights[k]
            if sight.looks > t + SOON * step:
                continue
            if self._changes(eye, sight, poses):
                found.append(self._within(k, t, poses))
            elif self._changes(eye, sight, ahead := poses.after(SOON * step)) and self._rules:
                found.append(self._edge(k, t, ahead))
        return found

    def _within(self, k: int, t: float, poses: Poses) -> _Edge:
        """An edge at the end of a step, or in it."""
        eye, sight = self._eyes[k], self._stage.sights[k]
        if self._before is None or self._before[0] >= t or self._changes(eye, sight, self._before[1]):
            return self._edge(k, t, poses)
        began, first = self._before
        long = t - began

        def at(ahead: float) -> Poses:
            return between(first, poses, ahead / long, long)

        time = self._first(lambda ahead: self._changes(eye, sight, at(ahead)), long)
        return self._edge(k, began + time, at(time))

    def _edge(self, k: int, time: float, poses: Poses) -> _Edge:
        eye, there = self._eyes[k], self._seen(self._eyes[k])
        among = there or eye.sheets
        if self._stage.sights[k].covered and self._before is not None:
            were = [sheet for sheet in eye.sheets if _nearest(eye, sheet, self._before[1]) < eye.hysteresis]
            # one that has left the machine since clears it, too
            among = [sheet for sheet in were if sheet in there] or were or among
        return _Edge(k, min(among, key=lambda sheet: _nearest(eye, sheet, poses)), time, poses)

    def _see(self, edge: _Edge) -> None:
        """Takes over what a sensor sees, and notes it."""
        eye, sight = self._eyes[edge.eye], self._stage.sights[edge.eye]
        by = eye.passing(edge.sheet, edge.poses.of(eye.boxes[edge.sheet]))
        since = edge.time - sight.since
        sight.covered = not sight.covered
        if self.there is not None and not self.there[edge.sheet]:  # it has left the machine
            by = Passing(sight.speed, sight.skew, sight.position)
        sight.speed, sight.skew, sight.position = by
        numbers: dict[str, Any] = {"speed_mm_per_s": by.speed * PER_SECOND}
        if sight.covered:
            sight.count += 1
            sight.gap = since * by.speed
            numbers |= {"skew_deg": math.degrees(by.skew), "position_mm": by.position, "count": sight.count}
            numbers |= {"gap_ms": _number(since), "gap_mm": _number(sight.gap)}
        else:
            numbers["covered_ms"] = _number(since)
        sight.since = edge.time
        kind = "covered" if sight.covered else "cleared"
        sheet = self._model.sheets[edge.sheet].name
        self.log.append({"time_ms": edge.time, "kind": kind, "sensor": eye.name, "sheet": sheet} | numbers)

    def _judge(self, t: float, poses: Poses, soon: float, seen: Mapping[str, float]) -> None:
        """Lets the rules that come true be due; `seen`: when sensors changed since the last look, from which
        delays of rules count that name them."""
        stage, known = self._stage, self._known(t + soon, poses)
        for k, rule in enumerate(self._rules):
            holds = (not rule.states or stage.state in rule.states) and self._conditions[k].holds(known)
            if holds and not stage.true[k] and not (rule.once and self._set_off(k)):
                named = {name.partition(".")[0] for name in self._conditions[k].expression.names}
                since = max((time for name, time in seen.items() if name in named), default=t)
                stage.pending.append((since + rule.after, k))
            stage.true[k] = holds

    def _set_off(self, rule: int) -> bool:
        return self._stage.fired[rule] > 0 or any(k == rule for _, k in self._stage.pending)

    def _act(self, rule: int, t: float) -> list[Order]:
        """The orders of a rule at the time t; changes of state are made here."""
        stage, orders = self._stage, self._rules[rule].orders
        stage.fired[rule] += 1
        for order in orders:
            if order.kind == "go":
                stage.state = order.name
                stage.true = [
                    held and (not r.states or stage.state in r.states)
                    for held, r in zip(stage.true, self._rules, strict=True)
                ]
            elif order.kind == "end":
                stage.ended = True
        does = ", ".join(in_words(order, order.name in self._turning) for order in orders)
        row = {"time_ms": t, "kind": "rule", "rule": rule, "when": self._rules[rule].when, "does": does}
        self.log.append(row)
        return [order for order in orders if order.kind != "go"]

    def _changed(self, rules: Sequence[int], t: float, poses: Poses) -> bool:
        """True if the condition of one of these rules differs from its stored truth."""
        stage, known = self._stage, self._known(t, poses)
        return any(
            self._conditions[k].holds(known) != stage.true[k]
            for k in rules
            if not self._rules[k].states or stage.state in self._rules[k].states
        )

    def _known(self, t: float, poses: Poses) -> Callable[[str], Amount | float]:
        """A lookup of the values that conditions use, at a time, by name."""

        def value(name: str) -> Amount | float:
            if name == CLOCK:
                return Amount(t, (0.0, 0.0, 1.0, 0.0))
            if name in self._amounts:
                return self._amounts[name]
            if name in self._of_states:
                return self._of_states[name](poses)
            if name in self._stays.words:
                return self._stays.known(name)
            sensor, _, word = name.partition(".")
            return self._stage.sights[self._number[sensor]].known(word, t)

        return value

    # -- runs that are resumed

    def kept(self) -> dict[str, Any]:
        """All that a resumed run needs, as plain values."""
        stage = self._stage
        before = None if self._before is None else [self._before[0], *(a.tolist() for a in self._before[1])]
        return {
            "sights": [vars(sight) for sight in stage.sights],
            **{name: getattr(stage, name) for name in _PLAIN},
            "pending": [list(entry) for entry in stage.pending],
            "before": before,
            "stays": self._stays.kept(),
            "log": self.log,
        }

    def restore(self, kept: dict[str, Any]) -> None:
        """Restores the state that `kept` returned."""
        stage, before = self._stage, kept["before"]
        stage.sights = [Sight(**sight) for sight in kept["sights"]]
        for name in _PLAIN:
            setattr(stage, name, kept[name])
        stage.pending = [(time, rule) for time, rule in kept["pending"]]
        self._before = None if before is None else (before[0], Poses(*map(np.array, before[1:])))
        self._stays.restore(kept["stays"])
        self.log = list(kept["log"])


def _nearest(eye: Eye, sheet: int, poses: Poses) -> float:
    """How far a sheet is from where a sensor sees it [mm], see Eye.off; `poses` of all bodies."""
    return float(eye.off(sheet, poses.of(eye.boxes[sheet])).min())


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None

"""Lints of sensors and rules: sensors that see nothing, rules that never act, and conflicting orders."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Iterator
from itertools import combinations, pairwise

import numpy as np

from mdlgen.conditions import CLOCK, OF_SENSOR, Condition, Known, condition
from mdlgen.formulas import ON, PI, Amount
from mdlgen.lints.lint import Lint
from mdlgen.model.tables import Model, Order, RulePart, SensorPart

# Number of times at which a condition of time alone is evaluated, in addition to those at which comparisons
# that are linear in time turn (convention).
_TIMES = 1001
_LINEAR = 1e-9  # relative to a change: a smaller distance from a line is round-off


def sees_nothing(model: Model) -> Iterator[Lint]:
    """Sensors that no sheet can come to, as far as the bounds go from which contacts were chosen."""
    for sensor in model.reactions.sensors:
        if not _reached(model, sensor):
            yield Lint(
                "W167",
                f"sensors.{sensor.name}",
                "no sheet that it sees comes there in this run",
                "move it into the way of the sheet, or let it see further",
            )


def never(model: Model) -> Iterator[Lint]:
    """Rules that can never act."""
    table = model.reactions
    reached, blind = _states(model), {s.name for s in table.sensors if not _reached(model, s)}
    for k, rule in enumerate(table.rules):
        of = condition(rule.when)
        named = {name.partition(".")[0] for name in of.expression.names if "." in name}
        why = remedy = ""
        if rule.states and not reached & set(rule.states):
            why, remedy = f"the machine never comes to {_either(rule.states)}", "let a rule go there"
        elif named and named <= blind and not _blindly(of):
            why, remedy = f"{_either(tuple(sorted(named)))} never sees a sheet", "move the sensor"
        elif not _in_time(model, of):
            why, remedy = "it is true at no time of this run", "run longer, or change it"
        if why:
            yield Lint("W165", f"rules.{k}.when", f"{rule.when}: this rule never acts, since {why}", remedy)


def fights(model: Model) -> Iterator[Lint]:
    """Rules that tell one part two things at one time."""
    for (one, first), (two, second) in combinations(enumerate(model.reactions.rules), 2):
        if first.when != second.when or first.after != second.after or not _together(first, second):
            continue
        ordered = dict(map(_what, first.orders))
        for order in second.orders:
            part, what = _what(order)
            if ordered.get(part, what) != what:
                yield Lint(
                    "W166",
                    f"rules.{two}.do.{order.kind}.{order.name}",
                    f"rules.{one} sets {order.name} to another value at the same time; this one comes last",
                    "leave one of them out, or give them other conditions",
                )


def dead_end(model: Model) -> Iterator[Lint]:
    """States that rules go to, and in which no rule holds."""
    rules = model.reactions.rules
    known = {state for rule in rules for state in rule.states}
    if not all(rule.states for rule in rules):
        return
    for k, rule in enumerate(rules):
        ends = any(order.kind == "end" for order in rule.orders)
        for order in rule.orders:
            if order.kind == "go" and order.name not in known and not ends:
                yield Lint(
                    "W189",
                    f"rules.{k}.do.go",
                    f"no rule holds in the state {order.name}: from then on nothing reacts",
                    f"give a rule in: {order.name}, or go to one of {', '.join(sorted(known))[:100]}",
                )


def _what(order: Order) -> tuple[tuple[str, str], tuple[str | float, float]]:
    """The part and quantity that an order changes, and the value that it asks for."""
    if order.kind == "go":
        return ("go", ""), (order.name, 0.0)
    return (order.kind, order.name), (order.value, order.ramp)


def _reached(model: Model, sensor: SensorPart) -> bool:
    """True if the bounding box of a sensor's view meets that of all places its sheets can reach."""
    corners = np.concatenate([sensor.ends, sensor.ends + sensor.way])
    low, high = corners.min(axis=0), corners.max(axis=0)
    for k in sensor.sheets:
        sheet = model.sheets[int(k)]
        boxes = slice(sheet.first, sheet.first + sheet.count)
        reach = np.linalg.norm(model.bodies.half[boxes], axis=1)[:, None]
        below, above = model.pairs.low[boxes] - reach, model.pairs.high[boxes] + reach
        if ((below <= high) & (above >= low)).all(axis=1).any():
            return True
    return False


def _states(model: Model) -> set[str]:
    """The states that rules can lead to, from the first one on."""
    found = {model.reactions.begins}
    while True:
        more = {
            order.name
            for rule in model.reactions.rules
            if not rule.states or found & set(rule.states)
            for order in rule.orders
            if order.kind == "go"
        }
        if more <= found:
            return found
        found |= more


def _blindly(of: Condition) -> bool:
    """True if a condition of sensors holds, or may hold, while none has seen a sheet."""
    if any("." not in name for name in of.expression.names):
        return True

    def unseen(name: str) -> Amount | float:
        dimension = OF_SENSOR[name.partition(".")[2]]
        if dimension is None:
            return float(name.endswith(".clear"))
        return Amount(0.0 if name.endswith(".count") else math.nan, dimension)

    return of.holds(unseen)


def _in_time(model: Model, of: Condition) -> bool:
    """True if a condition of time alone becomes true in the run; any other condition may."""
    amounts = {name: Amount(value, dimension) for name, value, dimension in model.reactions.amounts}
    amounts["pi"] = PI
    if not set(of.expression.names) <= {CLOCK, *amounts}:
        return True
    end, unit = model.run.duration, (0.0, 0.0, 1.0, 0.0)

    def known(t: float) -> Known:
        return lambda name: Amount(t, unit) if name == CLOCK else amounts[name]

    turns = [turn for part in ast.walk(of.expression.tree) for turn in _turns(of, part, known, end)]
    # what holds between two times at which a comparison turns holds in the middle of them
    ends = sorted({0.0, end, *(turn for turn in turns if 0.0 <= turn <= end)})
    middles = [0.5 * (one + two) for one, two in pairwise(ends)]
    return any(of.holds(known(t)) for t in (*ends, *middles, *np.linspace(0.0, end, _TIMES).tolist()))


def _turns(of: Condition, part: ast.AST, known: Callable[[float], Known], end: float) -> list[float]:
    """Times at which a comparison that is linear in time turns; none of one that is not."""
    if not isinstance(part, ast.Compare):
        return []
    found = []
    for one, two in pairwise((part.left, *part.comparators)):
        try:
            low, middle, high = (
                of.expression.part(one, ON, known(t)).value - of.expression.part(two, ON, known(t)).value
                for t in (0.0, 0.5 * end, end)
            )
        except (ArithmeticError, ValueError):
            continue
        if high != low and abs(middle - 0.5 * (low + high)) <= _LINEAR * abs(high - low):
            found.append(end * low / (low - high))
    return found


def _together(one: RulePart, two: RulePart) -> bool:
    return not one.states or not two.states or bool(set(one.states) & set(two.states))


def _either(names: tuple[str, ...]) -> str:
    return " or ".join(names)

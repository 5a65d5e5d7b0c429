"""Orders of rules in words."""

from __future__ import annotations

import math

from mdlgen.model.tables import Order
from mdlgen.units import PER_SECOND


def in_words(order: Order, turns: bool = False) -> str:
    """The text of an order for a message; `turns`: its place is an angle."""
    if order.kind == "speed":
        ramp = f" in {order.ramp:g} ms" if order.ramp else ""
        return f"{order.name} to {order.value * PER_SECOND:.6g} rad/s{ramp}"
    if order.kind == "press":
        return f"{order.name} pressed by {order.value:.6g} N"
    if order.kind == "torque":
        return f"arm of {order.name} to {order.value:.6g} N*mm"
    if order.kind == "move":
        place = f"{math.degrees(order.value):.6g} deg" if turns else f"{order.value:.6g} mm"
        return f"{order.name} moves to {place} in {order.ramp:g} ms"
    if order.kind == "enter":
        return f"the next sheet of {order.name} comes in"
    return f"go to {order.name}" if order.kind == "go" else "end"

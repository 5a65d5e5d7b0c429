"""States of sensors and rules over the time of a run, in rows as a logic analyser shows them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

# Sizes of the drawing, in its own units (convention).
WIDE, LEFT, HIGH, AXIS, NUMBER = 1000.0, 150.0, 24.0, 22.0, 22.0


def logic(summary: Mapping[str, Any]) -> dict[str, Any] | None:
    """The drawing of a summary, None without sensors and rules that acted: its size; `rows` with a name, a
    place y and `spans` in which a sensor was covered; `marks` of rules with a place x, a time and what was
    done; `ticks` of the axis."""
    sensors, acts = summary.get("sensors", {}), [e for e in summary["events"] if e["kind"] == "rule"]
    end = float(summary["t_end_ms"] or 0.0)
    if not (sensors or acts) or end <= 0.0:
        return None

    def at(time: float) -> float:
        return LEFT + (WIDE - LEFT - 10.0) * time / end

    rows = []
    for k, (name, seen) in enumerate(sensors.items()):
        spans = []
        for sheet in seen["passed"]:
            begin, cleared = sheet["covered_at_ms"], sheet["cleared_at_ms"]
            x = at(begin)
            spans.append(
                {"x": x, "width": at(end if cleared is None else cleared) - x, "sheet": sheet["sheet"]}
            )
        rows.append({"name": name, "y": HIGH * k, "spans": spans})
    marks = [
        {"x": at(e["time_ms"]), "time": e["time_ms"], "rule": e["rule"], "text": f"{e['when']}: {e['does']}"}
        for e in acts
    ]
    for mark, before in zip(marks[1:], marks, strict=False):
        # a number that would be written over the one before it stands lower
        near = mark["x"] - before["x"] < NUMBER
        mark["down"] = 0.0 if not near or before.get("down") else 0.5 * HIGH
    step = _round(end / 8.0)
    ticks = [{"x": at(k * step), "text": f"{k * step:g}"} for k in range(int(end / step + 1e-9) + 1)]
    below = HIGH * len(rows)
    return {
        "width": WIDE,
        "height": below + (1.5 * HIGH if marks else 0.0) + AXIS,
        "bar": HIGH,
        "left": LEFT,
        "axis": below + (1.5 * HIGH if marks else 0.0),
        "rows": rows,
        "below": below,
        "marks": marks,
        "ticks": ticks,
    }


def _round(value: float) -> float:
    """1, 2 or 5 times a power of ten that is not below a value."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(m * power for m in (1.0, 2.0, 5.0, 10.0) if m * power >= value * (1.0 - 1e-9))

"""Events that a reader should know of, and those of them that are printed where there is little space."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

Event = Mapping[str, Any]

# Events that a reader sees whether or not they are required away.
NOTABLE = ("jam", "double_feed", "stub", "creep", "stall", "lost_steps")
# A slip of more than this part of the surface's speed, over a whole stay, is named, too; one of more than all
# of it is that of a roller which holds back.
LARGE_SLIP = 0.2


def notable(events: Sequence[Event]) -> list[Event]:
    """Those that a reader sees in any case, creep last. A jam or a wait at a roller says why a sheet slips
    there."""
    held = [event for event in events if event["kind"] in ("jam", "wait")]

    def explained(slip: Event) -> bool:
        at = slip["time_ms"]
        return any(
            (event["sheet"], event["roller"]) == (slip["sheet"], slip["roller"])
            and event["time_ms"] <= at <= event["time_ms"] + event["duration_ms"]
            for event in held
        )

    def listed(event: Event) -> bool:
        if event["kind"] != "slip":
            return event["kind"] in NOTABLE
        large = LARGE_SLIP < abs(event.get("part_of_surface_speed") or 0.0) <= 1.0
        return large and not explained(event)

    return sorted(filter(listed, events), key=lambda event: event["kind"] == "creep")


def foremost(events: Sequence[Event], most: int) -> tuple[list[Event], str]:
    """At most `most` of them in their order, and in words how many of each kind are left out. The first of
    each kind goes before others: one stub matters more than a double feed that repeats itself."""
    seen: Counter[str] = Counter()
    ranks: list[int] = []
    for event in events:
        ranks.append(seen[event["kind"]])
        seen[event["kind"]] += 1
    shown = set(sorted(range(len(events)), key=lambda k: (ranks[k] > 0, k))[:most])
    rest = Counter(str(event["kind"]).replace("_", " ") for k, event in enumerate(events) if k not in shown)
    return [events[k] for k in sorted(shown)], ", ".join(f"{kind} ({count})" for kind, count in rest.items())

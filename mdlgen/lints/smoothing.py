"""The smoothing speeds of contacts as `check` shows them, and a notice where they are not what they were."""

from __future__ import annotations

from typing import Any

from mdlgen.model.tables import Model

MOST_NAMED = 6


def smoothings(model: Model) -> list[dict[str, Any]]:
    """Each entry of the contacts that pairs of parts have, in their order: its name, or its index in the
    list, the smoothing [mm/s], and whether that follows from the speeds of the scene."""
    table = model.contacts
    rows = {int(entry): row for row, entry in reversed([*enumerate(table.entry.tolist())])}
    return [
        {
            "contact": table.called(row),
            "mm_per_s": 1e3 * float(table.smoothing[row]),
            "follows": entry in model.following,
        }
        for entry, row in sorted(rows.items())
    ]


def lines(message: list[dict[str, Any]]) -> list[str]:
    """The same for a terminal: one line for each speed."""
    groups: dict[tuple[float, bool], list[str]] = {}
    for item in message:
        groups.setdefault((item["mm_per_s"], item["follows"]), []).append(item["contact"])
    return [
        f"smoothing {speed:.4g} mm/s{', from the speeds of the scene' if follows else ''}: "
        f"{_contacts(names, len(message))}"
        for (speed, follows), names in groups.items()
    ]


def notice(model: Model) -> str:
    """The notice about a scene whose meaning has changed since version 0.1; "" where it has not."""
    changed = [item for item in smoothings(model) if item["follows"]]
    if not changed:
        return ""
    names, speed = [item["contact"] for item in changed], changed[0]["mm_per_s"]
    return (
        f"{_contacts(names, 0)}: smoothing is left out and follows from the speeds of the scene, {speed:.4g} "
        "mm/s; up to version 0.1 it was 1 mm/s, which mdlgen upgrade FILE writes"
    )


def _contacts(names: list[str], of: int) -> str:
    if len(names) == of:
        return "all contacts"
    shown = ", ".join(names[:MOST_NAMED]) + (", ..." if len(names) > MOST_NAMED else "")
    return f"contact{'s' if len(names) > 1 else ''} {shown}"

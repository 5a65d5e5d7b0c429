"""A verification in words, and as JSON."""

from __future__ import annotations

from typing import Any

from mdlgen.verify.outcome import Verification
from mdlgen.verify.tables import LIMIT, Compared

MOST_SHOWN = 20


def report(found: Verification) -> dict[str, Any]:
    """As plain values: the largest relative differences, what differs, what came of changing values."""
    result: dict[str, Any] = {
        "ok": found.ok,
        "limit": LIMIT,
        "kinds": {
            source: {kind: _kind(compared) for kind, compared in kinds.items()}
            for source, kinds in found.kinds.items()
        },
        "differences": [str(d) for d in found.all_differences()],
        "notes": found.notes,
        "script": found.script,
    }
    if found.perturbed is not None:
        result["turned"] = {
            "values": found.perturbed.values,
            "largest": _finite(found.perturbed.largest),
            "where": found.perturbed.where,
            "shown_only": sorted(found.perturbed.shown_only),
        }
    return result


def _kind(compared: Compared) -> dict[str, Any]:
    return {"count": compared.entities, "largest": _finite(compared.largest), "where": compared.where}


def _finite(value: float) -> float | None:
    """None where there is no number to compare with."""
    return value if value < float("inf") else None


def report_text(found: Verification) -> str:
    """A table of the kinds, then what differs."""
    sources = list(found.kinds)
    lines = [
        "largest relative difference to the model that is run, by kind",
        f"{'kind':12}{'count':>8}" + "".join(f"{s:>11}" for s in sources) + "  largest at",
    ]
    for kind, compared in {**found.kinds.get("deck", {}), **found.kinds.get("text", {})}.items():
        if not compared.entities and not compared.differences:
            continue
        cells = [found.kinds[source].get(kind) for source in sources]
        shown = "".join(f"{c.largest:11.1e}" if c else f"{'-':>11}" for c in cells)
        lines.append(f"{kind:12}{compared.entities:8}{shown}  {compared.where}".rstrip())
    perturbed = found.perturbed
    if perturbed is not None:
        lines.append(
            f"{perturbed.values} values of data sets changed, each in the text and in the scene: "
            f"largest difference {perturbed.largest:.1e}"
        )
        if perturbed.shown_only:
            count = len(perturbed.shown_only)
            lines.append(f"{count} values are shown only (NO_EDIT): {_some(perturbed.shown_only)}")
    lines += found.notes
    differences = found.all_differences()
    lines += [str(d) for d in differences[:MOST_SHOWN]]
    if len(differences) > MOST_SHOWN:
        lines.append(f"and {len(differences) - MOST_SHOWN} more")
    return "\n".join(lines)


def _some(names: set[str]) -> str:
    shown = sorted(names)
    return ", ".join(shown[:4]) + (", ..." if len(shown) > 4 else "")

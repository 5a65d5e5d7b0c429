"""A result as a notebook shows it: a few numbers in tables."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

from mdlgen.results.wording import number, numbers

if TYPE_CHECKING:
    from mdlgen.results.result import Result

FIGURES = 5


def tables(result: Result) -> str:
    """HTML with what summary.json has of sheets, probes and rollers; names are escaped."""
    record = result.summary()
    head = f"<b>{escape(record['scene'])}</b> ({escape(record['solver'])}): {escape(record['status'])}, "
    parts = [f"<p>{head}{record['t_end_ms']:g} ms in {record['steps']} steps</p>"]
    for kind, keys in (
        ("sheets", ("travel_mm", "speed_mm_per_s", "yaw_deg")),
        ("probes", ("displacement_mm", "speed_mm_per_s")),
        ("rollers", ("omega_rad_per_s", "nip_force_n", "max_penetration_mm")),
    ):
        if record[kind]:
            cells = "".join(f"<th>{key}</th>" for key in keys)
            rows = "".join(
                _row(name, [numbers[key] for key in keys]) for name, numbers in record[kind].items()
            )
            parts.append(f"<table><tr><th>{kind}</th>{cells}</tr>{rows}</table>")
    return "".join(parts)


def _row(name: str, values: list[Any]) -> str:
    cells = "".join(f"<td>{_shown(value)}</td>" for value in values)
    return f"<tr><th>{escape(name)}</th>{cells}</tr>"


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(numbers(value, FIGURES, "-"))
    return "-" if value is None else number(value, FIGURES)

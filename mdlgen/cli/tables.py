"""Tables that a command prints on a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mdlgen.errors import printable

if TYPE_CHECKING:
    from rich.console import Console

    from mdlgen.report.text import Rows

_LINTS = ["code", "where", "what", "what to do"]


def show(record: dict[str, Any], console: Console | None = None) -> None:
    """An overview (`report.overview`) on a terminal, with its lints last."""
    from rich.console import Console

    from mdlgen.report.text import lints_end, overview_parts

    console = console or Console()
    parts = overview_parts(record)
    for k, part in enumerate(parts):
        if not part and any(not isinstance(near, str) for near in parts[k - 1 : k + 2]):
            continue  # a table has its own empty lines
        if isinstance(part, str):
            # a name is no markup
            console.print(
                printable(part), markup=False, highlight=False, style="bold" if part[:1] != " " else ""
            )
        else:
            _table(console, part, numbers=True)
    if record["lints"]:
        rows = [[lint[key] for key in ("code", "where", "message", "remedy")] for lint in record["lints"]]
        _table(console, [_LINTS, *rows], numbers=False)
    console.print(lints_end(record), highlight=False)


def _table(console: Console, rows: Rows, numbers: bool) -> None:
    """The first row is the head, the first column says what the others are of."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for k, head in enumerate(rows[0]):
        values = [row[k] for row in rows[1:]]
        right = numbers and all(_number(value) for value in values)
        style = "yellow" if not numbers and k == 0 else "cyan" if k == 0 else ""
        table.add_column(Text(head), justify="right" if right else "left", style=style, no_wrap=numbers)
    for row in rows[1:]:
        table.add_row(*(Text(printable(value)) for value in row))
    console.print(table)


def _number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True

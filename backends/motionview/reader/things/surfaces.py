"""Deformable surfaces through the origins of markers."""

from __future__ import annotations

from typing import Any

from mdlgen.backends.motionview.reader.things.thing import Thing


class DeformableSurface(Thing):
    """`*DeformableSurface( name, label, NATURAL|PARABOLIC|PERIODIC, rows, columns, marker, ... )`."""

    kind = "DeformableSurface"

    def p_rows(self) -> tuple[tuple[Any, ...], ...]:
        """The markers, row by row. Raises Trouble where their number is not rows times columns."""
        count, across = int(self.number(3)), int(self.number(4))
        given = len(self.statement.args) - 5
        if count < 1 or across < 1 or given != count * across:
            due = f"a number of rows that gives {given} markers with the columns"
            raise self.wrong(self.statement, 3, due, float(count))
        markers = [self.related(5 + k, "Marker") for k in range(given)]
        return tuple(tuple(markers[k * across : (k + 1) * across]) for k in range(count))

    def record(self) -> dict[str, Any]:
        return {
            "label": self.ask("label"),
            "type": self.statement.arg(2).upper(),
            "markers": tuple(tuple(m.name for m in row) for row in self.ask("rows")),
        }

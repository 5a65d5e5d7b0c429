"""Curves y(x) of points."""

from __future__ import annotations

from typing import Any

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.thing import Thing

Points = tuple[tuple[float, ...], tuple[float, ...]]


class Curve(Thing):
    """`*Curve( name, label, 2D, CARTESIAN, WRITE, CURVE_POINTS, OPEN )`, with the numbers of *SetCurve."""

    kind = "Curve"

    def p_points(self) -> Points | None:
        """All x and all y; None where no *SetCurve gives them. Raises Trouble for another form than VALUE."""
        chosen = self.chosen("setcurve")
        if chosen is None:
            return None
        statement, scope, at = chosen.statement, chosen.scope, chosen.first
        columns = []
        for _ in range(2):
            word = statement.arg(at).upper()
            if word != "VALUE":
                due = "VALUE" if word not in ("MATH", "FILE") else "VALUE, the only form that is read,"
                trouble = Trouble("curve", f"{due} is due here, not {word or 'nothing'}", severity="warning")
                trouble.place = statement.place(at)
                raise trouble
            count = self.number(at + 1, statement, scope)
            if not 2 <= count <= len(statement.args) - at - 2 or count != int(count):
                raise self.wrong(statement, at + 1, "a number of values that follow", count)
            begin = at + 2
            at = begin + int(count)
            columns.append(tuple(self.number(k, statement, scope) for k in range(begin, at)))
        if len(columns[0]) != len(columns[1]):
            raise Trouble("curve", f"{self} has {len(columns[0])} values of x and {len(columns[1])} of y")
        return columns[0], columns[1]

    def p_extrapolates(self) -> str:
        """Arguments after the numbers: none, or the extrapolation of the curve."""
        chosen, points = self.chosen("setcurve"), self.ask("points")
        if chosen is None or points is None:
            return ""
        return ", ".join(chosen.statement.args[chosen.first + 4 + 2 * len(points[0]) :])

    def record(self) -> dict[str, Any]:
        x, y = self.ask("points") or (None, None)
        form = tuple(word.upper() for word in self.statement.args[2:])
        return {"label": self.ask("label"), "form": form, "beyond": self.ask("extrapolates"), "x": x, "y": y}

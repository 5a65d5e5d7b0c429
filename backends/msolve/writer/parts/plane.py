"""Planes: blocks, fixed or pressed."""

from __future__ import annotations

from collections.abc import Iterator

from mdlgen.backends.msolve.writer.bodies import body, press
from mdlgen.backends.msolve.writer.parts.kind import Kind, Table
from mdlgen.backends.msolve.writer.units import row
from mdlgen.model.tables import Model, PlanePart


class _Planes(Kind[PlanePart]):
    pressed = recorded = True

    def table(self, model: Model, part: PlanePart) -> Table:
        table = {**body(model, part.body), "lengths": row(2.0 * model.bodies.half[part.body])}
        if part.press is not None:
            table["press"] = press(part, part.press)
        return table

    def labels(self, part: PlanePart) -> Iterator[str]:
        yield f"o_{part.name}"


KIND = _Planes()

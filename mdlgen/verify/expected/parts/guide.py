"""Guides: the boxes that show them."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from mdlgen.altair.rims import Side
from mdlgen.model.parts.guide import facets, outer
from mdlgen.model.tables import Floats, GuidePart, Model
from mdlgen.verify.expected.parts.kind import (
    Box,
    Bushing,
    Joint,
    Kind,
    Marker,
    gate_joint,
    gate_points,
    gate_spring,
    gate_way,
    own_vector,
    stops_data,
)


class _Guides(Kind[GuidePart]):
    def points(self, model: Model, part: GuidePart) -> Iterator[tuple[str, Floats]]:
        yield from gate_points(model, part.body, part.name, part.moving)
        yield f"p_{part.name}", part.center
        for box in self.boxes(model, part):
            yield f"p_{box.name.removeprefix('gbox_')}", box.center

    def joints(self, model: Model, part: GuidePart) -> Iterator[Joint]:
        yield from gate_joint(part.name, part.moving, part.center)

    def boxes(self, model: Model, part: GuidePart) -> Iterator[Box]:
        for k, facet in enumerate(facets(part)):
            yield Box(f"gbox_{part.name}_{k}", f"b_{part.name}", *facet)

    def markers(self, model: Model, part: GuidePart) -> Iterator[Marker]:
        yield Marker(f"m_{part.name}", "B_Ground", part.center, part.axes)

    def bushings(self, model: Model, part: GuidePart) -> Iterator[Bushing]:
        yield from gate_spring(part.name, part.moving, part.center)

    def vectors(self, model: Model, part: GuidePart) -> Iterator[tuple[str, Floats]]:
        yield from gate_way(part.name, part.moving)
        yield from own_vector(f"v_{part.name}_axis", part.axes[:, 2])
        if part.radius == 0.0:
            given = {p.member: p.value for p in model.parameters if p.data_set == part.name}
            along = np.array([given[f"{a}_1"] - given[f"{a}_0"] for a in "xyz"])
            yield f"v_{part.name}_along", along / np.linalg.norm(along)

    def data(self, model: Model, part: GuidePart) -> dict[str, float]:
        if part.radius == 0.0:
            return {"L": part.length, **stops_data(model, part.name)}
        turn = 2 * part.half_angle / part.facets
        chord = 2 * outer(part) * math.tan(turn / 2)
        return {
            "n": float(part.facets),
            "turn": turn,
            "R_o": outer(part),
            "chord": chord,
            **stops_data(model, part.name),
        }

    def graphics(self, part: GuidePart, side: Side) -> list[str]:
        return [f"gbox_{part.name}_{k}" for k in range(part.facets)]

    def names(self, part: GuidePart) -> set[str]:
        shown = {f"{kind}_{part.name}_{k}" for kind in ("p", "gbox") for k in range(part.facets)}
        return super().names(part) | {f"m_{part.name}"} | shown


KIND = _Guides()

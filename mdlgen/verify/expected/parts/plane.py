"""Planes: a box each, and of pressed ones slide and spring."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from mdlgen.altair.rims import Side
from mdlgen.model.tables import Floats, Model, PlanePart
from mdlgen.verify.expected.parts.kind import (
    Box,
    Bushing,
    Joint,
    Kind,
    Spring,
    gate_joint,
    gate_points,
    gate_spring,
    gate_way,
    own_vector,
    spring_of,
    stops_data,
)
from mdlgen.verify.solver_expressions import motion


class _Planes(Kind[PlanePart]):
    def points(self, model: Model, part: PlanePart) -> Iterator[tuple[str, Floats]]:
        yield from gate_points(model, part.body, part.name, part.moving)
        yield f"p_{part.name}", model.bodies.position[part.body]
        for spring in self.springs(model, part):
            yield f"p_{part.name}_anchor", spring.anchor

    def joints(self, model: Model, part: PlanePart) -> Iterator[Joint]:
        yield from gate_joint(part.name, part.moving, model.bodies.position[part.body])
        if part.press is not None:
            name, at = part.name, model.bodies.position[part.body]
            way = part.press.direction
            yield Joint(f"j_{name}_slide", "TRANSLATIONAL", f"b_{name}", "B_Ground", at, way)

    def boxes(self, model: Model, part: PlanePart) -> Iterator[Box]:
        table, body = model.bodies, part.body
        lengths = 2 * table.half[body]
        yield Box(f"gbox_{part.name}", f"b_{part.name}", table.position[body], table.rotation[body], lengths)

    def bushings(self, model: Model, part: PlanePart) -> Iterator[Bushing]:
        yield from gate_spring(part.name, part.moving, model.bodies.position[part.body])

    def vectors(self, model: Model, part: PlanePart) -> Iterator[tuple[str, Floats]]:
        yield from gate_way(part.name, part.moving)
        yield from own_vector(f"v_{part.name}_normal", part.normal)
        if part.press is not None:
            yield f"v_{part.name}_press", part.press.direction

    def outputs(self, model: Model, part: PlanePart) -> Iterator[tuple[str, Iterable[float]]]:
        """Position and velocity of a pressed one."""
        if part.press is not None:
            state, at = motion(f"b_{part.name}"), model.bodies.position[part.body]
            yield f"o_{part.name}", [*state.place(at), *state.speed(at)]

    def springs(self, model: Model, part: PlanePart) -> Iterator[Spring]:
        if part.press is not None:
            yield spring_of(model, part, part.press, f"b_{part.name}")

    def data(self, model: Model, part: PlanePart) -> dict[str, float]:
        return stops_data(model, part.name)

    def graphics(self, part: PlanePart, side: Side) -> list[str]:
        return [f"gbox_{part.name}"]

    def names(self, part: PlanePart) -> set[str]:
        return super().names(part) | {f"p_{part.name}_anchor", f"j_{part.name}_slide"}


KIND = _Planes()

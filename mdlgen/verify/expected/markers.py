"""Markers, vectors and outputs that a text must have."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from mdlgen.model.shape import ground_frames
from mdlgen.model.tables import (
    Floats,
    Model,
)
from mdlgen.verify.expected.parts.kind import axis_vectors
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.expected.points import anchor_points, boxes_of
from mdlgen.verify.expected.units import body_name, reach
from mdlgen.verify.solver_expressions import motion
from mdlgen.verify.tables import Part, Table, table


def markers(model: Model) -> Table:
    """The markers that the text itself makes; those of bodies and joints are where their owners are."""
    names, bodies, places, axes = [], [], [], []

    def add(name: str, body: str, place: Floats, frame: Floats) -> None:
        names.append(name)
        bodies.append((body,))
        places.append(place)
        axes.append(frame)

    for index, sheet in enumerate(model.sheets):
        add(f"m_{sheet.name}", "B_Ground", sheet.center, sheet.rotation.T)
        for frame in ground_frames(model, index):
            add(frame.name, "B_Ground", frame.origin, frame.axes.T)
        for b in boxes_of(model, sheet) if sheet.surface else ():
            name = model.bodies.name[b]
            add(f"m_{name}", f"b_{name}", model.bodies.position[b], np.eye(3))
    for part in model.machine:
        for marker in kind_of(part).markers(model, part):
            add(marker.name, marker.body, marker.origin, marker.rotation.T)
    for probe in model.probes:
        points = anchor_points(model, probe)
        for k, body in enumerate(probe.body.tolist()):
            end = f"_{k}" if len(points) > 1 else ""
            add(f"m_probe_{probe.name}{end}", body_name(model, body), points[k], np.eye(3))
    parts: dict[str, Part] = {
        "origin": (np.array(places).reshape(-1, 3), reach(model)),
        "axes": (np.array(axes).reshape(-1, 9), 1.0),
    }
    return table(names, parts, bodies)


def vectors(model: Model) -> Table:
    found = list(_sheet_vectors(model))
    found += [vector for part in model.machine for vector in kind_of(part).vectors(model, part)]
    directions = np.array([direction for _, direction in found]).reshape(-1, 3)
    return table([name for name, _ in found], {"direction": (directions, 1.0)})


def _sheet_vectors(model: Model) -> Iterator[tuple[str, Floats]]:
    """Those that give the markers of sheets their axes: of a sheet that turns about z alone only x."""
    angled = {p.data_set for p in model.parameters if p.member == "r_x"}
    for index, sheet in enumerate(model.sheets):
        if sheet.name in angled:
            yield from axis_vectors(f"v_{sheet.name}", sheet.rotation)
        else:
            yield f"v_{sheet.name}_x", sheet.rotation[:, 0]
        for frame in ground_frames(model, index):
            yield from axis_vectors(f"v_{frame.name.removeprefix('m_')}", frame.axes)


def outputs(model: Model) -> Table:
    """Six numbers of each output in the made-up state: position and velocity, of rollers and spin."""
    names, rows = [], []
    for probe in model.probes:
        names.append(f"o_{probe.name}")
        points = anchor_points(model, probe)
        states = [motion(body_name(model, b)) for b in probe.body.tolist()]
        rows.append(
            [
                *_mean(probe.share, (s.place(p) for s, p in zip(states, points, strict=True))),
                *_mean(probe.share, (s.speed(p) for s, p in zip(states, points, strict=True))),
            ]
        )
    for part in model.machine:
        for name, values in kind_of(part).outputs(model, part):
            names.append(name)
            rows.append([*values])
    numbers = np.array(rows).reshape(-1, 6)
    scale = np.repeat([reach(model), 1000.0], 3)
    return table(names, {"value": (numbers, scale)})


def _mean(share: Floats, vectors: Iterable[Floats]) -> Floats:
    return np.einsum("n,nk->k", share, np.array(list(vectors)))

"""A run as VTKHDF for ParaView: every body at every shown state, boxes with what they do."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from mdlgen.geometry.solids import CORNERS
from mdlgen.model.rotations import turns
from mdlgen.model.tables import Floats, Ints
from mdlgen.report import boxes
from mdlgen.report.animation import frames
from mdlgen.report.meshes import machine
from mdlgen.report.motion import poses
from mdlgen.results.result import Result
from mdlgen.results.strain import histories

HEXAHEDRON, TRIANGLE = 12, 5
# our corners of a box in the order of VTK
_ORDER = np.array([0, 1, 3, 2, 4, 5, 7, 6])


def vtkhdf(result: Result) -> bytes:
    """The file of a run: an UnstructuredGrid (VTKHDF 2.0) with one step a shown state, times in ms, mm.

    Cells: the boxes as hexahedra, then rollers, their marks, arms, planes, guides and meshes as triangles.
    CellData: `body` (arms are counted on from the last one), and of boxes `speed` [mm/s], `strain`,
    `curvature` [1/mm] and `contact` [N], zero for the rest.

    The same result gives the same bytes.
    """
    import h5py

    at = frames(result)
    points, connectivity, types, body = _cells(result, at)
    joints = histories(result, at)
    force, _ = boxes.contact(result, at)
    strain, curvature = boxes.greatest(joints, force.shape)
    values = {
        "speed": boxes.speed(result, at),
        "strain": strain,
        "curvature": curvature,
        "contact": force,
    }
    lengths = np.where(types == HEXAHEDRON, 8, 3)
    states, cells = len(at), len(types)
    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:

        def put(name: str, data: Any) -> None:
            file.create_dataset(f"VTKHDF/{name}", data=data, track_times=False)

        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
        # a reader wants a text of fixed length
        root.attrs.create("Type", b"UnstructuredGrid", dtype="S16")
        put("Points", points.reshape(-1, 3).astype("<f4"))
        put("Connectivity", connectivity)
        put("Offsets", np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64))
        put("Types", types.astype(np.uint8))
        for name, count in (
            ("Points", points.shape[1]),
            ("Cells", cells),
            ("ConnectivityIds", len(connectivity)),
        ):
            put(f"NumberOf{name}", np.array([count], dtype=np.int64))
        put("CellData/body", body)
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = np.int64(states)
        put("Steps/Values", result.time[at])
        # one set of cells for all steps; points and values of a step follow those of the one before
        zero = np.zeros(states, dtype=np.int64)
        put("Steps/PartOffsets", zero)
        put("Steps/NumberOfParts", zero + 1)
        put("Steps/PointOffsets", np.arange(states, dtype=np.int64) * points.shape[1])
        put("Steps/CellOffsets", zero[:, None])
        put("Steps/ConnectivityIdOffsets", zero[:, None])
        put("Steps/CellDataOffsets/body", zero)
        for name, data in values.items():
            whole = np.zeros((states, cells), dtype="<f4")
            whole[:, : data.shape[1]] = data
            put(f"CellData/{name}", whole.ravel())
            put(f"Steps/CellDataOffsets/{name}", np.arange(states, dtype=np.int64) * cells)
    return stream.getvalue()


def _cells(result: Result, at: Ints) -> tuple[Floats, Ints, Ints, Ints]:
    """Points at the states, (t, n, 3), the points of each cell in a row, kinds and bodies of the cells."""
    model = result.model
    place, turn = poses(result, at)
    turn = turns(turn)
    count = boxes.count(model)
    corners = CORNERS[_ORDER] * model.bodies.half[:count, None]
    moved = np.einsum("tnij,ncj->tnci", turn[:, :count], corners) + place[:, :count, None]
    points = [moved.reshape(len(at), -1, 3)]
    connectivity = [np.arange(8 * count)]
    types, body = [np.full(count, HEXAHEDRON)], [np.arange(count)]
    start = 8 * count
    for mesh in machine(model):
        own = np.einsum("tij,cj->tci", turn[:, mesh.body], mesh.points) + place[:, mesh.body, None]
        points.append(own)
        connectivity.append(mesh.triangles.ravel() + start)
        types.append(np.full(len(mesh.triangles), TRIANGLE))
        body.append(np.full(len(mesh.triangles), mesh.body))
        start += len(mesh.points)
    return (
        np.concatenate(points, axis=1),
        np.concatenate(connectivity).astype(np.int64),
        np.concatenate(types),
        np.concatenate(body).astype(np.int64),
    )

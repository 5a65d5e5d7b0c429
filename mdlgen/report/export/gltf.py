"""A run as an animated GLB (glTF 2.0): one node a body, moved by key frames; for viewers and Blender."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

from mdlgen.geometry.solids import BOX, CORNERS
from mdlgen.model.tables import Floats
from mdlgen.report import boxes
from mdlgen.report.animation import frames
from mdlgen.report.meshes import machine, moving
from mdlgen.report.motion import names, poses
from mdlgen.results.result import Result
from mdlgen.version import version

LASTS = 10.0  # seconds that an animation takes: motion within 50 ms is too fast to be seen
_FLOAT, _INDEX = 5126, 5125
_VERTICES, _INDICES = 34962, 34963
# linear colours and opacity of bodies by kind
_LOOKS = {
    "box": (0.05, 0.45, 0.45, 1.0),
    "roller": (0.40, 0.45, 0.50, 1.0),
    "sector": (0.07, 0.09, 0.11, 1.0),
    "mark": (0.67, 0.11, 0.0, 1.0),
    "arm": (0.30, 0.22, 0.10, 1.0),
    "mesh": (0.20, 0.29, 0.39, 1.0),
    "plane": (0.55, 0.60, 0.65, 0.35),
    "guide": (0.20, 0.29, 0.39, 0.45),
}


class _Buffer:
    """The binary part of a file, and what says how to read it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def put(self, values: Any, kind: str, target: int | None = None, bounds: bool = False) -> int:
        """Number of the accessor of these values, by rows."""
        index = kind == "SCALAR" and target == _INDICES
        array = np.ascontiguousarray(values, dtype="<u4" if index else "<f4")
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": array.nbytes}
        self.views.append(view | ({} if target is None else {"target": target}))
        self.data += array.tobytes()
        message: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": _INDEX if index else _FLOAT,
            "count": len(array),
            "type": kind,
        }
        if bounds:
            rows = array.reshape(len(array), -1)
            message |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.accessors.append(message)
        return len(self.accessors) - 1


def glb(result: Result, first: int = 0) -> bytes:
    """The file of a run, in metres, y up, as glTF wants it; its nodes stand where the bodies are at the state
    `first` of those that are shown, and are named as the bodies (an arm as its roller, with `_arm`).

    The animation takes LASTS seconds; `asset.extras.ms_per_s` says how many ms a second shows. The same
    result gives the same bytes.
    """
    model, buffer = result.model, _Buffer()
    at = frames(result)
    place, turn = poses(result, at)
    # x, y, z, w
    turn = np.roll(turn, -1, axis=2)
    looks = list(_LOOKS)
    meshes = [_mesh(buffer, "box", CORNERS, BOX, looks.index("box"))]
    nodes: list[dict[str, Any]] = []
    rows: dict[int, int] = {}
    called = names(model)

    def node(body: int, **more: Any) -> None:
        rows[body] = len(nodes)
        record = {"name": called[body], "translation": place[first, body].tolist()}
        nodes.append(record | {"rotation": turn[first, body].tolist()} | more)

    for body in range(boxes.count(model)):
        node(body, mesh=0, scale=model.bodies.half[body].tolist())
    for mesh in machine(model):
        meshes.append(
            _mesh(buffer, f"{mesh.name} {mesh.kind}", mesh.points, mesh.triangles, looks.index(mesh.kind))
        )
        if mesh.body not in rows:
            node(mesh.body, mesh=len(meshes) - 1)
            continue
        nodes[rows[mesh.body]].setdefault("children", []).append(len(nodes))
        nodes.append({"name": f"{mesh.name} {mesh.kind}", "mesh": len(meshes) - 1})
    moves = moving(model)
    for body in moves:
        if body not in rows:  # nothing is drawn of a roller that is a mesh
            node(body)
    inside = {child for record in nodes for child in record.get("children", ())}
    # mm to m, and z up to y up
    root = {
        "name": model.name,
        "children": [k for k in range(len(nodes)) if k not in inside],
        "rotation": [-(0.5**0.5), 0.0, 0.0, 0.5**0.5],
        "scale": [0.001] * 3,
    }
    span = float(result.time[at[-1]] - result.time[at[0]])
    record: dict[str, Any] = {
        "asset": {
            "version": "2.0",
            "generator": f"mdlgen {version()}",
            "extras": {"ms_per_s": span / LASTS},
        },
        "scene": 0,
        "scenes": [{"name": model.name, "nodes": [len(nodes)]}],
        "nodes": [*nodes, root],
        "meshes": meshes,
        "materials": [_material(name) for name in looks],
    }
    if span > 0.0:
        time = (result.time[at] - result.time[at[0]]) * (LASTS / span)
        record["animations"] = [_animation(buffer, time, place, turn, {b: rows[b] for b in moves})]
    record |= {
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    return _file(record, bytes(buffer.data))


def _mesh(buffer: _Buffer, name: str, points: Floats, triangles: Any, look: int) -> dict[str, Any]:
    """Without normals a reader takes faces as flat, which they are."""
    attributes = {"POSITION": buffer.put(points, "VEC3", _VERTICES, bounds=True)}
    indices = buffer.put(np.ravel(triangles), "SCALAR", _INDICES)
    return {"name": name, "primitives": [{"attributes": attributes, "indices": indices, "material": look}]}


def _material(name: str) -> dict[str, Any]:
    colour = _LOOKS[name]
    look = {"baseColorFactor": list(colour), "metallicFactor": 0.0, "roughnessFactor": 0.8}
    more = {"alphaMode": "BLEND"} if colour[3] < 1.0 else {}
    return {"name": name, "pbrMetallicRoughness": look, "doubleSided": True, **more}


def _animation(
    buffer: _Buffer, time: Floats, place: Floats, turn: Floats, rows: dict[int, int]
) -> dict[str, Any]:
    clock = buffer.put(time, "SCALAR", bounds=True)
    samplers, channels = [], []
    for body, row in rows.items():
        quaternions = turn[:, body].copy()
        # of q and -q, which are the same rotation, the one that is nearer to the one before
        flips = np.where(np.einsum("tk,tk->t", quaternions[1:], quaternions[:-1]) < 0.0, -1.0, 1.0)
        quaternions[1:] *= np.cumprod(flips)[:, None]
        for path, values, kind in (
            ("translation", place[:, body], "VEC3"),
            ("rotation", quaternions, "VEC4"),
        ):
            channels.append({"sampler": len(samplers), "target": {"node": row, "path": path}})
            samplers.append({"input": clock, "output": buffer.put(values, kind), "interpolation": "LINEAR"})
    return {"name": "run", "channels": channels, "samplers": samplers}


def _file(message: dict[str, Any], data: bytes) -> bytes:
    """Both chunks, each filled up to a multiple of four."""
    text = json.dumps(message, allow_nan=False, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = (
        struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    )
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks

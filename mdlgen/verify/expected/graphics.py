"""What a text must show: boxes, cylinders, meshes, surfaces."""

from __future__ import annotations

import numpy as np

from mdlgen.model.meshes import origin as mesh_origin
from mdlgen.model.parts.guide import facets
from mdlgen.model.tables import (
    Floats,
    Ints,
    MeshPart,
    Model,
)
from mdlgen.spec.solid import moments
from mdlgen.verify.expected.points import boxes_of, rim
from mdlgen.verify.expected.units import reach
from mdlgen.verify.tables import Part, Table, table


def boxes(model: Model) -> Table:
    bodies = model.bodies
    rows = np.array(
        [*(b for s in model.sheets for b in boxes_of(model, s)), *(p.body for p in model.planes)], dtype=int
    )
    names = [f"gbox_{bodies.name[b]}" for b in rows]
    words = [(f"b_{bodies.name[b]}",) for b in rows]
    shown = [(f"{guide.name}_{k}", guide, f) for guide in model.guides for k, f in enumerate(facets(guide))]
    names += [f"gbox_{name}" for name, _, _ in shown]
    words += [(f"b_{guide.name}",) for _, guide, _ in shown]
    rims = [(name, roller, f) for roller in model.rollers for name, f in rim(model, roller)]
    names += [f"gbox_{name}" for name, _, _ in rims]
    words += [(f"b_{roller.name}",) for _, roller, _ in rims]
    shown = [*shown, *rims]
    turned = np.array([f.rotation for _, _, f in shown]).reshape(-1, 3, 3)
    parts: dict[str, Part] = {
        "center": (np.array([*bodies.position[rows], *(f.center for _, _, f in shown)]), reach(model)),
        "axes": (np.concatenate([bodies.rotation[rows], turned]).transpose(0, 2, 1), 1.0),
        "lengths": (np.array([*2 * bodies.half[rows], *(f.lengths for _, _, f in shown)]), None),
    }
    return table(names, parts, words)


def cylinders(model: Model) -> Table:
    parts: dict[str, Part] = {
        "start": (
            np.array([model.bodies.position[r.body] - r.axis * r.width / 2 for r in model.rollers]).reshape(
                -1, 3
            ),
            reach(model),
        ),
        "axis": (np.array([r.axis for r in model.rollers]).reshape(-1, 3), 1.0),
        "radii": (np.array([(r.radius, r.radius) for r in model.rollers]).reshape(-1, 2), None),
        "length": (np.array([r.width for r in model.rollers]), None),
    }
    words = [(f"b_{r.name}", "CAPBOTH") for r in model.rollers]
    return table([f"gcyl_{r.name}" for r in model.rollers], parts, words)


def under(model: Model, mesh: MeshPart) -> str:
    """The body that a mesh is fixed to."""
    return "B_Ground" if mesh.on < 0 else f"b_{model.rollers[mesh.on].name}"


def meshes(model: Model) -> Table:
    places = np.array([mesh_origin(m, model.rollers) for m in model.meshes]).reshape(-1, 3)
    axes = np.array([m.axes.T for m in model.meshes]).reshape(-1, 9)
    parts: dict[str, Part] = {"origin": (places, reach(model)), "axes": (axes, 1.0)}
    return table([f"gcad_{m.name}" for m in model.meshes], parts, [(f"b_{m.name}",) for m in model.meshes])


def mesh_files(model: Model) -> Table:
    """What a text says of files: moved and turned by nothing against their marker, and scaled to mm."""
    parts: dict[str, Part] = {
        "moved": (np.zeros((len(model.meshes), 6)), 1.0),
        "scale": (np.array([[m.scale] * 3 for m in model.meshes]).reshape(-1, 3), None),
    }
    return table([f"gcad_{m.name}" for m in model.meshes], parts, [(m.file,) for m in model.meshes])


def mesh_shapes(model: Model) -> Table:
    """What a deck says of meshes: counts, volume, its middle, least and greatest coordinates."""
    rows = [shape_numbers(m.corners, m.triangles) for m in model.meshes]
    scale = np.array([[1.0, 1.0, m.volume] + [float(np.abs(m.corners).max())] * 9 for m in model.meshes])
    parts: dict[str, Part] = {"shape": (np.array(rows).reshape(-1, 12), scale.reshape(-1, 12))}
    return table([f"gcad_{m.name}" for m in model.meshes], parts)


def shape_numbers(corners: Floats, triangles: Ints) -> list[float]:
    """The twelve numbers of `mesh_shapes`."""
    volume, middle, _ = moments(corners, triangles)
    ends = (*middle, *corners.min(axis=0), *corners.max(axis=0))
    return [float(v) for v in (len(corners), len(triangles), volume, *ends)]


def surfaces(model: Model) -> Table:
    names, words = [], []
    for sheet in model.sheets:
        if sheet.surface:
            names.append(f"defsur_{sheet.name}")
            boxes = [f"m_{model.bodies.name[b]}" for b in boxes_of(model, sheet)]
            words.append(("NATURAL", f"{sheet.n_y} rows", *boxes))
    return table(names, {}, words)

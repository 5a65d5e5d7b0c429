"""Rows of the graphics in an MDL file, a deck or a script."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mdlgen.verify.expected.parts.mesh import shape_numbers
from mdlgen.verify.readback.rows import Row, flat, table_of
from mdlgen.verify.tables import Table

FORMS = ("BOX", "CYLINDER", "SPHERE", "CADGRAPHIC")


def graphic_tables(graphics: Mapping[str, Mapping[str, Any]]) -> dict[str, Table]:
    """Those of graphics of each form, as `expected` has them."""
    of = {form: {n: r for n, r in graphics.items() if r["type"] == form} for form in FORMS}
    meshes = of["CADGRAPHIC"]
    return {
        "boxes": table_of(of["BOX"], _box, 15),
        "cylinders": table_of(of["CYLINDER"], _cylinder, 9),
        "spheres": table_of(of["SPHERE"], _sphere, 4),
        "meshes": table_of(meshes, _mesh, 12),
        "mesh files": table_of({n: r for n, r in meshes.items() if "file" in r}, _mesh_file, 9),
        "mesh shapes": table_of({n: r for n, r in meshes.items() if "corners" in r}, _mesh_shape, 12),
    }


def surface_table(surfaces: Mapping[str, Mapping[str, Any]]) -> Table:
    """The markers that surfaces go through."""
    return table_of(surfaces, _surface, 0)


def _box(name: str, record: Mapping[str, Any]) -> Row:
    return [*record["center"], *flat(record["axes"]), *record["lengths"]], (record["body"],)


def _cylinder(name: str, record: Mapping[str, Any]) -> Row:
    numbers = [*record["start"], *record["axis"], *record["radii"], record["length"]]
    return numbers, (record["body"], record["caps"])


def _sphere(name: str, record: Mapping[str, Any]) -> Row:
    return [*record["center"], record["radius"]], (record["body"],)


def _mesh(name: str, record: Mapping[str, Any]) -> Row:
    if record.get("origin") is None:
        return [], (record["body"] or "",)
    return [*record["origin"], *flat(record["axes"])], (record["body"] or "",)


def _mesh_file(name: str, record: Mapping[str, Any]) -> Row:
    return [*record["moved"], *record["scale"]], (record["file"],)


def _mesh_shape(name: str, record: Mapping[str, Any]) -> Row:
    return shape_numbers(np.array(record["corners"]), np.array(record["triangles"])), ()


def _surface(name: str, record: Mapping[str, Any]) -> Row:
    rows = record["markers"]
    return [], (record["type"], f"{len(rows)} rows", *(m for row in rows for m in row))

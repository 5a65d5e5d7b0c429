"""The parameters that the user gave for sheets."""

from __future__ import annotations

from mdlgen.model.parameters.machine import center_rows
from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.tables import Parameter
from mdlgen.spec.material import Damping
from mdlgen.spec.scene import Scene
from mdlgen.spec.shape import Fold


def sheet_rows(scene: Scene, name: str) -> list[Parameter]:
    sheet, base = scene.sheets[name], ("sheets", name)
    material, source = scene.materials[sheet.material], ("materials", sheet.material)
    rows = center_rows(name, sheet.center, base)
    if sheet.rotation is None:
        rows.append(Parameter(name, "turn", "Turn about z (deg)", sheet.turn or 0.0, "rad", (*base, "turn")))
    else:
        for k, axis in enumerate(NAMED_AXES):
            label = f"Rotation about {axis} (deg)"
            rows.append(Parameter(name, f"r_{axis}", label, sheet.rotation[k], "rad", (*base, "rotation", k)))
    rows += [
        Parameter(name, "L_x", "Length L_x along MD", sheet.size[0], "mm", (*base, "size", 0)),
        Parameter(name, "L_y", "Length L_y along CD", sheet.size[1], "mm", (*base, "size", 1)),
        Parameter(name, "s", "Thickness s", sheet.thickness, "mm", (*base, "thickness")),
        Parameter(name, "M", "Mass M of the sheet", sheet.mass, "g", (*base, "mass")),
    ]
    for k, way in enumerate(("md", "cd")):
        label = f"Modulus E_{way.upper()} (N/mm2)"
        # of a curve the modulus is its first slope, computed
        path = (*source, f"E_{way}") if getattr(material, f"curve_{way}") is None else None
        rows.append(Parameter(name, f"E_{way}", label, material.moduli[k], "MPa", path))
    for member, label, unit in (
        ("k_tx", "Hinge stiffness k_tx (N mm/rad)", "N*mm/rad"),
        ("k_ty", "Hinge stiffness k_ty (N mm/rad)", "N*mm/rad"),
        ("k_tz", "In-plane stiffness k_tz (N mm/rad)", "N*mm/rad"),
        ("D_md", "Bending stiffness per width D_MD (N mm)", "N*mm"),
        ("D_cd", "Bending stiffness per width D_CD (N mm)", "N*mm"),
        ("D_twist", "Twisting stiffness per width (N mm)", "N*mm"),
        ("G", "Shear modulus G in the plane (N/mm2)", "MPa"),
    ):
        value = getattr(material, member)
        if member == "k_tz" and sheet.layout == "plate":  # follows from E_md and E_cd there
            continue
        if value is not None:
            rows.append(Parameter(name, member, label, value, unit, (*source, member)))
    rows += _damping(name, material.damping, (*source, "damping"))
    if any(sheet.velocity) or any(sheet.spin):
        for k, axis in enumerate(NAMED_AXES):
            label = f"Initial velocity {axis}"
            rows.append(
                Parameter(name, f"v_{axis}", label, sheet.velocity[k], "mm/ms", (*base, "velocity", k))
            )
        for k, axis in enumerate(NAMED_AXES):
            label = f"Initial spin {axis} (rad/s)"
            rows.append(Parameter(name, f"w_{axis}", label, sheet.spin[k], "rad/ms", (*base, "spin", k)))
    return rows


def _damping(name: str, damping: Damping, path: tuple[str, ...]) -> list[Parameter]:
    """Ratios, damping times or loss factors of a sheet's material, as they are given."""
    if damping.times is None:
        zeta, zeta_ty = damping.zetas
        label = "Relative damping zeta"
        return [
            Parameter(name, "zeta", label, zeta, "1", (*path, "ratio")),
            Parameter(name, "zeta_ty", f"{label} of rotation about y", zeta_ty, "1", (*path, "ratio_ty")),
        ]
    if damping.time is not None:
        return _each_way(name, "tau", "Damping time tau", damping.time, "ms", (*path, "time"))
    assert damping.loss_factor is not None and damping.at is not None
    rows = _each_way(name, "eta", "Loss factor eta", damping.loss_factor, "1", (*path, "loss_factor"))
    label = "Frequency of the loss factor (Hz)"
    return [*rows, Parameter(name, "f", label, damping.at, "1/ms", (*path, "at"))]


def _each_way(
    name: str,
    member: str,
    label: str,
    value: float | tuple[float, float],
    unit: str,
    path: tuple[str | int, ...],
) -> list[Parameter]:
    """A value for both MD and CD, or one for each."""
    if not isinstance(value, tuple):
        return [Parameter(name, member, label, value, unit, path)]
    return [
        Parameter(name, f"{member}_{way}", f"{label} of {way.upper()}", own, unit, (*path, k))
        for k, (way, own) in enumerate(zip(("md", "cd"), value, strict=True))
    ]


def grading_rows(scene: Scene, name: str) -> list[Parameter]:
    """Relative lengths of the columns and rows of boxes that are given one by one."""
    sheet, rows = scene.sheets[name], []
    if sheet.grading is None:
        return rows
    for k, (axis, graded) in enumerate((("x", sheet.grading.x), ("y", sheet.grading.y))):
        if graded is None:
            continue
        what = ("column", "row")[k]
        for index, size in enumerate(graded.relative(sheet.boxes[k], sheet.size[k])):
            path = ("sheets", name, "grading", axis, "sizes", index)
            label = f"Relative length of {what} {index}"
            rows.append(Parameter(f"{name}_grid_{axis}", f"g_{index}", label, size, "1", path))
    return rows


def zones_rows(scene: Scene, name: str) -> list[Parameter]:
    rows, sheet = [], scene.sheets[name]
    for zone_name in sorted(sheet.zones):
        zone, group = sheet.zones[zone_name], f"{name}_zone_{zone_name}"
        path = ("sheets", name, "zones", zone_name)
        if zone.thickness is not None:
            rows.append(Parameter(group, "s", "Thickness s", zone.thickness, "mm", (*path, "thickness")))
        for member, label in (
            ("density", "Density relative to the rest"),
            ("stiffness", "Moduli relative to the rest"),
            ("friction", "Friction relative to the rest"),
        ):
            rows.append(Parameter(group, member, label, getattr(zone, member), "1", (*path, member)))
    return rows


def shape_rows(scene: Scene, name: str) -> list[Parameter]:
    """Radius of a curl, and angles and stiffness of creases."""
    shape, rows = scene.sheets[name].shape, []
    if shape is None:
        return rows
    group, path = f"{name}_shape", ("sheets", name, "shape")
    if shape.curl is not None:
        label = f"Radius of the curl along {shape.curl.along}"
        rows.append(Parameter(group, "radius", label, shape.curl.radius, "mm", (*path, "curl", "radius")))
    for kind, items in (("folds", shape.folds), ("dog_ears", shape.dog_ears)):
        for k, item in enumerate(items):
            at, what = (*path, kind, k), "fold" if kind == "folds" else "ear"
            stiff = ("soft", f"Stiffness of the crease of {what} {k}", item.stiffness, "1", "stiffness")
            if isinstance(item, Fold) and item.crease is not None:
                label = f"Stiffness of the crease of {what} {k} per length (N/rad)"
                stiff = ("crease", label, item.crease, "N*mm/rad/mm", "crease")
            for member, label, value, unit, key in (
                ("angle", f"Angle of {what} {k} (deg)", item.angle, "rad", "angle"),
                stiff,
            ):
                rows.append(Parameter(group, f"{what}_{k}_{member}", label, value, unit, (*at, key)))
    return rows

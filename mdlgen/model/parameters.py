"""The named values that a user gave, in the order in which a text shows them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from mdlgen.formulas import Dimension, is_formula
from mdlgen.model.meshes import LIGHT
from mdlgen.model.tables import Parameter, RunSettings
from mdlgen.spec.machine import Press
from mdlgen.spec.material import Damping
from mdlgen.spec.scene import Scene
from mdlgen.spec.smoothing import formulas as smoothing_formulas
from mdlgen.spec.smoothing import speeds
from mdlgen.units import parse_unit, same, unit_of

_NAMED_AXES = ("x", "y", "z")
OF_USER = "parameters"  # data set of those that the user named
# Members of a contact -> what they are of its friction.
FRICTION = {"mu_s": "static", "mu_d": "dynamic", "v_s": "stiction_velocity", "v_d": "friction_velocity"}
# Internal units as parameters have them.
_UNITS = (
    *("mm", "N", "1", "MPa", "N/mm", "N*mm", "N*mm/rad", "N/mm^1.5", "g", "g/mm^3", "g*mm^2"),
    *("N*mm*ms/rad", "ms", "1/ms", "mm/ms", "rad/ms", "mm/ms^2", "rad"),
)


def unit(dimension: Dimension) -> str:
    """The internal unit of a dimension."""
    for known in _UNITS:
        if same(parse_unit(known).dimension, dimension):
            return known
    named = zip(("mm", "g", "ms", "rad"), dimension, strict=True)
    return "*".join(f"{name}^{power!r}" for name, power in named if power)


def in_text(dimension: Dimension) -> str:
    """The unit in which a text shows a dimension, in the letters that a label may have."""
    shown = unit_of(dimension)
    if shown in ("no unit", "g", "rad"):
        shown = {"no unit": "", "g": "kg", "rad": "deg"}[shown]
    elif shown.startswith("g"):
        shown = f"k{shown}"
    return shown.replace("*", " ").replace("^1.5", " to the 1.5").replace("^", "")


def parameters(
    scene: Scene, starts: dict[str, tuple[float, float]], run: RunSettings
) -> tuple[Parameter, ...]:
    """All parameters of a scene; `starts` gives (touch, start) of each pressed roller and plate [mm]."""
    rows = _given(scene, starts, run)
    if not scene.formulas and not scene.parameters:
        return tuple(rows)
    formulas = {**scene.formulas, **smoothing_formulas(scene)}
    return (*_own(scene), *(_with_formula(scene, formulas, row) for row in rows))


def unfollowed(scene: Scene, rows: tuple[Parameter, ...]) -> tuple[tuple[str, str], ...]:
    """Formulas of values that no row has, and that so are numbers in a text: where they stand, and texts.

    Gravity, loads and frictions are not among them: a script sets them, or a text is refused; of nips the
    rollers are there.
    """
    had = {row.path for row in rows} | {_source(scene, row)[0] for row in rows if row.formula}
    return tuple(
        (".".join(map(str, path)), formula)
        for path, formula in sorted(scene.formulas.items(), key=lambda item: str(item[0]))
        if path not in had and path[0] not in ("gravity", "loads", "nips") and path[2:3] != ("at",)
    )


def _own(scene: Scene) -> list[Parameter]:
    """The parameters that the user named."""
    rows = []
    for name, amount in scene.amounts.items():
        given = scene.parameters[name]
        formula = given if isinstance(given, str) and is_formula(given, scene.parameters) else ""
        shown = in_text(amount.dimension)
        label = f"Parameter {name}" + (f" ({shown})" if shown else "")
        rows.append(
            Parameter(OF_USER, name, label, amount.value, unit(amount.dimension), (OF_USER, name), formula)
        )
    return rows


def _with_formula(scene: Scene, formulas: Mapping[tuple[str | int, ...], str], row: Parameter) -> Parameter:
    """A row with its formula: that of its value, or of the one that it follows from where it is left out."""
    formula = formulas.get(row.path or (), "")
    if not formula:
        source, template = _source(scene, row)
        followed = formulas.get(source, "")
        formula = template.format(followed) if followed else ""
    return replace(row, formula=formula)


def _source(scene: Scene, row: Parameter) -> tuple[tuple[str | int, ...], str]:
    """Where the value stands that a row follows from, and how."""
    path = row.path or ()
    if row.data_set.startswith("contact_") and row.member in FRICTION:
        index = int(row.data_set.removeprefix("contact_"))
        base, friction = ("contacts", index), scene.contacts[index].friction
        own, smooth = ((*base, "friction", FRICTION[member]) for member in (row.member, "v_s"))
        if row.member in ("mu_s", "mu_d") or getattr(friction, FRICTION[row.member]) is not None:
            return own, "{}"
        slow = smooth if friction.stiction_velocity is not None else (*base, "smoothing")
        if scene.contacts[index].smoothing is None and friction.friction_velocity is not None:
            return slow, f"min({{}}, {1e3 * friction.friction_velocity!r} mm/s)"
        return slow, "{}" if row.member == "v_s" or friction.static == friction.dynamic else "1.5*({})"
    if path[-2:] == ("press", "carrier_mass") and path[:1] == ("rollers",):
        return (*path[:2], "mass"), "({})/1000"
    if path[-2:] == ("damping", "ratio_ty"):
        return (*path[:-1], "ratio"), "{}"
    if path == ("run", "print_step"):
        return ("run", "duration"), "({})/200"
    return (), "{}"


def _given(scene: Scene, starts: dict[str, tuple[float, float]], run: RunSettings) -> list[Parameter]:
    """All parameters but those that the user named, as numbers."""
    rows: list[Parameter] = []
    for name in sorted(scene.sheets):
        rows += _sheet(scene, name)
        rows += _grading(scene, name)
        rows += _zones(scene, name)
        rows += _shape(scene, name)
    for name in sorted(scene.rollers):
        rows += _roller(scene, name, starts)
    for name in sorted(scene.planes):
        plane, base = scene.planes[name], ("planes", name)
        rows += _center(name, plane.center, base)
        for k, size in enumerate(plane.size):
            axis = _NAMED_AXES[k]
            rows.append(
                Parameter(name, f"L_{axis}", f"Length along its {axis}", size, "mm", (*base, "size", k))
            )
        rows.append(Parameter(name, "M", "Mass", plane.mass, "g", (*base, "mass")))
        if plane.press is not None:
            rows += _plate_press(name, plane.press, starts[name][1])
    for name in sorted(scene.guides):
        rows += _guide(scene, name)
    for name in sorted(scene.meshes):
        rows += _mesh(scene, name)
    for index, (contact, (smooth, slow, fast)) in enumerate(zip(scene.contacts, speeds(scene), strict=True)):
        base, group, friction = ("contacts", index), f"contact_{index}", contact.friction
        for member, label, value, unit, path in (
            ("k", "Stiffness k (N/mm to the 1.5)", contact.stiffness, "N/mm^1.5", "stiffness"),
            ("c_R", "Restitution c_R", contact.restitution, "1", "restitution"),
            ("mu_s", "Static friction", friction.static, "1", None),
            ("mu_d", "Dynamic friction", friction.dynamic, "1", None),
            ("v_s", "Stiction velocity", slow, "mm/ms", None),
            ("v_d", "Friction velocity", fast, "mm/ms", None),
            ("v_n", "Smoothing velocity of the damping", smooth, "mm/ms", "smoothing"),
        ):
            rows.append(Parameter(group, member, label, value, unit, (*base, path) if path else None))
    rows.append(Parameter("run", "end", "End time", run.duration, "ms", ("run", "duration")))
    rows.append(Parameter("run", "print", "Print interval", run.print_step, "ms", ("run", "print_step")))
    return rows


def _center(name: str, center: tuple[float, ...], base: tuple[str, str]) -> list[Parameter]:
    return [
        Parameter(name, axis, f"Centre {axis}", center[k], "mm", (*base, "center", k))
        for k, axis in enumerate(_NAMED_AXES)
    ]


def _guide(scene: Scene, name: str) -> list[Parameter]:
    guide, base = scene.guides[name], ("guides", name)
    rows = []
    if guide.line is not None:
        for end, key, place in (("0", "from", guide.line.from_), ("1", "to", guide.line.to)):
            for k, axis in enumerate(_NAMED_AXES):
                path = (*base, "line", key, k)
                label = f"{axis} where it {'ends' if key == 'to' else 'begins'}"
                rows.append(Parameter(name, f"{axis}_{end}", label, place[k], "mm", path))
    if guide.arc is not None:
        arc, path = guide.arc, (*base, "arc")
        for k, axis in enumerate(_NAMED_AXES):
            rows.append(Parameter(name, axis, f"Centre {axis}", arc.center[k], "mm", (*path, "center", k)))
        rows += [
            Parameter(name, "R", f"Radius, {arc.side}", arc.radius, "mm", (*path, "radius")),
            Parameter(name, "from", "Angle where it begins (deg)", arc.from_, "rad", (*path, "from")),
            Parameter(name, "to", "Angle where it ends (deg)", arc.to, "rad", (*path, "to")),
        ]
    return [
        *rows,
        Parameter(name, "w", "Width", guide.width, "mm", (*base, "width")),
        Parameter(name, "s", "Thickness of the plate", guide.thickness, "mm", (*base, "thickness")),
        Parameter(name, "M", "Mass", guide.mass, "g", (*base, "mass")),
    ]


def _mesh(scene: Scene, name: str) -> list[Parameter]:
    mesh, base = scene.meshes[name], ("meshes", name)
    rows = _center(name, mesh.center, base)
    for k, axis in enumerate(_NAMED_AXES):
        label = f"Rotation about {axis} (deg)"
        rows.append(Parameter(name, f"r_{axis}", label, mesh.rotation[k], "rad", (*base, "rotation", k)))
    if mesh.density is not None:
        path = (*base, "density")
        return [*rows, Parameter(name, "rho", "Density (kg/mm3)", mesh.density, "g/mm^3", path)]
    mass = LIGHT if mesh.mass is None else mesh.mass
    return [*rows, Parameter(name, "M", "Mass", mass, "g", (*base, "mass"))]


def _sheet(scene: Scene, name: str) -> list[Parameter]:
    sheet, base = scene.sheets[name], ("sheets", name)
    material, source = scene.materials[sheet.material], ("materials", sheet.material)
    rows = _center(name, sheet.center, base)
    if sheet.rotation is None:
        rows.append(Parameter(name, "turn", "Turn about z (deg)", sheet.turn or 0.0, "rad", (*base, "turn")))
    else:
        for k, axis in enumerate(_NAMED_AXES):
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
        for k, axis in enumerate(_NAMED_AXES):
            label = f"Initial velocity {axis}"
            rows.append(
                Parameter(name, f"v_{axis}", label, sheet.velocity[k], "mm/ms", (*base, "velocity", k))
            )
        for k, axis in enumerate(_NAMED_AXES):
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


def _grading(scene: Scene, name: str) -> list[Parameter]:
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


def _zones(scene: Scene, name: str) -> list[Parameter]:
    rows, sheet = [], scene.sheets[name]
    for zone_name in sorted(sheet.zones):
        zone, group = sheet.zones[zone_name], f"{name}_zone_{zone_name}"
        path = ("sheets", name, "zones", zone_name)
        if zone.thickness is not None:
            rows.append(Parameter(group, "s", "Thickness s", zone.thickness, "mm", (*path, "thickness")))
        for member, label in (
            ("density", "Density in times that of the rest"),
            ("stiffness", "Moduli in times those of the rest"),
            ("friction", "Friction in times that of the rest"),
        ):
            rows.append(Parameter(group, member, label, getattr(zone, member), "1", (*path, member)))
    return rows


def _shape(scene: Scene, name: str) -> list[Parameter]:
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
            for member, label, value, unit, key in (
                ("angle", f"Angle of {what} {k} (deg)", item.angle, "rad", "angle"),
                ("soft", f"Stiffness of the crease of {what} {k}", item.stiffness, "1", "stiffness"),
            ):
                rows.append(Parameter(group, f"{what}_{k}_{member}", label, value, unit, (*at, key)))
    return rows


def _roller(scene: Scene, name: str, starts: dict[str, tuple[float, float]]) -> list[Parameter]:
    roller, base = scene.rollers[name], ("rollers", name)
    rows = _center(name, roller.center, base)
    rows += [
        Parameter(name, "R", "Radius R", roller.radius, "mm", (*base, "radius")),
        Parameter(name, "w", "Width", roller.width, "mm", (*base, "width")),
        Parameter(name, "M", "Mass", roller.mass, "g", (*base, "mass")),
    ]
    if roller.drive is not None:
        drive = (*base, "drive")
        if roller.drive.speed is not None:
            rows.append(
                Parameter(name, "omega", "Speed (rad/s)", roller.drive.speed, "rad/ms", (*drive, "speed"))
            )
            rows.append(Parameter(name, "ramp", "Ramp time", roller.drive.ramp, "ms", (*drive, "ramp")))
        for k, (time, speed) in enumerate(roller.drive.profile or ()):
            at = (*drive, "profile", k)
            rows.append(Parameter(name, f"t_{k}", f"Time of corner {k}", time, "ms", (*at, 0)))
            rows.append(Parameter(name, f"w_{k}", f"Speed at corner {k} (rad/s)", speed, "rad/ms", (*at, 1)))
    rows += _rim(scene, name) + _arm(scene, name)
    if roller.press is not None:
        carrier = roller.press.carrier_mass
        touch, start = starts[name]
        rows += [
            *_spring(name, roller.press, base),
            Parameter(
                name,
                "M_c",
                "Carrier mass",
                roller.mass / 1000 if carrier is None else carrier,
                "g",
                (*base, "press", "carrier_mass"),
            ),
            Parameter(name, "touch", "Touching position along the slide, as written", touch, "mm", None),
            _start(name, start),
        ]
    return rows


def _spring(name: str, press: Press, base: tuple[str, str]) -> list[Parameter]:
    """The spring of a roller or a plate."""
    way = (*base, "press")
    return [
        Parameter(name, "k", "Spring stiffness", press.stiffness, "N/mm", (*way, "stiffness")),
        Parameter(name, "f", "Spring preload (N)", press.preload, "N", (*way, "preload")),
        Parameter(name, "l", "Spring free length", press.free_length, "mm", (*way, "free_length")),
        Parameter(name, "zeta", "Relative damping", press.damping_ratio, "1", (*way, "damping_ratio")),
    ]


def _start(name: str, start: float) -> Parameter:
    label = "Start along the slide in static equilibrium, as written"
    return Parameter(name, "start", label, start, "mm", None)


def _plate_press(name: str, press: Press, start: float) -> list[Parameter]:
    """Spring and slide of a plate, which touches no roller: its spring has the preload where it is given."""
    base = ("planes", name)
    rows = _spring(name, press, base)
    if press.carrier_mass is not None:
        path = (*base, "press", "carrier_mass")
        rows.append(Parameter(name, "M_c", "Mass of its slide", press.carrier_mass, "g", path))
    return [*rows, _start(name, start)]


def _rim(scene: Scene, name: str) -> list[Parameter]:
    """Angles, radius, friction, stiffness and restitution of the sectors of a rim, as far as given."""
    rim, rows = scene.rollers[name].rim, []
    for k, sector in enumerate(rim.sectors if rim is not None else ()):
        path = ("rollers", name, "rim", "sectors", k)
        for member, label, value, unit in (
            ("from", "Angle where sector %d begins (deg)", sector.from_, "rad"),
            ("to", "Angle where sector %d ends (deg)", sector.to, "rad"),
            ("radius", "Radius of sector %d", sector.radius, "mm"),
            ("friction", "Friction of sector %d in times that of the contact", sector.friction, "1"),
            ("stiffness", "Stiffness of sector %d in times that of the contact", sector.stiffness, "1"),
            ("restitution", "Restitution c_R of sector %d", sector.restitution, "1"),
        ):
            if value is not None:
                rows.append(Parameter(name, f"s{k}_{member}", label % k, value, unit, (*path, member)))
    return rows


def _arm(scene: Scene, name: str) -> list[Parameter]:
    """Pivot, mass and spring of an arm; centre of mass and inertia where they are given."""
    arm, path = scene.rollers[name].arm, ("rollers", name, "arm")
    if arm is None:
        return []
    rows = []
    for k, axis in enumerate(_NAMED_AXES):
        label = f"Pivot of the arm {axis}"
        rows.append(Parameter(name, f"a_{axis}", label, arm.pivot[k], "mm", (*path, "pivot", k)))
    rows.append(Parameter(name, "M_a", "Mass of the arm", arm.mass, "g", (*path, "mass")))
    if arm.center is not None:
        for k, axis in enumerate(_NAMED_AXES):
            label = f"Centre of mass of the arm {axis}"
            rows.append(Parameter(name, f"g_{axis}", label, arm.center[k], "mm", (*path, "center", k)))
    if arm.inertia is not None:
        label = "Inertia of the arm about it (kg mm2)"
        rows.append(Parameter(name, "I_a", label, arm.inertia, "g*mm^2", (*path, "inertia")))
    if arm.sprung:
        rows += [
            Parameter(name, "T_a", "Torque of its spring (N mm)", arm.torque, "N*mm", (*path, "torque")),
            Parameter(
                name, "k_a", "Its stiffness (N mm/rad)", arm.stiffness, "N*mm/rad", (*path, "stiffness")
            ),
            Parameter(
                name, "c_a", "Its damping (N mm s/rad)", arm.damping, "N*mm*ms/rad", (*path, "damping")
            ),
        ]
    return rows

"""What a text must say of a Model, made from its tables and from nothing else, in the units of the text.

Names follow the promise of the text: `b_` body, `p_` point, `bsh_` bushing, `gbox_`, `gcyl_`, `gcad_`
graphic, `j_` joint, `mot_` motion, `cs_` spring, `con_` contact, `m_` marker, `o_` output, `ds_` data set.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from mdlgen.model import naming
from mdlgen.model.curves import straight_points, written
from mdlgen.model.meshes import origin as mesh_origin
from mdlgen.model.parts.guide import Facet, facets
from mdlgen.model.rim_facets import rim_facets
from mdlgen.model.shape import apart, ground_frames
from mdlgen.model.tables import (
    CLAMP,
    GROUND,
    SUPPORT,
    Anchor,
    Floats,
    Ints,
    MeshPart,
    Model,
    PlanePart,
    RollerPart,
    SheetPart,
)
from mdlgen.spec.solid import moments
from mdlgen.verify.state import motion
from mdlgen.verify.tables import Part, Table, table

KG, SECOND = 1e-3, 1e-3  # of a gram, of a millisecond
RAMP_STATIONS = (0.0, 0.25, 0.5, 1.0, 2.0, 10.0)  # where the law of a drive is looked at, in ramps
_STATIONS_WITHOUT = (0.0, 1e-3, 1.0)  # [s]


Times = Mapping[str, tuple[float, ...]]


def expected(model: Model, times: Times) -> dict[str, Table]:
    """All tables of a Model, by kind; `times` are those at which the laws of drives are looked at [s]."""
    return {
        "points": _points(model),
        "bodies": _bodies(model),
        "bushings": _bushings(model),
        "curves": _curves(model),
        "curve laws": _curve_laws(model),
        "springs": _springs(model),
        "boxes": _boxes(model),
        "cylinders": _cylinders(model),
        "meshes": _meshes(model),
        "mesh files": _mesh_files(model),
        "joints": _joints(model),
        "motions": _motions(model, times),
        "velocities": _velocities(model),
        "markers": _markers(model),
        "vectors": _vectors(model),
        "surfaces": _surfaces(model),
        "outputs": _outputs(model),
    }


def body_name(model: Model, body: int) -> str:
    """Of a body in the text."""
    return "B_Ground" if body == GROUND else f"b_{model.bodies.name[body]}"


def reach(model: Model) -> float:
    """Size of the scene [mm], by which coordinates are measured."""
    size = [max(s.size) for s in model.sheets] + [g.radius + g.length for g in model.guides]
    return float(max(np.abs(model.bodies.position).max(initial=0.0), *size))


def _boxes_of(model: Model, sheet: SheetPart) -> range:
    return range(sheet.first, sheet.first + sheet.count)


def _anchor_points(model: Model, anchor: Anchor) -> Floats:
    """The point of an anchor on each of its boxes [mm], (n, 3)."""
    bodies = model.bodies
    return bodies.position[anchor.body] + np.einsum("nij,nj->ni", bodies.rotation[anchor.body], anchor.local)


def _spring_anchor(part: RollerPart | PlanePart) -> Floats:
    press = part.press
    assert press is not None
    return part.center + press.direction * (press.touch - press.free_length)


def _points(model: Model) -> Table:
    names, places = [], []
    for index, sheet in enumerate(model.sheets):
        names.append(f"p_{sheet.name}")
        places.append(sheet.center[None])
        names += [f"p_{model.bodies.name[b]}" for b in _boxes_of(model, sheet)]
        places.append(model.bodies.position[sheet.first : sheet.first + sheet.count])
        rows = np.flatnonzero((model.bushings.sheet == index) & (model.bushings.kind != SUPPORT))
        joints = model.bushings
        ends = zip(joints.node[rows].tolist(), joints.frames[rows].tolist(), rows.tolist(), strict=True)
        first = {naming.node(sheet, x, y, (one, two)): row for (x, y), (one, two), row in ends}
        names += [f"p_{name}" for name in first]
        places.append(joints.origin[list(first.values())])
        frames = [frame for frame in ground_frames(model, index) if frame.point]
        names += [frame.point for frame in frames]
        places += [frame.origin[None] for frame in frames]
    for name, anchor in [(s.name, s) for s in model.supports] + [
        (f"probe_{p.name}", p) for p in model.probes
    ]:
        found = _anchor_points(model, anchor)
        split = apart(model, anchor)
        names += [f"p_{name}_{k}" for k in range(len(found))] if split else [f"p_{name}"]
        places.append(found if split else found[:1])
    for roller in model.rollers:
        names.append(f"p_{roller.name}")
        places.append(model.bodies.position[roller.body][None])
        for name, facet in _rim(model, roller):
            names.append(f"p_{name}")
            places.append(facet.center[None])
        if roller.press is not None:
            names.append(f"p_{roller.name}_anchor")
            places.append(_spring_anchor(roller)[None])
        if roller.arm is not None:
            names += [f"p_{roller.name}_pivot", f"p_{roller.name}_arm"]
            places += [roller.arm.pivot[None], roller.arm.center[None]]
    for plane in model.planes:
        names.append(f"p_{plane.name}")
        places.append(model.bodies.position[plane.body][None])
        if plane.press is not None:
            names.append(f"p_{plane.name}_anchor")
            places.append(_spring_anchor(plane)[None])
    for guide in model.guides:
        names += [f"p_{guide.name}", *(f"p_{guide.name}_{k}" for k in range(guide.facets))]
        places += [guide.center[None], *(facet.center[None] for facet in facets(guide))]
    for mesh in model.meshes:
        names += [f"p_{mesh.name}", f"p_{mesh.name}_cm"]
        places += [mesh_origin(mesh, model.rollers)[None], model.bodies.position[mesh.body][None]]
    return table(names, {"at": (np.concatenate(places), reach(model))})


def _rim(model: Model, roller: RollerPart) -> list[tuple[str, Facet]]:
    body = roller.body
    return rim_facets(roller, model.bodies.position[body], model.bodies.rotation[body])


def _bodies(model: Model) -> Table:
    bodies = model.bodies
    pressed = [r for r in model.rollers if r.press is not None]
    swung = [(r.name, r.arm) for r in model.rollers if r.arm is not None]
    names = [f"b_{n}" for n in bodies.name] + [f"b_{r.name}_carrier" for r in pressed]
    names += [f"b_{name}_arm" for name, _ in swung]
    carrier = np.array([r.press.carrier_mass for r in pressed if r.press is not None])
    radius = np.array([r.radius for r in pressed])
    ball = (0.4 * carrier * radius**2)[:, None] * np.ones(3)  # a solid ball of the roller's radius
    # of an arm the inertia about its own axis counts; the text gives it for all three
    arms = np.array([arm.inertia for _, arm in swung])[:, None] * np.ones(3)
    mass = np.concatenate([bodies.mass, carrier, [arm.mass for _, arm in swung]]) * KG
    inertia = np.concatenate([bodies.inertia, ball, arms.reshape(-1, 3)]) * KG
    places = [bodies.position[r.body][None] for r in pressed] + [arm.center[None] for _, arm in swung]
    position = np.concatenate([bodies.position, *places])
    axes = np.concatenate([bodies.rotation.transpose(0, 2, 1), *(np.eye(3)[None] for _ in places)])
    products = np.zeros_like(inertia)
    parts: dict[str, Part] = {
        "mass": (mass, None),
        "inertia": (inertia, None),
        "products": (products, inertia.max(axis=1, keepdims=True)),
        "cm": (position, reach(model)),
        "axes": (axes, 1.0),
    }
    return table(names, parts)


def _bushings(model: Model) -> Table:
    rows = model.bushings
    stiff = rows.k[:, :3].copy()
    bent = np.flatnonzero(model.curves.of >= 0)
    stiff[bent, model.curves.axis[bent]] = 0.0  # a curve stands there: see _curve_laws
    arms = [(r, r.arm) for r in model.rollers if r.arm is not None and r.arm.sprung]
    turned = [model.bodies.rotation[r.body] for r, _ in arms]
    last, none = np.eye(3)[2], np.zeros((len(arms), 3))

    def both(own: Floats, more: list[Floats]) -> Floats:
        return np.concatenate([own, np.array(more).reshape(-1, *own.shape[1:])])

    parts: dict[str, Part] = {
        "origin": (both(rows.origin, [arm.pivot for _, arm in arms]), reach(model)),
        "axes": (both(rows.axes, turned).transpose(0, 2, 1), 1.0),
        "k": (both(stiff, [*none]), None),
        "c": (both(rows.c[:, :3], [*none]) * SECOND, None),
        "kt": (both(rows.k[:, 3:], [arm.stiffness * last for _, arm in arms]), None),
        "ct": (both(rows.c[:, 3:], [arm.damping * last for _, arm in arms]) * SECOND, None),
        "force": (np.zeros((len(rows) + len(arms), 3)), 1.0),
        # on the first body, which the second one is to turn away from
        "torque": (both(-rows.k[:, 3:] * rows.rest, [arm.torque * last for _, arm in arms]), 1.0),
    }
    words = [
        (body_name(model, a), body_name(model, b))
        for a, b in zip(rows.a.tolist(), rows.b.tolist(), strict=True)
    ]
    words += [(f"b_{r.name}_arm", "B_Ground") for r, _ in arms]
    names = [f"bsh_{n}" for n in rows.name] + [f"bsh_{r.name}_arm" for r, _ in arms]
    return table(names, parts, words)


def _curves(model: Model) -> Table:
    """Points of the curves: elongation [mm] and force [N] of one bushing."""
    names, points, scales = [], [np.zeros((0, 2))], [np.zeros((0, 2))]
    for curve in written(model)[0]:
        strain, stress = straight_points(model.curves, curve.number)
        length, area, name = curve.length, curve.area, curve.name
        names += [f"crv_{name}.{k}" for k in range(len(strain))]
        points.append(np.stack([length * strain, area * stress], axis=1))
        scales.append(np.broadcast_to(points[-1].max(axis=0), points[-1].shape))
    return table(names, {"point": (np.concatenate(points), np.concatenate(scales))})


def _curve_laws(model: Model) -> Table:
    """The curve of each bushing that has one, and its independent variable in the made-up state [mm]."""
    rows, curves = model.bushings, model.curves
    entities, follows = written(model)
    names, values, words = [], [], []
    for row in np.flatnonzero(curves.of >= 0).tolist():
        way = int(curves.axis[row])
        a, b = (motion(body_name(model, int(ends[row]))).displacement for ends in (rows.a, rows.b))
        # the curve is that of a whole joint: half a cell has its strain at half of the elongation
        factor = 2.0 if rows.kind[row] == CLAMP else 1.0
        name = f"bsh_{rows.name[row]}"
        names.append(f"{name}.k.{way}")
        values.append(factor * float(rows.axes[row][:, way] @ (a - b)))
        words.append((f"crv_{entities[follows[row]].name}", "LINEAR", f"{name}.i", f"{name}.j", f"{name}.j"))
    return table(names, {"variable": (np.array(values), reach(model))}, words)


def _springs(model: Model) -> Table:
    pressed = [(r, r.press) for r in (*model.rollers, *model.planes) if r.press is not None]
    parts: dict[str, Part] = {
        "p1": (np.array([model.bodies.position[r.body] for r, _ in pressed]).reshape(-1, 3), reach(model)),
        "p2": (np.array([_spring_anchor(r) for r, _ in pressed]).reshape(-1, 3), reach(model)),
        "k": (np.array([p.stiffness for _, p in pressed]), None),
        "c": (np.array([p.damping for _, p in pressed]) * SECOND, None),
        "force": (np.array([p.preload for _, p in pressed]), None),
        "length": (np.array([p.free_length for _, p in pressed]), None),
    }
    slides = {r.name: f"b_{r.name}_carrier" for r in model.rollers}
    words = [(slides.get(r.name, f"b_{r.name}"), "B_Ground") for r, _ in pressed]
    return table([f"cs_{r.name}" for r, _ in pressed], parts, words)


def _boxes(model: Model) -> Table:
    bodies = model.bodies
    rows = np.array(
        [*(b for s in model.sheets for b in _boxes_of(model, s)), *(p.body for p in model.planes)], dtype=int
    )
    names = [f"gbox_{bodies.name[b]}" for b in rows]
    words = [(f"b_{bodies.name[b]}",) for b in rows]
    shown = [(f"{guide.name}_{k}", guide, f) for guide in model.guides for k, f in enumerate(facets(guide))]
    names += [f"gbox_{name}" for name, _, _ in shown]
    words += [(f"b_{guide.name}",) for _, guide, _ in shown]
    rims = [(name, roller, f) for roller in model.rollers for name, f in _rim(model, roller)]
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


def _cylinders(model: Model) -> Table:
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


def _under(model: Model, mesh: MeshPart) -> str:
    """The body that a mesh is fixed to."""
    return "B_Ground" if mesh.on < 0 else f"b_{model.rollers[mesh.on].name}"


def _meshes(model: Model) -> Table:
    places = np.array([mesh_origin(m, model.rollers) for m in model.meshes]).reshape(-1, 3)
    axes = np.array([m.axes.T for m in model.meshes]).reshape(-1, 9)
    parts: dict[str, Part] = {"origin": (places, reach(model)), "axes": (axes, 1.0)}
    return table([f"gcad_{m.name}" for m in model.meshes], parts, [(f"b_{m.name}",) for m in model.meshes])


def _mesh_files(model: Model) -> Table:
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


def _joints(model: Model) -> Table:
    names, words, origins, axes = [], [], [], []

    def add(name: str, kind: str, a: str, b: str, origin: Floats, axis: Floats) -> None:
        names.append(name)
        words.append((kind, a, b))
        origins.append(origin)
        axes.append(axis)

    none = np.zeros(3)
    for body in np.flatnonzero(model.bodies.fixed).tolist():
        name = model.bodies.name[body]
        add(f"j_{name}", "FIXED", f"b_{name}", "B_Ground", model.bodies.position[body], none)
    for roller in model.rollers:
        name, at, on = roller.name, model.bodies.position[roller.body], "B_Ground"
        if roller.press is not None:
            on = f"b_{name}_carrier"
            add(f"j_{name}_slide", "TRANSLATIONAL", on, "B_Ground", at, roller.press.direction)
        if roller.arm is not None:
            on = f"b_{name}_arm"
            add(f"j_{name}_pivot", "REVOLUTE", on, "B_Ground", roller.arm.pivot, roller.axis)
        add(f"j_{name}", "REVOLUTE", f"b_{name}", on, at, roller.axis)
    for plate, press in model.plates:
        name, at = plate.name, model.bodies.position[plate.body]
        add(f"j_{name}_slide", "TRANSLATIONAL", f"b_{name}", "B_Ground", at, press.direction)
    for mesh in model.meshes:
        if mesh.on >= 0:
            at, name = model.bodies.position[mesh.body], mesh.name
            add(f"j_{name}", "FIXED", f"b_{name}", _under(model, mesh), at, none)
    parts: dict[str, Part] = {
        "origin": (np.array(origins).reshape(-1, 3), reach(model)),
        "axis": (np.array(axes).reshape(-1, 3), 1.0),
    }
    return table(names, parts, words)


def stations(model: Model) -> Times:
    """Times at which the law of each drive is looked at [s], by motion."""
    found = {}
    for roller in model.rollers:
        if roller.speed is not None:
            ramp, name = roller.ramp * SECOND, f"mot_{roller.name}"
            if roller.profile is not None:
                found[name] = _profile_stations(roller.profile[:, 0] * SECOND)
            else:
                found[name] = tuple(s * ramp for s in RAMP_STATIONS) if ramp > 0.0 else _STATIONS_WITHOUT
    most = max(map(len, found.values()), default=0)  # a table has as many columns for all
    return {name: (*times, *[times[-1]] * (most - len(times))) for name, times in found.items()}


def _profile_stations(corners: Floats) -> tuple[float, ...]:
    """Every corner, the middle of every piece, and times before and after all."""
    middles = 0.5 * (corners[1:] + corners[:-1])
    return tuple(np.unique([0.0, 0.5 * corners[0], *corners, *middles, 2.0 * corners[-1] or 1.0]).tolist())


def _motions(model: Model, times: Times) -> Table:
    driven = [r for r in model.rollers if r.speed is not None]
    laws = [r.prescribed(np.array(times[f"mot_{r.name}"]) / SECOND) / SECOND for r in driven]
    speeds = np.array(laws).reshape(len(driven), -1) if driven else np.zeros((0, 0))
    scale = np.array([[np.abs(r.corners[:, 1]).max() / SECOND] for r in driven]).reshape(-1, 1)
    words = [(f"j_{r.name}", "ROT", "VEL") for r in driven]
    return table([f"mot_{r.name}" for r in driven], {"speed": (speeds, scale)}, words)


def _velocities(model: Model) -> Table:
    rows = [
        b
        for s in model.sheets
        if np.any(s.velocity) or np.any(s.spin)
        for b in _boxes_of(model, s)
        if not model.bodies.fixed[b]
    ]
    rows = np.array(rows, dtype=int)
    velocity, spin = model.bodies.velocity[rows] / SECOND, model.bodies.spin[rows] / SECOND
    parts: dict[str, Part] = {
        "velocity": (velocity, np.abs(velocity).max(initial=0.0)),
        "spin": (spin, np.abs(spin).max(initial=0.0)),
    }
    return table([f"b_{model.bodies.name[b]}" for b in rows], parts)


def _markers(model: Model) -> Table:
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
        for b in _boxes_of(model, sheet) if sheet.surface else ():
            name = model.bodies.name[b]
            add(f"m_{name}", f"b_{name}", model.bodies.position[b], np.eye(3))
    for guide in model.guides:
        add(f"m_{guide.name}", "B_Ground", guide.center, guide.axes.T)
    for mesh in model.meshes:
        add(f"m_{mesh.name}", _under(model, mesh), mesh_origin(mesh, model.rollers), mesh.axes.T)
    for roller in model.rollers:
        if roller.rim is not None:
            body = roller.body
            add(f"m_{roller.name}", "B_Ground", model.bodies.position[body], model.bodies.rotation[body].T)
    for probe in model.probes:
        points = _anchor_points(model, probe)
        for k, body in enumerate(probe.body.tolist()):
            end = f"_{k}" if len(points) > 1 else ""
            add(f"m_probe_{probe.name}{end}", body_name(model, body), points[k], np.eye(3))
    parts: dict[str, Part] = {
        "origin": (np.array(places).reshape(-1, 3), reach(model)),
        "axes": (np.array(axes).reshape(-1, 9), 1.0),
    }
    return table(names, parts, bodies)


def _vectors(model: Model) -> Table:
    names, directions = [], []

    def add(name: str, direction: Floats) -> None:
        names.append(name)
        directions.append(direction)

    def own(name: str, direction: Floats) -> None:
        if not any(np.array_equal(direction, axis) for axis in np.eye(3)):
            add(name, direction)

    for roller in model.rollers:
        own(f"v_{roller.name}_axis", roller.axis)
        if roller.press is not None:
            add(f"v_{roller.name}_press", roller.press.direction)
    for plane in model.planes:
        own(f"v_{plane.name}_normal", plane.normal)
        if plane.press is not None:
            add(f"v_{plane.name}_press", plane.press.direction)
    for guide in model.guides:
        own(f"v_{guide.name}_axis", guide.axes[:, 2])
    return table(names, {"direction": (np.array(directions).reshape(-1, 3), 1.0)})


def _surfaces(model: Model) -> Table:
    names, words = [], []
    for sheet in model.sheets:
        if sheet.surface:
            names.append(f"defsur_{sheet.name}")
            boxes = [f"m_{model.bodies.name[b]}" for b in _boxes_of(model, sheet)]
            words.append(("NATURAL", f"{sheet.n_y} rows", *boxes))
    return table(names, {}, words)


def _outputs(model: Model) -> Table:
    """Six numbers of each output in the made-up state: position and velocity, of rollers and spin."""
    names, rows = [], []
    for probe in model.probes:
        names.append(f"o_{probe.name}")
        points = _anchor_points(model, probe)
        states = [motion(body_name(model, b)) for b in probe.body.tolist()]
        rows.append(
            [
                *_mean(probe.share, (s.place(p) for s, p in zip(states, points, strict=True))),
                *_mean(probe.share, (s.speed(p) for s, p in zip(states, points, strict=True))),
            ]
        )
    for roller in model.rollers:
        names.append(f"o_{roller.name}")
        state = motion(f"b_{roller.name}")
        rows.append([*state.place(model.bodies.position[roller.body]), *state.spin])
    for plate, _ in model.plates:
        names.append(f"o_{plate.name}")
        state, at = motion(f"b_{plate.name}"), model.bodies.position[plate.body]
        rows.append([*state.place(at), *state.speed(at)])
    numbers = np.array(rows).reshape(-1, 6)
    scale = np.repeat([reach(model), 1000.0], 3)
    return table(names, {"value": (numbers, scale)})


def _mean(share: Floats, vectors: Iterable[Floats]) -> Floats:
    return np.einsum("n,nk->k", share, np.array(list(vectors)))

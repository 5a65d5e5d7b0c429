"""Scene -> Model, pure: the same scene always gives the same tables."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mdlgen.model import grid, naming
from mdlgen.model.anchors import anchor, find_tension, lower_loads
from mdlgen.model.curves import lower_curves
from mdlgen.model.external import external_pairs, lower_externals
from mdlgen.model.joints import find_joints
from mdlgen.model.machine import frame, lower_planes, lower_rollers
from mdlgen.model.pairs import find_pairs
from mdlgen.model.parameters import parameters
from mdlgen.model.stiffness import JointValues, joint_values
from mdlgen.model.supports import joined, support_bushings
from mdlgen.model.tables import (
    BOX_CYLINDER,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    EXTERNAL,
    Bodies,
    Bushings,
    Clamp,
    Contacts,
    Floats,
    Model,
    PlanePart,
    RollerPart,
    RunSettings,
    SheetPart,
)
from mdlgen.spec.scene import Scene


def lower(scene: Scene) -> Model:
    """The tables that every backend reads.

    Raises SpecError where names that are made from the user's meet.
    """
    run = _run(scene)
    sheets, values = _sheets(scene)
    first = sum(s.count for s in sheets)
    contacts = _contacts(scene)
    rollers = lower_rollers(scene, sheets, contacts, first)
    planes = lower_planes(scene, first + len(rollers))
    externals = lower_externals(scene)
    gravity = np.array(scene.gravity)
    bodies = _bodies(sheets, values, rollers, planes)
    supports = tuple(anchor(f"support_{k}", item, sheets) for k, item in enumerate(scene.supports))
    held = support_bushings(scene.supports, supports, sheets, bodies)
    bushings = joined([*_joints(sheets, values), *held])
    naming.check_unique("bodies", bodies.name)
    naming.check_unique("bushings", bushings.name)
    starts = {r.name: (r.press.touch, r.press.start) for r in rollers if r.press is not None}
    return Model(
        name=scene.name,
        gravity=gravity,
        sheets=sheets,
        rollers=rollers,
        planes=planes,
        externals=externals,
        bodies=bodies,
        bushings=bushings,
        curves=lower_curves(scene, sheets, bushings),
        contacts=contacts,
        pairs=find_pairs(
            gravity, sheets, rollers, planes, bodies, contacts, run, scene.run.prune, scene.run.margin
        ),
        external_pairs=external_pairs(sheets, externals, contacts),
        loads=lower_loads(scene, sheets),
        probes=tuple(anchor(name, scene.probes[name], sheets) for name in sorted(scene.probes)),
        supports=supports,
        tension=find_tension(scene, sheets),
        parameters=parameters(scene, starts, run),
        run=run,
    )


def _run(scene: Scene) -> RunSettings:
    run = scene.run
    print_step = run.print_step if run.print_step is not None else run.duration / 200
    return RunSettings(run.duration, run.analysis, run.step, run.tolerance, print_step)


def _sheets(scene: Scene) -> tuple[tuple[SheetPart, ...], list[JointValues]]:
    parts: list[SheetPart] = []
    values: list[JointValues] = []
    first = 0
    for name in sorted(scene.sheets):
        sheet = scene.sheets[name]
        material = scene.materials[sheet.material]
        joint = joint_values(sheet, material)
        angles = sheet.rotation if sheet.rotation is not None else (0.0, 0.0, sheet.turn or 0.0)
        parts.append(
            SheetPart(
                name=name,
                first=first,
                n_x=sheet.boxes[0],
                n_y=sheet.boxes[1],
                d_x=joint.d_x,
                d_y=joint.d_y,
                thickness=sheet.thickness,
                size=sheet.size,
                layout=sheet.layout,
                grid=sheet.grid,
                center=np.array(sheet.center),
                angles=angles,
                rotation=grid.rotation_matrix(angles),
                velocity=np.array(sheet.velocity),
                spin=np.array(sheet.spin),
                surface=sheet.surface,
                clamp=Clamp(sheet.clamp.edge, sheet.clamped_rows()) if sheet.clamp else None,
                bending=(
                    "k_tx" if material.k_tx is not None else "D_cd",
                    "k_ty" if material.k_ty is not None else "D_md",
                ),
                twist=material.D_twist is not None,
                in_plane=material.k_tz is not None,
                rotation_damping=material.damping.rotation,
                derived=joint.derived(),
            )
        )
        values.append(joint)
        first += parts[-1].count
    return tuple(parts), values


def _contacts(scene: Scene) -> Contacts:
    rows = scene.contact_pairs()

    def column(read: Callable) -> Floats:
        return np.array([read(scene.contacts[i]) for i, _, _ in rows], dtype=float)

    with_sheet = dict.fromkeys(scene.rollers, BOX_CYLINDER)
    with_sheet |= dict.fromkeys(scene.planes, BOX_PLANE) | dict.fromkeys(scene.parts, EXTERNAL)
    kinds = [CYLINDER_CYLINDER if a in scene.rollers else with_sheet[b] for _, a, b in rows]
    return Contacts(
        entry=np.array([i for i, _, _ in rows], dtype=np.int64),
        part_a=tuple(a for _, a, _ in rows),
        part_b=tuple(b for _, _, b in rows),
        kind=np.array(kinds, dtype=np.int64),
        stiffness=column(lambda c: c.stiffness),
        restitution=column(lambda c: c.restitution),
        mu_static=column(lambda c: c.friction.static),
        mu_dynamic=column(lambda c: c.friction.dynamic),
        stiction_velocity=column(lambda c: c.friction.speeds(c.smoothing)[0]),
        friction_velocity=column(lambda c: c.friction.speeds(c.smoothing)[1]),
        smoothing=column(lambda c: c.smoothing),
        share=tuple(scene.contacts[i].share for i, _, _ in rows),
    )


def _bodies(
    sheets: tuple[SheetPart, ...],
    values: list[JointValues],
    rollers: tuple[RollerPart, ...],
    planes: tuple[PlanePart, ...],
) -> Bodies:
    names, labels, tables = [], [], []
    for sheet, joint in zip(sheets, values, strict=True):
        count = sheet.count
        node_x, node_y = grid.box_nodes(sheet)
        names += [naming.box(sheet.name, k % sheet.n_x, k // sheet.n_x) for k in range(count)]
        labels += [f"{sheet.name} box {k % sheet.n_x}, {k // sheet.n_x}" for k in range(count)]
        position = grid.place(sheet, grid.local(sheet, node_x, node_y))
        held = grid.clamped_boxes(sheet)
        moving = ~held[:, None]
        half = np.array([joint.d_x, joint.d_y, sheet.thickness]) / 2
        tables.append(
            (
                position,
                np.broadcast_to(sheet.rotation, (count, 3, 3)),
                np.full(count, joint.m),
                np.broadcast_to(np.array(joint.inertia), (count, 3)),
                moving * (sheet.velocity + np.cross(sheet.spin, position - sheet.center)),
                moving * np.broadcast_to(sheet.spin, (count, 3)),
                held,
                np.broadcast_to(half, (count, 3)),
                grid.exposed_sides(sheet),
            )
        )
    zero, none = np.zeros((1, 3)), np.zeros((1, 4), bool)
    for roller in rollers:
        names.append(roller.name)
        labels.append(f"Roller {roller.name}")
        start = roller.press.start * roller.press.direction if roller.press else np.zeros(3)
        inertia = np.array([[roller.inertia_transverse, roller.inertia_transverse, roller.inertia_axial]])
        tables.append(
            (
                (roller.center + start)[None],
                frame(roller.axis)[None],
                np.array([roller.mass]),
                inertia,
                zero,
                zero,
                np.array([False]),
                zero,
                none,
            )
        )
    for plane in planes:
        names.append(plane.name)
        labels.append(f"Plane {plane.name}")
        a, b, c = plane.size
        inertia = plane.mass / 12 * np.array([[b * b + c * c, a * a + c * c, a * a + b * b]])
        half = np.array([plane.size]) / 2
        tables.append(
            (
                plane.center[None],
                frame(plane.normal)[None],
                np.array([plane.mass]),
                inertia,
                zero,
                zero,
                np.array([True]),
                half,
                none,
            )
        )
    columns = [np.concatenate(column) for column in zip(*tables, strict=True)]
    return Bodies(tuple(names), tuple(labels), *columns)


def _joints(sheets: tuple[SheetPart, ...], values: list[JointValues]) -> list[Bushings]:
    tables = []
    for number, (sheet, value) in enumerate(zip(sheets, values, strict=True)):
        for joints in find_joints(sheet):
            count = len(joints.name)
            k, c = (np.broadcast_to(six, (count, 6)) for six in joints.coefficients(value))
            made = Bushings(
                name=tuple(joints.name),
                label=tuple(name.replace("_", " ") for name in joints.name),
                kind=np.full(count, joints.kind),
                sheet=np.full(count, number),
                a=joints.a,
                b=joints.b,
                # point by point: a product with many rows at once may round each as their number has it
                origin=grid.place(sheet, grid.local(sheet, *joints.node.T)[:, None])[:, 0],
                axes=np.broadcast_to(sheet.rotation, (count, 3, 3)),
                k=k,
                c=c,
                node=joints.node,
            )
            tables.append(made)
    return tables

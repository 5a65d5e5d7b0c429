"""Scene -> Model, pure: the same scene always gives the same tables."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mdlgen.model import grid, naming
from mdlgen.model.anchors import anchor, find_tension, lower_loads
from mdlgen.model.machine import frame, lower_planes, lower_rollers
from mdlgen.model.pairs import find_pairs
from mdlgen.model.parameters import parameters
from mdlgen.model.stiffness import SUPPORT_FACTOR, JointValues, joint_values
from mdlgen.model.tables import (
    BOX_CYLINDER,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    GROUND,
    SUPPORT,
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
    gravity = np.array(scene.gravity)
    bodies = _bodies(sheets, values, rollers, planes)
    bushings = _bushings(scene, sheets, values, bodies)
    naming.check_unique("bodies", bodies.name)
    naming.check_unique("bushings", bushings.name)
    starts = {r.name: (r.press.touch, r.press.start) for r in rollers if r.press is not None}
    return Model(
        name=scene.name,
        gravity=gravity,
        sheets=sheets,
        rollers=rollers,
        planes=planes,
        bodies=bodies,
        bushings=bushings,
        contacts=contacts,
        pairs=find_pairs(
            gravity, sheets, rollers, planes, bodies, contacts, run, scene.run.prune, scene.run.margin
        ),
        loads=lower_loads(scene, sheets),
        probes=tuple(anchor(name, scene.probes[name], sheets) for name in sorted(scene.probes)),
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

    kinds = [
        CYLINDER_CYLINDER if a in scene.rollers else BOX_CYLINDER if b in scene.rollers else BOX_PLANE
        for _, a, b in rows
    ]
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


def _bushings(
    scene: Scene, sheets: tuple[SheetPart, ...], values: list[JointValues], bodies: Bodies
) -> Bushings:
    names, labels, rows = [], [], []
    index = {s.name: k for k, s in enumerate(sheets)}
    for number, (sheet, value) in enumerate(zip(sheets, values, strict=True)):
        for joint in grid.joints(sheet):
            names.append(joint.name)
            labels.append(joint.label)
            origin = grid.place(sheet, grid.local(sheet, *joint.node))
            k, c = grid.joint_coefficients(joint, value)
            rows.append((joint.kind, number, joint.a, joint.b, origin, sheet.rotation, k, c, joint.node))
    for number, support in enumerate(scene.supports):
        held = anchor(f"support_{number}", support, sheets)
        sheet = sheets[index[support.sheet]]
        stiff = SUPPORT_FACTOR * sheet.derived["k_z"] * np.array([axis in support.fix for axis in "xyz"])
        for part, (body, local, share) in enumerate(zip(held.body, held.local, held.share, strict=True)):
            names.append(f"support_{number}_{part}")
            labels.append(f"support {number} of {sheet.name}, part {part}")
            origin = bodies.position[body] + bodies.rotation[body] @ local
            k = np.concatenate([stiff * share, np.zeros(3)])
            c = 2 * 0.5 * np.sqrt(k * sheet.derived["m"])
            rows.append((SUPPORT, index[support.sheet], GROUND, body, origin, np.eye(3), k, c, held.node))
    count = len(rows)
    columns = [list(column) for column in zip(*rows, strict=True)] if rows else [[] for _ in range(9)]
    kind, sheet_index, a, b, origin, axes, k, c, node = columns
    return Bushings(
        name=tuple(names),
        label=tuple(labels),
        kind=np.array(kind, dtype=np.int64),
        sheet=np.array(sheet_index, dtype=np.int64),
        a=np.array(a, dtype=np.int64),
        b=np.array(b, dtype=np.int64),
        origin=np.array(origin, dtype=float).reshape(count, 3),
        axes=np.array(axes, dtype=float).reshape(count, 3, 3),
        k=np.array(k, dtype=float).reshape(count, 6),
        c=np.array(c, dtype=float).reshape(count, 6),
        node=np.array(node, dtype=np.int64).reshape(count, 2),
    )

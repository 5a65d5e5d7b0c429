"""Scene -> Model, pure: the same scene always gives the same tables."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.model import grid, naming, over_time
from mdlgen.model.curves import lower_curves
from mdlgen.model.ends import with_ends
from mdlgen.model.external import external_pairs, lower_externals
from mdlgen.model.frictions import lower_frictions
from mdlgen.model.lowering.anchors import anchor, find_tension, lower_loads
from mdlgen.model.lowering.cells import Cells, cells, zone_parts
from mdlgen.model.lowering.joints import Joints, find_joints
from mdlgen.model.lowering.pairs import find_pairs
from mdlgen.model.lowering.poisson import couple
from mdlgen.model.lowering.stiffness import between, coefficients, derived, extent
from mdlgen.model.lowering.supports import joined, support_bushings
from mdlgen.model.lowering.yielding import together, yielding
from mdlgen.model.meshes import loaded
from mdlgen.model.nips import spreads
from mdlgen.model.parameters.given import parameters, unfollowed
from mdlgen.model.parts.kinds import KINDS, kind_of
from mdlgen.model.passing import planes_out
from mdlgen.model.press.before import Before
from mdlgen.model.press.faces import Bow, Face, Facets
from mdlgen.model.reactions import lower_reactions
from mdlgen.model.rotations import matrices
from mdlgen.model.shape import bend, box_rotations, joint_creases, joint_frames, joint_turns, placed
from mdlgen.model.tables import (
    BOX_BOX,
    EXTERNAL,
    Bodies,
    Bushings,
    Clamp,
    Contacts,
    Floats,
    MachinePart,
    Model,
    Plastic,
    RollerPart,
    RunSettings,
    SheetPart,
    no_plastic,
)
from mdlgen.spec.scene import Scene
from mdlgen.spec.smoothing import following, speeds


def lower(scene: Scene) -> Model:
    """The tables that every backend reads.

    Raises SpecError where a generated name is equal to one of the user, and where there would be more pairs
    than the scene's limits allow; also where values are so far apart that a table has infinite numbers.
    """
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            model = _lower(scene)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        raise SpecError(f"values of this scene are too far apart to compute with ({error})") from None
    for table, names in ((model.bodies, _OF_BODIES), (model.bushings, _OF_BUSHINGS)):
        for column in names:
            wrong = np.argwhere(~np.isfinite(getattr(table, column)))
            if len(wrong):
                where = f"{table.name[wrong[0][0]]}: its {column} is not finite"
                raise SpecError(f"values of this scene are too far apart to compute with ({where})")
    return model


_OF_BODIES = ("position", "rotation", "mass", "inertia", "velocity", "spin", "half")
_OF_BUSHINGS = ("origin", "axes", "k", "c")


def _lower(scene: Scene) -> Model:
    run = _run(scene)
    sheets, boxes = _sheets(scene)
    first = sum(s.count for s in sheets)
    contacts = _contacts(scene)
    parts = _machine(scene, sheets, contacts, first)
    planes, guides = with_ends(parts["planes"], parts["guides"], contacts)
    rollers = loaded(parts["rollers"], parts["meshes"])
    parts |= {"rollers": rollers, "planes": planes, "guides": guides}
    contacts = replace(contacts, spread=spreads(sheets, rollers, contacts))
    externals = lower_externals(scene)
    gravity, profile = np.array(scene.gravity), over_time.corners(scene.gravity_profile)
    machine = tuple(part for kind in KINDS for part in parts[kind.table])
    bodies = _bodies(sheets, boxes, rollers, machine)
    supports = tuple(
        anchor(f"support_{k}", item, sheets, _formulas(scene, "supports", k))
        for k, item in enumerate(scene.supports)
    )
    held = support_bushings(scene.supports, supports, sheets, bodies)
    joints, extents, plastic = _joints(scene, sheets, boxes)
    bushings, corners = couple(scene, sheets, bodies, joined([*joints, *held]))
    none = np.zeros(sum(len(table) for table in held))  # of supports
    long, wide = (np.concatenate([*(each[k] for each in extents), none]) for k in range(2))
    naming.check_unique("bodies", bodies.name)
    naming.check_unique("bushings", bushings.name)
    pressed = (*rollers, *planes)
    starts = {part.name: (part.press.touch, part.press.start) for part in pressed if part.press is not None}
    given = [
        row
        for kind in KINDS
        for part in parts[kind.table]
        for row in kind.parameters(scene, part.name, starts)
    ]
    rows = parameters(scene, starts, run, sheets, contacts, given)
    return Model(
        name=scene.name,
        gravity=gravity,
        sheets=sheets,
        machine=machine,
        externals=externals,
        bodies=bodies,
        bushings=bushings,
        curves=lower_curves(scene, sheets, bushings, long, wide),
        contacts=contacts,
        pairs=find_pairs(
            over_time.most(profile) * gravity,
            sheets,
            machine,
            bodies,
            contacts,
            run,
            scene.run.prune,
            scene.run.margin,
            scene.limits,
        ),
        external_pairs=external_pairs(sheets, externals, contacts),
        loads=lower_loads(scene, sheets),
        probes=tuple(
            anchor(name, scene.probes[name], sheets, _formulas(scene, "probes", name))
            for name in sorted(scene.probes)
        ),
        supports=supports,
        tension=find_tension(scene, sheets),
        parameters=rows,
        run=run,
        unfollowed=unfollowed(scene, rows),
        following=tuple(following(scene)),
        require=scene.require,
        author=scene.author or "",
        revision=scene.revision or "",
        plastic=plastic,
        corners=corners,
        reactions=lower_reactions(scene, contacts),
        gravity_profile=profile,
    )


def _formulas(scene: Scene, kind: str, key: str | int) -> tuple[str, str]:
    """Those of the place of a probe or support."""
    x, y = (scene.formulas.get((kind, key, "at", axis), "") for axis in range(2))
    return x, y


def _run(scene: Scene) -> RunSettings:
    run = scene.run
    print_step = run.print_step if run.print_step is not None else run.duration / 200
    return RunSettings(
        run.duration,
        run.analysis,
        run.step,
        run.tolerance,
        print_step,
        run.symmetry,
        run.threads,
        run.sleep,
        run.limit,
        run.margin,
    )


def _sheets(scene: Scene) -> tuple[tuple[SheetPart, ...], list[Cells]]:
    parts: list[SheetPart] = []
    boxes: list[Cells] = []
    first = 0
    for name in sorted(scene.sheets):
        sheet = scene.sheets[name]
        material = scene.materials[sheet.material]
        zones, graded = zone_parts(sheet), sheet.grading
        lines_x, lines_y = map(np.array, sheet.lines)
        angles = sheet.rotation if sheet.rotation is not None else (0.0, 0.0, sheet.turn or 0.0)
        parts.append(
            SheetPart(
                name=name,
                first=first,
                n_x=sheet.boxes[0],
                n_y=sheet.boxes[1],
                d_x=sheet.pitch[0],
                d_y=sheet.pitch[1],
                lines_x=lines_x,
                lines_y=lines_y,
                graded=(False, False) if graded is None else (graded.x is not None, graded.y is not None),
                zones=zones,
                bend=bend(sheet),
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
                twist=material.D_twist is not None or sheet.layout == "plate",
                in_plane=material.k_tz is not None,
                rotation_damping=material.damping.kind,
                damping_times=material.damping.times,
                yields=None if material.yield_ is None else material.yield_.curvatures,
                enters=math.nan if sheet.by_rule else sheet.enters,
                out=planes_out(sheet),
                out_at_rest=any(out.axis is None for out in sheet.out),
                derived=derived(sheet, material),
            )
        )
        boxes.append(cells(sheet, zones))
        first += parts[-1].count
    return tuple(parts), boxes


def _contacts(scene: Scene) -> Contacts:
    rows = scene.contact_pairs()
    named = any(contact.name for contact in scene.contacts)
    speed = speeds(scene, rows)

    def column(read: Callable) -> Floats:
        return np.array([read(scene.contacts[i]) for i, _, _ in rows], dtype=float)

    with_sheet = dict.fromkeys(scene.sheets, BOX_BOX) | dict.fromkeys(scene.parts, EXTERNAL)
    with_roller: dict[str, int] = {}
    for kind in KINDS:
        with_sheet |= dict.fromkeys(getattr(scene, kind.table), kind.with_sheet)
        with_roller |= dict.fromkeys(getattr(scene, kind.table), kind.with_roller)
    kinds = [(with_roller if a in scene.rollers else with_sheet)[b] for _, a, b in rows]
    stiction = np.array([speed[i].stiction for i, _, _ in rows], dtype=float)
    return Contacts(
        entry=np.array([i for i, _, _ in rows], dtype=np.int64),
        part_a=tuple(a for _, a, _ in rows),
        part_b=tuple(b for _, _, b in rows),
        kind=np.array(kinds, dtype=np.int64),
        stiffness=column(lambda c: c.stiffness),
        restitution=column(lambda c: c.restitution),
        mu_static=column(lambda c: c.friction.static),
        mu_dynamic=column(lambda c: c.friction.dynamic),
        stiction_velocity=stiction,
        friction_velocity=np.array([speed[i].friction for i, _, _ in rows], dtype=float),
        smoothing=np.array([speed[i].smoothing for i, _, _ in rows], dtype=float),
        rolling=column(lambda c: c.rolling_resistance),
        share=tuple(scene.contacts[i].share for i, _, _ in rows),
        spread=np.zeros(len(rows)),
        air_viscosity=column(lambda c: c.air.viscosity if c.air else 0.0),
        air_roughness=column(lambda c: c.air.roughness if c.air else 0.0),
        sticking=column(lambda c: c.friction.sticking or 0.0),
        name=tuple(scene.contacts[i].name or "" for i, _, _ in rows) if named else (),
        frictions=lower_frictions([scene.contacts[i].friction for i, _, _ in rows], stiction),
    )


def _machine(
    scene: Scene, sheets: tuple[SheetPart, ...], contacts: Contacts, first: int
) -> dict[str, tuple[Any, ...]]:
    """All parts of the machine by the table that they stand in; their bodies are numbered from `first`."""
    kinds = {name: kind for kind in KINDS for name in getattr(scene, kind.table)}

    def face(name: str, at: Floats, roller: str) -> Face | Bow | Facets | None:
        return kinds[name].face(scene, name, at, roller)

    found: dict[str, tuple[Any, ...]] = {}
    for kind in KINDS:
        before = Before(sheets, contacts, found.get("rollers", ()), face)
        found[kind.table] = kind.lower(scene, before, first)
        first += len(found[kind.table])
    return found


def _bodies(
    sheets: tuple[SheetPart, ...],
    boxes: list[Cells],
    rollers: tuple[RollerPart, ...],
    machine: tuple[MachinePart, ...],
) -> Bodies:
    names, labels, tables = [], [], []
    for sheet, box in zip(sheets, boxes, strict=True):
        count = sheet.count
        node_x, node_y = grid.box_nodes(sheet)
        names += [naming.box(sheet.name, k % sheet.n_x, k // sheet.n_x) for k in range(count)]
        labels += [f"{sheet.name} box {k % sheet.n_x}, {k // sheet.n_x}" for k in range(count)]
        on = np.zeros(count, np.int64) if sheet.bend is None else sheet.bend.frames.box
        position = grid.place(sheet, placed(sheet, grid.local(sheet, node_x, node_y), on))
        held = grid.clamped_boxes(sheet)
        moving = ~held[:, None]
        tables.append(
            (
                position,
                sheet.rotation @ box_rotations(sheet),
                box.m,
                box.inertia,
                moving * (sheet.velocity + np.cross(sheet.spin, position - sheet.center)),
                moving * np.broadcast_to(sheet.spin, (count, 3)),
                held,
                np.stack([box.d_x, box.d_y, box.s], axis=1) / 2,
                grid.exposed_sides(sheet),
                box.friction,
            )
        )
    still, covered = np.zeros((1, 3)), np.zeros((1, 4), bool)
    for part in machine:
        kind = kind_of(part)
        names.append(part.name)
        labels.append(f"{kind.name.capitalize()} {part.name}")
        body = kind.body(part, rollers)
        place, turn, inertia, half = (np.asarray(column)[None] for column in (*body[:2], body[3], body[5]))
        mass, fixed = np.array([body.mass]), np.array([body.fixed])
        tables.append((place, turn, mass, inertia, still, still, fixed, half, covered, np.ones(1)))
    columns = [np.concatenate(column) for column in zip(*tables, strict=True)]
    return Bodies(tuple(names), tuple(labels), *columns)


def _joints(
    scene: Scene, sheets: tuple[SheetPart, ...], boxes: list[Cells]
) -> tuple[list[Bushings], list[tuple[Floats, Floats]], Plastic]:
    """Bushings by sheet and kind, the length and section of each, and those that yield."""
    tables, extents, plastic, many = [], [], [no_plastic()], 0
    for number, (sheet, box) in enumerate(zip(sheets, boxes, strict=True)):
        spec = scene.sheets[sheet.name]
        for joints in find_joints(sheet):
            count = len(joints.name)
            of = between(box, joints.one, joints.two, joints.along_x, *_creases(sheet, joints))
            origin, axes, rest = _where(sheet, joints)
            k, c = coefficients(spec, scene.materials[spec.material], of, joints.along_x)
            if sheet.twist:
                for values in (k, c):
                    values[:, 3 if joints.along_x else 4] *= joints.tributary
            made = Bushings(
                name=tuple(joints.name),
                label=tuple(name.replace("_", " ") for name in joints.name),
                kind=np.full(count, joints.kind),
                sheet=np.full(count, number),
                a=joints.a,
                b=joints.b,
                origin=origin,
                axes=axes,
                rest=rest,
                k=joints.scale * k,
                c=joints.scale * c,
                node=joints.node,
                frames=np.stack(joint_frames(sheet, joints), axis=1),
            )
            tables.append(made)
            extents.append(extent(spec, of, joints.along_x))
            found = yielding(spec, scene.materials[spec.material], joints, of, many)
            plastic += [] if found is None else [found]
            many += count
    return tables, extents, together(plastic)


def _creases(sheet: SheetPart, joints: Joints) -> tuple[Floats, Floats]:
    """Bending stiffness of each joint relative to that of the sheet, and stiffness of the crease per length,
    for joints on a crease and on none."""
    creases = sheet.bend.creases if sheet.bend is not None else ()
    factors = [crease.stiffness for crease in creases]
    own = [np.inf if crease.per_length is None else crease.per_length for crease in creases]
    on = joint_creases(sheet, joints)
    return np.array([*factors, 1.0])[on], np.array([*own, np.inf])[on]


def _where(sheet: SheetPart, joints: Joints) -> tuple[Floats, Floats, Floats]:
    """Origin and axes of joints at the start, global, and their rotation at rest.

    In a bent sheet they stand halfway between the two sides that they join, which only around a dog-ear are
    not at the same place.
    """
    flat, turn = grid.local(sheet, *joints.node.T), joint_turns(sheet, joints)
    one, two = joint_frames(sheet, joints)
    if sheet.bend is None or sheet.bend.start == "flat":
        axes = np.broadcast_to(sheet.rotation, (len(turn), 3, 3))
        rest = turn
    else:
        flat = 0.5 * (placed(sheet, flat, one) + placed(sheet, flat, two))
        half = matrices(0.5 * turn)
        axes = sheet.rotation @ (sheet.bend.frames.rotation[one] @ half)
        rest = np.zeros_like(turn)
    # point by point: a product with many rows at once may round each as their number has it
    return grid.place(sheet, flat[:, None])[:, 0], axes, rest

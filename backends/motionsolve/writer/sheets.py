"""Rows of the sheets: bushings, surfaces, probes and loads."""

from __future__ import annotations

from mdlgen.altair.curves import Written, straight_points, written
from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.ids import body_id
from mdlgen.backends.motionsolve.writer.over_time import load_factor
from mdlgen.backends.motionsolve.writer.requests import add_request
from mdlgen.backends.motionsolve.writer.rows import (
    Bushing,
    BushingGroup,
    Cosines,
    CurvedSpring,
    Deck,
    Load,
    Spline,
    Surface,
)
from mdlgen.backends.motionsolve.writer.units import Triple, number, numbers, per_thousand, triples
from mdlgen.model.tables import CLAMP, Model

_AXES = ("x", "y", "z", "tx", "ty", "tz")


def add_bushings(deck: Deck, model: Model) -> None:
    """All bushings, with a marker on each body at the same place."""
    table, curves = model.bushings, model.curves
    splines, follows = written(model)
    _add_splines(deck, model, splines)
    turns: dict[bytes, Cosines | None] = {}
    groups: dict[bytes, BushingGroup] = {}
    ends = zip(table.a.tolist(), table.b.tolist(), triples(table.origin), strict=True)
    for row, (a, b, at) in enumerate(ends):
        name, label = f"bsh_{table.name[row]}", table.label[row]
        key = table.axes[row].tobytes()
        if key not in turns:
            turns[key] = cosines(table.axes[row])
        axes = turns[key]
        i = deck.marker(f"{name}.i", f"{label}-Marker I", body_id(a), at, axes)
        j = deck.marker(f"{name}.j", f"{label}-Marker J", body_id(b), at, axes)
        key = b"".join(column[row].tobytes() for column in (table.k, table.c, table.rest, curves.of))
        if key not in groups:
            stiff = table.k[row].tolist()
            if curves.of[row] >= 0:
                stiff[curves.axis[row]] = 0.0
            # on the first body, which the second one is to turn away from
            push = [0.0, 0.0, 0.0, *(-table.k[row, 3:] * table.rest[row]).tolist()]
            groups[key] = BushingGroup(_law(stiff, table.c[row].tolist(), push), [])
        if curves.of[row] >= 0:
            floating = deck.marker(f"{name}.jfloat", f"{label}-Float Marker J", body_id(b), at, axes)
            force = _curved(int(curves.axis[row]), int(follows[row]) + 1, i, j, table.kind[row] == CLAMP)
            number_of = len(deck.curved) + 1
            deck.curved.append(
                CurvedSpring(f"frc_{table.name[row]}", f"{label}-Curve", number_of, i, floating, j, force)
            )
        groups[key].bushings.append(Bushing(name, label, row + 1, i, j))
    deck.bushing_groups += groups.values()


def _add_splines(deck: Deck, model: Model, curves: list[Written]) -> None:
    """Curves of one bushing, straight between their points."""
    for index, curve in enumerate(curves, 1):
        strain, stress = straight_points(model.curves, curve.number)
        points = zip(numbers(curve.length * strain), numbers(curve.area * stress), strict=True)
        name = model.curves.name[curve.number]
        label = f"{name.replace('_', ' ')}: force over elongation of one bushing"
        deck.splines.append(Spline(f"crv_{curve.name}", label, index, list(points)))


def _curved(axis: int, spline: int, i: int, j: int, half: bool) -> Triple:
    """Force on i along each axis of j; half a cell has its strain at half of the elongation."""
    elongation = f"{'2*' if half else ''}D{'XY'[axis]}({i},{j},{j})"
    along = f"-LINSPL({elongation},0,{spline})"
    return ("0", along, "0") if axis else (along, "0", "0")


def _law(k: list[float], c: list[float], push: list[float]) -> tuple[tuple[str, str, str, str], ...]:
    """(axis, stiffness, damping, preload); rotations are per radian (seen)."""
    return tuple(
        (axis, number(stiff), per_thousand(damp), number(load))
        for axis, stiff, damp, load in zip(_AXES, k, c, push, strict=True)
    )


def add_surfaces(deck: Deck, model: Model) -> None:
    """A surface through the centres of the boxes, row by row, for each sheet that requests one."""
    for sheet in (s for s in model.sheets if s.surface):
        at = triples(model.bodies.position[sheet.first : sheet.first + sheet.count])
        rows: list[list[int]] = []
        for j in range(sheet.n_y):
            bodies = range(sheet.body(0, j), sheet.body(0, j) + sheet.n_x)
            rows.append(
                [
                    deck.marker(
                        f"m_{model.bodies.name[k]}", model.bodies.label[k], body_id(k), at[k - sheet.first]
                    )
                    for k in bodies
                ]
            )
        number_of = len(deck.surfaces) + 1
        graphic = len(model.bodies.name) + number_of
        deck.surfaces.append(Surface(f"defsur_{sheet.name}", sheet.name, number_of, graphic, rows))


def add_probes(deck: Deck, model: Model) -> None:
    """A marker on each box with a probe, and the requests for these."""
    table = model.bodies
    for probe in model.probes:
        arms = (table.rotation[probe.body] @ probe.local[:, :, None])[:, :, 0]
        ends = [""] if len(probe.body) == 1 else [f"_{k}" for k in range(len(probe.body))]
        places = zip(ends, probe.body.tolist(), triples(table.position[probe.body] + arms), strict=True)
        markers = [
            deck.marker(f"m_probe_{probe.name}{end}", f"Probe {probe.name}", body_id(body), at)
            for end, body, at in places
        ]
        label = f"Probe {probe.name}: position, velocity"
        add_request(deck, f"o_{probe.name}", label, "DX DY DZ VX VY VZ", markers)


def add_loads(deck: Deck, model: Model) -> None:
    """Dead loads: force and moment keep their global direction, the point moves with its box."""
    loads, table = model.loads, model.bodies
    arms = (table.rotation[loads.body] @ loads.local[:, :, None])[:, :, 0]
    at = triples(table.position[loads.body] + arms)
    for row, body in enumerate(loads.body.tolist()):
        name, label = f"frc_{row}", f"Load {loads.entry[row]} on {table.label[body]}"
        marker = deck.marker(f"{name}.i", f"{label}-Marker I", body_id(body), at[row])
        fx, fy, fz = numbers(loads.force[row])
        tx, ty, tz = numbers(loads.moment[row])
        if loads.entry[row] in loads.changing:
            factor = load_factor(loads.profiles[loads.entry[row]])
            fx, fy, fz, tx, ty, tz = (f"{v}*({factor})" for v in (fx, fy, fz, tx, ty, tz))
        deck.loads.append(Load(name, label, row + 1, marker, (fx, fy, fz), (tx, ty, tz)))

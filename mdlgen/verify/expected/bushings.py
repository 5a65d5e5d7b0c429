"""Bushings, curves and springs that a text must have."""

from __future__ import annotations

import numpy as np

from mdlgen.altair.curves import straight_points, written
from mdlgen.model.tables import (
    CLAMP,
    Floats,
    Model,
)
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.expected.units import SECOND, body_name, reach
from mdlgen.verify.solver_expressions import motion
from mdlgen.verify.tables import Part, Table, table


def bushings(model: Model) -> Table:
    rows = model.bushings
    stiff = rows.k[:, :3].copy()
    bent = np.flatnonzero(model.curves.of >= 0)
    stiff[bent, model.curves.axis[bent]] = 0.0  # a curve stands there: see curve_laws
    arms = [bushing for part in model.machine for bushing in kind_of(part).bushings(model, part)]
    last = np.eye(3)[2]

    def about(turns: bool, name: str) -> list[Floats]:
        """A value of each spring about z, or along it, as a vector."""
        return [getattr(arm, name) * last * (arm.turns == turns) for arm in arms]

    def both(own: Floats, more: list[Floats]) -> Floats:
        return np.concatenate([own, np.array(more).reshape(-1, *own.shape[1:])])

    parts: dict[str, Part] = {
        "origin": (both(rows.origin, [arm.origin for arm in arms]), reach(model)),
        "axes": (both(rows.axes, [arm.rotation for arm in arms]).transpose(0, 2, 1), 1.0),
        "k": (both(stiff, about(False, "stiffness")), None),
        "c": (both(rows.c[:, :3], about(False, "damping")) * SECOND, None),
        "kt": (both(rows.k[:, 3:], about(True, "stiffness")), None),
        "ct": (both(rows.c[:, 3:], about(True, "damping")) * SECOND, None),
        "force": (both(np.zeros((len(rows), 3)), about(False, "torque")), 1.0),
        # on the first body, which the second one is to turn away from
        "torque": (both(-rows.k[:, 3:] * rows.rest, about(True, "torque")), 1.0),
    }
    words = [
        (body_name(model, a), body_name(model, b))
        for a, b in zip(rows.a.tolist(), rows.b.tolist(), strict=True)
    ]
    words += [(arm.body, "B_Ground") for arm in arms]
    names = [f"bsh_{n}" for n in rows.name] + [arm.name for arm in arms]
    return table(names, parts, words)


def curves(model: Model) -> Table:
    """Points of the curves: elongation [mm] and force [N] of one bushing."""
    names, points, scales = [], [np.zeros((0, 2))], [np.zeros((0, 2))]
    for curve in written(model)[0]:
        strain, stress = straight_points(model.curves, curve.number)
        length, area, name = curve.length, curve.area, curve.name
        names += [f"crv_{name}.{k}" for k in range(len(strain))]
        points.append(np.stack([length * strain, area * stress], axis=1))
        scales.append(np.broadcast_to(points[-1].max(axis=0), points[-1].shape))
    return table(names, {"point": (np.concatenate(points), np.concatenate(scales))})


def curve_laws(model: Model) -> Table:
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


def springs(model: Model) -> Table:
    found = [spring for part in model.machine for spring in kind_of(part).springs(model, part)]
    presses = [spring.press for spring in found]
    parts: dict[str, Part] = {
        "p1": (np.array([spring.place for spring in found]).reshape(-1, 3), reach(model)),
        "p2": (np.array([spring.anchor for spring in found]).reshape(-1, 3), reach(model)),
        "k": (np.array([press.stiffness for press in presses]), None),
        "c": (np.array([press.damping for press in presses]) * SECOND, None),
        "force": (np.array([press.preload for press in presses]), None),
        "length": (np.array([press.free_length for press in presses]), None),
    }
    return table([spring.name for spring in found], parts, [(spring.body, "B_Ground") for spring in found])

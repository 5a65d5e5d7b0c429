"""Held material points of a sheet: stiff bushings to ground, one on each box that such a point lies on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from mdlgen.model.lowering.stiffness import SUPPORT_FACTOR
from mdlgen.model.tables import GROUND, SUPPORT, Anchor, Bodies, Bushings, SheetPart
from mdlgen.spec.action import Support


def support_bushings(
    supports: Sequence[Support], anchors: Sequence[Anchor], sheets: Sequence[SheetPart], bodies: Bodies
) -> list[Bushings]:
    """The bushings of each support, along the global axes; `anchors` says on which boxes and where."""
    return [
        _bushings(number, support, held, sheets[held.sheet], bodies)
        for number, (support, held) in enumerate(zip(supports, anchors, strict=True))
    ]


def _bushings(number: int, support: Support, held: Anchor, sheet: SheetPart, bodies: Bodies) -> Bushings:
    count = len(held.body)
    stiff = SUPPORT_FACTOR * sheet.derived["k_z"] * np.array([axis in support.fix for axis in "xyz"])
    k = np.hstack([stiff * held.share[:, None], np.zeros((count, 3))])
    arms = [bodies.rotation[body] @ local for body, local in zip(held.body, held.local, strict=True)]
    return Bushings(
        name=tuple(f"{held.name}_{part}" for part in range(count)),
        label=tuple(f"support {number} of {sheet.name}, part {part}" for part in range(count)),
        kind=np.full(count, SUPPORT),
        sheet=np.full(count, held.sheet),
        a=np.full(count, GROUND),
        b=held.body,
        origin=bodies.position[held.body] + np.array(arms),
        axes=np.broadcast_to(np.eye(3), (count, 3, 3)),
        rest=np.zeros((count, 3)),
        k=k,
        c=2 * 0.5 * np.sqrt(k * sheet.derived["m"]),
        node=np.broadcast_to(held.node, (count, 2)),
        frames=np.zeros((count, 2), np.int64),
    )


def joined(tables: Sequence[Bushings]) -> Bushings:
    """Several tables as one; none makes an empty one."""
    columns = [[getattr(t, f.name) for t in tables] for f in fields(Bushings)]
    names, labels = (tuple(text for column in parts for text in column) for parts in columns[:2])
    # rows of a broadcast table would lie scattered in memory
    arrays = [np.ascontiguousarray(np.concatenate(parts)) for parts in columns[2:]]
    return Bushings(names, labels, *arrays)

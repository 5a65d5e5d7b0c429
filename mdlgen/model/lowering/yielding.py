"""Bushings that yield in bending, from the yield curvature of their material."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mdlgen.model.lowering.joints import Joints
from mdlgen.model.lowering.stiffness import Between, coefficients
from mdlgen.model.tables import Plastic
from mdlgen.spec.material import Material
from mdlgen.spec.sheet import Sheet


def yielding(sheet: Sheet, material: Material, joints: Joints, of: Between, first: int) -> Plastic | None:
    """Returns those of `joints`, numbered from `first` on among the bushings; None: the material is elastic.

    A bushing with the stiffness k over the length L yields at the moment k L kappa_y. Beyond, its moment
    grows with the rotation by h k, hence with the plastic part of the rotation by H = k h/(1 - h). The
    compliance of a crease is elastic: it is in series with the sheet, which yields.
    """
    if material.yield_ is None:
        return None
    along = 0 if joints.along_x else 1
    sheet_alone = replace(of, crease=np.full_like(of.crease, np.inf))
    k, _ = coefficients(sheet, material, sheet_alone, joints.along_x)
    stiffness = k[:, 4 if joints.along_x else 3]
    length = of.d_x if joints.along_x else of.d_y
    share = material.yield_.hardenings[along]
    return Plastic(
        bushing=first + np.arange(len(stiffness)),
        axis=np.full(len(stiffness), 1 - along),
        moment=material.yield_.curvatures[along] * stiffness * length,
        hardening=joints.scale * stiffness * share / (1.0 - share),
    )


def together(tables: Sequence[Plastic]) -> Plastic:
    """One table of several."""
    return Plastic(
        *(
            np.concatenate([getattr(table, name) for table in tables])
            for name in ("bushing", "axis", "moment", "hardening")
        )
    )

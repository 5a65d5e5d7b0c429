"""The boxes of one sheet: what each is, where lengths and zones make them differ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.model.tables import Floats, ZonePart, thick_of
from mdlgen.spec.sheet import Sheet
from mdlgen.spec.zone import Zone


@dataclass(frozen=True)
class Cells:
    """One row per box, row by row: index = i + j n_x. Units: mm, g."""

    d_x: Floats  # lengths (Eq. 1)
    d_y: Floats
    s: Floats  # thickness
    m: Floats  # mass (Eq. 2)
    stiff: Floats  # moduli relative to those of the sheet
    friction: Floats  # friction relative to that of the contact
    plain: float  # thickness of the sheet outside its zones

    @property
    def inertia(self) -> Floats:
        """About the axes of a solid box (Eq. 3) [g mm^2], (n, 3)."""
        x, y, z = self.d_x**2, self.d_y**2, self.s**2
        return np.stack([self.m * (y + z) / 12, self.m * (x + z) / 12, self.m * (x + y) / 12], axis=1)

    @property
    def membrane(self) -> Floats:
        """Membrane stiffness relative to that of the sheet outside its zones."""
        return self.stiff * (self.s / self.plain)

    @property
    def bending(self) -> Floats:
        """Bending stiffness relative to that of the sheet outside its zones."""
        return self.stiff * (self.s / self.plain) ** 3


def zone_parts(sheet: Sheet) -> tuple[ZonePart, ...]:
    """The zones of a sheet by name, with the share of each box that they cover."""
    return tuple(_part(sheet, name, sheet.zones[name]) for name in sorted(sheet.zones))


def _part(sheet: Sheet, name: str, zone: Zone) -> ZonePart:
    along = []
    for (low, high), lines in zip((zone.x, zone.y), map(np.array, sheet.lines), strict=True):
        covered = np.minimum(high, lines[1:]) - np.maximum(low, lines[:-1])
        part = np.clip(covered / np.diff(lines), 0.0, 1.0)
        # a side on a line between boxes leaves no sliver of the next one
        along.append(np.where(part < 1e-9, 0.0, np.where(part > 1 - 1e-9, 1.0, part)))
    share = np.outer(along[1], along[0]).ravel()
    return ZonePart(name, share, zone.thickness, zone.density, zone.stiffness, zone.friction)


def cells(sheet: Sheet, zones: tuple[ZonePart, ...]) -> Cells:
    """The boxes of a sheet. Its mass is shared out by area, thickness and density."""
    n_x, n_y = sheet.boxes
    graded = sheet.grading
    sides = []
    for axis, (lines, pitch, count) in enumerate(zip(sheet.lines, sheet.pitch, sheet.boxes, strict=True)):
        even = graded is None or (graded.x, graded.y)[axis] is None
        # equal lengths are equal to the last bit
        sides.append(np.full(count, pitch) if even else np.diff(lines))
    d_x, d_y = np.tile(sides[0], n_y), np.repeat(sides[1], n_x)
    s = thick_of(sheet.thickness, zones, n_x * n_y)
    stiff, friction, dense = (np.ones(n_x * n_y) for _ in range(3))
    for zone in zones:
        thick = zone.thickness if zone.thickness is not None else sheet.thickness
        stiff = stiff + zone.share * (zone.stiffness - 1.0)
        friction = friction + zone.share * (zone.friction - 1.0)
        dense = dense + zone.share * (zone.density * (thick / sheet.thickness) - 1.0)
    if graded is None and not zones:
        m = np.full(n_x * n_y, sheet.mass / (n_x * n_y))  # Eq. 2
    else:
        weight = d_x * d_y * dense
        m = sheet.mass * (weight / weight.sum())
    return Cells(d_x, d_y, s, m, stiff, friction, sheet.thickness)

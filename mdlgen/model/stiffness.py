"""Joint stiffness and damping of a sheet: the paper's Eqs. 2-7, and bending from plate stiffness.

Units: mm, N, g, ms, rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from mdlgen.spec.material import Material
from mdlgen.spec.sheet import Sheet

# A support is a bushing to ground this much stiffer than the sheet's own k_z.
SUPPORT_FACTOR = 100.0


@dataclass(frozen=True)
class JointValues:
    """Values of one bushing of the sheet (each of the two at a pair in `edge_to_edge`).

    `k`, `c`: (k_x, k_y, k_z, k_tx, k_ty, k_tz) in N/mm and N mm/rad, and the dampings in N ms/mm and
    N mm ms/rad. `k_joint_x` and `k_joint_y` are the same for the joints along x and along y; they differ
    from `k` only where `D_twist` sets the twist of the joint.
    """

    d_x: float
    d_y: float
    m: float
    inertia: tuple[float, float, float]
    k_joint_x: tuple[float, ...]
    k_joint_y: tuple[float, ...]
    c_joint_x: tuple[float, ...]
    c_joint_y: tuple[float, ...]

    def derived(self) -> dict[str, float]:
        """The paper's Tables 1 and 2 for this sheet, by symbol."""
        names = ("x", "y", "z", "tx", "ty", "tz")
        # the hinge about x bends the joints along y, the hinge about y those along x
        k = (*self.k_joint_x[:3], self.k_joint_y[3], self.k_joint_x[4], self.k_joint_x[5])
        c = (*self.c_joint_x[:3], self.c_joint_y[3], self.c_joint_x[4], self.c_joint_x[5])
        values = {"d_x": self.d_x, "d_y": self.d_y, "m": self.m}
        values |= {f"I_{a}": i for a, i in zip("xyz", self.inertia, strict=True)}
        values |= {f"k_{n}": v for n, v in zip(names, k, strict=True)}
        return values | {f"c_{n}": v for n, v in zip(names, c, strict=True)}


def joint_values(sheet: Sheet, material: Material) -> JointValues:
    """Eqs. 2-7 for one sheet."""
    d_x, d_y = sheet.pitch
    s = sheet.thickness
    m = sheet.mass / (sheet.boxes[0] * sheet.boxes[1])  # Eq. 2
    inertia = (m * (d_y**2 + s**2) / 12, m * (d_x**2 + s**2) / 12, m * (d_x**2 + d_y**2) / 12)
    parts = 2 if sheet.layout == "edge_to_edge" else 1  # bushings per pair

    e_md, e_cd = material.moduli
    k_x = e_md * d_y * s / d_x / parts  # Eq. 5
    k_y = e_cd * d_x * s / d_y / parts  # Eq. 6
    k_z = 10.0 * max(k_x, k_y)
    k_tx = material.k_tx if material.k_tx is not None else _plate(material.D_cd, d_x / d_y, parts)
    k_ty = material.k_ty if material.k_ty is not None else _plate(material.D_md, d_y / d_x, parts)
    k_tz = material.k_tz if material.k_tz is not None else 20.0 * max(k_tx, k_ty)
    k_along_x, k_along_y = [k_x, k_y, k_z, k_tx, k_ty, k_tz], [k_x, k_y, k_z, k_tx, k_ty, k_tz]
    if material.D_twist is not None:
        k_along_x[3] = 2.0 * material.D_twist * d_y / d_x
        k_along_y[4] = 2.0 * material.D_twist * d_x / d_y

    def damping(k: list[float]) -> tuple[float, ...]:
        return _damping(k, m, (d_x, d_y, s), parts, material)

    return JointValues(
        d_x, d_y, m, inertia, tuple(k_along_x), tuple(k_along_y), damping(k_along_x), damping(k_along_y)
    )


def _plate(stiffness: float | None, shape: float, parts: int) -> float:
    """Hinge stiffness of one bushing from bending stiffness per width; `shape` = width / length."""
    assert stiffness is not None, "the spec requires one of k_t* and D_*"
    return stiffness * shape / parts


def _damping(
    k: list[float], m: float, box: tuple[float, float, float], parts: int, material: Material
) -> tuple[float, ...]:
    """Eq. 7 for the six components of one bushing; the bushings of a pair add up to the central one."""
    damping = material.damping
    zeta_ty = damping.ratio if damping.ratio_ty is None else damping.ratio_ty
    zeta = (damping.ratio, damping.ratio, damping.ratio, damping.ratio, zeta_ty, damping.ratio)
    c = [2.0 * z * math.sqrt(parts * ki * m) / parts for z, ki in zip(zeta[:3], k[:3], strict=True)]
    if damping.rotation == "paper":
        # The paper's Table 2: Eq. 7 with the mass of the box; in e2e c_tx and c_ty follow their own k,
        # c_tz is half of the central one (physics.md). A mass in a rotation is not dimensionally right.
        shares = (1, 1, parts)
        masses = (m, m, m)
    else:
        d_x, d_y, s = box
        shares = (parts, parts, parts)
        # about the edges and the corner of the box, where the hinges lie
        masses = (m * (d_y**2 / 3 + s**2 / 12), m * (d_x**2 / 3 + s**2 / 12), m * (d_x**2 + d_y**2) / 3)
    for z, ki, share, mass in zip(zeta[3:], k[3:], shares, masses, strict=True):
        c.append(2.0 * z * math.sqrt(share * ki * mass) / share)
    return tuple(c)

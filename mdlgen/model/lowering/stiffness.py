"""Joint stiffness and damping of a sheet: the paper's Eqs. 4-7, and values derived from plate stiffness.

Each joint has a length and a width of its own. Along it that is the mean of the two boxes, across it the side
that they share. It consists of two halves in series, one in each box. For equal boxes that is the paper's
formula with d_x and d_y. Units: mm, N, g, ms, rad.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.model.lowering import plate
from mdlgen.model.lowering.cells import Cells
from mdlgen.model.tables import Floats, Ints
from mdlgen.spec.material import Material
from mdlgen.spec.sheet import Sheet

# A support is a bushing to ground this much stiffer than the sheet's own k_z.
SUPPORT_FACTOR = 100.0
COMPONENTS: tuple[str, ...] = ("x", "y", "z", "tx", "ty", "tz")


@dataclass(frozen=True)
class Between:
    """Boxes that joints connect, one row each; a half-cell hinge has the one box that it holds twice."""

    d_x: Floats  # [mm]
    d_y: Floats
    s: Floats
    m: Floats  # [g]
    membrane: Floats  # stiffness relative to that of the sheet outside its zones
    bending: Floats
    crease: Floats  # stiffness of a crease per length [N mm/rad per mm], inf: none


def between(boxes: Cells, one: Ints, two: Ints, along_x: bool, soft: Floats, crease: Floats) -> Between:
    """The joints between boxes `one` and `two`, next to each other along x, or along y. Of creases: `soft` is
    the bending stiffness relative to that of the sheet, `crease` the stiffness per length, see Between."""
    lengths = boxes.d_x if along_x else boxes.d_y
    a, b = lengths[one], lengths[two]
    length = 0.5 * (a + b)

    def series(factor: Floats) -> Floats:
        return (a + b) / (a / factor[one] + b / factor[two])

    return Between(
        d_x=length if along_x else boxes.d_x[one],
        d_y=boxes.d_y[one] if along_x else length,
        s=0.5 * (boxes.s[one] + boxes.s[two]),
        m=0.5 * (boxes.m[one] + boxes.m[two]),
        membrane=series(boxes.membrane),
        bending=soft * series(boxes.bending),
        crease=crease,
    )


def extent(sheet: Sheet, of: Between, along_x: bool) -> tuple[Floats, Floats]:
    """Length [mm] of each joint along x, or along y, and section [mm^2] of one of its bushings. In zones the
    section is scaled by their membrane stiffness."""
    parts = 2 if sheet.layout == "edge_to_edge" else 1
    long, wide = (of.d_x, of.d_y) if along_x else (of.d_y, of.d_x)
    return long, of.membrane * (wide * sheet.thickness / parts)


def plain(sheet: Sheet) -> Between:
    """A joint between two boxes of mean length outside all zones."""
    d_x, d_y = sheet.pitch
    m = sheet.mass / (sheet.boxes[0] * sheet.boxes[1])  # Eq. 2
    columns = (d_x, d_y, sheet.thickness, m, 1.0, 1.0, np.inf)
    return Between(*(np.array([value]) for value in columns))


def coefficients(sheet: Sheet, material: Material, of: Between, along_x: bool) -> tuple[Floats, Floats]:
    """(k, c) of one bushing of each joint along x, or along y, (n, 6) each: k_x, k_y, k_z [N/mm], k_tx, k_ty,
    k_tz [N mm/rad], and the dampings [N ms/mm], [N mm ms/rad] (Eqs. 4-7, or damping times of k)."""
    parts = 2 if sheet.layout == "edge_to_edge" else 1  # bushings per pair
    s = sheet.thickness
    e_md, e_cd = material.moduli
    k_x = of.membrane * (e_md * of.d_y * s / of.d_x / parts)  # Eq. 5
    k_y = of.membrane * (e_cd * of.d_x * s / of.d_y / parts)  # Eq. 6
    k_z = 10.0 * np.maximum(k_x, k_y)
    shape, mean = of.d_x / of.d_y, sheet.pitch[0] / sheet.pitch[1]
    d_md, d_cd = material.plates(s)
    k_tx = of.bending * _hinge(material.k_tx, d_cd, shape, mean, parts)
    k_ty = of.bending * _hinge(material.k_ty, d_md, 1.0 / shape, 1.0 / mean, parts)
    if along_x:
        k_ty = _creased(k_ty, of.crease, of.d_y / parts)
    else:
        k_tx = _creased(k_tx, of.crease, of.d_x / parts)
    even = np.ones_like(k_x)
    k_tz = material.k_tz * even if material.k_tz is not None else 20.0 * np.maximum(k_tx, k_ty)
    twist = plate.twisting(sheet, material)
    if twist is not None:
        if along_x:
            k_tx = of.bending * (2.0 * twist * of.d_y / of.d_x)
        else:
            k_ty = of.bending * (2.0 * twist * of.d_x / of.d_y)
    if sheet.layout == "plate":
        k_x, k_y, k_tz = plate.in_plane(material, (k_x, k_y), (of.d_x, of.d_y), of.membrane * s, along_x)
    k = np.stack([k_x, k_y, k_z, k_tx, k_ty, k_tz], axis=1)
    times = material.damping.times
    if times is None:
        return k, _damping(k, of, parts, material)
    return k, k * damping_times(times, sheet.layout == "plate", twist is not None, along_x)


def damping_times(times: tuple[float, float], sheared: bool, twisted: bool, along_x: bool) -> Floats:
    """Damping time of each of the six components of joints along x, or along y [ms], (6,).

    Kelvin and Voigt's modulus at the frequency w is E (1 + i w tau), so each component has the time of the
    modulus that its stiffness follows from. Shear and twist follow from the root of both moduli
    (`plate.SHEAR_RATIO`). They have sqrt((1 + i w tau_md) (1 + i w tau_cd)) = 1 + i w (tau_md + tau_cd)/2 to
    first order, the mean of both times. k_z and a k_tz without a direction have the mean, too. `sheared`:
    joints have a shear stiffness of their own, and bend in the plane as the strip does; `twisted`: a twisting
    stiffness.
    """
    md, cd = times
    mean = 0.5 * (md + cd)
    tau = np.array([md, cd, mean, cd, md, mean])
    if twisted:
        tau[3 if along_x else 4] = mean
    if sheared:
        tau[1 if along_x else 0] = mean
        tau[5] = md if along_x else cd
    return tau


def _hinge(given: float | None, plate: float | None, shape: Floats, mean: float, parts: int) -> Floats:
    """Hinge stiffness of one bushing; `shape` is its width over its length, `mean` that of the mean box, for
    which a stiffness per bushing is given."""
    if given is not None:
        return given * (shape / mean)
    assert plate is not None, "what is no hinge is a plate"
    return plate * shape / parts


def _creased(k: Floats, crease: Floats, width: Floats) -> Floats:
    """The stiffness k in bending in series with a crease of a stiffness per length, on a bushing's width."""
    return k / (1.0 + k / (crease * width))


def _damping(k: Floats, of: Between, parts: int, material: Material) -> Floats:
    """Eq. 7 for the six components of one bushing; the bushings of a pair add up to the central one."""
    damping = material.damping
    zeta, zeta_ty = damping.zetas
    c = [2.0 * zeta * np.sqrt(parts * k[:, i] * of.m) / parts for i in range(3)]
    if damping.kind == "paper":
        # The paper's Table 2: Eq. 7 with the mass of the box; in e2e c_tx and c_ty follow their own k,
        # c_tz is half of the central one (physics.md). A mass in a rotation is not dimensionally right.
        shares = (1, 1, parts)
        masses = (of.m, of.m, of.m)
    else:
        shares = (parts, parts, parts)
        # about the edges and the corner of the box, where the hinges lie
        masses = (
            of.m * (of.d_y**2 / 3 + of.s**2 / 12),
            of.m * (of.d_x**2 / 3 + of.s**2 / 12),
            of.m * (of.d_x**2 + of.d_y**2) / 3,
        )
    zetas = (zeta, zeta_ty, zeta)
    for i, (own, share, mass) in enumerate(zip(zetas, shares, masses, strict=True), start=3):
        c.append(2.0 * own * np.sqrt(share * k[:, i] * mass) / share)
    return np.stack(c, axis=1)


def derived(sheet: Sheet, material: Material) -> dict[str, float]:
    """The paper's Tables 1 and 2 for this sheet, by symbol: of a box of mean size outside all zones.

    k_x, k_ty and k_tz are those of the joints along x, k_y and k_tx those of the joints along y; layout plate
    adds the others as k_y_shear, k_tx_twist and k_x_shear, k_ty_twist, k_tz_y, and the G [MPa] and D_twist
    [N mm] that they follow from. Joints in the rows and columns at free edges have k_tx_twist_edge and
    k_ty_twist_edge in place of k_tx_twist and k_ty_twist. Damping by time adds tau_md and tau_cd [ms],
    poisson nu_md and nu_cd. Stiffnesses are those of strips, which lowering.poisson makes those of a plate.
    """
    of = plain(sheet)
    own, shared = {True: ("x", "ty", "tz"), False: ("y", "tx")}, ("z",)
    other = {
        True: {"y": "y_shear", "tx": "tx_twist"},
        False: {"x": "x_shear", "ty": "ty_twist", "tz": "tz_y"},
    }
    d_x, d_y, s, m = (float(v[0]) for v in (of.d_x, of.d_y, of.s, of.m))
    values = {"d_x": d_x, "d_y": d_y, "m": m}
    inertia = (m * (d_y**2 + s**2) / 12, m * (d_x**2 + s**2) / 12, m * (d_x**2 + d_y**2) / 12)
    values |= {f"I_{a}": i for a, i in zip("xyz", inertia, strict=True)}
    found: dict[str, float] = {}
    for along_x in (True, False):
        for symbol, six in zip("kc", coefficients(sheet, material, of, along_x), strict=True):
            row = dict(zip(COMPONENTS, six[0].tolist(), strict=True))
            found |= {f"{symbol}_{n}": row[n] for n in (*own[along_x], *shared)}
            if sheet.layout == "plate":
                found |= {f"{symbol}_{name}": row[n] for n, name in other[along_x].items()}
    values |= {name: found.pop(name) for name in [f"{symbol}_{n}" for symbol in "kc" for n in COMPONENTS]}
    if material.damping.times is not None:
        values |= dict(zip(("tau_md", "tau_cd"), material.damping.times, strict=True))
    if sheet.layout != "plate":
        return values
    if material.poisson:
        md, cd = material.moduli
        values |= {"nu_md": material.poisson, "nu_cd": material.poisson * cd / md}
    twist = plate.twisting(sheet, material)
    assert twist is not None, "a plate has one"
    held = "" if sheet.clamp is None else sheet.clamp.edge
    for name, side, strips in (("tx", "y", sheet.boxes[1]), ("ty", "x", sheet.boxes[0])):
        ends = plate.tributary(
            np.array([0, strips - 1]), strips, held == f"{side}_min", held == f"{side}_max"
        )
        found |= {f"{s}_{name}_twist_edge": found[f"{s}_{name}_twist"] * float(ends.max()) for s in "kc"}
    return values | found | {"G": plate.shear_modulus(material), "D_twist": twist}

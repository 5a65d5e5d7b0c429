"""A rubber cover as a ring of finite elements in plane strain, bonded to its core, under a rigid round.

Independent of the transform of a flat layer that mdlgen.rubber uses: here the cover is round, and the surface
of the other roller is its true circle. Elements have four nodes; their change of volume is taken at the
middle (Hughes, The Finite Element Method, section 4.4), so that nearly incompressible rubber does not lock.
Strains are small, contact is without friction and found by an active set.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from mdlgen.rubber.layer import Floats

_MOST = 60  # changes of the active set: a nip needs about ten
_NODES = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)  # of an element
_ROUND = 3.0  # either way [rad], where the mesh ends at the latest
FAR = 5.0  # thicknesses beyond the contact, where the mesh ends: displacements there are e^-10


@dataclass(frozen=True)
class Ring:
    """A cover [mm, MPa] and its mesh: `fine` elements on the half-width of the nip, `deep` across."""

    radius: float
    thickness: float
    modulus: float
    poisson: float
    half: float  # about the half-width that the mesh is made for [mm]
    fine: int = 40
    deep: int = 32


@dataclass(frozen=True)
class Surface:
    """Displacements of the surface of a ring by unit forces there, along the round in order: angles of the
    nodes (n,), radial and tangential displacement [mm] of each node by a radial (n, n) and a tangential
    force [N/mm] of each."""

    angle: Floats
    radial: tuple[Floats, Floats]
    tangential: tuple[Floats, Floats]


@dataclass(frozen=True)
class Nip:
    """Half-width and depth [mm], line load [N/mm], forces of the nodes (n,) [N/mm], and v/(omega R) - 1 of a
    sheet that slides on all of it without a pull."""

    half: float
    depth: float
    load: float
    force: Floats
    gain: float


def _angles(ring: Ring) -> Floats:
    """Ends of the elements along the round, symmetric about 0 [rad]."""
    near, step = 1.5 * ring.half, ring.half / ring.fine
    ends = list(np.linspace(0.0, near, math.ceil(1.5 * ring.fine) + 1))
    while ends[-1] < near + FAR * ring.thickness:
        step *= 1.2
        ends.append(ends[-1] + step)
    some = np.array([end / ring.radius for end in ends if end < _ROUND * ring.radius])
    return np.concatenate([-some[:0:-1], some])


@lru_cache(maxsize=8)
def surface(ring: Ring) -> Surface:
    """The compliance of the surface."""
    across = _angles(ring)
    share = np.linspace(0.0, 1.0, ring.deep + 1) ** 0.7  # finer towards the surface
    radii = ring.radius - ring.thickness * (1.0 - share)
    nx, ny = len(across) - 1, ring.deep
    number = np.arange((nx + 1) * (ny + 1)).reshape(nx + 1, ny + 1)
    theta, r = (v.ravel() for v in np.meshgrid(across, radii, indexing="ij"))
    place = np.stack([r * np.sin(theta), r * np.cos(theta)], axis=1)
    nodes = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    nodes = nodes.reshape(-1, 4)
    stiff = _stiffness(ring, place[nodes])
    unknowns = np.stack([2 * nodes, 2 * nodes + 1], axis=2).reshape(len(nodes), 8)
    rows, columns = np.repeat(unknowns, 8, axis=1), np.tile(unknowns, (1, 8))
    whole = coo_matrix((stiff.ravel(), (rows.ravel(), columns.ravel()))).tocsc()
    free = np.flatnonzero(np.repeat(r > radii[0] + 1e-9 * ring.radius, 2))
    solved = splu(whole[free][:, free])
    top = number[:, -1]
    angle = across
    found = []
    outward = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    along = np.stack([np.cos(angle), -np.sin(angle)], axis=1)
    for way in (outward, along):
        loads = np.zeros((2 * len(place), len(top)))
        loads[2 * top, np.arange(len(top))] = way[:, 0]
        loads[2 * top + 1, np.arange(len(top))] = way[:, 1]
        moved = np.zeros_like(loads)
        moved[free] = solved.solve(loads[free])
        x, y = moved[2 * top], moved[2 * top + 1]
        found.append(tuple(w[:, :1] * x + w[:, 1:] * y for w in (outward, along)))
    return Surface(angle, found[0], found[1])


def _stiffness(ring: Ring, corners: Floats) -> Floats:
    """Stiffness of each element, whose nodes have the places `corners` (m, 4, 2), (m, 8, 8)."""
    e, nu = ring.modulus, ring.poisson
    shear, bulk = e / (2 * (1 + nu)), e / (3 * (1 - 2 * nu))
    away = shear * np.array([[4 / 3, -2 / 3, 0], [-2 / 3, 4 / 3, 0], [0, 0, 1]])  # of a change of shape
    found = np.zeros((len(corners), 8, 8))
    for a in (-1.0, 1.0):
        for b in (-1.0, 1.0):
            strain, size = _strain(corners, a / math.sqrt(3.0), b / math.sqrt(3.0))
            found += np.einsum("mai,ab,mbj,m->mij", strain, away, strain, size, optimize=True)
    strain, size = _strain(corners, 0.0, 0.0)
    volume = strain[:, 0] + strain[:, 1]
    return found + np.einsum("mi,mj,m->mij", volume, volume, 4.0 * bulk * size, optimize=True)


def _strain(corners: Floats, x: float, y: float) -> tuple[Floats, Floats]:
    """Strains xx, yy, xy of elements at a place by the displacements of their nodes, (m, 3, 8), and the area
    that stands for, (m,)."""
    a, b = _NODES.T
    slopes = 0.25 * np.stack([a * (1 + b * y), b * (1 + a * x)])
    jacobian = np.einsum("kn,mnc->mkc", slopes, corners)
    local = np.linalg.solve(jacobian, np.broadcast_to(slopes, (len(corners), 2, 4)))
    strain = np.zeros((len(corners), 3, 8))
    strain[:, 0, 0::2], strain[:, 1, 1::2] = local[:, 0], local[:, 1]
    strain[:, 2, 0::2], strain[:, 2, 1::2] = local[:, 1], local[:, 0]
    return strain, np.abs(np.linalg.det(jacobian))


def nip(ring: Ring, other: float, depth: float) -> Nip:
    """The nip with a rigid round of another radius [mm] (inf: a flat face) that is pressed in by a depth."""
    of = surface(ring)
    angle, compliance = of.angle, of.radial[0]
    ahead = np.cos(angle)
    if math.isinf(other):
        face = np.where(ahead > 0.1, (ring.radius - depth) / np.maximum(ahead, 0.1), math.inf)
    else:
        apart = ring.radius + other - depth
        under = other**2 - (apart * np.sin(angle)) ** 2
        meets = (under > 0.0) & (ahead > 0.0)
        face = np.where(meets, apart * ahead - np.sqrt(np.maximum(under, 0.0)), math.inf)
    deep = ring.radius - face  # of each node, if it were pressed onto the other surface
    touching, force = deep > 0.0, np.zeros(len(angle))
    for _ in range(_MOST):
        some = np.flatnonzero(touching)
        force[:] = 0.0
        force[some] = np.linalg.solve(compliance[np.ix_(some, some)], deep[some])
        inside = compliance @ force < deep - 1e-12 * depth
        new = (touching & (force > 0.0)) | (~touching & inside)
        if (new == touching).all():
            break
        touching = new
    load = float(force.sum())
    stretch = stretched(ring, -of.radial[0] @ force, -of.radial[1] @ force)
    return Nip(ring.radius * _edge(angle, force), depth, load, force, float(force @ stretch / load))


def _edge(angle: Floats, force: Floats) -> float:
    """Angle at which the pressure ends [rad]: half a node beyond the last node with a force."""
    last = int(np.flatnonzero(force > 0.0)[-1])
    return float(0.5 * (angle[last] + angle[last + 1]))


def stretched(ring: Ring, radial: Floats, tangential: Floats) -> Floats:
    """Stretch of the surface along the round at the nodes, of displacements there: (dv/dtheta + u)/R."""
    return (np.gradient(tangential, surface(ring).angle, edge_order=2) + radial) / ring.radius

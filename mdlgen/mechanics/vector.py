"""Vectors (x, y, z) and rotation matrices (row by row) as tuples, for compiled code."""

from __future__ import annotations

import math

from mdlgen.program.kernel import FUSED, njit


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def scale(s, a):
    return (s * a[0], s * a[1], s * a[2])


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def vec(array, row):
    """Row of an (n, 3) array."""
    return (array[row, 0], array[row, 1], array[row, 2])


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def mat(array, row):
    """Row of an (n, 9) array."""
    return (
        array[row, 0],
        array[row, 1],
        array[row, 2],
        array[row, 3],
        array[row, 4],
        array[row, 5],
        array[row, 6],
        array[row, 7],
        array[row, 8],
    )


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def three(a):
    """The first three numbers of an array or a record's field."""
    return (a[0], a[1], a[2])


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def three_from(a, first):
    """Three numbers of an array."""
    return (a[first], a[first + 1], a[first + 2])


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def nine(a):
    """The first nine."""
    return (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8])


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def rotate(m, a):
    """m a."""
    return (
        m[0] * a[0] + m[1] * a[1] + m[2] * a[2],
        m[3] * a[0] + m[4] * a[1] + m[5] * a[2],
        m[6] * a[0] + m[7] * a[1] + m[8] * a[2],
    )


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def back(m, a):
    """m^T a."""
    return (
        m[0] * a[0] + m[3] * a[1] + m[6] * a[2],
        m[1] * a[0] + m[4] * a[1] + m[7] * a[2],
        m[2] * a[0] + m[5] * a[1] + m[8] * a[2],
    )


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def matmul(m, n):
    """m n."""
    return (
        m[0] * n[0] + m[1] * n[3] + m[2] * n[6],
        m[0] * n[1] + m[1] * n[4] + m[2] * n[7],
        m[0] * n[2] + m[1] * n[5] + m[2] * n[8],
        m[3] * n[0] + m[4] * n[3] + m[5] * n[6],
        m[3] * n[1] + m[4] * n[4] + m[5] * n[7],
        m[3] * n[2] + m[4] * n[5] + m[5] * n[8],
        m[6] * n[0] + m[7] * n[3] + m[8] * n[6],
        m[6] * n[1] + m[7] * n[4] + m[8] * n[7],
        m[6] * n[2] + m[7] * n[5] + m[8] * n[8],
    )


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def transpose_matmul(m, n):
    """m^T n."""
    return matmul((m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]), n)


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def log_rotation(m):
    """Rotation vector of m, |theta| <= pi."""
    w = (0.5 * (m[7] - m[5]), 0.5 * (m[2] - m[6]), 0.5 * (m[3] - m[1]))
    sine2 = dot(w, w)
    cosine = 0.5 * (m[0] + m[4] + m[8] - 1.0)
    if cosine > 0.9999:
        # asin(x)/x = 1 + x^2/6 + 3 x^4/40 + 15 x^6/336; x^2 < 2e-4 here
        return scale(1.0 + sine2 / 6 + 3 * sine2 * sine2 / 40 + 15 * sine2 * sine2 * sine2 / 336, w)
    sine = math.sqrt(sine2)
    if sine > 1e-6:
        return scale(math.atan2(sine, cosine) / sine, w)
    # half a turn: the axis from the symmetric part
    x = math.sqrt(max(0.0, 0.5 * (1.0 + m[0])))
    y = math.sqrt(max(0.0, 0.5 * (1.0 + m[4])))
    z = math.sqrt(max(0.0, 0.5 * (1.0 + m[8])))
    if x >= y and x >= z:
        axis = (x, 0.5 * (m[1] + m[3]) / (2 * x), 0.5 * (m[2] + m[6]) / (2 * x))
    elif y >= z:
        axis = (0.5 * (m[1] + m[3]) / (2 * y), y, 0.5 * (m[5] + m[7]) / (2 * y))
    else:
        axis = (0.5 * (m[2] + m[6]) / (2 * z), 0.5 * (m[5] + m[7]) / (2 * z), z)
    return scale(math.pi, axis)


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def sines(angle2):
    """sin(a)/a and (1 - cos(a))/a^2 of the square of an angle."""
    if angle2 < 0.01:
        # the next terms of the series are below 3e-18; a call of sin takes as long as all of them
        s = 1.0 + angle2 * (-1 / 6 + angle2 * (1 / 120 + angle2 * (-1 / 5040 + angle2 * (1 / 362880))))
        c = 0.5 + angle2 * (-1 / 24 + angle2 * (1 / 720 + angle2 * (-1 / 40320 + angle2 * (1 / 3628800))))
        return s, c
    angle = math.sqrt(angle2)
    return math.sin(angle) / angle, (1.0 - math.cos(angle)) / angle2


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def exp_rotation(theta):
    """Rotation matrix of a rotation vector."""
    s, c = sines(dot(theta, theta))
    return turned(theta, s, c)


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def turned(theta, s, c):
    """The same with what `sines` gives of the vector's square."""
    x, y, z = theta
    return (
        1 - c * (y * y + z * z),
        c * x * y - s * z,
        c * x * z + s * y,
        c * x * y + s * z,
        1 - c * (x * x + z * z),
        c * y * z - s * x,
        c * x * z - s * y,
        c * y * z + s * x,
        1 - c * (x * x + y * y),
    )


@njit(cache=True, error_model="numpy")
def local(p, r, q, a, b, c):
    """The vector with components a, b, c on the axes p, r, q."""
    x = a if p == 0 else b if r == 0 else c
    y = a if p == 1 else b if r == 1 else c
    z = a if p == 2 else b if r == 2 else c
    return (x, y, z)

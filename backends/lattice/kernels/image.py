"""Bodies that move as the mirror images of others."""

from __future__ import annotations

from mdlgen.mechanics.vector import add, dot, mat, scale, sub, three, vec
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy", forceinline=True)
def _seen(v, normal):
    """Mirror image of a vector."""
    return sub(v, scale(2.0 * dot(normal, v), normal))


@njit(cache=True, error_model="numpy")
def reflect(images, x, r):
    """Places each mirrored body at the mirror image of its original."""
    for i in range(images.size):
        image = images[i]
        b, of, normal, signs = image.body, image.of, three(image.normal), image.signs
        at = add(_seen(vec(x, of), normal), scale(2.0 * image.at, normal))
        m = mat(r, of)
        for c in range(3):
            x[b, c] = at[c]
            axis = _seen((m[c], m[3 + c], m[6 + c]), normal)
            for k in range(3):
                r[b, 3 * k + c] = signs[c] * axis[k]


@njit(cache=True, error_model="numpy")
def reflect_rates(images, u, w):
    """Sets the velocity of each mirrored body: the mirror image, with the opposite sense of rotation."""
    for i in range(images.size):
        b, of, normal = images[i].body, images[i].of, three(images[i].normal)
        rate, spin = _seen(vec(u, of), normal), _seen(vec(w, of), normal)
        for c in range(3):
            u[b, c], w[b, c] = rate[c], -spin[c]

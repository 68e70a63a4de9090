"""Mirror planes of a body and what they say about its added-mass matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.least_squares import Array
from coeflab.kernels.surface_mesh import Faces

# Signs of u v w p q r under the mirror that turns x, y or z round: velocities are polar, rates axial vectors.
SIGNS = np.array([[-1, 1, 1, 1, -1, -1], [1, -1, 1, -1, 1, -1], [1, 1, -1, -1, -1, 1]])
INNER, OUTER = 1.0 / 6.0, 1.0 / 2.0
WEIGHTS = np.array([-0.8, 0.45, 0.45, 0.45, 0.45])


def asymmetries(vertices: Array, faces: Faces) -> Array:
    """How far a closed surface is from its mirror images in x, y and z through its centre of volume, shape (3,).

    The largest volume moment up to the third degree that a mirror plane would make vanish, in coordinates of unit second
    moment, over the volume: zero for a symmetric body however it is meshed.

    Notes
    -----
    Necessary, not sufficient: a body that only higher moments tell from its image, such as one of canted fins all alike,
    passes. Tetrahedra from the centre to the faces, each by the rule of degree 3 of Keast (1986) with five points.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    sixth = np.einsum("ij,ij->i", a - vertices[0], np.cross(b - vertices[0], c - vertices[0])) / 6.0
    volume = sixth.sum()
    centre = sixth @ (a + b + c + vertices[0]) / (4.0 * volume)
    a, b, c = a - centre, b - centre, c - centre
    signed = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    middle, corners = (a + b + c) / 4.0, (np.zeros_like(a), a, b, c)
    total = a + b + c
    points = np.stack([middle, *(INNER * (total - k) + OUTER * k for k in corners)])
    weight = WEIGHTS[:, None] * signed
    scale = np.sqrt(np.einsum("sn,snk->k", weight, points**2) / volume)
    x = points / scale
    out = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        others = (x[..., i], x[..., j], x[..., k] ** 2, x[..., i] ** 2, x[..., j] ** 2, x[..., i] * x[..., j])
        out.append(max(abs(float(np.sum(weight * x[..., k] * f))) for f in others) / volume)
    return np.array(out)


def vanishing(mirrors: tuple[bool, bool, bool]) -> NDArray[np.bool_]:
    """Which entries of the (6, 6) matrix vanish about a point on the mirror planes of x, y and z, as booleans."""
    out = np.zeros((6, 6), dtype=bool)
    for signs, holds in zip(SIGNS, mirrors, strict=True):
        if holds:
            out |= np.outer(signs, signs) < 0
    return out

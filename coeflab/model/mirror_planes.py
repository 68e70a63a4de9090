"""The mirror planes of a body's shape."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.mirror import asymmetries, vanishing
from coeflab.model.mesh import TriangleMesh
from coeflab.model.shape import Array, Part, Parts, Revolution, Shape

WITHIN = 2e-3
NAMES = ("fore-aft", "port-starboard", "top-bottom")


@lru_cache(2)
def mirrors(shape: Shape) -> tuple[bool, bool, bool]:
    """Whether a shape equals its image in x, in y and in z, each through its centre of volume.

    A mesh is held to volume moments up to the third degree, 0.2 % in units of its own size; parts are compared one by one.
    """
    if isinstance(shape, Revolution):
        return _fore_aft(shape), True, True
    if isinstance(shape, TriangleMesh):
        x, y, z = asymmetries(shape.vertices, shape.faces) < WITHIN
        return bool(x), bool(y), bool(z)
    middle = shape.centre_of_volume
    x, y, z = (_parts_mirror(shape, k, middle) for k in range(3))
    return x, y, z


def _fore_aft(hull: Revolution) -> bool:
    area, middle = hull.radius**2 * hull.weight, hull.centre_of_volume[0]
    spread = float(np.sqrt(np.sum(area * (hull.x - middle) ** 2) / area.sum()))
    return abs(float(np.sum(area * (hull.x - middle) ** 3))) < WITHIN * spread**3 * float(area.sum())


def _parts_mirror(shape: Parts, axis: int, middle: Array) -> bool:
    turn = np.ones(3)
    turn[axis] = -1.0
    size = max(float(np.max(p.form.half_extents(p.rotation))) for p in shape.parts)
    figures = [_figure(p) for p in shape.parts]
    return all(
        any(
            other[0] == kind
            and abs(other[1] - volume) <= WITHIN * max(volume, other[1])
            and np.allclose(other[2], turn * (centre - middle) + middle, atol=WITHIN * size)
            and np.allclose(other[3], np.outer(turn, turn) * spread, atol=WITHIN * size**2)
            for other in figures
        )
        for kind, volume, centre, spread in figures
    )


def _figure(part: Part) -> tuple[str, float, Array, Array]:
    spread = part.rotation @ np.diag(part.form.spread) @ part.rotation.T
    return type(part.form).__name__, part.form.volume, part.centre, spread


def must_vanish(shape: Shape, point: Array) -> NDArray[np.bool_]:
    """Entries of the added mass about a point that the mirror planes through it make vanish, (6, 6) of booleans."""
    off = np.abs(point - shape.centre_of_volume)
    size = shape.length or 1.0
    found = mirrors(shape)
    x, y, z = (m and bool(d <= 1e-6 * size) for m, d in zip(found, off, strict=True))
    return vanishing((x, y, z))

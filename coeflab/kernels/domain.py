"""Where a fitted table may be read: the convex hull of its data."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from coeflab.kernels.least_squares import Array

SLACK = 1e-9


def half_spaces(points: Array) -> Array:
    """Half-spaces [a, b] with a . x + b <= 0 inside the convex hull, shape (m, d + 1).

    Parameters
    ----------
    points : (n, d) array
        Scaled alike in every direction by the caller or not; the hull does not mind.

    Notes
    -----
    Flat data (all points on a line or plane of the space) are bounded along their own axes, with the directions across
    pinned.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    d = points.shape[1]
    if d > 1 and len(points) > d:
        size = np.where(high > low, high - low, 1.0)
        try:
            equations = np.unique(np.round(ConvexHull((points - low) / size).equations, 12), axis=0)
        except QhullError:
            return _flat(points, low, size)
        normals = equations[:, :d] / size
        return np.column_stack([normals, equations[:, d] - normals @ low])
    eye = np.eye(d)
    return np.vstack([np.column_stack([eye, -high]), np.column_stack([-eye, low])])


def _flat(points: Array, low: Array, size: Array) -> Array:
    """Bounds along the principal axes of scaled points that do not fill the space."""
    scaled = (points - low) / size
    _, _, axes = np.linalg.svd(scaled - scaled.mean(axis=0))
    along = scaled @ axes.T
    normals = np.vstack([axes, -axes])
    offsets = -np.concatenate([along.max(axis=0), -along.min(axis=0)])
    return np.column_stack([normals / size, offsets - (normals / size) @ low])


def inside(spaces: Array, points: Array, slack: float = SLACK) -> Array:
    """Whether points lie in all half-spaces, boolean (n,)."""
    d = spaces.shape[1] - 1
    scale = np.maximum(np.abs(spaces[:, d]), 1e-300)
    values = points @ spaces[:, :d].T + spaces[:, d]
    return np.asarray(np.all(values <= slack * np.maximum(scale, 1.0), axis=1))

"""Where a fitted table may be read: the convex hull of its data."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from coeflab.kernels.least_squares import Array

SLACK = 1e-9
FLAT = 1e-10


def half_spaces(points: Array) -> Array:
    """Half-spaces [a, b] with a . x + b <= 0 inside the convex hull, shape (m, d + 1).

    Parameters
    ----------
    points : (n, d) array
        Scaled alike in every direction by the caller or not; the hull does not mind.

    Notes
    -----
    Data on a line or plane of the space have their hull there, with the directions across pinned.
    """
    d = points.shape[1]
    low, high = points.min(axis=0), points.max(axis=0)
    if d == 1:
        return np.array([[1.0, -high[0]], [-1.0, low[0]]])
    size = np.where(high > low, high - low, 1.0)
    scaled = (points - low) / size
    try:
        equations = _flat(scaled) if len(points) <= d else ConvexHull(scaled).equations
    except QhullError:
        equations = _flat(scaled)
    equations = np.unique(np.round(equations, 12), axis=0)
    normals = equations[:, :d] / size
    return np.column_stack([normals, equations[:, d] - normals @ low])


def _flat(scaled: Array) -> Array:
    """Hull of scaled points that do not fill the space: that within their plane, along its principal axes."""
    d = scaled.shape[1]
    middle = scaled.mean(axis=0)
    _, _, axes = np.linalg.svd(np.linalg.qr(scaled - middle, mode="r"))
    along = (scaled - middle) @ axes.T
    wide = np.ptp(along, axis=0) > FLAT
    if np.all(wide):
        wide[-1] = False
    across = axes[~wide]
    pinned = along[:, ~wide]
    normals = [across, -across]
    offsets = [-pinned.max(axis=0), pinned.min(axis=0)]
    if np.any(wide):
        within = half_spaces(along[:, wide])
        normals.append(within[:, :-1] @ axes[wide])
        offsets.append(within[:, -1])
    stacked = np.vstack(normals)
    return np.column_stack([stacked.reshape(-1, d), np.concatenate(offsets) - stacked @ middle])


def inside(spaces: Array, points: Array, slack: float = SLACK) -> Array:
    """Whether points lie in all half-spaces, boolean (n,); infinite points and NaN do not."""
    d = spaces.shape[1] - 1
    scale = np.maximum(np.abs(spaces[:, d]), 1e-300)
    finite = np.all(np.isfinite(points), axis=1)
    values = np.where(finite[:, None], points, 0.0) @ spaces[:, :d].T + spaces[:, d]
    return np.asarray(finite & np.all(values <= slack * np.maximum(scale, 1.0), axis=1))

"""The smallest box about a cloud of points, in any attitude."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array

DIRECTIONS = 400
PREFERRED = 0.99


def oriented_box(points: Array, first: Array) -> tuple[Array, Array, Array]:
    """Attitude, sides and centre of a small box about points.

    One face of the smallest box lies on a face of the convex hull (O'Rourke, 1985, gives the edges); the hull is that of
    the extreme points in 400 fixed directions, so the box is smallest up to that coarseness. It holds all points.

    Parameters
    ----------
    points : (n, 3) array
        m.
    first : (3, 3) array
        An attitude to prefer unless another box is smaller by more than 1 %; its columns are the axes.

    Returns
    -------
    rotation : (3, 3) array
        Columns along the sides, the longest first.
    sides, centre : (3,) arrays
        m.
    """
    hull = points[_extreme(points)]
    best, volume = first, PREFERRED * float(np.prod(np.ptp(hull @ first, axis=0)))
    for normal in _normals(hull):
        turn, size = _about(hull, normal)
        if size < volume * (1.0 - 1e-9):
            best, volume = turn, size
    local = points @ best
    low, high = local.min(axis=0), local.max(axis=0)
    order = np.argsort(-np.round(high - low, 12), kind="stable")
    turn = best[:, order]
    turn[:, 2] *= np.sign(np.linalg.det(turn))
    return turn, (high - low)[order], np.asarray(best @ ((low + high) / 2.0))


def _extreme(points: Array) -> Array:
    """Indices of the points farthest out in directions spread over the sphere (Fibonacci's lattice)."""
    i = np.arange(DIRECTIONS) + 0.5
    z, turn = 1.0 - 2.0 * i / DIRECTIONS, np.pi * (1.0 + np.sqrt(5.0)) * i
    across = np.sqrt(1.0 - z**2)
    directions = np.column_stack([across * np.cos(turn), across * np.sin(turn), z])
    directions = np.vstack([directions, np.eye(3), -np.eye(3)])
    return np.unique([int(np.argmax(points @ d)) for d in directions])


def _normals(points: Array) -> Array:
    from scipy.spatial import ConvexHull, QhullError

    try:
        normals = ConvexHull(points).equations[:, :3]
    except QhullError:
        return np.zeros((0, 3))
    normals = normals * np.sign(normals[np.arange(len(normals)), np.argmax(np.abs(normals), axis=1)])[:, None]
    return np.unique(np.round(normals, 6), axis=0)


def _about(points: Array, normal: Array) -> tuple[Array, float]:
    """Smallest box with one face across a normal: rectangles along the edges of the outline."""
    normal = normal / np.linalg.norm(normal)
    second = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    second /= np.linalg.norm(second)
    plane = np.column_stack([second, np.cross(normal, second)])
    along, area = smallest_rectangle(points @ plane)
    turn = np.column_stack([plane @ along, plane @ [-along[1], along[0]], normal])
    return turn, float(area * np.ptp(points @ normal))


def smallest_rectangle(flat: Array) -> tuple[Array, float]:
    """Direction of a side and area of the smallest rectangle about (n, 2) points; a side lies on an edge of their hull."""
    from scipy.spatial import ConvexHull

    outline = flat[ConvexHull(flat).vertices]
    edge = np.roll(outline, -1, axis=0) - outline
    along = edge / np.linalg.norm(edge, axis=1)[:, None]
    across = np.column_stack([-along[:, 1], along[:, 0]])
    area = np.ptp(outline @ along.T, axis=0) * np.ptp(outline @ across.T, axis=0)
    k = int(np.argmin(np.round(area / area.min(), 9)))
    return along[k], float(area[k])

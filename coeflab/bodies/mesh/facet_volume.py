"""What the flat facets of a curved surface cut off; arrays in, arrays out.

A triangle with its corners on a surface of curvature K leaves out A/24 sum(e' K e) over its edges e: the integral of the
error of linear interpolation. K follows from the angles between facets: an edge of length L that turns by an angle t
bends each of its two triangles by t L / 2 across the edge (the normal cycle of Cohen-Steiner & Morvan, Restricted Delaunay
triangulations and normal cycle, SoCG 2003). Together: the sum over edges of t L h1 h2 / 12, where h are the heights of both
triangles over the edge. Exact for an inscribed prism to third order of t. The product of the heights, not the mean of
their squares, is a choice: a facet much wider than its neighbour is nearly flat, as on a parallel middle body. One more
than `FLATTER` times as wide is flat and has none of the bend, as the side of a box next to the first strip of its rounded
edge: the edge then counts with the square of the smaller height.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, Faces

SHARPEST = np.radians(30.0)
FLATTER = 3.0


def enclosed(corners: Array) -> float:
    """Volume within triangles of (n, 3, 3) corners that close a surface, m^3."""
    middle = corners.mean(axis=(0, 1))
    a, b, c = np.moveaxis(corners - middle, 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def facet_deficit(vertices: Array, faces: Faces) -> float:
    """Volume between facets and the smooth surface through their corners, m^3; positive where that bulges outward.

    Edges that turn by more than 30 degrees are taken for real, those of more or fewer than two faces are left out.

    Parameters
    ----------
    vertices : (n, 3) array
        m.
    faces : (m, 3) array of int
        Counter-clockwise seen from outside.
    """
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    twice = np.linalg.norm(normal, axis=1)
    one, other = _neighbours(faces, len(vertices))
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    along = vertices[end[one]] - vertices[start[one]]
    length = np.linalg.norm(along, axis=1)
    n, m = normal[one // 3], normal[other // 3]
    turn = np.arctan2(np.einsum("ij,ij->i", np.cross(n, m), along), length * np.einsum("ij,ij->i", n, m))
    lower, upper = (pick(twice[one // 3], twice[other // 3]) for pick in (np.minimum, np.maximum))
    heights = np.where(upper > FLATTER * lower, lower**2, lower * upper)
    smooth = (np.abs(turn) <= SHARPEST) & (length > 0.0)
    return float(np.sum(turn[smooth] * heights[smooth] / length[smooth]) / 12.0)


def _neighbours(faces: Faces, count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Both half-edges of every edge that two faces share."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key = np.minimum(start, end) * np.int64(count) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    sorted_key = key[order]
    same = np.concatenate([[False], sorted_key[1:] == sorted_key[:-1], [False]])
    first = np.flatnonzero(same[1:] & ~same[:-1])
    first = first[(first + 2 >= len(same)) | ~same[np.minimum(first + 2, len(same) - 1)]]
    return order[first], order[first + 1]

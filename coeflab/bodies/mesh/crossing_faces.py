"""Triangles of a mesh that cut through each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, Faces

Pairs = tuple[NDArray[np.int64], NDArray[np.int64]]
FILLED = 12
MOST_PAIRS = 8_000_000
TOUCH, SHARED = 1e-5, 1e-3


def crossing_faces(vertices: Array, faces: Faces, within: float = 0.0) -> int | None:
    """How many pairs of faces cross, or None where more than eight million pairs would have to be looked at.

    Pairs that reach no deeper than ``within`` through each other do not count: corners in single precision are off by as much.

    Two faces cross when a side of one passes through the inside of the other, or when their planes meet in a line on
    which both have a length in common: sides that meet sides, as in bodies with planes of symmetry. Faces that only
    touch, and faces that lie in one plane, do not count.
    """
    triangles = vertices[faces]
    candidates = _neighbours(triangles.min(axis=1), triangles.max(axis=1))
    if candidates is None:
        return None
    one, two = candidates
    common = sum((faces[one, i] == faces[two, j]).astype(int) for i in range(3) for j in range(3))
    one, two = one[common < 2], two[common < 2]
    for _ in range(2):
        astride = _astride(triangles[one], triangles[two])
        one, two = two[astride], one[astride]
    cut = np.zeros(len(one), dtype=bool)
    for through, by in ((one, two), (two, one)):
        for k in range(3):
            cut |= _pierced(triangles[through], triangles[by, k], triangles[by, (k + 1) % 3])
    cut[~cut] = _share_a_length(triangles[one[~cut]], triangles[two[~cut]])
    if within > 0.0 and cut.any():
        first, second = triangles[one[cut]], triangles[two[cut]]
        return int(np.sum(np.minimum(_depth(first, second), _depth(second, first)) > within))
    return int(cut.sum())


def _depth(triangle: Array, other: Array) -> Array:
    """How far the corners of one triangle reach to the side of another's plane on which they reach less, (n,)."""
    normal = np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    height = np.einsum("nij,nj->ni", other - triangle[:, :1], normal)
    return np.asarray(np.minimum(height.max(axis=1), -height.min(axis=1)))


def _astride(triangle: Array, other: Array) -> NDArray[np.bool_]:
    """Whether the other triangle has corners on both sides of the plane of the first."""
    normal = np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
    height = np.einsum("ij,ikj->ik", normal, other - triangle[:, :1])
    return np.asarray((height.min(axis=1) < 0.0) & (height.max(axis=1) > 0.0))


def _neighbours(low: Array, high: Array) -> Pairs | None:
    """Each pair of boxes that meet, once; those that share a cell of a grid are looked at."""
    size = float(np.median((high - low).max(axis=1)))
    while True:
        first = np.floor((low - low.min(axis=0)) / size).astype(np.int64)
        span = np.floor((high - low.min(axis=0)) / size).astype(np.int64) - first + 1
        filled = span.prod(axis=1)
        if float(filled.astype(float).sum()) <= FILLED * len(low):
            break
        size *= 1.5
    face = np.repeat(np.arange(len(low)), filled)
    within = np.arange(len(face)) - np.repeat(np.cumsum(filled) - filled, filled)
    ny, nz = span[face, 1], span[face, 2]
    cell = first[face] + np.column_stack([within // (ny * nz), within // nz % ny, within % nz])
    grid = cell.max(axis=0) + 1
    key = (cell[:, 0] * grid[1] + cell[:, 1]) * grid[2] + cell[:, 2]
    order = np.argsort(key, kind="stable")
    key, face = key[order], face[order]
    begins = np.flatnonzero(np.r_[True, key[1:] != key[:-1]])
    ends = np.r_[begins[1:], len(key)]
    after = np.repeat(ends, ends - begins) - np.arange(len(key)) - 1
    if int(after.sum()) > MOST_PAIRS:
        return None
    left = np.repeat(np.arange(len(key)), after)
    right = left + 1 + np.arange(len(left)) - np.repeat(np.cumsum(after) - after, after)
    a, b = face[left], face[right]
    for k in range(3):
        meet = (low[a, k] <= high[b, k]) & (low[b, k] <= high[a, k])
        a, b = a[meet], b[meet]
    a, b = np.minimum(a, b), np.maximum(a, b)
    pair = np.unique(a * len(low) + b)
    return pair // len(low), pair % len(low)


def _pierced(triangle: Array, start: Array, end: Array) -> NDArray[np.bool_]:
    """Whether segments pass through the inside of triangles; by signs of volumes; below 1e-5 of the cube is touching."""
    a, b, c = triangle[:, 0], triangle[:, 1], triangle[:, 2]
    scale = np.max(np.ptp(np.concatenate([triangle, start[:, None], end[:, None]], axis=1), axis=1), axis=1)
    least = TOUCH * scale**3

    def volume(p: Array, q: Array, r: Array, s: Array) -> Array:
        return np.asarray(np.einsum("ij,ij->i", np.cross(q - p, r - p), s - p))

    before, past = volume(a, b, c, start), volume(a, b, c, end)
    through = ((before > least) & (past < -least)) | ((before < -least) & (past > least))
    inside = [volume(start, end, p, q) for p, q in ((a, b), (b, c), (c, a))]
    same = np.all([v > least for v in inside], axis=0) | np.all([v < -least for v in inside], axis=0)
    return np.asarray(through & same)


def _share_a_length(one: Array, two: Array) -> NDArray[np.bool_]:
    """Whether both triangles cover a common length of the line in which their planes meet.

    Moller, A fast triangle-triangle intersection test, J. Graphics Tools 2, 1997. Corners closer to the other's plane
    than touching do not count as beyond it.
    """
    both = np.concatenate([one, two], axis=1)
    scale = np.max(np.ptp(both, axis=1), axis=1, initial=0.0)
    first, second = (np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]) for t in (one, two))
    line = np.cross(first, second)
    length = np.linalg.norm(line, axis=1)
    line = line / np.where(length > 0.0, length, 1.0)[:, None]
    low, high, beyond = [], [], length > 0.0
    for triangle, other, normal in ((one, two, second), (two, one, first)):
        height = np.einsum("ij,ikj->ik", normal, triangle - other[:, :1])
        least = TOUCH * scale**3
        beyond &= (height.min(axis=1) < -least) & (height.max(axis=1) > least)
        along = np.einsum("ij,ikj->ik", line, triangle - both[:, :1])
        ends = [_where_zero(height, along, k, (k + 1) % 3) for k in range(3)]
        low.append(np.nanmin(ends, axis=0, initial=np.inf))
        high.append(np.nanmax(ends, axis=0, initial=-np.inf))
    common = np.minimum(*high) - np.maximum(*low)
    return np.asarray(beyond & (common > SHARED * scale))


def _where_zero(height: Array, along: Array, i: int, j: int) -> Array:
    """Where on the line the side from corner i to j passes through the plane; NaN where it does not."""
    apart = height[:, i] - height[:, j]
    passes = (height[:, i] * height[:, j] <= 0.0) & (apart != 0.0)
    share = height[:, i] / np.where(passes, apart, 1.0)
    return np.where(passes, along[:, i] + share * (along[:, j] - along[:, i]), np.nan)

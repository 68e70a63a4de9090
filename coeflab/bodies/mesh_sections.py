"""Sections of a closed mesh by planes x = const; arrays in, arrays out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.integrals import corner_range
from coeflab.core.types import Array, Faces

Contour = Array


def contours(vertices: Array, faces: Faces, x: Array) -> list[list[Contour]]:
    """Closed contours of the sections at stations ``x``, all cut at once.

    Each is (n, 2), y and z, with the body to its left where y points right and z up: its area is positive, and that of
    a hole negative. A vertex in the plane of a station counts as lying aft of it, so that no case is special.

    Raises
    ------
    ValueError
        The mesh is open where a plane cuts it.
    """
    order = np.argsort(x)
    rank = np.searchsorted(x[order], vertices[:, 0], side="left")
    corner = rank[faces]
    low, high = corner_range(corner)
    hit = np.flatnonzero(high > low)
    face = np.repeat(hit, (high - low)[hit])
    first = np.cumsum((high - low)[hit]) - (high - low)[hit]
    station = np.arange(len(face)) - np.repeat(first - low[hit], (high - low)[hit])
    ahead = corner[face] > station[:, None]
    lone_ahead = ahead[:, 0].astype(np.int64) + ahead[:, 1] + ahead[:, 2] == 1
    alone = ahead == lone_ahead[:, None]
    lone = alone[:, 1] + 2 * alone[:, 2]
    own = faces[face]
    rows = np.arange(len(face))
    i, j, k = (own[rows, (lone + turn) % 3] for turn in range(3))
    begin = np.where(lone_ahead, j, k)
    finish = np.where(lone_ahead, k, j)
    start, end = (_edge(i, other, len(vertices), station, len(x)) for other in (begin, finish))
    sort = np.argsort(start)
    place = np.minimum(np.searchsorted(start[sort], end), len(start) - 1)
    follower = sort[place] if len(start) else place
    if np.any(start[follower] != end):
        raise ValueError("an open mesh")
    points = _crossing(vertices, np.minimum(i, begin), np.maximum(i, begin), x[order][station])
    out: list[list[Contour]] = [[] for _ in x]
    for cycle in _cycles(follower):
        out[int(order[station[cycle[0]]])].append(points[cycle])
    return out


def _edge(a: NDArray[np.int64], b: NDArray[np.int64], count: int, station: NDArray[np.int64], stops: int) -> Faces:
    return np.asarray((np.minimum(a, b) * count + np.maximum(a, b)) * stops + station)


def _crossing(vertices: Array, one: NDArray[np.int64], two: NDArray[np.int64], x: Array) -> Array:
    a, b = vertices[one], vertices[two]
    share = (x - a[:, 0]) / (b[:, 0] - a[:, 0])
    return np.asarray(a[:, 1:] + share[:, None] * (b[:, 1:] - a[:, 1:]))


def _cycles(follower: NDArray[np.int64]) -> list[list[int]]:
    """The cycles of a permutation."""
    following = follower.tolist()
    seen = bytearray(len(following))
    out = []
    for first in range(len(following)):
        if seen[first]:
            continue
        cycle, at = [], first
        while not seen[at]:
            seen[at] = 1
            cycle.append(at)
            at = following[at]
        out.append(cycle)
    return out

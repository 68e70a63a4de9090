"""Fewer triangles for a closed surface, which stays closed, near where it was, and of well-shaped triangles.

Edges collapse, cheapest first, many at a time where they do not touch each other. Source of the cost: Garland & Heckbert,
Surface simplification using quadric error metrics, SIGGRAPH 1997, with the quadrics of the present surface; the length of
the edge is added, so that flat regions thin out evenly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, Faces, brief

Index = NDArray[np.int64]
Lots = NDArray[np.uint64]
LENGTH, PULL = 1e-2, 1e-3
SHARE, FEWEST = 0.12, 512
TURN, NEEDLE = 0.5, 1e-6
SHAPE, STRETCHED, YIELD, SLIVER = 0.3, 0.6, 0.5, 0.05
SIX, DIAGONAL = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)), [0, 3, 5]
THOUSAND, NEAR = 2.0**10, 1.0 + 1e-9
# No round number: coordinates of CAD must not lie midway between two places.
PLACE = 1.2345e-7
FAR = np.iinfo(np.int64).max


def is_closed(faces: Faces) -> bool:
    """Whether every edge is run exactly once each way."""
    most = int(faces.max()) + 1
    there = np.sort((faces * most + np.roll(faces, -1, axis=1)).ravel())
    back = np.sort((np.roll(faces, -1, axis=1) * most + faces).ravel())
    return bool(np.all(there[1:] != there[:-1]) and np.array_equal(there, back))


def decimated(vertices: Array, faces: Faces, target: int) -> tuple[Array, Faces]:
    """A surface of about ``target`` triangles, more where none can go without a fold, a sliver or a hole.

    Parameters
    ----------
    vertices : (n, 3) array
        m.
    faces : (m, 3) array of int
        A closed surface; see `is_closed`.
    target : int
    """
    middle, share = vertices.mean(axis=0), SHARE
    vertices = vertices - middle
    names = _names(vertices)
    while len(faces) > target:
        edges = _cheapest(vertices, faces, names, share)
        chosen = _apart(_sound(edges, vertices, faces), len(vertices))[: (len(faces) - target + 1) // 2]
        if not len(chosen.ends):
            if share == 1.0:
                break
            share = 1.0
            continue
        share = SHARE
        vertices, faces, names = _collapsed(chosen, vertices, faces, names)
    return vertices + middle, faces


@brief
@dataclass(frozen=True, slots=True)
class _Edges:
    """Edges, cheapest first: end vertices, where they collapse to, and the rings of vertices about both ends."""

    ends: Index
    to: Array
    lot: Lots
    ring: Index
    start: Index

    def __getitem__(self, selected: slice | NDArray[np.bool_]) -> _Edges:
        return _Edges(self.ends[selected], self.to[selected], self.lot[selected], self.ring, self.start)


def _cheapest(vertices: Array, faces: Faces, names: Lots, share: float) -> tuple[Index, Array, Lots]:
    """The share of the edges that cost least, cheapest first, the point where each collapses to, and its lot.

    All planes about a vertex pass through it: their quadric there is (x - u)' A (x - u) with A the sum of area n n', and
    nothing cancels. Costs within a thousandth are equal and go by lot, so that rounding, which differs from machine to
    machine, hardly ever decides.
    """
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]) / 2.0
    area = np.sqrt(_dot(normal, normal))
    across = normal / np.sqrt(np.maximum(area, np.finfo(float).tiny))[:, None]
    at = faces.ravel()
    tensor = np.stack(
        [np.bincount(at, np.repeat(across[:, i] * across[:, j], 3), len(vertices)) for i, j in SIX], axis=1
    )
    weights = np.bincount(at, np.repeat(area, 3), len(vertices))
    run = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends = run[run[:, 0] < run[:, 1]]
    u, v = vertices[ends[:, 0]], vertices[ends[:, 1]]
    one, other = tensor[ends[:, 0]], tensor[ends[:, 1]]
    weight = np.maximum(weights[ends[:, 0]] + weights[ends[:, 1]], np.finfo(float).tiny)
    half = (v - u) / 2.0
    left = one + other
    left[:, DIAGONAL] += PULL * weight[:, None]
    moved = _solved(left, _times(other - one, half))
    flat = _dot(moved + half, _times(one, moved + half)) + _dot(moved - half, _times(other, moved - half))
    cost = flat + LENGTH * weight * (_dot(moved, moved) + _dot(half, half))
    count = min(len(ends), max(FEWEST, int(share * len(ends))))
    lot = _lots(names[ends])
    order = np.lexsort((lot, _rounded(cost)))[:count]
    return ends[order], ((u + v) / 2.0 + moved)[order], lot[order]


def _rounded(cost: Array) -> Array:
    """Positive numbers to a thousandth."""
    mantissa, power = np.frexp(cost)
    return np.asarray(np.ldexp(np.round(mantissa * THOUSAND), power))


def _names(vertices: Array) -> Lots:
    """A number for each vertex by its place alone, whatever the order of the list."""
    size = max(float(np.max(np.abs(vertices))), np.finfo(float).tiny)
    place = np.round(vertices / size / PLACE).astype(np.int64).astype(np.uint64)
    out = np.zeros(len(vertices), dtype=np.uint64)
    for along in place.T:
        out = _mixed(out + along)
    return out


def _lots(names: Lots) -> Lots:
    """A number for each edge by the names of its two ends alone, as if drawn.

    Edges of equal cost stand in rows on a structured mesh, where the first of each neighbourhood would be few; and a
    change in one place leaves the lots of all others as they are.
    """
    low, high = np.sort(names, axis=1).T
    return _mixed(_mixed(low) + high)


def _mixed(number: Lots) -> Lots:
    """SplitMix64 (Steele, Lea & Flood 2014)."""
    number = number + np.uint64(0x9E3779B97F4A7C15)
    number = (number ^ number >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    number = (number ^ number >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return number ^ number >> np.uint64(31)


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])


def _times(tensor: Array, x: Array) -> Array:
    """Symmetric tensors, six numbers each, on vectors."""
    a, b, c, d, e, f = tensor.T
    return np.stack([_dot(np.stack(row, axis=1), x) for row in ((a, b, c), (b, d, e), (c, e, f))], axis=1)


def _solved(tensor: Array, right: Array) -> Array:
    """Solutions for positive definite tensors, by factors L D L'."""
    a, b, c, d, e, f = tensor.T
    p, q = b / a, c / a
    second = d - p * b
    r = (e - p * c) / second
    third = f - q * c - r * r * second
    x = right[:, 0]
    y = right[:, 1] - p * x
    z = (right[:, 2] - q * x - r * y) / third
    y = y / second - r * z
    return np.stack([x / a - p * y - q * z, y, z], axis=1)


def _spread(lengths: Index) -> tuple[Index, Index]:
    """Which group an item is of, and its place in it, for groups of these lengths."""
    group = np.repeat(np.arange(len(lengths)), lengths)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(lengths) - lengths, lengths)


def _shape(corner: Array) -> tuple[Array, Array]:
    """Normals, and how near triangles are to equilateral: 1 at best, 0 without area."""
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    runs = corner - np.roll(corner, 1, axis=1)
    sides = _dot(runs[:, 0], runs[:, 0]) + _dot(runs[:, 1], runs[:, 1]) + _dot(runs[:, 2], runs[:, 2])
    length = np.sqrt(_dot(normal, normal))
    return normal, 2.0 * np.sqrt(3.0) * length / np.maximum(sides, np.finfo(float).tiny)


def _least_shape(was: Array, start: Index, group: Index) -> Array:
    """What a collapse may leave of shapes that were like this: no sliver, nor worse than the worst of its ring was.

    Where a whole ring is stretched, as on a scaled sphere, nothing could go unless some get worse for a while: there down
    to half of the worst.
    """
    worst = np.minimum.reduceat(was, start)
    stretched = np.maximum.reduceat(was, start) < STRETCHED
    eased = np.maximum(YIELD * worst, np.minimum(SLIVER, worst))
    return np.asarray(np.minimum(SHAPE, np.where(stretched, eased, worst))[group])


def _sound(edges: tuple[Index, Array, Lots], vertices: Array, faces: Faces) -> _Edges:
    """Those edges whose collapse leaves a surface: no hole, no fold, and no sliver worse than there was."""
    ends, to, lot = edges
    order = np.argsort(faces.ravel(), kind="stable")
    valence = np.bincount(faces.ravel(), minlength=len(vertices))
    first = np.cumsum(valence) - valence
    group, place = _spread(valence[ends].sum(axis=1))
    second = place >= valence[ends[group, 0]]
    at = np.where(second, ends[group, 1], ends[group, 0])
    slot = order[first[at] + place - np.where(second, valence[ends[group, 0]], 0)]
    face, turn = slot // 3, slot % 3
    ring = faces[face, (turn + 1) % 3]
    keys = np.sort(group * len(vertices) + ring)
    shared = np.bincount(keys[1:][keys[1:] == keys[:-1]] // len(vertices), minlength=len(ends))
    other = np.where(second, ends[group, 0], ends[group, 1])
    stays = ~np.any(faces[face] == other[:, None], axis=1)
    before = vertices[faces[face]]
    after = before.copy()
    after[np.arange(len(face)), turn] = to[group]
    (old, was), (new, now) = _shape(before), _shape(after)
    start = np.concatenate([[0], np.flatnonzero(np.diff(group)) + 1])
    folded = _dot(old, new) * NEAR < TURN * np.sqrt(_dot(old, old) * _dot(new, new))
    bad = stays & ((folded & (was > NEEDLE)) | (now * NEAR < _least_shape(was, start, group)))
    fine = (shared == 2) & (valence[ends].sum(axis=1) > 6) & ~np.logical_or.reduceat(bad, start)
    selected = fine[group]
    lengths = np.bincount(group, minlength=len(ends))[fine]
    return _Edges(ends[fine], to[fine], lot[fine], ring[selected], np.cumsum(lengths) - lengths)


def _apart(edges: _Edges, count: int) -> _Edges:
    """Edges of which none reaches into the ring of another; where several would, the least lot."""
    if not len(edges.ends):
        return edges
    rank = np.empty(len(edges.ends), dtype=np.int64)
    rank[np.argsort(edges.lot, kind="stable")] = np.arange(len(rank))
    best = np.full(count, FAR)
    np.minimum.at(best, edges.ends[:, 0], rank)
    np.minimum.at(best, edges.ends[:, 1], rank)
    return edges[np.minimum.reduceat(best[edges.ring], edges.start) >= rank]


def _collapsed(edges: _Edges, vertices: Array, faces: Faces, names: Lots) -> tuple[Array, Faces, Lots]:
    vertices, names = vertices.copy(), names.copy()
    vertices[edges.ends[:, 0]] = edges.to
    names[edges.ends[:, 0]] = edges.lot
    goes = np.arange(len(vertices))
    goes[edges.ends[:, 1]] = edges.ends[:, 0]
    faces = goes[faces]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    used, place = np.unique(faces[whole], return_inverse=True)
    return vertices[used], place.reshape(-1, 3), _mixed(names[used])

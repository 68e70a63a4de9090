"""Fewer triangles for a closed surface, which stays closed, near where it was, and of well-shaped triangles.

Edges collapse, cheapest first, many at a time where they do not touch each other. Source of the cost: Garland & Heckbert,
Surface simplification using quadric error metrics, SIGGRAPH 1997, with the quadrics of the present surface; the length of
the edge is added, so that flat regions thin out evenly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.least_squares import Array
from coeflab.kernels.surface_mesh import Faces

Index = NDArray[np.int64]
LENGTH, PULL = 1e-2, 1e-3
SHARE, FEWEST = 0.12, 512
TURN, SHAPE = 0.5, 0.3
LOT = 1997
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
    while len(faces) > target:
        edges = _cheapest(vertices, faces, share)
        chosen = _apart(_sound(edges, vertices, faces), len(vertices))[: (len(faces) - target + 1) // 2]
        if not len(chosen.ends):
            if share == 1.0:
                break
            share = 1.0
            continue
        share = SHARE
        vertices, faces = _collapsed(chosen, vertices, faces)
    return vertices + middle, faces


@dataclass(frozen=True, slots=True)
class _Edges:
    """Edges, cheapest first: end vertices, where they collapse to, and the rings of vertices about both ends."""

    ends: Index
    to: Array
    ring: Index
    start: Index

    def __getitem__(self, kept: slice | NDArray[np.bool_]) -> _Edges:
        return _Edges(self.ends[kept], self.to[kept], self.ring, self.start)


def _cheapest(vertices: Array, faces: Faces, share: float) -> tuple[Index, Array]:
    """The share of the edges that cost least, cheapest first, and the point where each collapses to."""
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]) / 2.0
    area = np.linalg.norm(normal, axis=1)
    unit = normal / np.maximum(area, np.finfo(float).tiny)[:, None]
    offset = -np.einsum("ij,ij->i", unit, corner[:, 0])
    plane = np.column_stack([unit, offset])
    products = np.column_stack([(area[:, None, None] * plane[:, :, None] * plane[:, None, :]).reshape(-1, 16), area])
    at = faces.ravel()
    quadric = np.stack([np.bincount(at, np.repeat(p, 3), len(vertices)) for p in products.T], axis=1)
    run = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends = run[run[:, 0] < run[:, 1]]
    u, v = vertices[ends[:, 0]], vertices[ends[:, 1]]
    both = quadric[ends[:, 0]] + quadric[ends[:, 1]]
    q, weight = both[:, :16].reshape(-1, 4, 4), np.maximum(both[:, 16], np.finfo(float).tiny)
    mid = (u + v) / 2.0
    pull = PULL * weight[:, None]
    left = q[:, :3, :3] + pull[:, :, None] * np.eye(3)
    to = np.linalg.solve(left, (pull * mid - q[:, :3, 3])[:, :, None])[:, :, 0]
    flat = np.einsum("ki,kij,kj->k", to, q[:, :3, :3], to) + 2.0 * np.einsum("ki,ki->k", q[:, :3, 3], to) + q[:, 3, 3]
    cost = flat + LENGTH * weight * (np.sum((to - mid) ** 2, axis=1) + np.sum((u - v) ** 2, axis=1) / 4.0)
    count = min(len(ends), max(FEWEST, int(share * len(ends))))
    order = np.argsort(cost, kind="stable")[:count]
    return ends[order], to[order]


def _spread(lengths: Index) -> tuple[Index, Index]:
    """Which group an item is of, and its place in it, for groups of these lengths."""
    group = np.repeat(np.arange(len(lengths)), lengths)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(lengths) - lengths, lengths)


def _shape(corner: Array) -> tuple[Array, Array]:
    """Normals, and how near triangles are to equilateral: 1 at best, 0 without area."""
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    sides = np.sum((corner - np.roll(corner, 1, axis=1)) ** 2, axis=(1, 2))
    length = np.linalg.norm(normal, axis=1)
    return normal, 2.0 * np.sqrt(3.0) * length / np.maximum(sides, np.finfo(float).tiny)


def _sound(edges: tuple[Index, Array], vertices: Array, faces: Faces) -> _Edges:
    """Those edges whose collapse leaves a surface: no hole, no fold, and no sliver worse than there was."""
    ends, to = edges
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
    worst = np.minimum.reduceat(was, start)[group]
    folded = np.einsum("ij,ij->i", old, new) < TURN * np.linalg.norm(old, axis=1) * np.linalg.norm(new, axis=1)
    bad = stays & ((folded & (was > SHAPE / 10.0)) | (now < np.minimum(SHAPE, worst)))
    fine = (shared == 2) & (valence[ends].sum(axis=1) > 6) & ~np.logical_or.reduceat(bad, start)
    kept = fine[group]
    lengths = np.bincount(group, minlength=len(ends))[fine]
    return _Edges(ends[fine], to[fine], ring[kept], np.cumsum(lengths) - lengths)


def _apart(edges: _Edges, count: int) -> _Edges:
    """Edges of which none reaches into the ring of another.

    Drawn by lot, always the same: equal costs stand in rows on a structured mesh, where the cheapest of each
    neighbourhood would be few.
    """
    if not len(edges.ends):
        return edges
    rank = np.random.default_rng(LOT).permutation(len(edges.ends))
    best = np.full(count, FAR)
    np.minimum.at(best, edges.ends[:, 0], rank)
    np.minimum.at(best, edges.ends[:, 1], rank)
    return edges[np.minimum.reduceat(best[edges.ring], edges.start) >= rank]


def _collapsed(edges: _Edges, vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    vertices = vertices.copy()
    vertices[edges.ends[:, 0]] = edges.to
    goes = np.arange(len(vertices))
    goes[edges.ends[:, 1]] = edges.ends[:, 0]
    faces = goes[faces]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    used, place = np.unique(faces[whole], return_inverse=True)
    return vertices[used], place.reshape(-1, 3)

"""A solid parted into what was united, along the sharp inward edges that seams leave."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.mesh.solids import Solid, solid, surface
from coeflab.core.types import Array, Faces

CREASE = np.radians(35.0)


def patches(body: Solid) -> list[Solid]:
    """The bodies that were united into a solid, where sharp inward edges still show all of their seams.

    The surface is parted along edges whose faces meet inward by more than 35 degrees. Each part of it that loops of such
    edges bound is closed by fans from the middles of its loops, so that neighbours share them and the bodies fill the
    solid. The solid itself where it has no such part or one cannot be closed.

    Notes
    -----
    Seams of bodies united without fillet are such edges (the minima rule: Hoffman & Richards, Cognition 18, 1984).
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    vertices, faces = surface(body)
    one, other, turn = dihedral(vertices, faces)
    joined = turn > -CREASE
    count = len(faces)
    links = coo_array((np.ones(joined.sum()), (one[joined] // 3, other[joined] // 3)), shape=(count, count))
    parts, which = connected_components(links, directed=False)
    if parts == 1:
        return [body]
    out = []
    seam = which[one // 3] != which[other // 3]
    rim = np.concatenate([one[seam], other[seam]])
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    for k in range(parts):
        own = rim[which[rim // 3] == k]
        points, corners = _capped(vertices, faces[which == k], start[own], end[own])
        try:
            result = solid(points, corners)
        except ValueError:
            return [body]
        if not result.volume() > 0.0:
            return [body]
        out.append(result)
    return sorted(out, key=lambda p: -p.volume())


def dihedral(vertices: Array, faces: Faces) -> tuple[Faces, Faces, Array]:
    """Both half-edges of every edge, and the angle by which the surface turns there, rad; negative inward."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    order = np.lexsort([start > end, np.maximum(start, end), np.minimum(start, end)])
    one, other = order[0::2], order[1::2]
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    along = vertices[end[one]] - vertices[start[one]]
    n, m = normal[one // 3], normal[other // 3]
    sine = np.einsum("ij,ij->i", np.cross(n, m), along)
    return one, other, np.arctan2(sine, np.linalg.norm(along, axis=1) * np.einsum("ij,ij->i", n, m))


def _capped(vertices: Array, faces: Faces, start: Faces, end: Faces) -> tuple[Array, Faces]:
    """A patch with a fan over each loop of its rim."""
    after: dict[int, list[int]] = {}
    for a, b in zip(start.tolist(), end.tolist(), strict=True):
        after.setdefault(a, []).append(b)
    points, fans = [vertices], [faces]
    while after:
        first = next(iter(after))
        loop, here = [first], first
        while here in after:
            there = after[here].pop()
            if not after[here]:
                del after[here]
            here = there
            if here == first:
                break
            loop.append(here)
        middle = sum(len(p) for p in points)
        ring = np.array(loop)
        points.append(vertices[ring].mean(axis=0)[None])
        fans.append(np.column_stack([np.roll(ring, -1), ring, np.full(len(ring), middle)]))
    return np.concatenate(points), np.concatenate(fans)

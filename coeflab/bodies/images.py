"""Whether a mirror or a turn leaves a body as it is, surface for surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.pieces import mesh_piece
from coeflab.core.errors import InputError
from coeflab.core.types import Array

if TYPE_CHECKING:
    from coeflab.bodies.body import Body

SAME = 1e-6  # of a piece's size: its image in a mirror is the same piece
SPACING, NEAR = 1.0 / 200.0, 0.75  # points on a mesh file's surface, over its size; how near its image is, over that
PANELS = 4000  # of a piece that is made from equations
MIRRORS = tuple(np.diag(signs) for signs in ([-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]))
QUARTER = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def is_fourfold(body: Body, point: Array) -> bool | None:
    """Whether a quarter of a turn about x through a point leaves a body as it is; None of one without a closed surface.

    Parameters
    ----------
    body : Body
    point : (3,) array
        m, FRD, from the body's datum.
    """
    shape = body.shape if body.mesh is None else body.mesh.read()[0]
    pieces = (
        body.pieces if body.mesh is None or not isinstance(shape, TriangleMesh) else (mesh_piece(shape, body.mesh),)
    )
    try:
        surfaces = [piece.surface(PANELS) for piece in pieces]
    except InputError:
        surfaces = []
    return (
        same(surfaces, point, QUARTER, isinstance(shape, TriangleMesh) and shape.remade is None) if surfaces else None
    )


def same(surfaces: list[TriangleMesh], origin: Array, turn: Array, from_file: bool) -> bool:
    """Whether a mirror or a turn through the origin leaves the pieces as they are, one for another."""
    about = [TriangleMesh(s.vertices - origin, s.faces) for s in surfaces]
    return all(any(_like(s, other, turn, from_file) for other in about) for s in about)


def _like(one: TriangleMesh, other: TriangleMesh, turn: Array, from_file: bool) -> bool:
    """Whether one surface, turned, is the other: every corner on a corner; of a mesh file, near its surface."""
    from scipy.spatial import cKDTree

    image, size = one.vertices @ turn.T, float(np.ptp(one.vertices, axis=0).max())
    low, high = (
        np.abs(image.min(axis=0) - other.vertices.min(axis=0)),
        np.abs(image.max(axis=0) - other.vertices.max(axis=0)),
    )
    within = NEAR * SPACING if from_file else SAME
    if max(low.max(), high.max()) > within * size:
        return False
    points = _sampled(other, SPACING * size) if from_file else other.vertices
    return bool(cKDTree(points).query(image, distance_upper_bound=within * size)[0].max() <= within * size)


def _sampled(mesh: TriangleMesh, apart: float) -> Array:
    """Points on a surface, no more than so far apart along each triangle's longest edge and across it, m."""
    corners = mesh.vertices[mesh.faces]
    edge = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    first = np.argmax(edge, axis=1)[:, None]
    a, b, c = (np.take_along_axis(corners, ((first + k) % 3)[:, :, None], axis=1)[:, 0] for k in range(3))
    longest = edge.max(axis=1)
    height = np.linalg.norm(np.cross(b - a, c - a), axis=1) / longest
    parts = np.maximum(np.ceil(np.stack([longest, height], axis=1) / apart), 1).astype(int)
    out = []
    for n, m in np.unique(parts, axis=0):
        own = np.all(parts == (n, m), axis=1)
        along, up = (g.ravel() for g in np.meshgrid(np.arange(n + 1) / n, np.arange(m + 1) / m))
        weight = np.stack([(1.0 - up) * (1.0 - along), (1.0 - up) * along, up], axis=1)
        out.append(np.einsum("pk,ktx->tpx", weight, np.stack([a[own], b[own], c[own]])).reshape(-1, 3))
    return np.concatenate(out)

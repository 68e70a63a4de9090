"""A triangulated closed surface as a body's shape.

Integrals over a closed triangulated surface, and what keeps it from being closed; arrays in, arrays out.

Vertices are (n, 3), m; faces are (m, 3) indices, counter-clockwise seen from outside.

What the flat facets of a curved surface cut off; arrays in, arrays out.

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

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.core.types import Array, Faces, brief, locked

BLOCK = 65536
ROUNDING = 1e-12  # of the longest side


@brief
@dataclass(frozen=True, slots=True)
class MeshIntegrals:
    """What a closed surface encloses.

    Attributes
    ----------
    volume : float
        m^3; negative when the faces look inward.
    centre : (3,) array
        Centre of the volume, m; NaN when nothing is enclosed.
    second_moments : (3, 3) array
        Integral of d d^T over the volume, d from that centre, m^5.
    area : float
        m^2.
    projected : (3,) array
        Half the area projected along x, y, z, m^2: the shadow, where each line of sight crosses the surface twice.
    """

    volume: float
    centre: Array
    second_moments: Array
    area: float
    projected: Array


def mesh_integrals(vertices: Array, faces: Faces) -> MeshIntegrals:
    """Integrals by the divergence theorem, face by face, exact for the faceted body.

    A coordinate of the centre below `ROUNDING` of the longest side is rounding and counts as zero.

    Source: Eberly, Polyhedral Mass Properties (2002), in vector form: tetrahedra from a common point to the faces.
    """
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    origin = (low + high) / 2.0
    points = np.ascontiguousarray((vertices - origin).T)
    volume, area = 0.0, 0.0
    first, projected = np.zeros(3), np.zeros(3)
    second = np.zeros((3, 3))
    for start in range(0, len(faces), BLOCK):
        a, b, c = (np.take(points, corner, axis=1) for corner in faces[start : start + BLOCK].T)
        normal = _cross(b - a, c - a)
        sixth = np.einsum("ij,ij->j", a, normal) / 6.0
        total = a + b + c
        volume += float(sixth.sum())
        area += float(np.sqrt(np.einsum("ij,ij->j", normal, normal)).sum()) / 2.0
        projected += np.abs(normal).sum(axis=1) / 4.0
        first += total @ sixth / 4.0
        second += sum((p * sixth) @ p.T for p in (a, b, c, total)) / 20.0
    if volume == 0.0:
        return MeshIntegrals(0.0, np.full(3, np.nan), np.zeros((3, 3)), area, projected)
    offset = first / volume
    centre = origin + offset
    centre[np.abs(centre) < ROUNDING * float(np.max(high - low))] = 0.0
    return MeshIntegrals(volume, centre, second - volume * np.outer(offset, offset), area, projected)


def corner_range(values: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Least and largest of the three corners of each face, from (m, 3); by columns, which is quicker than along rows."""
    a, b, c = values.T
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def _cross(a: Array, b: Array) -> Array:
    """Vector products of (3, n) arrays; numpy's own is slower along the short axis."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@brief
@dataclass(frozen=True, slots=True, eq=False)
class TriangleMesh:
    """A closed surface of triangles that look outward.

    Attributes
    ----------
    vertices : (n, 3) array
        m, FRD, from the datum.
    faces : (m, 3) array of int
        Counter-clockwise seen from outside.
    exact_volume : float, optional
        Of the body that the mesh stands for, m^3, where that is known.
    remade : callable, optional
        Meshes that body anew from its equations, with about so many faces; None where the mesh is all that is known.
    sheets : (k, 3) array of int, optional
        Faces of plates and walls without thickness, with water on both sides; they enclose nothing.
    integrals : MeshIntegrals
        Volume, centre, second moments, area and projected areas of the facets.

    Raises
    ------
    InputError
        No faces, an index without its vertex, or nothing enclosed though there are faces beside sheets.
    """

    vertices: Array
    faces: NDArray[np.int64]
    exact_volume: float | None = None
    remade: Callable[[int], TriangleMesh] | None = None
    sheets: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int64))
    integrals: MeshIntegrals = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", locked(self.vertices))
        object.__setattr__(self, "faces", locked(self.faces, np.int64))
        object.__setattr__(self, "sheets", locked(self.sheets, np.int64))
        faces = self.faces
        if not len(faces) and len(self.sheets):
            corner = self.vertices[self.sheets]
            twice = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
            centre = twice @ corner.mean(axis=1) / twice.sum()
            both = mesh_integrals(self.vertices, self.sheets)
            object.__setattr__(
                self, "integrals", MeshIntegrals(0.0, centre, np.zeros((3, 3)), 2.0 * both.area, 2.0 * both.projected)
            )
            return
        if not len(faces):
            raise InputError("a mesh without faces", "triangles of a closed surface")
        if faces.min() < 0 or faces.max() >= len(self.vertices):
            raise InputError("a face whose vertex does not exist", f"indices from 0 to {len(self.vertices) - 1}")
        object.__setattr__(self, "integrals", mesh_integrals(self.vertices, faces))
        if not self.integrals.volume > 0.0:
            raise input_error("mesh.mesh_encloses", volume=self.integrals.volume)

    @property
    def volume(self) -> float:
        """m^3."""
        return self.integrals.volume

    @property
    def discretisation_error(self) -> float | None:
        """Volume of the facets over that of the body they stand for, minus one; None where that is not known."""
        return None if self.exact_volume is None else self.volume / self.exact_volume - 1.0

    @property
    def centre_of_volume(self) -> Array:
        """(3,) array, m, FRD, from the datum."""
        return self.integrals.centre

    @property
    def extents(self) -> Array:
        """(3,) size along x, y, z, m."""
        return np.asarray(np.ptp(self.vertices, axis=0))

    @property
    def length(self) -> float:
        """Along x, m."""
        return float(self.extents[0])

    @property
    def breadth_over_depth(self) -> float:
        """Root of the ratio of the second moments of volume along y and along z; b/c of an ellipsoid exactly."""
        return float(np.sqrt(self.integrals.second_moments[1, 1] / self.integrals.second_moments[2, 2]))


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

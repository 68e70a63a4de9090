"""Integrals over a closed triangulated surface, and what keeps it from being closed; arrays in, arrays out.

Vertices are (n, 3), m; faces are (m, 3) indices, counter-clockwise seen from outside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, Faces, brief

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

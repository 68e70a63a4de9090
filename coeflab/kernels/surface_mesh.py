"""Integrals over a closed triangulated surface, and what keeps it from being closed; arrays in, arrays out.

Vertices are (n, 3), m; faces are (m, 3) indices, counter-clockwise seen from outside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.least_squares import Array

Faces = NDArray[np.int64]
BLOCK = 65536


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

    Source: Eberly, Polyhedral Mass Properties (2002), in vector form: tetrahedra from a common point to the faces.
    """
    origin = (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0
    volume, area = 0.0, 0.0
    first, projected = np.zeros(3), np.zeros(3)
    second = np.zeros((3, 3))
    for start in range(0, len(faces), BLOCK):
        a, b, c = (vertices[faces[start : start + BLOCK, k]] - origin for k in range(3))
        normal = np.cross(b - a, c - a) / 2.0
        sixth = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
        total = a + b + c
        volume += float(sixth.sum())
        area += float(np.linalg.norm(normal, axis=1).sum())
        projected += np.abs(normal).sum(axis=0) / 2.0
        first += sixth @ total / 4.0
        weighted = sixth[:, None]
        second += (
            (a * weighted).T @ a + (b * weighted).T @ b + (c * weighted).T @ c + (total * weighted).T @ total
        ) / 20.0
    if volume == 0.0:
        return MeshIntegrals(0.0, np.full(3, np.nan), np.zeros((3, 3)), area, projected)
    offset = first / volume
    return MeshIntegrals(volume, origin + offset, second - volume * np.outer(offset, offset), area, projected)

"""A triangulated closed surface as a body's shape."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.integrals import MeshIntegrals, mesh_integrals
from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locked


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

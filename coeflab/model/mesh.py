"""A triangulated closed surface as a body's shape."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.brief import brief
from coeflab.kernels.surface_mesh import MeshIntegrals, mesh_integrals
from coeflab.model.frozen import locked

Array = NDArray[np.float64]


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
    integrals : MeshIntegrals
        Volume, centre, second moments, area and projected areas of the facets.

    Raises
    ------
    InputError
        No faces, an index without its vertex, or nothing enclosed: faces that look inward, an open sheet.
    """

    vertices: Array
    faces: NDArray[np.int64]
    exact_volume: float | None = None
    remade: Callable[[int], TriangleMesh] | None = None
    integrals: MeshIntegrals = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", locked(self.vertices))
        object.__setattr__(self, "faces", locked(self.faces, np.int64))
        faces = self.faces
        if not len(faces):
            raise InputError("a mesh without faces", "triangles of a closed surface")
        if faces.min() < 0 or faces.max() >= len(self.vertices):
            raise InputError("a face whose vertex does not exist", f"indices from 0 to {len(self.vertices) - 1}")
        object.__setattr__(self, "integrals", mesh_integrals(self.vertices, faces))
        if not self.integrals.volume > 0.0:
            raise InputError(
                f"a mesh that encloses {self.integrals.volume:g} m^3",
                "a volume above zero",
                advice="Do its faces look outward?",
            )

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

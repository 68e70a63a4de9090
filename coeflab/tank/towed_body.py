"""The body as a solver gets it: one closed surface whose triangles know which patch they belong to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.core.types import Array, brief, locked


@brief
@dataclass(frozen=True, slots=True, eq=False)
class TowedBody:
    """A closed surface with named patches, about the reference point of its moments.

    Attributes
    ----------
    body : Body
    vertices : (n, 3) array
        m, FRD, from the **reference point**, which is the origin of the cases.
    faces : (m, 3) array of int
        Counter-clockwise seen from the water.
    patches : tuple of str
        ``hull``, ``stern``, ``sail``, ``fins``, or the names of the body's parts.
    patch : (m,) array of int
        Of each face, an index into ``patches``.
    chord : mapping of str to float
        Of each appendage, its mean chord, m; of the hull and of a bare body, its length. Grid sizes come from them.
    mirrors : (3,) tuple of bool
        Whether the body is its own mirror image in the planes x = 0, y = 0, z = 0 through the origin.
    fourfold : bool
        Whether a quarter of a turn about x leaves the body as it is.
    """

    body: Body
    vertices: Array
    faces: NDArray[np.int64]
    patches: tuple[str, ...]
    patch: NDArray[np.int64]
    chord: Mapping[str, float] = field(default_factory=dict)
    mirrors: tuple[bool, bool, bool] = (False, False, False)
    fourfold: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", locked(self.vertices))
        object.__setattr__(self, "faces", locked(self.faces, np.int64))
        object.__setattr__(self, "patch", locked(self.patch, np.int64))
        object.__setattr__(self, "chord", MappingProxyType(dict(self.chord)))

    @property
    def length(self) -> float:
        """Over all along x, m."""
        return float(np.ptp(self.vertices[:, 0]))


PANELS = 100_000  # of the whole surface, where it is made from equations


def towed(
    body: Body, reference_point: Array, controls: Mapping[str, float] = MappingProxyType({}), panels: int = PANELS
) -> TowedBody:
    """The closed surface of a body with its patches, about the reference point, with its controls turned.

    Parameters
    ----------
    body : Body
    reference_point : (3,) array
        m, FRD, from the body's datum; the origin of the cases.
    controls : mapping of str to float
        Angle of each control by its name, rad; an absent one is at zero.
    panels : int
        About how many triangles, where the surface is made from equations; a mesh file is taken as it is.

    Raises
    ------
    InputError
        A body without a closed surface: particulars only, plates without thickness; a control that the body does not have.
    """
    raise NotImplementedError


def stl(towed: TowedBody) -> bytes:
    """The surface as an ASCII STL, one solid a patch, m; the same bytes for the same surface."""
    raise NotImplementedError

"""Added mass of a slender closed mesh by its sections along x; arrays in, arrays out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.closed_forms.sections import (
    SectionIntegrals,
    as_ellipse,
    as_rectangle,
    carried,
    ellipse,
    rectangle,
    section_integrals,
    turned,
)
from coeflab.bodies.mesh_sections import contours
from coeflab.bodies.section_elements import divided
from coeflab.bodies.section_flow import section_matrices
from coeflab.bodies.stations import joints, stations
from coeflab.core.types import Array, Faces, brief

ELEMENTS, FEWEST, TOGETHER, MOST_CONTOURS = 120, 24, 360, 40
SPECK = 1e-4


@brief
@dataclass(frozen=True, slots=True)
class Strips:
    """What the sections of a mesh add up to.

    Attributes
    ----------
    matrix : (6, 6) array
        Added mass over the density about the origin of the coordinates; nothing along x.
    volume : float
        Of the sections, m^3, to be compared with that of the mesh.
    ellipses, rectangles, others : int
        Sections by how they were done; the others by boundary elements.
    trapped : float
        Water inside closed rings, m^3, which moves sideways with the body and is in the matrix.
    """

    matrix: Array
    volume: float
    ellipses: int
    rectangles: int
    others: int
    trapped: float

    @property
    def count(self) -> int:
        """All sections that meet the body."""
        return self.ellipses + self.rectangles + self.others


def strips(vertices: Array, faces: Faces, count: int, elements: int = ELEMENTS, places: Array | None = None) -> Strips:
    """Cut a closed mesh at about ``count`` stations and add up the sections, by ``elements`` a contour where need be.

    ``places`` are the joints of the sections where they have been found already.

    Each section moves as in two dimensions with its own sway v + x r, heave w - x q and roll p (Newman, Marine
    Hydrodynamics, 1977, section 4.16).

    Raises
    ------
    ValueError
        An open mesh, or a section of more than 40 contours.
    """
    x, weight = stations(joints(vertices, faces) if places is None else places, count)
    matrices, waiting = np.zeros((len(x), 3, 3)), {}
    volume = trapped = 0.0
    done = {"ellipse": 0, "rectangle": 0}
    for k, found in enumerate(contours(vertices, faces, x)):
        loops = _without_specks(found)
        if not loops:
            continue
        whole = section_integrals(loops)
        volume += weight[k] * whole.area
        outer = [c for c in loops if _signed_area(c) > 0.0]
        if len(outer) < len(loops):
            outer = _outermost(outer)
            filled = section_integrals(outer)
            matrices[k] += _ring_water(filled, whole)
            trapped += weight[k] * (filled.area - whole.area)
            whole = filled
        known = _closed_form(outer, whole, done)
        if known is None:
            waiting[k] = outer, whole.centroid
        else:
            matrices[k] += carried(known, whole.centroid)
    for k, matrix in _by_elements(waiting, elements).items():
        matrices[k] += matrix
    return Strips(_summed(x, weight, matrices), volume, done["ellipse"], done["rectangle"], len(waiting), trapped)


def _signed_area(contour: Array) -> float:
    q = np.roll(contour, -1, axis=0)
    return float(np.sum(contour[:, 0] * q[:, 1] - contour[:, 1] * q[:, 0])) / 2.0


def _without_specks(loops: list[Array]) -> list[Array]:
    """Contours of three sides or more that are no smaller than 1e-4 of the largest."""
    sizes = [float(np.ptp(c, axis=0).max()) for c in loops]
    least = SPECK * max(sizes, default=0.0)
    return [c for c, size in zip(loops, sizes, strict=True) if len(c) > 2 and size > least and _signed_area(c) != 0.0]


def _outermost(outer: list[Array]) -> list[Array]:
    """Those contours that lie in no other one."""
    return [c for c in outer if not any(d is not c and _holds(d, c[0]) for d in outer)]


def _holds(contour: Array, point: Array) -> bool:
    """Whether a point lies inside, by the crossings of a ray along y."""
    p, q = contour - point, np.roll(contour, -1, axis=0) - point
    astride = (p[:, 1] > 0.0) != (q[:, 1] > 0.0)
    p, q = p[astride], q[astride]
    return bool(np.sum(p[:, 0] - p[:, 1] * (q[:, 0] - p[:, 0]) / (q[:, 1] - p[:, 1]) > 0.0) % 2)


def _ring_water(filled: SectionIntegrals, own: SectionIntegrals) -> Array:
    """Water within rings moves sideways with them; its turning about its own centre is left out, as in a round ring."""
    area = filled.area - own.area
    centre = (filled.area * filled.centroid - own.area * own.centroid) / area
    return carried(np.diag([area, area, 0.0]), centre)


def _closed_form(outer: list[Array], whole: SectionIntegrals, done: dict[str, int]) -> Array | None:
    """The matrix about the centroid of an ellipse or a rectangle; None for any other section."""
    if len(outer) > 1:
        return None
    for name, fitted, form in (("ellipse", as_ellipse, ellipse), ("rectangle", as_rectangle, rectangle)):
        sizes = fitted(outer[0], whole)
        if sizes is not None:
            done[name] += 1
            return turned(form(*sizes[:2]), sizes[2])
    return None


def _by_elements(waiting: dict[int, tuple[list[Array], Array]], elements: int) -> dict[int, Array]:
    """Matrices about the origin; sections with equally many contours are solved together."""
    out = {}
    for loops in sorted({len(outer) for outer, _ in waiting.values()}):
        if loops > MOST_CONTOURS:
            raise ValueError(f"a section of {loops} separate contours")
        own = max(FEWEST, min(elements, TOGETHER // loops))
        keys = [k for k, (outer, _) in waiting.items() if len(outer) == loops]
        points = np.array([np.concatenate([divided(c, own) for c in waiting[k][0]]) - waiting[k][1] for k in keys])
        belongs: NDArray[np.int64] = np.repeat(np.arange(loops), own)
        for k, matrix in zip(keys, _definite(section_matrices(points, belongs), points), strict=True):
            out[k] = carried(matrix, waiting[k][1])
    return out


def _definite(matrices: Array, points: Array) -> Array:
    """The nearest matrices without negative energy: rolling a nearly round section has about none, and rounding of it."""
    size = np.ptp(points, axis=1).max(axis=-1)
    unit = np.ones((len(size), 3))
    unit[:, 2] = size
    values, ways = np.linalg.eigh(matrices / (unit[:, :, None] * unit[:, None, :]))
    selected = np.einsum("sij,sj,skj->sik", ways, np.maximum(values, 0.0), ways)
    return np.asarray(selected * unit[:, :, None] * unit[:, None, :])


def _summed(x: Array, weight: Array, matrices: Array) -> Array:
    motion = np.zeros((len(x), 3, 6))
    motion[:, 0, 1] = motion[:, 1, 2] = motion[:, 2, 3] = 1.0
    motion[:, 0, 5], motion[:, 1, 4] = x, -x
    total = np.einsum("s,sai,sab,sbj->ij", weight, motion, matrices, motion)
    return np.asarray((total + total.T) / 2.0)


@dataclass(frozen=True, slots=True)
class EllipsoidCorrection:
    """Exact values of an ellipsoid over those of its own sections; ``axial`` over its displaced mass."""

    axial: float
    sway: float
    heave: float
    pitch: float
    yaw: float

    def applied(self, matrix: Array, volume: float) -> Array:
        """A strip matrix about the centre of volume, corrected; products by the roots of both factors, roll as it is."""
        root = np.sqrt([1.0, self.sway, self.heave, 1.0, self.pitch, self.yaw])
        out = matrix * np.outer(root, root)
        out[0, 0] += self.axial * volume
        return np.asarray(out)


def ellipsoid_correction(a: float, b: float, c: float) -> EllipsoidCorrection:
    """Of the ellipsoid with semi-axes a, b, c along x, y, z.

    Its sections alone give sway 4 pi a c^2 / 3 and heave 4 pi a b^2 / 3, and a^2 / 5 times these in yaw and pitch.
    """
    exact = np.diag(ellipsoid_added_mass(np.array([a, b, c]), 1.0))
    third = 4.0 * np.pi * a / 3.0
    sway, heave = third * c**2, third * b**2
    lever = a**2 / 5.0
    own = np.array([third * b * c, sway, heave, heave * lever, sway * lever])
    return EllipsoidCorrection(*(float(v) for v in exact[[0, 1, 2, 4, 5]] / own))

"""Added mass of a slender closed mesh by its sections along x; arrays in, arrays out.

Where to cut a mesh along x: stations between the places where its sections jump; arrays in, arrays out.

Sections of a closed mesh by planes x = const; arrays in, arrays out.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.closed_forms import (
    SectionIntegrals,
    as_ellipse,
    as_rectangle,
    carried,
    ellipse,
    ellipsoid_added_mass,
    rectangle,
    section_integrals,
    turned,
)
from coeflab.bodies.mesh.mesh import corner_range
from coeflab.bodies.strips.flow import divided, section_matrices
from coeflab.core.types import Array, Faces, brief

Contour = Array


def contours(vertices: Array, faces: Faces, x: Array) -> list[list[Contour]]:
    """Closed contours of the sections at stations ``x``, all cut at once.

    Each is (n, 2), y and z, with the body to its left where y points right and z up: its area is positive, and that of
    a hole negative. A vertex in the plane of a station counts as lying aft of it, so that no case is special.

    Raises
    ------
    ValueError
        The mesh is open where a plane cuts it.
    """
    order = np.argsort(x)
    rank = np.searchsorted(x[order], vertices[:, 0], side="left")
    corner = rank[faces]
    low, high = corner_range(corner)
    hit = np.flatnonzero(high > low)
    face = np.repeat(hit, (high - low)[hit])
    first = np.cumsum((high - low)[hit]) - (high - low)[hit]
    station = np.arange(len(face)) - np.repeat(first - low[hit], (high - low)[hit])
    ahead = corner[face] > station[:, None]
    lone_ahead = ahead[:, 0].astype(np.int64) + ahead[:, 1] + ahead[:, 2] == 1
    alone = ahead == lone_ahead[:, None]
    lone = alone[:, 1] + 2 * alone[:, 2]
    own = faces[face]
    rows = np.arange(len(face))
    i, j, k = (own[rows, (lone + turn) % 3] for turn in range(3))
    begin = np.where(lone_ahead, j, k)
    finish = np.where(lone_ahead, k, j)
    start, end = (_edge(i, other, len(vertices), station, len(x)) for other in (begin, finish))
    sort = np.argsort(start)
    place = np.minimum(np.searchsorted(start[sort], end), len(start) - 1)
    follower = sort[place] if len(start) else place
    if np.any(start[follower] != end):
        raise ValueError("an open mesh")
    points = _crossing(vertices, np.minimum(i, begin), np.maximum(i, begin), x[order][station])
    out: list[list[Contour]] = [[] for _ in x]
    for cycle in _cycles(follower):
        out[int(order[station[cycle[0]]])].append(points[cycle])
    return out


def _edge(a: NDArray[np.int64], b: NDArray[np.int64], count: int, station: NDArray[np.int64], stops: int) -> Faces:
    return np.asarray((np.minimum(a, b) * count + np.maximum(a, b)) * stops + station)


def _crossing(vertices: Array, one: NDArray[np.int64], two: NDArray[np.int64], x: Array) -> Array:
    a, b = vertices[one], vertices[two]
    share = (x - a[:, 0]) / (b[:, 0] - a[:, 0])
    return np.asarray(a[:, 1:] + share[:, None] * (b[:, 1:] - a[:, 1:]))


def _cycles(follower: NDArray[np.int64]) -> list[list[int]]:
    """The cycles of a permutation."""
    following = follower.tolist()
    seen = bytearray(len(following))
    out = []
    for first in range(len(following)):
        if seen[first]:
            continue
        cycle, at = [], first
        while not seen[at]:
            seen[at] = 1
            cycle.append(at)
            at = following[at]
        out.append(cycle)
    return out


MOST_STATIONS, FLAT_SHARE = 40, 0.002
BINS, STEP = 256, 0.1
FEWEST_STATIONS, CLOSE = 4, 1e-4


def joints(vertices: Array, faces: Faces) -> Array:
    """Where the sections of a mesh may jump, rising, with both ends of the mesh, m.

    Flat faces across x that make up 0.2 % of the frontal box or more, and places where the breadth or the depth changes
    by a tenth within 1/256 of the length, as at the edges of a mast.
    """
    ends = np.array([vertices[:, 0].min(), vertices[:, 0].max()])
    found = np.sort(np.r_[_flat_faces(vertices, faces, ends), _steps(vertices, faces, ends)])
    margin = CLOSE * (ends[1] - ends[0])
    found = found[(found > ends[0] + margin) & (found < ends[1] - margin)]
    found = found[np.diff(found, prepend=-np.inf) > margin]
    return np.asarray(np.r_[ends[0], found, ends[1]])


def stations(places: Array, count: int) -> tuple[Array, Array]:
    """Gauss-Legendre stations between joints, four or more in each piece and about ``count`` in all without these.

    Returns
    -------
    x, weight : (n,) arrays
        m.
    """
    found, weights = [], []
    for low, high in pairwise(places):
        own = max(FEWEST_STATIONS, 2 * round(count * (high - low) / (places[-1] - places[0]) / 2.0))
        node, weight = np.polynomial.legendre.leggauss(own)
        found.append(low + (high - low) * (node + 1.0) / 2.0)
        weights.append((high - low) * weight / 2.0)
    return np.concatenate(found), np.concatenate(weights)


def _flat_faces(vertices: Array, faces: Faces, ends: Array) -> Array:
    """Places of the largest flat faces across x, m."""
    length = ends[1] - ends[0]
    fore, aft = corner_range(vertices[:, 0][faces])
    upright = faces[aft - fore <= 1e-6 * length]
    a, b, c = (vertices[corner] for corner in upright.T)
    e, f = b - a, c - a
    area = np.abs(e[:, 1] * f[:, 2] - e[:, 2] * f[:, 1]) / 2.0
    step = np.round((a[:, 0] - ends[0]) / (1e-5 * length)).astype(np.int64)
    found, own = np.unique(step, return_inverse=True)
    total = np.bincount(own, area, len(found))
    place = np.bincount(own, area * a[:, 0], len(found)) / np.maximum(total, np.finfo(float).tiny)
    large = np.flatnonzero(total > FLAT_SHARE * np.ptp(vertices[:, 1]) * np.ptp(vertices[:, 2]))
    return np.asarray(place[large[np.argsort(-total[large], kind="stable")[:MOST_STATIONS]]])


def _steps(vertices: Array, faces: Faces, ends: Array) -> Array:
    """Places where the outline seen from the side or from above jumps, m: the outermost vertices of the step."""
    bins = np.minimum((BINS * (vertices[:, 0] - ends[0]) / (ends[1] - ends[0])).astype(np.int64), BINS - 1)
    low, high = corner_range(bins[faces])
    covered = high - low + 1
    face = np.repeat(np.arange(len(faces)), covered)
    bin_of = np.arange(len(face)) - np.repeat(np.cumsum(covered) - covered - low, covered)
    found: list[tuple[float, float]] = []
    for axis in (1, 2):
        size = float(np.ptp(vertices[:, axis]))
        for sign in (1.0, -1.0):
            value = sign * vertices[:, axis]
            outline = np.full(BINS, value.min())
            np.maximum.at(outline, bin_of, corner_range(value[faces])[1][face])
            change = np.diff(outline)
            for k in np.flatnonzero(np.abs(change) > STEP * size):
                high_bin, edge = (k + 1, np.min) if change[k] > 0.0 else (k, np.max)
                out = (bins == high_bin) & (value > (outline[k] + outline[k + 1]) / 2.0)
                if out.any():
                    found.append((-abs(change[k]) / size, float(edge(vertices[out, 0]))))
    return np.array([place for _, place in sorted(found)[:MOST_STATIONS]])


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
        Of the sections, m^3, to be held against that of the mesh.
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
    kept = np.einsum("sij,sj,skj->sik", ways, np.maximum(values, 0.0), ways)
    return np.asarray(kept * unit[:, :, None] * unit[:, None, :])


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

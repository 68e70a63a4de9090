"""Added mass of a slender closed mesh by its sections along x; arrays in, arrays out.

Where to cut a mesh along x: stations between the places where its sections jump; arrays in, arrays out.

Sections of a closed mesh by planes x = const; arrays in, arrays out.

Added mass of plane sections of any shape in unbounded fluid, by boundary elements for the stream function.

Per unit length, density 1; matrices are (3, 3): sway (along y), heave (along z), roll (y towards z).

The stream function of the flow is known on a moving contour but for a constant: f = z for sway, -y for heave and
-(y^2 + z^2) / 2 for roll. Green's identities for the fluid outside and for f inside add up to one equation of a single
layer, S sigma = f - domain term + C, whose density is the jump of the normal derivative; C, one for each contour, goes
with the condition that no circulation arises. It needs only the integrals of ln r over straight elements, which are
exact, and stays well-behaved for thin fins, where the usual equations for the potential become singular: both sides of
a fin then share their density. The kinetic energy is a boundary integral of f sigma and area integrals of f.

Contours of sections divided anew for boundary elements: fine at corners and where they bend.
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
from coeflab.core.types import Array, Faces, brief

BATCH = 1_000_000


def section_matrices(points: Array, contour: NDArray[np.int64]) -> Array:
    """Section matrices about the origin of each section's coordinates.

    Parameters
    ----------
    points : (s, n, 2) array
        y, z of s sections of n elements each, m; around each contour with the body to the left.
    contour : (n,) array of int
        Which contour each point belongs to, from 0, rising; alike for all sections.

    Returns
    -------
    (s, 3, 3) array
        m^2, m^3, m^4.
    """
    size = np.ptp(points, axis=1).max(axis=-1)
    scaled = points / size[:, None, None]
    block = max(1, BATCH // points.shape[1] ** 2)
    parts = [_solved(scaled[k : k + block], contour) for k in range(0, len(points), block)]
    units = np.array([1.0, 1.0, 0.0])[None, :] + np.array([0.0, 0.0, 1.0]) * size[:, None]
    return np.asarray(np.concatenate(parts) * size[:, None, None] ** 2 * units[:, :, None] * units[:, None, :])


def _followers(contour: NDArray[np.int64]) -> NDArray[np.int64]:
    """Index of the next point around the same contour."""
    following = np.arange(1, len(contour) + 1)
    first = np.flatnonzero(np.r_[True, np.diff(contour) != 0])
    following[np.r_[first[1:], len(contour)] - 1] = first
    return following


def _solved(start: Array, contour: NDArray[np.int64]) -> Array:
    following = _followers(contour)
    end = start[:, following]
    step = end - start
    length = np.linalg.norm(step, axis=2)
    middle = (start + end) / 2.0
    single, domain = _influence(middle, start, step / length[..., None], length, following)
    s, n = length.shape
    bodies = int(contour.max()) + 1
    own = (contour[:, None] == np.arange(bodies)).astype(float)
    twice = start[..., 0] * end[..., 1] - start[..., 1] * end[..., 0]
    matrix = np.zeros((s, n + bodies, n + bodies))
    matrix[:, :n, :n] = single
    matrix[:, :n, n:] = -own
    matrix[:, n:, :n] = own.T * length[:, None, :]
    known = np.zeros((s, n + bodies, 3))
    known[:, :n, 0], known[:, :n, 1] = middle[..., 1], -middle[..., 0]
    known[:, :n, 2] = domain - np.sum(middle**2, axis=2) / 2.0
    known[:, n:, 2] = twice @ own
    density = np.linalg.solve(matrix, known)[:, :n]
    square = np.sum(start**2 + start * end + end**2, axis=2) / 3.0
    f = np.stack([middle[..., 1], -middle[..., 0], -square / 2.0], axis=2)
    energy = -np.einsum("sni,snj,sn->sij", density, f, length) - _inside(start, end, twice)
    return np.asarray((energy + energy.transpose(0, 2, 1)) / 2.0)


def _influence(
    middle: Array, start: Array, along: Array, length: Array, following: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Single layer (s, n, n) of every element at every middle, and the domain term of roll (s, n).

    Over an element the integral of ln r is b ln r_b - a ln r_a - h + d (angle), with a and b along it from the foot of
    the point, d its distance. The area integral of ln r / 2 pi turns into the same integrals, d (2 L - h) / 8 pi.
    """
    y = middle[:, :, None, 0] - start[:, None, :, 0]
    z = middle[:, :, None, 1] - start[:, None, :, 1]
    ty, tz, h = along[:, None, :, 0], along[:, None, :, 1], length[:, None, :]
    u, d = y * ty + z * tz, y * tz - z * ty
    log = np.log(y * y + z * z) / 2.0
    a, b = -u, h - u
    integral = b * log[:, :, following] - a * log - h + d * np.arctan2(d * h, d * d + a * b)
    domain = -np.sum(d * (2.0 * integral - h), axis=2) / (4.0 * np.pi)
    return integral / (2.0 * np.pi), domain


def _inside(start: Array, end: Array, twice: Array) -> Array:
    """Area integrals of grad f_i grad f_j + f_j laplace f_i, (s, 3, 3)."""
    area = twice.sum(axis=1) / 2.0
    first = np.einsum("sn,snk->sk", twice, start + end) / 6.0
    polar = np.sum(twice * np.sum(start**2 + start * end + end**2, axis=2), axis=1) / 12.0
    out = np.zeros((len(area), 3, 3))
    out[:, 0, 0] = out[:, 1, 1] = area
    out[:, 2, 0], out[:, 0, 2] = -3.0 * first[:, 1], -first[:, 1]
    out[:, 2, 1], out[:, 1, 2] = 3.0 * first[:, 0], first[:, 0]
    out[:, 2, 2] = 2.0 * polar
    return out


CORNER = np.radians(20.0)
AT_CORNER, IN_CORNER, GROWTH, BEND, WIDEST = 3e-3, 0.03, 0.7, 0.3, 0.04
SAMPLES = 768


def divided(contour: Array, count: int) -> Array:
    """``count`` points along a closed contour, (n, 2), that keep its corners and, where it bends, its area.

    The size of an element grows by 0.7 of the distance from 0.003 of the perimeter at an outward corner (a turn above 20
    degrees) and 0.03 at an inward one, where the water is still; it is 0.3 of the radius of curvature where the contour bends, and 0.04 of the perimeter at most, all in
    proportion.

    Returns
    -------
    (count, 2) array
        Corners are kept exactly, up to ``count / 3`` of them.
    """
    corner, s, wanted, closed = _wanted(contour, count)
    weight = np.r_[0.0, np.cumsum(np.diff(s) * (1.0 / wanted[1:] + 1.0 / wanted[:-1]) / 2.0)]
    at = np.interp(np.arange(count) * weight[-1] / count, weight, s)
    at = _snapped(at, corner, s[-1])
    place = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))]
    points = np.column_stack([np.interp(at, place, closed[:, k]) for k in range(2)])
    return _bulged(points)


def _wanted(contour: Array, count: int) -> tuple[Array, Array, Array, Array]:
    """Arc lengths of corners, sample arc lengths, element size there, and the closed contour from its first corner."""
    size = float(np.ptp(contour, axis=0).max())
    step = np.linalg.norm(np.roll(contour, -1, axis=0) - contour, axis=1)
    contour = contour[step > 1e-9 * size]
    side = np.roll(contour, -1, axis=0) - contour
    before = np.roll(side, 1, axis=0)
    turn = np.arctan2(before[:, 0] * side[:, 1] - before[:, 1] * side[:, 0], np.sum(before * side, axis=1))
    sharpest = int(np.argmax(turn))
    contour, turn = np.roll(contour, -sharpest, axis=0), np.roll(turn, -sharpest)
    closed = np.vstack([contour, contour[:1]])
    step = np.linalg.norm(np.diff(closed, axis=0), axis=1)
    place = np.r_[0.0, np.cumsum(step)]
    around = place[-1]
    sharp = np.flatnonzero(np.abs(turn) > CORNER)
    sharp = np.sort(sharp[np.argsort(-np.abs(turn[sharp]), kind="stable")[: count // 3]])
    bend = BEND * (step + np.roll(step, 1)) / 2.0 / np.maximum(np.abs(turn), 1e-12)
    bend[sharp] = np.where(turn[sharp] > 0.0, AT_CORNER, IN_CORNER) * around
    at_points = np.clip(np.r_[bend, bend[:1]], AT_CORNER * around, WIDEST * around)
    s = _samples(place)
    return place[sharp], s, _spread(s, place, at_points), closed


def _samples(place: Array) -> Array:
    """Arc lengths at which the size is laid out: every corner, and cosine points between."""
    own = max(3, SAMPLES // (len(place) - 1))
    share = (1.0 - np.cos(np.pi * np.arange(own) / own)) / 2.0
    return np.asarray(np.r_[(place[:-1, None] + np.diff(place)[:, None] * share).ravel(), place[-1]])


def _spread(s: Array, place: Array, size: Array) -> Array:
    """The largest sizes that nowhere exceed ``size`` at ``place`` and change by GROWTH of the distance, around."""
    around = place[-1]
    at = np.concatenate([place[:-1] - around, place, place[1:] + around])
    least = np.concatenate([size[:-1], size, size[1:]])
    rising = np.minimum.accumulate(least - GROWTH * at)
    falling = np.minimum.accumulate((least + GROWTH * at)[::-1])[::-1]
    behind = np.searchsorted(at, s, side="right") - 1
    ahead = np.searchsorted(at, s, side="left")
    return np.asarray(np.minimum(rising[behind] + GROWTH * s, falling[ahead] - GROWTH * s))


def _snapped(at: Array, corner: Array, around: float) -> Array:
    """The point nearest to each corner, moved there; a point serves one corner."""
    out = at.copy()
    taken: NDArray[np.bool_] = np.zeros(len(at), dtype=bool)
    for c in corner:
        distance = np.abs(at - c)
        distance = np.minimum(distance, around - distance)
        distance[taken] = np.inf
        nearest = int(np.argmin(distance))
        out[nearest], taken[nearest] = c, True
    return np.sort(out)


def _bulged(points: Array) -> Array:
    """The points moved outward where the contour bends, so that the chords enclose what the arcs did.

    A regular polygon inscribed in a circle has the circle's area once its corners move out by h turn / 12, to the fourth
    order in the turn. Corners stay.
    """
    side = np.roll(points, -1, axis=0) - points
    before = np.roll(side, 1, axis=0)
    turn = np.arctan2(before[:, 0] * side[:, 1] - before[:, 1] * side[:, 0], np.sum(before * side, axis=1))
    chord = before + side
    outward = np.column_stack([chord[:, 1], -chord[:, 0]])
    step = np.where(np.abs(turn) > CORNER, 0.0, turn / 24.0)
    return np.asarray(points + outward * step[:, None])


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

"""Added mass of plane sections of any shape in unbounded fluid, by boundary elements for the stream function.

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

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array

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

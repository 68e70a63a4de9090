"""Contours of sections divided anew for boundary elements: fine at corners and where they bend."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array

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

"""Where a fitted table may be read: the convex hull of its data.

Reading a linear model outside its data: refused, held at the hull's nearest point, or tapered to that value.

Distances are in widths of the data's bounding box, so that they do not depend on units. The nearest point of a convex
hull is a least distance problem: Lawson & Hanson, Solving Least Squares Problems (1974), chapter 23. The taper is
defined here, by the cubic step 1 - 3 t^2 + 2 t^3 of Hermite interpolation.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from coeflab.core.types import Array, brief, locking
from coeflab.law.symbols import PORT_STARBOARD
from coeflab.law.terms import Term

SLACK = 1e-9
FLAT = 1e-10


def half_spaces(points: Array) -> Array:
    """Half-spaces [a, b] with a . x + b <= 0 inside the convex hull, shape (m, d + 1).

    Parameters
    ----------
    points : (n, d) array
        Scaled alike in every direction by the caller or not; the hull does not mind.

    Notes
    -----
    Data on a line or plane of the space have their hull there, with the directions across pinned.
    """
    d = points.shape[1]
    low, high = points.min(axis=0), points.max(axis=0)
    if d == 1:
        return np.array([[1.0, -high[0]], [-1.0, low[0]]])
    size = np.where(high > low, high - low, 1.0)
    scaled = (points - low) / size
    try:
        equations = _flat(scaled) if len(points) <= d else ConvexHull(scaled).equations
    except QhullError:
        equations = _flat(scaled)
    equations = np.unique(np.round(equations, 12), axis=0)
    normals = equations[:, :d] / size
    return np.column_stack([normals, equations[:, d] - normals @ low])


def _flat(scaled: Array) -> Array:
    """Hull of scaled points that do not fill the space: that within their plane, along its principal axes."""
    d = scaled.shape[1]
    middle = scaled.mean(axis=0)
    _, _, axes = np.linalg.svd(np.linalg.qr(scaled - middle, mode="r"))
    along = (scaled - middle) @ axes.T
    wide = np.ptp(along, axis=0) > FLAT
    if np.all(wide):
        wide[-1] = False
    across = axes[~wide]
    pinned = along[:, ~wide]
    normals = [across, -across]
    offsets = [-pinned.max(axis=0), pinned.min(axis=0)]
    if np.any(wide):
        within = half_spaces(along[:, wide])
        normals.append(within[:, :-1] @ axes[wide])
        offsets.append(within[:, -1])
    stacked = np.vstack(normals)
    return np.column_stack([stacked.reshape(-1, d), np.concatenate(offsets) - stacked @ middle])


def inside(spaces: Array, points: Array, slack: float = SLACK) -> Array:
    """Whether points lie in all half-spaces, boolean (n,); infinite points and NaN do not."""
    d = spaces.shape[1] - 1
    scale = np.maximum(np.abs(spaces[:, d]), 1e-300)
    finite = np.all(np.isfinite(points), axis=1)
    values = np.where(finite[:, None], points, 0.0) @ spaces[:, :d].T + spaces[:, d]
    return np.asarray(finite & np.all(values <= slack * np.maximum(scale, 1.0), axis=1))


TAPER = 0.1
THICKNESS = 1e-12
FAR, WITHIN = 1e3, 1e-6  # box widths: of points that ask where a hull ends, and by which it may leave its box


def clamped(points: Array, spaces: Array, low: Array, high: Array) -> Array:
    """The nearest points of the convex hull, shape (n, d); points inside stay as they are.

    Nearest in coordinates divided by the widths of the bounding box; a variable without width counts in its own unit,
    which does not matter, since it can only be pinned. The answer keeps every half-space, and the conditions of
    optimality, to `SLACK` box widths. Where that cannot be reached the point is NaN: infinite or NaN input, points some
    10^6 box widths away (rounding), half-spaces that contradict each other.

    Parameters
    ----------
    points : (n, d) array
    spaces : (m, d + 1) array
        Rows [a, b] with a . x + b <= 0 inside, as `coeflab.law.domain.half_spaces` gives them.
    low, high : (d,) array
        Bounding box of the data.
    """
    out = np.array(points, dtype=np.float64)
    outside = np.flatnonzero(np.logical_not(inside(spaces, out)))
    if not len(outside):
        return out
    size = _widths(low, high)
    scaled = (out[outside] - low) / size
    normals, bounds = _in_widths(spaces, low, size)
    held = np.full_like(scaled, np.nan)
    left = np.flatnonzero(np.all(np.isfinite(scaled), axis=1))
    if not len(left) or not len(normals):
        out[outside] = held
        return out
    beyond = scaled[left] @ normals.T - bounds
    worst = np.argmax(beyond, axis=1)
    # A point whose foot on some face lies in the hull has that face as its most violated one.
    for face in np.unique(worst):
        mine = left[worst == face]
        held[mine] = _feet(scaled[mine], normals, bounds, np.array([face]))
    left = left[np.isnan(held[left, 0])]
    # Elsewhere one point's exact solution names an edge or corner, which serves every other point that it is nearest to.
    while len(left):
        feet = _feet(scaled[left], normals, bounds, _active(scaled[left[0]], normals, bounds))
        held[left] = feet
        left = left[1:][np.isnan(feet[1:, 0])]
    out[outside] = low + size * held
    return out


def _widths(low: Array, high: Array) -> Array:
    return np.asarray(np.where(high > low, high - low, 1.0), dtype=np.float64)


def _in_widths(spaces: Array, low: Array, size: Array) -> tuple[Array, Array]:
    """Unit normals and bounds of the half-spaces in box widths from the low corner: normal . z <= bound."""
    d = len(low)
    normals = spaces[:, :d] * size
    length = np.linalg.norm(normals, axis=1)
    real = length > 0.0
    bounds = -(spaces[:, d] + spaces[:, :d] @ low)
    return normals[real] / length[real, None], bounds[real] / length[real]


def _feet(points: Array, normals: Array, bounds: Array, active: NDArray[np.intp]) -> Array:
    """Feet of points on the intersection of some faces; NaN where the foot is not the nearest point of the hull.

    It is nearest if it lies in the hull and no face pulls (Karush, Kuhn and Tucker).
    """
    face, at = normals[active], bounds[active]
    inverse = np.linalg.pinv(face @ face.T)
    push = (points @ face.T - at) @ inverse
    pulled = np.flatnonzero(np.all(push >= -SLACK, axis=1))
    feet = points[pulled] - push[pulled] @ face
    feet = feet - (feet @ face.T - at) @ inverse @ face
    out = np.full_like(points, np.nan)
    selected = np.all(feet @ normals.T - bounds <= SLACK, axis=1)
    out[pulled[selected]] = feet[selected]
    return out


def _active(point: Array, normals: Array, bounds: Array) -> NDArray[np.intp]:
    """Faces that hold the nearest point of the hull, by the dual of the least distance problem.

    Lawson & Hanson (1974), chapter 23, algorithm LDP, with lengths in units of the largest violation and the hull
    thicker by `THICKNESS`, so that data on a plane leave a solution in spite of rounding.
    """
    beyond = normals @ point - bounds
    rows = np.vstack([-normals.T, (beyond - THICKNESS) / np.max(beyond)])
    goal = np.zeros(len(rows))
    goal[-1] = 1.0
    try:
        from scipy.optimize import nnls

        dual, _ = nnls(rows, goal)
    except RuntimeError:
        return np.array([int(np.argmax(beyond))])
    return np.asarray(np.flatnonzero(dual > THICKNESS * np.max(dual, initial=0.0)), dtype=np.intp)


def taper_weight(points: Array, nearest: Array, low: Array, high: Array) -> Array:
    """How much of the free continuation remains, shape (n,): 1 in the hull, 0 from `TAPER` box widths beyond it.

    Between them w = 1 - 3 t^2 + 2 t^3, where t is the distance from the nearest point of the hull, in box widths, over
    `TAPER`. The step has no slope at either end. With f the free continuation and e the value at the nearest point of
    the hull, the tapered value e + w (f - e) therefore leaves the hull with the slope of f and settles at e. A variable
    without width in the data tapers at once, and so does a point without a nearest one.

    Parameters
    ----------
    points, nearest : (n, d) array
        `nearest` from `clamped`.
    low, high : (d,) array
        Bounding box of the data.
    """
    away = np.abs(points - nearest)
    flat = high <= low
    t = np.linalg.norm(away / _widths(low, high), axis=1) / TAPER
    t = np.where(np.any(away[:, flat] > 0.0, axis=1) | ~np.isfinite(t), 1.0, np.minimum(t, 1.0))
    return np.asarray(1.0 - t**2 * (3.0 - 2.0 * t), dtype=np.float64)


class Extrapolation(StrEnum):
    """What a reader outside the data gets: no value; that of the nearest point of the hull; a blend into that."""

    REFUSE = "refuse"
    CLAMP = "clamp"
    TAPER = "taper"


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("low high spaces")
class Domain:
    """The convex hull of the data of a table or model, and what a reader outside of it gets.

    Attributes
    ----------
    variables : tuple of str
    low, high : (d,) array
        Bounding box.
    spaces : (m, d + 1) array
        Rows [a, b] with a . x + b <= 0 inside.
    rule : Extrapolation
    """

    variables: tuple[str, ...]
    low: Array
    high: Array
    spaces: Array
    rule: Extrapolation = Extrapolation.CLAMP

    @classmethod
    def of(cls, columns: Mapping[str, Array], rule: Extrapolation, terms: Sequence[Term] = ()) -> Domain:
        """The domain of some data, one column a variable.

        Parameters
        ----------
        columns : mapping of variable to (n,) array
        rule : Extrapolation
        terms : sequence of Term
            Of the form. One that port-starboard symmetry leaves as it is, or turns around as a whole, holds the mirror images of
            its data too.
        """
        points = np.column_stack(list(columns.values()))
        sided = [v == "beta" or v in PORT_STARBOARD for v in columns]
        turns = {sum(t.odd_in(v) for v, at in zip(columns, sided, strict=True) if at) % 2 for t in terms}
        if any(sided) and len(turns) == 1:
            points = np.vstack([points, np.where(sided, -points, points)])
        return cls(tuple(columns), points.min(axis=0), points.max(axis=0), half_spaces(points), rule)

    @property
    def is_box(self) -> bool:
        """Whether the hull is its bounding box, so that every variable may be held by itself."""
        d = len(self.variables)
        normals, offsets = self.spaces[:, :d], self.spaces[:, d]
        if np.any(np.count_nonzero(np.abs(normals) > SLACK * np.abs(normals).max(axis=1, keepdims=True), axis=1) != 1):
            return False
        at = np.argmax(np.abs(normals), axis=1)
        slope = normals[np.arange(len(at)), at]
        edge, ends = -offsets / slope, np.where(slope > 0.0, self.high[at], self.low[at])
        wide = np.where(self.high > self.low, self.high - self.low, 1.0)[at]
        if len({(int(i), up) for i, up in zip(at, slope > 0.0, strict=True)}) < 2 * d:
            return False
        return bool(np.all(np.abs(edge - ends) <= SLACK * np.maximum(wide, np.abs(ends))))

    def beyond_its_box(self) -> tuple[str, ...]:
        """Variables whose low or high the half-spaces do not keep: the nearest points of far ones lie outside."""
        size = _widths(self.low, self.high)
        ways = np.vstack([np.eye(len(size)), -np.eye(len(size))])
        feet = clamped((self.low + self.high) / 2.0 + FAR * size * ways, self.spaces, self.low, self.high)
        out = np.maximum(feet - self.high, self.low - feet) > WITHIN * size
        return tuple(v for v, wrong in zip(self.variables, np.any(out, axis=0), strict=True) if wrong)

    def contains(self, points: Array, slack: float = SLACK) -> NDArray[np.bool_]:
        """(n,) whether points (n, d) lie inside."""
        return np.asarray(inside(self.spaces, points, slack), dtype=bool)

    def read(self, points: Array) -> tuple[Array, Array]:
        """Where a table is read for points (n, d): the nearest points of the hull, and (n,) the share of the free continuation.

        The share is zero unless the rule is ``taper``; what ``refuse`` does with a point outside is its caller's.
        """
        nearest = clamped(points, self.spaces, self.low, self.high)
        if self.rule is not Extrapolation.TAPER:
            return nearest, np.zeros(len(points))
        return nearest, taper_weight(points, nearest, self.low, self.high)

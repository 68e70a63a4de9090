"""Added mass of plane sections in unbounded fluid, in closed form; per unit length, density 1.

A section matrix is (3, 3), symmetric: sway (along y), heave (along z), roll (y towards z), about a named point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from coeflab.core.types import Array, brief

Curve = Callable[[float], float]
ELLIPSE_TOLERANCE = 0.005
RECTANGLE_TOLERANCE = 1e-4
# Rectangle of half-sides a and b = a 10^(-k/6): over pi b^2 along a, over pi a^2 along b, roll over pi a^4. Computed with
# section_flow at 1,600 elements graded to the corners; 1,100 change no entry by more than 4e-5.
_ALONG_A = (
    1.513166, 1.610243, 1.716910, 1.832362, 1.955615, 2.085590, 2.221201, 2.361420, 2.505323, 2.652117, 2.801131, 2.951840,
    3.103790,
)  # fmt: skip
_ALONG_B = (
    1.513166, 1.426224, 1.349647, 1.283336, 1.226880, 1.179604, 1.140642, 1.109014, 1.083700, 1.063705, 1.048099, 1.036052,
    1.026843,
)  # fmt: skip
_ROLL = (
    0.230638, 0.152947, 0.146876, 0.148594, 0.148448, 0.146433, 0.143553, 0.140496, 0.137621, 0.135084, 0.132932, 0.131160,
    0.129730,
)  # fmt: skip
STEPS_PER_DECADE = 6
SLENDEREST_RECTANGLE = 100.0


@brief
@dataclass(frozen=True, slots=True)
class SectionIntegrals:
    """Area m^2, centroid (2,) m, and second moments (2, 2) about the centroid m^4, of all contours of a section."""

    area: float
    centroid: Array
    second: Array


def section_integrals(contours: list[Array]) -> SectionIntegrals:
    """Integrals inside closed contours, (n, 2) each; clockwise ones are holes."""
    origin = contours[0].mean(axis=0)
    area, first, second = 0.0, np.zeros(2), np.zeros((2, 2))
    for contour in contours:
        p = contour - origin
        q = np.roll(p, -1, axis=0)
        twice = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
        total = p + q
        area += float(twice.sum()) / 2.0
        first += twice @ total / 6.0
        second += ((p * twice[:, None]).T @ p + (q * twice[:, None]).T @ q + (total * twice[:, None]).T @ total) / 24.0
    if not area > 0.0:
        return SectionIntegrals(0.0, origin, np.zeros((2, 2)))
    offset = first / area
    return SectionIntegrals(area, origin + offset, second - area * np.outer(offset, offset))


def ellipse(a: float, b: float) -> Array:
    """Ellipse with semi-axes a along y and b along z, about its centre.

    Source: Newman, Marine Hydrodynamics (1977), Table 4.3; a circle is a = b, a flat plate a = 0 or b = 0.
    """
    return np.diag([np.pi * b**2, np.pi * a**2, np.pi * (a**2 - b**2) ** 2 / 8.0])


def rectangle(a: float, b: float) -> Array:
    """Rectangle of half-sides a along y and b along z, about its centre; b / a from 0.01 to 100.

    Splines over the logarithm of the ratio through computed values; the printed ones agree to the digits they have
    (DNV-RP-C205, table D-1: 1.51 for a square, 1.14 and 2.23 for ten to one).
    """
    sway, heave, roll = _splines()
    t = np.log10(b / a) * STEPS_PER_DECADE
    if abs(t) > 12.0 + 1e-9:
        raise ValueError("a rectangle more slender than 100 to 1")
    along_y, along_z = (sway, heave) if t <= 0.0 else (heave, sway)
    return np.pi * np.diag([along_y(abs(t)) * b**2, along_z(abs(t)) * a**2, roll(abs(t)) * (a**4 + b**4)])


@cache
def _splines() -> tuple[Curve, Curve, Curve]:
    """Of sway, heave and roll over a^4 + b^4, by six times the decades of a / b; even about the square where they are."""
    from scipy.interpolate import CubicSpline

    step = np.arange(13.0)
    whole = CubicSpline(np.r_[-step[:0:-1], step], np.r_[_ALONG_A[:0:-1], _ALONG_B])
    ratio = 10.0 ** (-4.0 * step / STEPS_PER_DECADE)
    roll = CubicSpline(step, np.array(_ROLL) / (1.0 + ratio), bc_type=((1, 0.0), "not-a-knot"))
    return (lambda t: whole(-t)), whole, roll


def turned(matrix: Array, angle: float) -> Array:
    """The section turned from y towards z by ``angle``, rad."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(turn @ matrix @ turn.T)


def carried(matrix: Array, point: Array) -> Array:
    """The matrix about the origin of a section whose own is about ``point`` (2,).

    A roll rate p about the origin moves the point by (-p z, p y).
    """
    carry = np.eye(3)
    carry[:2, 2] = -point[1], point[0]
    return np.asarray(carry.T @ matrix @ carry)


def as_ellipse(contour: Array, whole: SectionIntegrals) -> tuple[float, float, float] | None:
    """Semi-axes and the angle of the first from y, of the ellipse with the contour's area and second moments.

    None where a corner or the middle of a side lies further than 0.5 % from it, along the radius.
    """
    moments, axes = np.linalg.eigh(whole.second)
    if not moments[0] > 0.0:
        return None
    ratio = np.sqrt(moments[1] / moments[0])
    a, b = np.sqrt(whole.area * ratio / np.pi), np.sqrt(whole.area / ratio / np.pi)
    points = (contour - whole.centroid) @ axes
    for p in (points, (points + np.roll(points, -1, axis=0)) / 2.0):
        if np.max(np.abs(np.hypot(p[:, 1] / a, p[:, 0] / b) - 1.0)) > ELLIPSE_TOLERANCE:
            return None
    return float(a), float(b), float(np.arctan2(axes[1, 1], axes[0, 1]))


def as_rectangle(contour: Array, whole: SectionIntegrals) -> tuple[float, float, float] | None:
    """Half-sides and the angle of the first from y, of the rectangle that a contour is.

    None where it is more slender than 100 to 1, or a corner lies further than 1e-4 of its size from the rectangle of the
    same area and second moments, or the contour has another area than its corners.
    """
    size = float(np.ptp(contour, axis=0).max())
    side = np.roll(contour, -1, axis=0) - contour
    before = np.roll(side, 1, axis=0)
    bend = before[:, 0] * side[:, 1] - before[:, 1] * side[:, 0]
    corners = contour[
        np.abs(bend) > RECTANGLE_TOLERANCE * size * np.minimum(*(np.linalg.norm(v, axis=1) for v in (side, before)))
    ]
    if len(corners) != 4:
        return None
    one, two = corners[1] - corners[0], corners[2] - corners[1]
    a, b = float(np.linalg.norm(one)) / 2.0, float(np.linalg.norm(two)) / 2.0
    fourth = corners[0] + two - corners[3]
    square = (
        abs(one @ two) <= RECTANGLE_TOLERANCE * 4.0 * a * b and np.linalg.norm(fourth) <= RECTANGLE_TOLERANCE * size
    )
    full = abs(4.0 * a * b / whole.area - 1.0) <= RECTANGLE_TOLERANCE
    if not (square and full and max(a / b, b / a) <= SLENDEREST_RECTANGLE):
        return None
    return a, b, float(np.arctan2(one[1], one[0]))

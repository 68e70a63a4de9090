"""Sail and stern planes of DARPA SUBOFF: integrals of what stands outside the hull, and sections to loft a mesh from.

Source: Groves, Huang & Chang, DTRC/SHD-1298-01 (1989), Tables 2 and 3. All in feet, x aft of the nose. The hull comes in
as a function of x that returns R and R dR/dx.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Polynomial

from coeflab.kernels.axisymmetric import graded_nodes
from coeflab.kernels.brief import brief
from coeflab.kernels.least_squares import Array

Hull = Callable[[Array], tuple[Array, Array]]

SAIL_JOINTS = (3.032986, 3.333333, 3.358507, 3.559028, 4.241319)
SIDE_TOP, SAIL_FOOT = 1.507813, 0.6
HALF_THICKNESS = 0.109375
TRAILING_EDGE, TAPER, AXIS_CHORD = 13.146284, -0.466308, 0.88859
TIP, PLANE_FOOT = 5.0 / 6.0, 0.12
NODES, GRADING, ROUNDS = 48, 4, 32

_D = Polynomial([0.0, 1.0])
_FORE = (
    2.094759 * 2.0 * _D * (_D - 1.0) ** 4
    + 0.2071781 * _D**2 * (_D - 1.0) ** 3 / 3.0
    + 1.0
    - (_D - 1.0) ** 4 * (4.0 * _D + 1.0)
)
_AFTER = 2.238361 * _D * (_D - 1.0) ** 4 + 3.106529 * _D**2 * (_D - 1.0) ** 3 + 1.0 - (_D - 1.0) ** 4 * (4.0 * _D + 1.0)


@brief
@dataclass(frozen=True, slots=True)
class Appendage:
    """What an appendage adds to the hull, in feet.

    Attributes
    ----------
    volume : float
        Outside the hull.
    moment : (2,) array
        First moments of that volume: x aft of the nose, and height above the axis.
    surface : float
        Its own wetted surface.
    covered : float
        Surface of the hull that it hides.
    """

    volume: float
    moment: Array
    surface: float
    covered: float


def sail_half_thickness(x: Array) -> tuple[Array, Array]:
    """Half thickness b and b db/dx of the sail."""
    d, e = 3.072 * (x - SAIL_JOINTS[0]), (SAIL_JOINTS[4] - x) / 0.6822917
    fore = np.sqrt(np.clip(_FORE(d), 0.0, None)), _FORE.deriv()(d) * 3.072 / 2.0
    after = _AFTER(e), -_AFTER(e) * _AFTER.deriv()(e) / 0.6822917
    ahead, behind = x < SAIL_JOINTS[2], x > SAIL_JOINTS[3]
    share = np.where(ahead, fore[0], np.where(behind, after[0], 1.0))
    slope = np.where(ahead, fore[1], np.where(behind, after[1], 0.0))
    return HALF_THICKNESS * share, HALF_THICKNESS**2 * slope


def sail(hull: Hull) -> Appendage:
    """The sail: vertical sides on the hull, a cap of half an ellipse as high as a quarter of the local thickness."""
    volume, surface, covered, moment = 0.0, 0.0, 0.0, np.zeros(2)
    turn, turn_weight = graded_nodes(0.0, np.pi, NODES)
    for start, end in pairwise(SAIL_JOINTS):
        x, weight = graded_nodes(start, end, NODES, GRADING)
        (b, slope), (radius, radius_slope) = sail_half_thickness(x), hull(x)
        foot = np.sqrt(radius**2 - b**2)
        area = 2.0 * b * SIDE_TOP - b * foot - radius**2 * np.arcsin(b / radius) + np.pi * b**2 / 4.0
        lift = b * (SIDE_TOP**2 - radius**2) + b**3 / 3.0 + np.pi * b**2 / 4.0 * SIDE_TOP + b**3 / 6.0
        cap = np.sqrt((slope[:, None] / 2.0) ** 2 + b[:, None] ** 2 * (1.0 - 0.75 * np.cos(turn) ** 2)) @ turn_weight
        volume += float(weight @ area)
        moment += np.array([weight @ (area * x), weight @ lift])
        surface += float(weight @ (2.0 * (SIDE_TOP - foot) * np.hypot(b, slope) / b + cap))
        covered += float(weight @ (2.0 * np.arcsin(b / radius) * np.hypot(radius, radius_slope)))
    return Appendage(volume, moment, surface, covered)


def sail_sections(stations: int, levels: int, cap: int) -> Array:
    """(stations + 1, 2 levels + cap + 1, 3) closed loops x, y, height across the sail, from within the hull to its top."""
    x = SAIL_JOINTS[0] + (SAIL_JOINTS[4] - SAIL_JOINTS[0]) * _eased(stations)
    b, _ = sail_half_thickness(x)
    up, turn = np.linspace(SAIL_FOOT, SIDE_TOP, levels + 1), np.pi * np.arange(1, cap) / cap
    share = np.concatenate([np.ones(levels + 1), np.cos(turn), -np.ones(levels + 1)])
    rise = np.concatenate([np.zeros(levels + 1), np.sin(turn) / 2.0, np.zeros(levels + 1)])
    foot = np.concatenate([up, np.full(cap - 1, SIDE_TOP), up[::-1]])
    y, height = b[:, None] * share, foot + b[:, None] * rise
    return np.stack([np.broadcast_to(x[:, None], y.shape), y, height], axis=-1)


def _eased(count: int) -> Array:
    """From 0 to 1, dense at both ends, both exact."""
    out: Array = (1.0 - np.cos(np.pi * np.arange(count + 1) / count)) / 2.0
    out[[0, -1]] = 0.0, 1.0
    return out


def _half(q: Array) -> Array:
    """Half thickness over chord of the planes at a share q of the chord."""
    return 0.2969 * np.sqrt(q) - 0.126 * q - 0.3516 * q**2 + 0.2852 * q**3 - 0.1045 * q**4


def _half_slope(q: Array) -> Array:
    return 0.14845 / np.sqrt(q) - 0.126 - 0.7032 * q + 0.8556 * q**2 - 0.418 * q**3


def _chord(y: Array) -> Array:
    return TAPER * y + AXIS_CHORD


def _foot(hull: Hull, q: Array, share: Array) -> Array:
    """Distance from the axis at which a line along the span leaves the hull; share of the half thickness from -1 to 1."""
    half = _half(q)
    y = np.full(np.broadcast_shapes(q.shape, share.shape), TIP / 2.0)
    for _ in range(ROUNDS):
        radius, _ = hull(TRAILING_EDGE - _chord(y) * (1.0 - q))
        y = np.sqrt(radius**2 - (share * half * _chord(y)) ** 2)
    return y


def plane(hull: Hull) -> Appendage:
    """One stern plane; its moment counts x alone, since four of them balance about the axis.

    Integrals run along the span, from the hull's surface to the tip, in closed form for every share of the chord and of
    the thickness.
    """
    q, q_weight = graded_nodes(0.0, 1.0, NODES, GRADING)
    share, share_weight = graded_nodes(0.0, 1.0, NODES)
    half, slope = _half(q), _half_slope(q)
    tip, foot = _chord(np.array(TIP)), _chord(_foot(hull, q[:, None], share))
    second = (tip**3 - foot**3) / (3.0 * TAPER) @ share_weight
    third = (tip**4 - foot**4) / (4.0 * TAPER) @ share_weight
    volume = 2.0 * q_weight @ (half * second)
    along = 2.0 * q_weight @ (half * (TRAILING_EDGE * second - (1.0 - q) * third))
    edge = _chord(_foot(hull, q, np.ones_like(q)))
    stretch = np.sqrt(1.0 + slope**2 + TAPER**2 * (slope * (1.0 - q) + half) ** 2)
    sides = 2.0 * q_weight @ (stretch * (tip**2 - edge**2) / (2.0 * TAPER))
    flat = 2.0 * tip**2 * (q_weight @ half)
    return Appendage(float(volume), np.array([along, 0.0]), float(sides + flat), _covered(hull))


def _covered(hull: Hull) -> float:
    nose = TRAILING_EDGE - float(_chord(_foot(hull, np.zeros(1), np.zeros(1)))[0])
    x, weight = graded_nodes(nose, TRAILING_EDGE, NODES, GRADING)
    radius, radius_slope = hull(x)
    angle = np.zeros_like(x)
    for _ in range(ROUNDS):
        chord = _chord(radius * np.cos(angle))
        q = np.clip((x - TRAILING_EDGE) / chord + 1.0, 0.0, 1.0)
        angle = np.arcsin(chord * _half(q) / radius)
    return float(weight @ (2.0 * angle * np.hypot(radius, radius_slope)))


def plane_sections(stations: int, levels: int) -> Array:
    """(stations + 1, 2 levels + 3, 3) closed loops x, distance from the axis, thickness across one stern plane."""
    q = _eased(stations)
    half = np.zeros(stations + 1)
    half[1:-1] = _half(q[1:-1])
    span = np.linspace(PLANE_FOOT, TIP, levels + 1)
    y = np.concatenate([span, [TIP], span[::-1]])
    side = np.concatenate([np.ones(levels + 1), [0.0], -np.ones(levels + 1)])
    x = TRAILING_EDGE - _chord(y) * (1.0 - q[:, None])
    return np.stack([x, np.broadcast_to(y, x.shape), _chord(y) * half[:, None] * side], axis=-1)

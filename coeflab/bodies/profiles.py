"""Hulls of revolution by equations: Myring's and that of DARPA SUBOFF.

Myring: D. F. Myring, A theoretical study of body drag in subcritical axisymmetric flow, Aeronautical Quarterly 27 (1976),
in the form of T. Prestero, MIT thesis (2001), equations 2.1-2.3: lengths in m, and offsets where the tip of the nose and
the end of the tail are cut off.

SUBOFF: Groves, Huang & Chang, DTRC/SHD-1298-01 (1989), Table 1; feet, x aft of the nose.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Polynomial

from coeflab.bodies.closed_forms.revolution import graded_nodes
from coeflab.bodies.shape import Revolution, within_reach
from coeflab.core.declarations import Angle, Declaration, Length, Pure
from coeflab.core.errors import InputError
from coeflab.core.limits import LONGEST_PART
from coeflab.core.texts import input_error
from coeflab.core.types import Array

BLUNTEST, SHARPEST = 5.0, 0.5
FOOT = 0.3048
LARGEST_RADIUS = 5.0 / 6.0
BOW_END, MIDDLE_END, AFTERBODY_END, CAP_END = 3.333333, 10.645833, 13.979167, 14.291667
CAP_RADIUS, K0, K1 = 0.1175, 10.0, 44.6244
NODES, GRADING = 96, 4


@dataclass(frozen=True, slots=True)
class Myring(Declaration):
    """The parameters of a Myring hull; m and rad.

    Attributes
    ----------
    nose, middle, tail : float
        Full lengths a, b, c; the middle body may be absent.
    diameter : float
        d, of the middle body.
    exponent : float
        n of the nose: 2 is half an ellipse, more is blunter.
    tail_angle : float
        theta, between the axis and the tail where the full tail ends.
    nose_offset, tail_offset : float
        What is cut off of the full nose and tail; flat discs close the ends.

    Raises
    ------
    InputError
        A length not above zero, an offset that leaves nothing, an exponent out of bounds, or an angle whose tail has a
        negative radius or swells beyond the diameter.
    """

    nose: Length
    middle: Length
    tail: Length
    diameter: Length
    exponent: Pure
    tail_angle: Angle
    nose_offset: Length = 0.0
    tail_offset: Length = 0.0

    def __post_init__(self) -> None:
        for name in ("nose", "tail", "diameter"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{getattr(self, name):g} m", "a length above zero", column=name)
        within_reach("Myring hull", nose=self.nose, tail=self.tail, diameter=self.diameter)
        if not 0.0 <= self.middle <= LONGEST_PART:
            raise input_error("bodies.length_zero_more", column="middle", middle=self.middle, longest_part=LONGEST_PART)
        for name, whole in (("nose_offset", self.nose), ("tail_offset", self.tail)):
            if not 0.0 <= getattr(self, name) < whole:
                raise input_error("bodies.zero_more_less", column=name, getattr=getattr(self, name), whole=whole)
        if not SHARPEST <= self.exponent <= BLUNTEST:
            raise InputError(f"{self.exponent:g}", f"a number from {SHARPEST:g} to {BLUNTEST:g}", column="exponent")
        steepest = np.arctan(1.5 * self.diameter / self.tail)
        if self.tail_angle < 0.0:
            found = f"{np.degrees(self.tail_angle):.4g} deg, whose tail has a negative radius"
        elif self.tail_angle > steepest:
            found = f"{np.degrees(self.tail_angle):.4g} deg, whose tail swells beyond the diameter"
        else:
            return
        raise input_error("bodies.angle_deg_where", column="tail_angle", found=found, degrees=np.degrees(steepest))

    @property
    def joints(self) -> tuple[float, float, float, float]:
        """Nose, both ends of the middle body, and tail, m aft of the nose."""
        start = self.nose - self.nose_offset
        return 0.0, start, start + self.middle, start + self.middle + self.tail - self.tail_offset

    def profile(self, piece: int, x: Array) -> tuple[Array, Array]:
        """R and R dR/dx of a piece, 0 to 2, m, at x aft of the nose."""
        most = self.diameter / 2.0
        if piece == 1:
            return np.full_like(x, most), np.zeros_like(x)
        if piece == 0:
            tip = (x + self.nose_offset) / self.nose
            share, power = tip * (2.0 - tip), 2.0 / self.exponent
            with np.errstate(divide="ignore"):
                slope = power * share ** (power - 1.0) * (1.0 - tip) / self.nose
            return most * share ** (power / 2.0), most**2 * slope
        s = (x - self.joints[2]) / self.tail
        rise = self.tail * np.tan(self.tail_angle)
        radius = most - (1.5 * self.diameter - rise) * s**2 + (self.diameter - rise) * s**3
        slope = -2.0 * (1.5 * self.diameter - rise) * s + 3.0 * (self.diameter - rise) * s**2
        return radius, radius * slope / self.tail

    @property
    def flat_ends(self) -> float:
        """Area of the discs where nose and tail are cut off, m^2."""
        fore, _ = self.profile(0, np.zeros(1))
        aft, _ = self.profile(2, np.array([self.joints[3]]))
        return float(np.pi * (fore[0] ** 2 + aft[0] ** 2))

    def meridian(self) -> Revolution:
        """The hull by Gauss-Legendre stations, graded to the ends of each piece."""
        pieces = []
        for piece, (start, end) in enumerate(zip(self.joints[:-1], self.joints[1:])):
            if end > start:
                x, weight = graded_nodes(start, end, NODES, GRADING)
                pieces.append((x, weight, *self.profile(piece, x)))
        x, weight, radius, slope = (np.concatenate(column) for column in zip(*pieces, strict=True))
        return Revolution(-x, weight, np.clip(radius, 0.0, None), -slope, np.zeros(2), self.joints[-1])


_X = Polynomial([0.0, 1.0])
_BOW = (
    1.126395101 * _X * (0.3 * _X - 1.0) ** 4
    + 0.442874707 * _X**2 * (0.3 * _X - 1.0) ** 3
    + 1.0
    - (0.3 * _X - 1.0) ** 4 * (1.2 * _X + 1.0)
)
_R2, _RK = CAP_RADIUS**2, CAP_RADIUS * K0
_AFTERBODY = Polynomial(
    [
        _R2,
        0.0,
        _RK,
        20.0 - 20.0 * _R2 - 4.0 * _RK - K1 / 3.0,
        -45.0 + 45.0 * _R2 + 6.0 * _RK + K1,
        36.0 - 36.0 * _R2 - 4.0 * _RK - K1,
        -10.0 + 10.0 * _R2 + _RK + K1 / 3.0,
    ]
)(Polynomial([AFTERBODY_END / 3.333333, -1.0 / 3.333333]))
_CAP = _R2 * (1.0 - Polynomial([-44.733333, 3.2]) ** 2)


def _bow(x: Array) -> tuple[Array, Array]:
    """(R/Rmax)^2 and half its slope; the power 1/2.1 makes the slope infinite at the nose itself."""
    p = np.clip(_BOW(x), 0.0, None)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = np.where(p > 0.0, p ** (1.0 / 1.05 - 1.0) * _BOW.deriv()(x) / 2.1, np.inf)
    return p ** (1.0 / 1.05), half


def _piece(x: Array, end: float) -> tuple[Array, Array]:
    if end == BOW_END:
        return _bow(x)
    square = {MIDDLE_END: Polynomial([1.0]), AFTERBODY_END: _AFTERBODY, CAP_END: _CAP}[end]
    return np.clip(square(x), 0.0, None), square.deriv()(x) / 2.0


def suboff_profile(x: Array) -> tuple[Array, Array]:
    """R and R dR/dx at stations within the hull, ft."""
    ends = (BOW_END, MIDDLE_END, AFTERBODY_END, CAP_END)
    square, half = np.empty_like(x), np.empty_like(x)
    for k, end in enumerate(ends):
        here = np.searchsorted(ends, x).clip(max=3) == k
        square[here], half[here] = _piece(x[here], end)
    return LARGEST_RADIUS * np.sqrt(square), LARGEST_RADIUS**2 * half


def suboff_meridian(nodes: int = NODES) -> Revolution:
    """The hull of SUBOFF by Gauss-Legendre stations, ``nodes`` on each of the four pieces, graded to the ends of each."""
    joints = (0.0, BOW_END, MIDDLE_END, AFTERBODY_END, CAP_END)
    pieces = []
    for start, end in pairwise(joints):
        stations, weights = graded_nodes(start, end, nodes, GRADING)
        pieces.append((stations, weights, *_piece(stations, end)))
    x, weight, square, half = (np.concatenate(column) for column in zip(*pieces, strict=True))
    return Revolution(
        x=-FOOT * x,
        weight=FOOT * weight,
        radius=FOOT * LARGEST_RADIUS * np.sqrt(square),
        radius_slope=-FOOT * LARGEST_RADIUS**2 * half,
        axis=np.zeros(2),
        length=FOOT * CAP_END,
    )

"""Myring hulls: a round nose of exponent n, a parallel middle body, and a cubic tail that ends in an angle.

Source: D. F. Myring, A theoretical study of body drag in subcritical axisymmetric flow, Aeronautical Quarterly 27 (1976),
in the form of T. Prestero, MIT thesis (2001), equations 2.1-2.3: lengths in m, and offsets where the tip of the nose and
the end of the tail are cut off.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from coeflab.bodies.body import Body, Configuration, ShapedBodyFile
from coeflab.bodies.closed_forms import graded_nodes
from coeflab.bodies.pieces import hull_piece
from coeflab.bodies.shape import Revolution, within_reach
from coeflab.core.declarations import Angle, Declaration, Length, Pure, declared
from coeflab.core.errors import InputError
from coeflab.core.limits import LONGEST_PART
from coeflab.core.text.toml import read_toml
from coeflab.core.types import Array

summary = "a Myring hull from the lengths of nose, middle body and tail, diameter, exponent and tail angle"
citations = ("myring1976", "prestero2001")
NODES, GRADING = 96, 4
BLUNTEST, SHARPEST = 5.0, 0.5


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
            raise InputError(
                f"{self.middle:g} m", f"a length of zero or more, at most {LONGEST_PART:g} m", column="middle"
            )
        for name, whole in (("nose_offset", self.nose), ("tail_offset", self.tail)):
            if not 0.0 <= getattr(self, name) < whole:
                raise InputError(
                    f"{getattr(self, name):g} m",
                    f"zero or more, and less than {whole:g} m, the full length",
                    column=name,
                )
        if not SHARPEST <= self.exponent <= BLUNTEST:
            raise InputError(f"{self.exponent:g}", f"a number from {SHARPEST:g} to {BLUNTEST:g}", column="exponent")
        steepest = np.arctan(1.5 * self.diameter / self.tail)
        if self.tail_angle < 0.0:
            found = f"{np.degrees(self.tail_angle):.4g} deg, whose tail has a negative radius"
        elif self.tail_angle > steepest:
            found = f"{np.degrees(self.tail_angle):.4g} deg, whose tail swells beyond the diameter"
        else:
            return
        raise InputError(
            found,
            f"an angle from 0 to {np.degrees(steepest):.4g} deg, where tan(angle) is 3 diameters over 2 tails",
            column="tail_angle",
        )

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


@dataclass(frozen=True, slots=True, kw_only=True)
class File(ShapedBodyFile):
    """A body.toml whose shape is a Myring hull.

    Attributes
    ----------
    hull : table
        Parameters of the hull.
    """

    reader: ClassVar[str] = "myring"
    hull: Myring


def read(path: Path) -> Body:
    """Read a body.toml whose ``[hull]`` gives nose, middle, tail, diameter, exponent, tail_angle and offsets.

    Raises
    ------
    InputError
        Everything missing, unknown, of the wrong unit or out of bounds, by file, line and key.
    """
    file = declared(File, read_toml(path))
    hull = file.hull.meridian()
    computed = Configuration(
        name="by_equations",
        title="integrals of the equations",
        volume=hull.volume,
        wetted_surface=hull.integrals.wetted_surface + file.hull.flat_ends,
        centre_of_buoyancy=hull.centre_of_volume,
        mass=None,
    )
    whole = hull_piece(hull, hull.integrals.wetted_surface + file.hull.flat_ends, -file.hull.joints[2])
    return file.shaped(path, hull, computed, (whole,))

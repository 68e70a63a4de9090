"""Thrusters as a body.toml states them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from coeflab.bodies.pieces import Direction
from coeflab.bodies.wageningen import AREAS, BLADES, PITCHES, thrust_over_speed
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.types import Array, brief, locked


@brief
@dataclass(frozen=True, slots=True)
class Screw:
    """The propeller of a thruster.

    Attributes
    ----------
    diameter : float
        m.
    blades : int
    pitch_ratio, area_ratio : float
        P/D, and expanded blade area over the disc's, A_E/A_0.
    highest_rpm : float, optional
        Speed of rotation up to which the Wageningen B-series gives its thrust.
    """

    diameter: float
    blades: int
    pitch_ratio: float
    area_ratio: float
    highest_rpm: float | None = None


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Thruster:
    """A thruster as its body.toml states it.

    Attributes
    ----------
    name : str
    place : (3,) array
        m, FRD, from the datum.
    axis : (3,) array
        Of positive thrust, a unit vector, FRD.
    curve : (n, 2) array or None
        Commands, rising, and thrusts, N; straight lines between. None where the Wageningen B-series gives them.
    command, unit : str
        What is commanded, and its unit.
    screw : Screw, optional
    """

    name: str
    place: Array
    axis: Array
    curve: Array | None
    command: str
    unit: str
    screw: Screw | None = None

    def __post_init__(self) -> None:
        for name in ("place", "axis", "curve"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))

    def thrusts(self, ahead: float, density: float) -> Array:
        """(n, 2) commands and thrusts, N: as stated, else of the series at a speed ahead without a wake.

        Parameters
        ----------
        ahead, density : float
            m/s, kg/m^3.

        Raises
        ------
        InputError
            Neither a curve nor a propeller with a highest speed of rotation, or one that gives no thrust there.
        """
        if self.curve is not None:
            return self.curve
        s = self.screw
        if s is None or s.highest_rpm is None:
            raise InputError(f"{self.name} without a curve", "a curve, or a propeller with highest_rpm", column="curve")
        inflow = ahead * float(self.axis[0])
        made = thrust_over_speed(
            s.diameter, s.pitch_ratio, s.area_ratio, s.blades, s.highest_rpm / 60.0, inflow, density
        )
        return np.asarray(made * np.array([60.0, 1.0]))


CURVE = takes.numbers(2, "none", "a point [command, thrust in N]")
FEWEST = 2


def _blades(value: Any, _file: Path) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not BLADES[0] <= value <= BLADES[1]:
        raise InputError(shown(value), f"a whole number from {BLADES[0]} to {BLADES[1]}")
    return value


def _curve(value: Any, file: Path) -> Array:
    if not isinstance(value, list) or len(value) < FEWEST:
        raise InputError(shown(value), "two points [command, thrust in N] or more")
    points = np.array([CURVE.read(point, file) for point in value])
    if np.any(np.diff(points[:, 0]) <= 0.0) or np.any(np.diff(points[:, 1]) < 0.0):
        raise InputError(shown(value), "rising commands, and thrusts that do not fall")
    return points


@dataclass(frozen=True, slots=True, kw_only=True)
class PropellerKeys(takes.Declaration):
    """The propeller of a thruster.

    Attributes
    ----------
    diameter : float
        m.
    blades : int
        2 to 7.
    pitch_ratio : float
        P/D, 0.5 to 1.4.
    area_ratio : float
        Expanded blade area over the disc's, A_E/A_0, 0.30 to 1.05.
    highest_rpm : float
        Of a thruster without a curve: up to there the Wageningen B-series gives it, at the vehicle's speed, without a wake.
    """

    diameter: takes.Length
    blades: Annotated[
        int,
        takes.Takes("a number of blades", _blades, {"type": "integer", "minimum": BLADES[0], "maximum": BLADES[1]}),
    ]
    pitch_ratio: takes.Pure
    area_ratio: takes.Pure
    highest_rpm: takes.Pure | None = None

    def check(self) -> None:
        """It has a size, and is of the series."""
        if not self.diameter > 0.0:
            raise InputError(f"{self.diameter:g} m", "a diameter above zero", column="diameter")
        if self.highest_rpm is not None and not self.highest_rpm > 0.0:
            raise InputError(f"{self.highest_rpm:g} rpm", "a speed of rotation above zero", column="highest_rpm")
        for name, (low, high) in (("pitch_ratio", PITCHES), ("area_ratio", AREAS)):
            value = getattr(self, name)
            if not low <= value <= high:
                raise InputError(f"{value:g}", f"{low:g} to {high:g}, as the Wageningen B-series has it", column=name)

    @property
    def made(self) -> Screw:
        """The same as a noun."""
        return Screw(self.diameter, self.blades, self.pitch_ratio, self.area_ratio, self.highest_rpm)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ThrusterKeys(takes.Declaration):
    """A thruster.

    Attributes
    ----------
    name : str
        What commands call it.
    place : (3,) array
        [x, y, z], m, FRD, from the datum.
    axis : (3,) tuple
        Of positive thrust, [x, y, z], FRD: [1, 0, 0] drives ahead.
    curve : (n, 2) array
        Points [command, thrust in N], straight lines between; as measured or as the maker states them.
    command, unit : str
        What is commanded, and its unit; ``speed`` in ``rpm`` unless given.
    propeller : table
        An open one along x has an estimate of its force across, and may give the curve.
    """

    name: takes.Text
    place: takes.Point
    axis: Direction
    curve: Annotated[
        Array,
        takes.Takes(
            "points [command, thrust in N]", _curve,
            {"type": "array", "items": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}, "minItems": 2},
        ),
    ] | None = None  # fmt: skip
    command: takes.Text = "speed"
    unit: takes.Text = "rpm"
    propeller: PropellerKeys | None = None

    def check(self) -> None:
        """It pushes somewhere, and one thing gives its thrust."""
        if not np.linalg.norm(self.axis) > 0.0:
            raise InputError("an axis without a direction", "[x, y, z], one of them not zero", column="axis")
        by_series = self.propeller is not None and self.propeller.highest_rpm is not None
        if self.curve is None and not by_series:
            advice = "Without one: propeller with diameter, blades, pitch_ratio, area_ratio and highest_rpm."
            raise InputError("no curve", "points [command, thrust in N]", column="curve", advice=advice)
        if not by_series:
            return
        if self.curve is not None:
            raise InputError("both curve and highest_rpm", "one of them", column="propeller.highest_rpm")
        if (self.command, self.unit) != ("speed", "rpm"):
            raise InputError(f"{self.command} in {self.unit}", "speed in rpm, with highest_rpm", column="unit")
        if not self.axis[0] > 0.0:
            raise InputError("no thrust ahead", "an axis that points ahead, with highest_rpm", column="axis")

    @property
    def made(self) -> Thruster:
        """With an axis of length one."""
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        screw = None if self.propeller is None else self.propeller.made
        return Thruster(self.name, self.place, axis, self.curve, self.command, self.unit, screw)

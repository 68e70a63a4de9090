"""The keys of thrusters in a body.toml."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from coeflab.bodies.pieces import Direction
from coeflab.bodies.thrusters import FULL, Screw, Squares, Thruster, bollard_squares
from coeflab.bodies.wageningen import AREAS, BLADES, PITCHES
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array

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


def _open_water(value: Any, file: Path) -> Array:
    rows = value if isinstance(value, list) else []
    widths = {len(r) if isinstance(r, list) else 0 for r in rows}
    if len(rows) < FEWEST or widths not in ({FEWEST}, {FULL}):
        raise InputError(shown(value), "two points [J, K_T] or more, or all of them [J, K_T, K_Q]")
    points = np.array([takes.numbers(widths.copy().pop(), "none", "numbers").read(r, file) for r in rows])
    if points[0, 0] != 0.0 or np.any(np.diff(points[:, 0]) <= 0.0):
        raise InputError(shown(value), "J that rises from 0")
    if np.any(points[:-1, 1:] <= 0.0) or points[-1, 1] < 0.0 or np.any(np.diff(points[:, 1]) >= 0.0):
        raise InputError(shown(value), "K_T and K_Q above zero, K_T falling, to the last point at most to zero")
    return points


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
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
        Of a thruster without a curve: up to there open water gives it, at the vehicle's speed, without a wake.
    open_water : (n, 2) or (n, 3) array
        Points [J, K_T] or [J, K_T, K_Q] of this propeller, J = V/(n D) from 0; the Wageningen B-series unless given.
    """

    diameter: takes.Length
    blades: Annotated[
        int, takes.Takes("a number of blades", _blades, {"type": "integer", "minimum": BLADES[0], "maximum": BLADES[1]})
    ]
    pitch_ratio: takes.Pure
    area_ratio: takes.Pure
    highest_rpm: takes.Pure | None = None
    open_water: Annotated[
        Array,
        takes.Takes(
            "points [J, K_T] or [J, K_T, K_Q]", _open_water,
            {"type": "array", "items": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 3}, "minItems": 2},
        ),
    ] | None = None  # fmt: skip

    def check(self) -> None:
        """It has a size, and is of the series; open water has a highest speed of rotation."""
        if self.open_water is not None and self.highest_rpm is None:
            raise InputError("open_water without highest_rpm", "both", column="highest_rpm")
        if not self.diameter > 0.0:
            raise InputError(f"{self.diameter:g} m", "a diameter above zero", column="diameter")
        if self.highest_rpm is not None and not self.highest_rpm > 0.0:
            raise InputError(f"{self.highest_rpm:g} rpm", "a speed of rotation above zero", column="highest_rpm")
        for name, (low, high) in (("pitch_ratio", PITCHES), ("area_ratio", AREAS)):
            value = getattr(self, name)
            if not low <= value <= high:
                raise InputError(f"{value:g}", f"{low:g} to {high:g}, as the Wageningen B-series has it", column=name)

    @property
    def built(self) -> Screw:
        """The same as a noun."""
        return Screw(self.diameter, self.blades, self.pitch_ratio, self.area_ratio, self.highest_rpm, self.open_water)


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
    bollard : float
        Thrust at rest at the command ``rate``, N or "60 N", in the place of a curve: it goes with the square of the command.
    rate : float
        The highest command, in ``unit``.
    bollard_astern : float
        Pull at ``-rate``; 0: no reverse. As ahead unless given. The torque astern is in the same ratio to that ahead.
    dead_zone : float
        Commands below it give nothing.
    torque : float
        Of the water on the rotor at ``rate``, N m; astern below zero, by the ratio of the pulls.
    handedness : int
        1 or -1: sign of the reaction about the axis.
    tilt_axis : (3,) tuple
        [x, y, z], FRD, that the axis turns about, right-handed.
    tilt_limit : float
        Largest tilt either way, "30 deg".
    lag : float
        Time constant, "0.2 s", in which the rotor goes to its command; at once unless given.
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
    bollard: takes.Force | None = None
    rate: takes.Pure | None = None
    bollard_astern: takes.Force | None = None
    dead_zone: takes.Pure | None = None
    torque: takes.Moment | None = None
    handedness: takes.Pure | None = None
    tilt_axis: Direction | None = None
    tilt_limit: takes.Angle | None = None
    lag: takes.Time | None = None

    def check(self) -> None:
        """It pushes somewhere, and one thing gives its thrust."""
        if not np.linalg.norm(self.axis) > 0.0:
            raise InputError("an axis without a direction", "[x, y, z], one of them not zero", column="axis")
        self._pulls()
        if self.bollard is not None:
            return
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

    def _pulls(self) -> None:
        """A bollard pull has its rate, a tilt its axis."""
        needs = {
            "rate": self.rate,
            "bollard_astern": self.bollard_astern,
            "dead_zone": self.dead_zone,
            "torque": self.torque,
        }
        if self.bollard is None:
            if stray := [k for k, v in needs.items() if v is not None]:
                raise InputError(f"{stray[0]} without bollard", 'bollard = "60 N"', column=stray[0])
        else:
            if self.curve is not None or (self.propeller is not None and self.propeller.highest_rpm is not None):
                raise InputError("bollard beside another curve", "one of them", column="bollard")
            if not self.bollard > 0.0:
                raise InputError(f"{self.bollard:g} N", "a pull above zero", column="bollard")
            if self.rate is None or not self.rate > 0.0:
                raise InputError(
                    "no rate" if self.rate is None else f"{self.rate:g}",
                    f"the command at that pull, in {self.unit}",
                    column="rate",
                )
            if not 0.0 <= (self.dead_zone or 0.0) < self.rate:
                raise InputError(f"{self.dead_zone:g}", f"0 to {self.rate:g}", column="dead_zone")
            for name in ("bollard_astern", "torque"):
                if (value := getattr(self, name)) is not None and value < 0.0:
                    raise InputError(f"{value:g}", "zero or more", column=name)
        if self.handedness not in (None, 1.0, -1.0):
            raise InputError(f"{self.handedness:g}", "1 or -1", column="handedness")
        if self.lag is not None and not self.lag > 0.0:
            raise InputError(f"{self.lag:g} s", "a time constant above zero", column="lag")
        if (self.tilt_axis is None) != (self.tilt_limit is None):
            raise input_error("bodies.one_them", column="tilt_axis" if self.tilt_axis is None else "tilt_limit")
        if self.tilt_axis is not None and not np.linalg.norm(self.tilt_axis) > 0.0:
            raise InputError("an axis without a direction", "[x, y, z], one of them not zero", column="tilt_axis")

    @property
    def built(self) -> Thruster:
        """With axes of length one."""
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        screw = None if self.propeller is None else self.propeller.built
        squares: tuple[Squares, ...] = ()
        torque: tuple[Squares, ...] = ()
        if self.bollard is not None and self.rate is not None:
            squares = bollard_squares(self.bollard, self.rate, self.dead_zone or 0.0, self.bollard_astern)
            share = 1.0 if self.bollard_astern is None else self.bollard_astern / self.bollard
            if self.torque:
                torque = bollard_squares(self.torque, self.rate, self.dead_zone or 0.0, share * self.torque)
        tilting = None if self.tilt_axis is None else np.asarray(self.tilt_axis) / np.linalg.norm(self.tilt_axis)
        limit = self.tilt_limit or 0.0
        return Thruster(
            self.name, self.place, axis, self.curve, self.command, self.unit, screw, squares, torque,
            -1 if self.handedness == -1.0 else 1, tilting, (-limit, limit), self.lag,
        )  # fmt: skip

"""Thrusters as a body.toml states them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np

from coeflab.bodies.pieces import Direction
from coeflab.bodies.wageningen import AREAS, BLADES, PITCHES, over_speed, thrust_over_speed
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locked


@brief
@dataclass(frozen=True, slots=True, eq=False)
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
        Speed of rotation up to which its open water gives its thrust.
    measured : (n, 2) or (n, 3) array, optional
        Its own open water, J, K_T and K_Q; None: that of the Wageningen B-series.
    """

    diameter: float
    blades: int
    pitch_ratio: float
    area_ratio: float
    highest_rpm: float | None = None
    measured: Array | None = None


@brief
@dataclass(frozen=True, slots=True)
class Squares:
    """A force with the square of a command between two commands of one sign.

    Attributes
    ----------
    low, high : float
    per_square : float
        N or N m by the square of the command, below zero for commands astern.
    """

    low: float
    high: float
    per_square: float

    def at(self, command: float) -> float:
        """The value; zero outside."""
        return self.per_square * command**2 if self.low <= command <= self.high else 0.0


def bollard_squares(
    ahead: float, rate: float, dead_zone: float = 0.0, astern: float | None = None
) -> tuple[Squares, ...]:
    """Thrust n|n| through a bollard pull at a rate; nothing in the dead zone, as between propellers that rest.

    Parameters
    ----------
    ahead : float
        N at ``rate``.
    rate : float
        The highest command, either way.
    dead_zone : float
        Commands below it give nothing.
    astern : float, optional
        N at ``-rate``, above zero; zero: no reverse; None: as ahead.

    Examples
    --------
    >>> [s.at(360.0) for s in bollard_squares(60.0, 720.0)]
    [0.0, 15.0]
    """
    back = ahead if astern is None else astern
    result = [Squares(-rate, -dead_zone, -back / rate**2)] if back > 0.0 else []
    if not result and dead_zone > 0.0:
        result = [Squares(0.0, dead_zone, 0.0)]  # a curve holds the end of its first segment below it
    return (*result, Squares(dead_zone, rate, ahead / rate**2))


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
    squares : tuple of Squares
        Thrust with the square of the command, in the place of a curve.
    torque : tuple of Squares
        Of the water on the rotor, N m; empty where it is not known.
    handedness : {-1, 1}
    tilt_axis : (3,) array or None
        What the axis turns about, of length one, FRD.
    tilt : (float, float)
        Lowest and highest, rad.
    lag : float or None
        Time constant from the command to what the rotor does, s.
    """

    name: str
    place: Array
    axis: Array
    curve: Array | None
    command: str
    unit: str
    screw: Screw | None = None
    squares: tuple[Squares, ...] = ()
    torque: tuple[Squares, ...] = ()
    handedness: Literal[-1, 1] = 1
    tilt_axis: Array | None = None
    tilt: tuple[float, float] = (0.0, 0.0)
    lag: float | None = None

    def __post_init__(self) -> None:
        for name in ("place", "axis", "curve", "tilt_axis"):
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
        if self.squares:
            points = np.unique(np.concatenate([np.linspace(s.low, s.high, POINTS) for s in self.squares]))
            return np.column_stack([points, [sum(s.at(float(n)) for s in self.squares) for n in points]])
        s = self.screw
        if s is None or s.highest_rpm is None:
            raise InputError(f"{self.name} without a curve", "a curve, or a propeller with highest_rpm", column="curve")
        if s.measured is not None:
            result = self._measured(s, s.measured, 1, ahead, density)
            return np.column_stack([result[:, 0], np.maximum.accumulate(result[:, 1])])
        inflow = ahead * float(self.axis[0])
        result = thrust_over_speed(
            s.diameter, s.pitch_ratio, s.area_ratio, s.blades, s.highest_rpm / 60.0, inflow, density
        )
        return np.asarray(result * np.array([60.0, 1.0]))

    def torques(self, ahead: float, density: float) -> Array | None:
        """(n, 2) commands and torques of the water on the rotor, N m, by its own open water; None where that has no K_Q."""
        s = self.screw
        if self.curve is not None or self.squares or s is None or s.measured is None or s.measured.shape[1] < FULL:
            return None
        return self._measured(s, s.measured, 2, ahead, density)

    def _measured(self, s: Screw, points: Array, column: int, ahead: float, density: float) -> Array:
        """Commands in rpm, and K_T rho n^2 D^4 or K_Q rho n^2 D^5 with straight lines between the points."""
        scale = density * s.diameter ** (3 + column)
        result = over_speed(
            lambda j, n: np.interp(j, points[:, 0], points[:, column]) * scale * n**2, float(points[-1, 0]), s.diameter,
            (s.highest_rpm or 0.0) / 60.0, ahead * float(self.axis[0]),
        )  # fmt: skip
        return np.asarray(result * np.array([60.0, 1.0]))


CURVE = takes.numbers(2, "none", "a point [command, thrust in N]")
FEWEST, POINTS, FULL = 2, 17, 3


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

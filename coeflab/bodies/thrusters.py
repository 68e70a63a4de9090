"""Thrusters of a body: thrust and torque over what is commanded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from coeflab.bodies.wageningen import over_speed, thrust_over_speed
from coeflab.core.errors import InputError
from coeflab.core.types import Array, brief, locked

POINTS = 17  # of a curve over each square
FULL = 3  # columns of open water with K_Q


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

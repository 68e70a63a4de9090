"""A manoeuvre as phases of constant orders, and the figures that are read off it.

A manoeuvre of a parameter file, as it was asked for and as it came out.

Reading figures off a motion that is known at times: crossings, values in between, extremes, periods.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from coeflab.core.types import Array, brief, locked
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.inertia import MEASURED

Quantity = Literal["heading", "yaw_rate", "pitch", "pitch_rate", "roll", "roll_rate", "depth", "u", "speed", "turned"]
QUANTITIES: dict[Quantity, str] = {
    "heading": "rad",
    "yaw_rate": "rad/s",
    "pitch": "rad",
    "pitch_rate": "rad/s",
    "roll": "rad",
    "roll_rate": "rad/s",
    "depth": "m",
    "u": "m/s",
    "speed": "m/s",
    "turned": "rad",
}
UPRIGHT = (1.0, 0.0, 0.0, 0.0)


@brief
@dataclass(frozen=True, slots=True)
class Until:
    """A phase ends when a quantity crosses a value, rising or falling.

    Attributes
    ----------
    quantity : str
        One of `QUANTITIES`; heading is counted from the start, not wrapped, and turned is its size, to either side.
    rises : bool
        Whether it crosses from below.
    value : float
    """

    quantity: Quantity
    rises: bool
    value: float


@brief
@dataclass(frozen=True, slots=True)
class Phase:
    """Orders that stand until something happens.

    Attributes
    ----------
    name : str
    orders : mapping of str to float
        Control angle (``dr``, rad), thruster (command) or ``thruster.tilt`` (rad); what is not named stays as it was.
    longest : float
        The phase ends after this time at the latest, s.
    until : Until or None
    """

    name: str
    orders: Mapping[str, float]
    longest: float
    until: Until | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "orders", MappingProxyType(dict(self.orders)))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Manoeuvre:
    """Where it starts, and what is ordered.

    Attributes
    ----------
    name : str
    phases : tuple of Phase
    velocity : (6,) array
        u v w p q r at the start.
    attitude : (4,) array
        Unit quaternion at the start.
    orders : mapping of str to float
        Orders that stand at the start.
    statements : tuple of str
    """

    name: str
    phases: tuple[Phase, ...]
    velocity: Array
    attitude: Array = field(default_factory=lambda: np.array(UPRIGHT))
    orders: Mapping[str, float] = field(default_factory=dict)
    statements: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("velocity", "attitude"):
            object.__setattr__(self, name, locked(getattr(self, name)))
        object.__setattr__(self, "orders", MappingProxyType(dict(self.orders)))

    @property
    def duration(self) -> float:
        """Longest time that it can take, s."""
        return sum(p.longest for p in self.phases)


@dataclass(frozen=True, slots=True)
class Figure:
    """A number that a manoeuvre is known by.

    Attributes
    ----------
    name : str
        ITTC or IMO term, for example ``tactical diameter``.
    value : float or None
        None where the motion does not show it.
    unit : str
    definition : str
        One line, with its source.
    status : str
        ``ok``, ``not reached``, ``not determined`` and the like.
    why : str
        In words, where the status is not ok or the figure leans on motions that no data cover.
    low, high : float or None
        95 % interval from the uncertainty of the coefficients, where it was computed.
    """

    name: str
    value: float | None
    unit: str
    definition: str
    status: str = "ok"
    why: str = ""
    low: float | None = None
    high: float | None = None


@brief
@dataclass(frozen=True, slots=True)
class Simulation:
    """What was asked and what came out.

    Attributes
    ----------
    vehicle : Vehicle
    manoeuvre : Manoeuvre
    trajectory : Trajectory
    figures : tuple of Figure
    statements : tuple of str
        Assumptions of vehicle, manoeuvre and motion.
    determined : float
        Time from which on the motion leans on terms that no data give, s; infinite where it never does.
    citations : tuple of str
        Works that the manoeuvre and the simulator rest on.
    undetermined : str
        Why the file determines nothing of the motion, from its first instant; empty where it determines its beginning.
    """

    vehicle: Vehicle
    manoeuvre: Manoeuvre
    trajectory: Trajectory
    figures: tuple[Figure, ...]
    statements: tuple[str, ...]
    determined: float = inf
    citations: tuple[str, ...] = ()
    undetermined: str = ""


def crossing(time: Array, values: Array, level: float, rises: bool, after: float = -np.inf) -> float | None:
    """First time after ``after`` at which values pass a level in the stated direction, linear between rows; None if never.

    A row that lies on the level counts as passed.
    """
    signed = (values - level) if rises else (level - values)
    found = np.flatnonzero((signed[:-1] < 0.0) & (signed[1:] >= 0.0) & (time[1:] > after))
    if not len(found):
        return None
    i = int(found[0])
    share = signed[i] / (signed[i] - signed[i + 1])
    return float(time[i] + share * (time[i + 1] - time[i]))


def value_at(time: Array, values: Array, when: float) -> float:
    """Value at a time, linear between rows."""
    return float(np.interp(when, time, values))


def extreme(
    time: Array, values: Array, largest: bool, after: float, before: float = np.inf
) -> tuple[float, float] | None:
    """Time and value of the first local maximum (or minimum) between two times, by a parabola through three rows.

    None where the values have none there.
    """
    v = values if largest else -values
    inner = np.arange(1, len(v) - 1)
    peak = (v[inner] >= v[inner - 1]) & (v[inner] > v[inner + 1]) & (time[inner] > after) & (time[inner] < before)
    if not np.any(peak):
        return None
    i = int(inner[peak][0])
    t, y = time[i - 1 : i + 2] - time[i], v[i - 1 : i + 2]
    a, b, _ = np.linalg.solve(np.column_stack([t**2, t, np.ones(3)]), y)
    shift = float(np.clip(-b / (2.0 * a), t[0], t[2])) if a < 0.0 else 0.0
    height = float(y[1] + b * shift + a * shift**2)
    return float(time[i] + shift), height if largest else -height


def settled(time: Array, values: Array, window: float, tolerance: float) -> float | None:
    """Mean of the last ``window`` seconds if the values stay within ``tolerance`` of it, otherwise None."""
    last = time >= time[-1] - window
    if time[-1] - time[0] < window or np.count_nonzero(last) < 3:
        return None
    mean = float(np.mean(values[last]))
    return mean if float(np.max(np.abs(values[last] - mean))) <= tolerance else None


def decay(time: Array, values: Array) -> tuple[float, float] | None:
    """Period and damping ratio of a free decay about whatever the values settle at, from successive extremes of both signs.

    The logarithmic decrement is the slope of the logarithms of the swings from one extreme to the next, which hold no
    value of rest (ITTC 7.5-02-07-04.5, double amplitudes). None where there are fewer than three extremes.
    """
    found = extremes(time, values)
    if len(found) < 3:
        return None
    times, heights = found.T
    swings = np.abs(np.diff(heights))
    period = 2.0 * float(np.polyfit(np.arange(len(times)), times, 1)[0])
    decrement = -2.0 * float(np.polyfit(np.arange(len(swings)), np.log(swings), 1)[0])
    return period, decrement / float(np.hypot(2.0 * np.pi, decrement))


def extremes(time: Array, values: Array) -> Array:
    """(k, 2) times and values of successive maxima and minima, until a swing is a millionth of the first."""
    found: list[tuple[float, float]] = []
    moved = np.flatnonzero(values != values[0])
    largest = bool(len(moved)) and bool(values[moved[0]] > values[0])
    while (one := extreme(time, values, largest, found[-1][0] if found else float(time[0]))) is not None:
        if len(found) > 1 and abs(one[1] - found[-1][1]) < 1e-6 * abs(found[1][1] - found[0][1]):
            break
        found.append(one)
        largest = not largest
    return np.array(found).reshape(-1, 2)


@brief
@dataclass(frozen=True, slots=True)
class PlannedManoeuvre:
    """One ``[[manoeuvre]]``: a parameter file of the study, the manoeuvre's name and its options.

    Attributes
    ----------
    parameter_file, name : str
    options : mapping
    accelerations : {"measured", "computed"}
    file : Path or None
        The plan's, for messages.
    place : str
        The table in it.
    """

    parameter_file: str
    name: str
    options: Mapping[str, Any] = field(default_factory=dict)
    accelerations: str = MEASURED
    file: Path | None = None
    place: str = "manoeuvre"

    def key(self, name: str) -> str:
        """Dotted name of a key."""
        return f"{self.place}.{name}"

"""A manoeuvre as phases of constant orders, as it was asked for and as it came out, with the figures that are read off it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from math import inf
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from coeflab.core.cards import html_by
from coeflab.core.types import Array, dataclass, in_angles, locking
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
    medium : int
        Of the manoeuvre's media: 0 is that of the vehicle itself, 1 the first of ``others``.
    """

    name: str
    orders: Mapping[str, float]
    longest: float
    until: Until | None = None
    medium: int = 0

    def __post_init__(self) -> None:
        object.__setattr__(self, "orders", MappingProxyType(dict(self.orders)))


@dataclass(frozen=True, slots=True, eq=False)
@locking("velocity attitude")
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
    others : tuple of Vehicle
        The same craft in other media, by their parameter files; see `coeflab.motion.media`.
    surface : float
        Depth of the surface between the media from the start, m, positive down.
    """

    name: str
    phases: tuple[Phase, ...]
    velocity: Array
    attitude: Array = field(default_factory=lambda: np.array(UPRIGHT))
    orders: Mapping[str, float] = field(default_factory=dict)
    statements: tuple[str, ...] = ()
    others: tuple[Vehicle, ...] = ()
    surface: float = 0.0

    def __post_init__(self) -> None:
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
        95 % interval from the uncertainty of the coefficients; None where no draws were asked for: ``draws=200`` of
        `coeflab.simulate`, or `coeflab uncertainty`. Where draws gave no interval, ``why`` says the reason.
    """

    name: str
    value: float | None
    unit: str
    definition: str
    status: str = "ok"
    why: str = ""
    low: float | None = None
    high: float | None = None

    @property
    def u95(self) -> float | None:
        """Half of the 95 % interval; None where there is none."""
        return None if self.low is None or self.high is None else (self.high - self.low) / 2.0

    def __repr__(self) -> str:
        value = self.status if self.value is None else f"{self.value:.4g} {self.unit}"
        interval = "no interval" if self.u95 is None else f"95 % {self.low:.4g} to {self.high:.4g}"
        return in_angles(self, f"{self.name}: {value}, {interval}{'' if self.status == 'ok' else f' ({self.status})'}")


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

    def __repr__(self) -> str:
        figures = ", ".join(f"{f.name} {f.value:.4g} {f.unit}" for f in self.figures if f.value is not None)
        return in_angles(self, f"{self.manoeuvre.name} of {self.vehicle.name}: {figures or 'no figure determined'}")

    def _repr_html_(self) -> str:
        """Track and figures, for notebooks."""
        return html_by("simulation", self)


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

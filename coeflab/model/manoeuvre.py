"""A manoeuvre as phases of constant orders, and the figures that are read off it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.model.frozen import locked

Array = NDArray[np.float64]
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

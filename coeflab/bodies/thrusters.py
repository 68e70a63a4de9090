"""Thrusters as a body.toml states them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from coeflab.bodies.pieces import Direction
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.types import Array, brief, locked


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
    curve : (n, 2) array
        Commands, rising, and thrusts, N; straight lines between.
    command, unit : str
        What is commanded, and its unit.
    """

    name: str
    place: Array
    axis: Array
    curve: Array
    command: str
    unit: str

    def __post_init__(self) -> None:
        for name in ("place", "axis", "curve"):
            object.__setattr__(self, name, locked(getattr(self, name)))


CURVE = takes.numbers(2, "none", "a point [command, thrust in N]")
FEWEST = 2


def _curve(value: Any, file: Path) -> Array:
    if not isinstance(value, list) or len(value) < FEWEST:
        raise InputError(shown(value), "two points [command, thrust in N] or more")
    points = np.array([CURVE.read(point, file) for point in value])
    if np.any(np.diff(points[:, 0]) <= 0.0) or np.any(np.diff(points[:, 1]) < 0.0):
        raise InputError(shown(value), "rising commands, and thrusts that do not fall")
    return points


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
    ]  # fmt: skip
    command: takes.Text = "speed"
    unit: takes.Text = "rpm"

    def check(self) -> None:
        """It pushes somewhere."""
        if not np.linalg.norm(self.axis) > 0.0:
            raise InputError("an axis without a direction", "[x, y, z], one of them not zero", column="axis")

    @property
    def made(self) -> Thruster:
        """With an axis of length one."""
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        return Thruster(self.name, self.place, axis, self.curve, self.command, self.unit)

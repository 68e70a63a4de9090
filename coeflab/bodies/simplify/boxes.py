"""Boxes that a person draws around parts of a body."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np

from coeflab.core.declarations import Declaration, Text, declared, numbers
from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import read_toml
from coeflab.core.types import brief
from coeflab.core.units import quantity

WRITTEN = "NAME=x0:x1,y0:y1,z0:z1 in m, FRD, from the datum"


@brief
@dataclass(frozen=True, slots=True)
class NamedBox:
    """A box along the body's axes; m, FRD, from the datum.

    Attributes
    ----------
    name : str
        Of the part inside.
    low, high : tuple of float
        Opposite corners.
    """

    name: str
    low: tuple[float, float, float]
    high: tuple[float, float, float]

    def __post_init__(self) -> None:
        if not np.all(np.less(self.low, self.high)):
            sides = ", ".join(f"{a:g}:{b:g}" for a, b in zip(self.low, self.high, strict=True))
            raise InputError(f"the box {shown(self.name)} over {sides}", "each side from a lower to a higher value")


def parse_box(text: str) -> NamedBox:
    """Read ``mast=0.05:0.15,-0.05:0.05,-0.4:-0.07``; a length may carry its unit (``5 cm``).

    Raises
    ------
    InputError
    """
    name, equals, sides = text.partition("=")
    ranges = [side.split(":") for side in sides.split(",")]
    if not equals or not name.strip() or len(ranges) != 3 or any(len(r) != 2 for r in ranges):
        raise InputError(shown(text), WRITTEN, column="--box")
    (x0, x1), (y0, y1), (z0, z1) = ([_length(end) for end in r] for r in ranges)
    return NamedBox(name.strip(), (x0, y0, z0), (x1, y1, z1))


def _length(text: str) -> float:
    try:
        return quantity(float(text), "length", key="--box")
    except ValueError:
        return quantity(text, "length", key="--box")


Side = Annotated[tuple[float, ...], numbers(2, "length", "[low, high], lengths in m or with units")]


@dataclass(frozen=True, slots=True)
class BoxKeys(Declaration):
    """A box drawn around a part.

    Attributes
    ----------
    name : str
        Of the part inside.
    x, y, z : (float, float)
        [low, high], m, FRD, from the datum.
    """

    name: Text
    x: Side
    y: Side
    z: Side

    def check(self) -> None:
        """A box from a lower to a higher corner."""
        _ = self.built

    @property
    def built(self) -> NamedBox:
        """The box."""
        (x0, x1), (y0, y1), (z0, z1) = self.x, self.y, self.z
        return NamedBox(self.name, (x0, y0, z0), (x1, y1, z1))


@dataclass(frozen=True, slots=True)
class BoxFile(Declaration):
    """Boxes that a person draws around parts of a body.

    Attributes
    ----------
    box : array of tables
        One for each part.
    """

    box: tuple[BoxKeys, ...] = ()

    def check(self) -> None:
        """One at least."""
        if not self.box:
            raise InputError("no [[box]]", "at least one, with name, x, y and z", column="box")


def read_boxes(path: Path) -> tuple[NamedBox, ...]:
    """The ``[[box]]`` tables of a TOML file, each with name, x, y and z as [low, high].

    Raises
    ------
    InputError
    """
    return tuple(b.built for b in declared(BoxFile, read_toml(path)).box)

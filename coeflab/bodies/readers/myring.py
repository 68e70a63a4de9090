"""Myring hulls, bare: see `coeflab.bodies.profiles`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.body_file import ShapedBodyFile
from coeflab.bodies.pieces import hull_piece
from coeflab.bodies.profiles import Myring
from coeflab.core.declarations import declared
from coeflab.core.text.toml import read_toml

summary = "a Myring hull from the lengths of nose, middle body and tail, diameter, exponent and tail angle"
citations = ("myring1976", "prestero2001")


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

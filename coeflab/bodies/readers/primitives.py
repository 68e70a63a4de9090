"""Bodies as named cylinders, plates, spheroids, ellipsoids, spheres and boxes, each with its pose."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np

from coeflab.bodies.body import Body, Configuration, ShapedBodyFile
from coeflab.bodies.mesh.meshing import surface_of
from coeflab.bodies.mesh.source import MeshKeys
from coeflab.bodies.pieces import part_pieces
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Form, Part, Parts, Plate, StandIn
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import read_toml
from coeflab.law.transforms import rotation

summary = "named cylinders, plates, spheroids, ellipsoids, spheres and boxes from a body.toml, each with its pose"
citations = ("fossen2011",)

SIZES = {
    "cylinder": ("radius", "length"),
    "plate": ("chord", "span"),
    "spheroid": ("length", "diameter"),
    "ellipsoid": ("semi_axis_x", "semi_axis_y", "semi_axis_z"),
    "sphere": ("radius",),
    "box": ("length", "width", "height"),
}
TURN = takes.Within(
    lambda turn: (
        "[roll, pitch, yaw] of at most 360 deg each, a whole turn" if max(map(abs, turn)) > 2.0 * np.pi else ""
    ),
)
Size = Annotated[takes.Length, takes.ABOVE_ZERO]


@dataclass(frozen=True, slots=True, kw_only=True)
class FitKeys(takes.Declaration):
    """How well a form stands for its piece of a mesh; errors are form over piece, less one.

    Attributes
    ----------
    class : str
        The form that the piece is like, or other: it is like none, and the nearest stands in.
    shared : float
        Share of the piece's volume that lies within the form, of a plate within its outline.
    volume, length : float
        Errors; a plate has no volume: -1.
    areas : (float, float, float)
        Errors of the areas projected along the part's own axes.
    misfit : float
        Of a solid: error of the length, plus errors of the areas over their sum.
    thickness : float
        Of a plate: mean thickness of the piece over the shorter side.
    """

    class_: takes.Text
    shared: takes.Pure
    volume: takes.Pure
    length: takes.Pure
    areas: Annotated[tuple[float, float, float], takes.numbers(3, "none", "three errors [x, y, z] of projected areas")]
    misfit: takes.Pure | None = None
    thickness: takes.Pure | None = None

    def check(self) -> None:
        """Bounds of the errors."""
        _ = self.made

    @property
    def made(self) -> StandIn:
        """The same as the part holds it."""
        return StandIn(
            self.class_, self.shared, self.volume, self.areas, self.length, misfit=self.misfit, thickness=self.thickness
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PartKeys(takes.Declaration):
    """A simple form with its pose; every form has its own sizes, all of them required.

    Attributes
    ----------
    name : str
        One for each part.
    form : str
        A cylinder has radius and length; a plate chord and span; a spheroid length and diameter; an ellipsoid semi_axis_x,
        semi_axis_y and semi_axis_z; a sphere radius; a box length, width and height.
    centre : (3,) array
        [x, y, z], m, FRD, from the datum.
    rotation : (3,) tuple
        [roll, pitch, yaw]. Along its own axes a cylinder and a spheroid lie along x; a plate has its chord along x, its span
        along y and its normal along z.
    fit : table
        Where the part stands for a piece of a mesh: how well.
    radius, length, chord, span, diameter, semi_axis_x, semi_axis_y, semi_axis_z, width, height : float
        Size of the form.
    """

    name: takes.Text
    form: Annotated[str, takes.one_of(*SIZES)]
    centre: takes.Point
    rotation: Annotated[tuple[float, float, float], takes.numbers(3, "angle", "three numbers [x, y, z] of angle"), TURN] = (
        0.0, 0.0, 0.0,
    )  # fmt: skip
    fit: FitKeys | None = None
    radius: Size | None = None
    length: Size | None = None
    chord: Size | None = None
    span: Size | None = None
    diameter: Size | None = None
    semi_axis_x: Size | None = None
    semi_axis_y: Size | None = None
    semi_axis_z: Size | None = None
    width: Size | None = None
    height: Size | None = None

    def check(self) -> None:
        """The sizes of the form, and no other."""
        for name in dict.fromkeys(chain(*SIZES.values())):
            given, wanted = getattr(self, name) is not None, name in SIZES[self.form]
            if given != wanted:
                found = "an unknown key" if given else "nothing"
                raise InputError(found, f"the sizes of a {self.form}, {', '.join(SIZES[self.form])}", column=name)
        _ = self.made

    @property
    def made(self) -> Part:
        """The part."""
        try:
            form = _made(self.form, [getattr(self, key) for key in SIZES[self.form]])
        except InputError as why:
            raise InputError(why.found, why.expected, column="form", advice=why.advice) from None
        return Part(self.name, form, self.centre, rotation(*self.rotation), None if self.fit is None else self.fit.made)


def _made(kind: str, values: list[float]) -> Form:
    if kind == "cylinder":
        return Cylinder(*values)
    if kind == "plate":
        return Plate(*values)
    if kind == "box":
        return Box(*values)
    if kind == "sphere":
        return Ellipsoid(values[0], values[0], values[0])
    if kind == "spheroid":
        return Ellipsoid(values[0] / 2.0, values[1] / 2.0, values[1] / 2.0)
    return Ellipsoid(*values)


@dataclass(frozen=True, slots=True, kw_only=True)
class File(ShapedBodyFile):
    """A body.toml of parts.

    Attributes
    ----------
    part : array of tables
        Simple forms with their poses, one at least.
    mesh : table
        What the parts stand for. Panel method and strips take it in their place.
    """

    reader: ClassVar[str] = "primitives"
    part: tuple[PartKeys, ...] = ()
    mesh: MeshKeys | None = None

    def check(self) -> None:
        """Parts of different names."""
        ShapedBodyFile.check(self)
        if not self.part:
            raise InputError("no [[part]]", f"at least one part, with form {', '.join(SIZES)}", column="part")
        try:
            _ = self.shape
        except InputError as why:
            raise InputError(why.found, why.expected, column="part") from None

    @property
    def shape(self) -> Parts:
        """All of them."""
        return Parts(tuple(p.made for p in self.part))


def read(path: Path) -> Body:
    """Read a body.toml of parts.

    Lengths are in metres unless a unit is written. ``rotation`` is [roll, pitch, yaw]; an angle has its unit. Along
    its own axes a cylinder and a spheroid lie along x, a plate has its chord along x, its span along y and its normal
    along z.

    Raises
    ------
    InputError
        Anything missing, unknown, of the wrong unit or not above zero, by file and key.
    """
    toml = read_toml(path)
    file = takes.declared(File, toml)
    shape = file.shape
    computed = Configuration(
        name="by_parts",
        title="sum of the parts; overlaps count twice",
        volume=shape.volume or None,
        wetted_surface=None,
        centre_of_buoyancy=shape.centre_of_volume,
        mass=None,
    )
    body = file.shaped(path, shape, computed, part_pieces(shape, (surface_of(p.form) for p in shape.parts)))
    if file.mesh is None:
        return body
    source = file.mesh.source(path.parent)
    if not source.file.is_file():
        raise toml.fail(
            "mesh.path", f"no file {shown(source.file.name)}", "the mesh that the parts replace",
            "Put it back, or delete [mesh]: results are then as rough as the parts.",
        )  # fmt: skip
    return replace(body, mesh=source, files=(*body.files, source.input_file(body.name)))

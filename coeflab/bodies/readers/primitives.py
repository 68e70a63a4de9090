"""Bodies as named simple forms, each with its pose, and as meshes where no form is good."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np

from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.body_file import ShapedBodyFile
from coeflab.bodies.mesh.meshing import surface_of
from coeflab.bodies.mesh.source import MeshKeys, MeshSource
from coeflab.bodies.pieces import part_pieces
from coeflab.bodies.shape import (
    Agreement,
    Bar,
    Box,
    Cylinder,
    Ellipsoid,
    Faceted,
    Finned,
    Form,
    Part,
    Parts,
    Plate,
    StandIn,
    Tube,
    Turned,
)
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.text.toml import read_toml
from coeflab.core.types import Array
from coeflab.law.symbols import MOTIONS
from coeflab.law.transforms import rotation

summary = "named cylinders, revolutions, tubes, bars, boxes, plates, fins, ellipsoids and meshes from a body.toml"
citations = ("fossen2011",)

SIZES = {
    "cylinder": ("radius", "length"),
    "plate": ("chord", "span"),
    "spheroid": ("length", "diameter"),
    "ellipsoid": ("semi_axis_x", "semi_axis_y", "semi_axis_z"),
    "sphere": ("radius",),
    "box": ("length", "width", "height"),
    "bar": ("length", "width", "height"),
    "tube": ("radius", "inner_radius", "length"),
    "ring": ("radius", "inner_radius", "length"),
    "revolution": ("stations", "radii"),
    "finned": ("radius", "semi_span", "chord", "thickness", "count"),
    "mesh": ("path",),
}
FORMS: dict[str, Any] = {
    "cylinder": Cylinder, "plate": Plate, "ellipsoid": Ellipsoid, "box": Box, "bar": Bar, "tube": Tube, "ring": Tube,
}  # fmt: skip
FINS = {"two": 2, "four": 4}
TURN = takes.Within(
    lambda turn: "[roll, pitch, yaw] of at most 360 deg each, a whole turn" if max(map(abs, turn)) > 2.0 * np.pi else ""
)
Size = Annotated[takes.Length, takes.ABOVE_ZERO]
LENGTH = takes.number_in("length")


def _lengths(value: Any, file: Path) -> tuple[float, ...]:
    if not isinstance(value, list) or len(value) < 2:
        raise InputError(shown(value), "a list of lengths, two at least")
    return tuple(LENGTH.read(v, file) for v in value)


Lengths = Annotated[
    tuple[float, ...],
    takes.Takes("a list of lengths", _lengths, {"type": "array", "items": dict(LENGTH.schema), "minItems": 2}),
]


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
        _ = self.built

    @property
    def built(self) -> StandIn:
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
        semi_axis_y and semi_axis_z; a sphere radius; a box and a long bar length, width and height; a tube and a ring
        radius, inner_radius and length; a revolution stations and radii; fins on a round hull (finned) its radius,
        semi_span, chord, thickness and count, two or four; a mesh path.
    centre : (3,) array
        [x, y, z], m, FRD, from the datum.
    rotation : (3,) tuple
        [roll, pitch, yaw]. Along its own axes a cylinder, a spheroid, a tube, a revolution, a bar and the hull of fins lie
        along x; a plate has its chord along x, its span along y and its normal along z; two fins lie along y.
    fit : table
        Where the part stands for a piece of a mesh: how well.
    radius, length, chord, span, diameter, semi_axis_x, semi_axis_y, semi_axis_z, width, height : float
        Size of the form.
    inner_radius, semi_span, thickness : float
        Size of the form; the semi_span of fins reaches from the hull's axis to a tip.
    count : str
        Of fins: two or four.
    stations, radii : list of float
        Of a revolution: places along its own x, rising, from the centre, and radii there; straight between them.
    path : str
        Of a mesh: a file beside the body.toml, m, along the part's own axes from the centre.
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
    inner_radius: Size | None = None
    semi_span: Size | None = None
    thickness: Size | None = None
    count: Annotated[str, takes.one_of(*FINS)] | None = None
    stations: Lengths | None = None
    radii: Lengths | None = None
    path: takes.Text | None = None

    def check(self) -> None:
        """The sizes of the form, and no other."""
        for name in dict.fromkeys(chain(*SIZES.values())):
            given, wanted = getattr(self, name) is not None, name in SIZES[self.form]
            if given != wanted:
                found = "an unknown key" if given else "nothing"
                raise InputError(found, f"the sizes of a {self.form}, {', '.join(SIZES[self.form])}", column=name)
        if self.path is None:
            _ = self.build()

    def build(self, folder: Path | None = None) -> Part:
        """The part; a mesh is read from the folder."""
        try:
            form, middle = self._form(folder)
        except InputError as why:
            if self.path is not None:
                raise
            raise why.at(column="form") from None
        turn = rotation(*self.rotation)
        centre = self.centre + turn @ middle
        return Part(self.name, form, centre, turn, None if self.fit is None else self.fit.built)

    def _form(self, folder: Path | None) -> tuple[Form, Array]:
        """The form, and where its centre of volume lies from its origin along its own axes, m."""
        if self.stations is not None and self.radii is not None:
            turned, along = Turned.about_its_centre(np.array(self.stations), np.array(self.radii))
            return turned, np.array([along, 0.0, 0.0])
        if self.path is not None and folder is not None:
            surface, _ = MeshSource(folder / self.path, 1.0, np.eye(3), np.zeros(3)).read()
            return Faceted.about_its_centre(surface)
        if self.count is not None:
            radius, semi_span, chord, thickness = (float(getattr(self, key)) for key in SIZES["finned"][:-1])
            return Finned(radius, semi_span, chord, thickness, FINS[self.count]), np.zeros(3)
        return _form(self.form, [getattr(self, key) for key in SIZES[self.form]]), np.zeros(3)


def _form(kind: str, values: list[float]) -> Form:
    if kind in FORMS:
        result: Form = FORMS[kind](*values)
        return result
    if kind == "sphere":
        return Ellipsoid(values[0], values[0], values[0])
    return Ellipsoid(values[0] / 2.0, values[1] / 2.0, values[1] / 2.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class AgreementKeys(takes.Declaration):
    """Added mass of the parts over that of the mesh by the panel method, less one, motion by motion.

    Attributes
    ----------
    u, v, w, p, q, r : float
        A motion that moves no water is left out.
    error : float
        Estimate for the mesh's entries, the largest over its entry. Left out where none was made.
    """

    u: takes.Pure | None = None
    v: takes.Pure | None = None
    w: takes.Pure | None = None
    p: takes.Pure | None = None
    q: takes.Pure | None = None
    r: takes.Pure | None = None
    error: takes.Pure | None = None

    @property
    def built(self) -> Agreement:
        """The same as the parts hold it."""
        return Agreement(tuple(getattr(self, motion) for motion in MOTIONS), self.error)


@dataclass(frozen=True, slots=True, kw_only=True)
class File(ShapedBodyFile):
    """A body.toml of parts.

    Attributes
    ----------
    part : array of tables
        Simple forms with their poses, one at least.
    mesh : table
        What the parts stand for. Panel method and strips take it in their place.
    against_mesh : table
        How far the added mass of the parts is from the mesh's.
    """

    reader: ClassVar[str] = "primitives"
    part: tuple[PartKeys, ...] = ()
    mesh: MeshKeys | None = None
    against_mesh: AgreementKeys | None = None

    def check(self) -> None:
        """Parts of different names."""
        ShapedBodyFile.check(self)
        if not self.part:
            raise InputError("no [[part]]", f"at least one part, with form {', '.join(SIZES)}", column="part")
        names = [p.name for p in self.part]
        twice = sorted({n for n in names if names.count(n) > 1})
        if twice:
            raise InputError(f"two parts called {shown(twice[0])}", "one name for each part", column="part")

    def shape(self, folder: Path) -> Parts:
        """All of them."""
        agreement = None if self.against_mesh is None else self.against_mesh.built
        return Parts(tuple(p.build(folder) for p in self.part), agreement)


def read(path: Path) -> Body:
    """Read a body.toml of parts.

    Lengths are in metres unless a unit is written. ``rotation`` is [roll, pitch, yaw]; an angle has its unit. Along
    its own axes what is round or long lies along x, a plate has its chord along x, its span along y and its normal
    along z.

    Raises
    ------
    InputError
        Anything missing, unknown, of the wrong unit or not above zero, by file and key.
    """
    toml = read_toml(path)
    file = takes.declared(File, toml)
    shape = file.shape(path.parent)
    computed = Configuration(
        name="by_parts",
        title="sum of the parts; overlaps count twice",
        volume=shape.volume or None,
        wetted_surface=None,
        centre_of_buoyancy=shape.centre_of_volume,
        mass=None,
    )
    meshes = [path.parent / p.path for p in file.part if p.path is not None]
    body = file.shaped(path, shape, computed, part_pieces(shape, (surface_of(p.form) for p in shape.parts)))
    own = (InputFile(f"{body.name}/{m.name}", sha256_of(m)) for m in dict.fromkeys(meshes))
    body = replace(body, files=(*body.files, *own))
    if file.mesh is None:
        return body
    source = file.mesh.source(path.parent)
    if not source.file.is_file():
        raise toml.fail(
            "mesh.path", f"no file {shown(source.file.name)}", "the mesh that the parts replace",
            "Put it back, or delete [mesh]: results are then as rough as the parts.",
        )  # fmt: skip
    files = dict.fromkeys((*body.files, source.input_file(body.name)))
    return replace(body, mesh=source, files=tuple(files), axes=file.mesh.axes)

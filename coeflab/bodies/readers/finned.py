"""A hull by equations with fins, sails, ducts and plates, or these alone.

The section of fins is the one by which Groves, Huang & Chang close the trailing edge of SUBOFF's planes (Table 3).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np

from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.body_file import ShapedBodyFile
from coeflab.bodies.mesh.facet_volume import enclosed
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import surface_of, united
from coeflab.bodies.mesh.particulars import computed
from coeflab.bodies.mesh.structured_surface import lofted
from coeflab.bodies.outline import Foil, Outline, RingWing, Sections
from coeflab.bodies.outlining import SLENDER, Radius, Trapezoid, of_parts, radius_towards, round_hull, with_controls
from coeflab.bodies.pieces import HULL, Control, Piece, hull_piece, part_pieces
from coeflab.bodies.profiles import FOOT, MIDDLE_END, Myring, suboff_meridian
from coeflab.bodies.shape import Ellipsoid, Part, Parts, Revolution, within_reach
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import read_toml
from coeflab.core.texts import input_error
from coeflab.core.types import Array

summary = "a hull (spheroid, Myring, SUBOFF) with fins, sails, ducts and plates, or these alone, that controls may turn"
citations = ("groves1989", "myring1976", "prestero2001")

PANELS = 40_000
STATIONS, LEVELS = 80, 12
THINNEST, THICKEST = 4, 40
UPWARD, SAME_WAY = 1.5 * np.pi, np.cos(np.radians(1.0))
FEWEST_AROUND = 24
SECTION = re.compile(r"NACA 00(\d\d)")
Size = Annotated[takes.Length, takes.ABOVE_ZERO]
NEEDED = {
    "spheroid": ("length", "diameter"),
    "myring": ("nose", "middle", "tail", "diameter", "exponent", "tail_angle"),
    "groves": (),
}
ALLOWED = {
    "spheroid": ("middle",),
    "myring": ("nose_offset", "tail_offset", "nose_at"),
    "groves": ("length", "nose_at"),
}


def half_thickness(q: Array, thickness: float) -> Array:
    """Half thickness over chord at a share q of the chord, closed at the trailing edge.

    Parameters
    ----------
    q : array
        From 0 at the nose to 1.
    thickness : float
        Largest, over chord; the coefficients are those of 0.20.
    """
    shape = 0.2969 * np.sqrt(q) - 0.126 * q - 0.3516 * q**2 + 0.2852 * q**3 - 0.1045 * q**4
    return np.asarray(thickness / 0.20 * np.where(q < 1.0, shape, 0.0))


def _thickness(section: str) -> float:
    """Of a NACA 00xx section, over the chord."""
    found = SECTION.fullmatch(section)
    if found is None or not THINNEST <= int(found[1]) <= THICKEST:
        expected = f"NACA 00xx, xx from {THINNEST:02d} to {THICKEST}: symmetric, thickness in percent of the chord"
        raise InputError(shown(section), expected, column="section")
    return int(found[1]) / 100.0


@dataclass(frozen=True, slots=True, kw_only=True)
class HullKeys(takes.Declaration):
    """A hull of revolution along x; every kind has its own keys.

    Attributes
    ----------
    kind : str
        A spheroid has length and diameter, and middle, the x of its centre. A myring has the keys of a bare Myring hull:
        nose, middle, tail, diameter, exponent, tail_angle, nose_offset, tail_offset. groves is the hull of SUBOFF, to the
        length overall where that is given.
    length, diameter : float
        Its axes.
    middle : float
        Of a spheroid x of its centre, FRD, from the datum, 0 unless given; of a Myring hull the length of its middle body.
    nose, tail, nose_offset, tail_offset : float
        Of a Myring hull.
    exponent : float
        Of its nose.
    tail_angle : float
        Of its tail.
    nose_at : float
        x of the nose of a Myring hull or of SUBOFF's, FRD, from the datum.
    """

    kind: Annotated[str, takes.one_of(*NEEDED)] = "spheroid"
    length: Size | None = None
    diameter: Size | None = None
    middle: takes.Length | None = None
    nose: takes.Length | None = None
    tail: takes.Length | None = None
    exponent: takes.Pure | None = None
    tail_angle: takes.Angle | None = None
    nose_offset: takes.Length | None = None
    tail_offset: takes.Length | None = None
    nose_at: takes.Length | None = None

    def check(self) -> None:
        """The keys of its kind, and no other."""
        needed, allowed = NEEDED[self.kind], (*NEEDED[self.kind], *ALLOWED[self.kind])
        for name in dict.fromkeys(key for kind in NEEDED for key in (*NEEDED[kind], *ALLOWED[kind])):
            given = getattr(self, name) is not None
            if name in needed and not given:
                raise input_error("bodies.sizes_hull_kind", column=name, kind_2=self.kind, needed=", ".join(needed))
            if given and name not in allowed:
                raise input_error("bodies.unknown_key", column=name, kind_2=self.kind, allowed=", ".join(allowed))
        shape = self.shape
        if isinstance(shape, Parts) and not of_parts(shape).hulls:
            expected = (
                f"at most {(self.length or 0.0) / SLENDER:.6g} m, the length over {SLENDER:g}: a hull lies along x"
            )
            raise InputError(f"{self.diameter:.6g} m", expected, column="diameter")

    @property
    def shape(self) -> Parts | Revolution:
        """The hull alone."""
        at = self.nose_at or 0.0
        if self.kind == "spheroid":
            half = (self.diameter or 0.0) / 2.0
            form = Ellipsoid((self.length or 0.0) / 2.0, half, half)
            return Parts((Part(HULL, form, np.array([self.middle or 0.0, 0.0, 0.0]), np.eye(3)),))
        if self.kind == "myring":
            given = {key: getattr(self, key) for key in (*NEEDED["myring"], "nose_offset", "tail_offset")}
            hull = Myring(**{key: value for key, value in given.items() if value is not None}).meridian()
            return replace(hull, x=hull.x + at)
        hull = suboff_meridian()
        share = 1.0 if self.length is None else self.length / hull.length
        sizes = {name: share * getattr(hull, name) for name in ("weight", "radius", "radius_slope", "length")}
        return replace(hull, x=share * hull.x + at, **sizes)

    @property
    def stern(self) -> float | None:
        """Where the run begins, x from the datum; None of a spheroid."""
        at = self.nose_at or 0.0
        if self.kind == "myring":
            return at - ((self.nose or 0.0) - (self.nose_offset or 0.0) + (self.middle or 0.0))
        return None if self.kind == "spheroid" else at - MIDDLE_END * FOOT * self.scale

    @property
    def scale(self) -> float:
        """Length over that of SUBOFF as Groves gives it."""
        return 1.0 if self.length is None else self.length / suboff_meridian(4).length

    @property
    def piece(self) -> Piece:
        """The closed piece."""
        shape = self.shape
        if isinstance(shape, Parts):
            return part_pieces(shape, (surface_of(shape.parts[0].form),))[0]
        return hull_piece(shape, shape.integrals.wetted_surface, self.stern)

    @property
    def sections(self) -> Sections:
        """As methods see it."""
        shape = self.shape
        return of_parts(shape).hulls[0] if isinstance(shape, Parts) else round_hull(shape)


@dataclass(frozen=True, slots=True, kw_only=True)
class Planform(takes.Declaration):
    """A straight tapered planform; it stands radially off the x axis.

    Attributes
    ----------
    name : str
        One for each part; controls and patches are called so.
    roll : float
        Where it points, right-handed about x: 0 starboard, 90 deg down, 180 deg port, 270 deg up.
    root, tip : float
        Their distances from the axis. On a hull the root lies within it.
    root_chord, tip_chord : float
        Chords there.
    trailing_edge : float
        x of the root's trailing edge, FRD, from the datum.
    tip_trailing_edge : float
        x of the tip's trailing edge, that of the root unless given.
    """

    name: takes.Text
    roll: takes.Angle
    root: takes.Length
    tip: Size
    root_chord: Size
    tip_chord: Size
    trailing_edge: takes.Length
    tip_trailing_edge: takes.Length | None = None

    def check(self) -> None:
        """A tip beyond the root."""
        if not 0.0 <= self.root < self.tip:
            found_root = f"a root at {self.root:g} m, the tip at {self.tip:g} m"
            raise InputError(found_root, "a root from 0 to less than the tip", column="root")
        within_reach("fin", tip=self.tip, root_chord=self.root_chord, tip_chord=self.tip_chord)

    @property
    def chord(self) -> float:
        """Mean, m."""
        return (self.root_chord + self.tip_chord) / 2.0

    @property
    def way(self) -> Array:
        """(2,) y and z of where it points."""
        return np.array([np.cos(self.roll), np.sin(self.roll)])

    @property
    def flat(self) -> Trapezoid:
        """From root to tip, whole."""
        ends = (self.trailing_edge, self.trailing_edge if self.tip_trailing_edge is None else self.tip_trailing_edge)
        return Trapezoid(self.root, self.tip, (self.root_chord, self.tip_chord), ends)

    def foils(self, radius: Radius | None) -> tuple[Foil, ...]:
        """What of it stands out of a hull of a radius at x, one foil or two; alone without a hull."""
        ways = {self.name: self.way} | ({f"{self.name}_image": -self.way} if _is_mirrored(self) else {})
        found = (self.flat.foil(name, one, np.zeros(2), _relative(self), radius) for name, one in ways.items())
        return tuple(foil for foil in found if foil is not None)

    @property
    def piece(self) -> Piece:
        """The closed piece."""
        span = (self.tip - self.root) * (1.0 + _is_mirrored(self))
        return Piece(self.name, self.name, partial(_solid, self), 2.05 * self.chord * span, self.chord)

    def check_hull(self, hull: Sections) -> None:
        """Refuse what does not stand on a hull.

        Raises
        ------
        InputError
            Its root lies outside, or all of it within.
        """
        radius = radius_towards(hull, self.way)
        ends = self.trailing_edge, self.trailing_edge + self.root_chord
        within = float(radius(np.linspace(*ends, LEVELS)).max())
        if self.root >= within:
            found = (
                f"{shown(self.name)}, whose root at {self.root:g} m lies outside of the hull, at most {within:.4g} m in "
                f"radius from x = {ends[0]:.4g} to {ends[1]:.4g} m"
            )
            expected = "a root within the hull, 0 for instance: what lies within it does not count"
            raise InputError(found, expected, column="root")
        if not self.foils(radius):
            raise InputError(f"{shown(self.name)}, which lies within the hull", "a tip outside of it", column="tip")


@dataclass(frozen=True, slots=True, kw_only=True)
class FinKeys(Planform):
    """A fin of a NACA 00xx section with a flat tip.

    Attributes
    ----------
    section : str
        NACA 00xx.
    mirrored : bool
        With its mirror image in the plane of its root, as one piece: one half of it is the fin on a symmetry plane.
    """

    section: takes.Text
    mirrored: takes.Flag = False

    def check(self) -> None:
        """A section that is known."""
        _ = _thickness(self.section)
        Planform.check(self)
        if self.mirrored and self.root:
            raise InputError(f"a mirrored fin with its root at {self.root:g} m", "a root at 0", column="root")


@dataclass(frozen=True, slots=True, kw_only=True)
class SailKeys(FinKeys):
    """A sail: a fin that points up from the axis.

    Attributes
    ----------
    name : str
        One for each part.
    roll : float
        Where it points, 270 deg, up, unless given.
    root : float
        Its distance from the axis, 0 unless given: what lies within the hull does not count.
    """

    name: takes.Text = "sail"
    roll: takes.Angle = UPWARD
    root: takes.Length = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateKeys(Planform):
    """A flat plate with square edges, such as a strut or a fin of sheet.

    Attributes
    ----------
    thickness : float
        Of the plate.
    """

    thickness: Size


@dataclass(frozen=True, slots=True, kw_only=True)
class DuctKeys(takes.Declaration):
    """A duct or a ring wing about the x axis, of a NACA 00xx section along x.

    Attributes
    ----------
    name : str
        One for each part.
    section : str
        NACA 00xx.
    diameter : float
        Of the circle of its chords.
    chord : float
        Of the section.
    trailing_edge : float
        x, FRD, from the datum.
    """

    name: takes.Text = "duct"
    section: takes.Text
    diameter: Size
    chord: Size
    trailing_edge: takes.Length

    def check(self) -> None:
        """A section that is known, an opening."""
        inner = self.inner
        if inner <= 0.0:
            raise input_error("bodies.section_thick_about", column="diameter", thick=self.thick, diameter=self.diameter)

    @property
    def thick(self) -> float:
        """Of its section, m."""
        return _thickness(self.section) * self.chord

    @property
    def inner(self) -> float:
        """Smallest radius, m."""
        return (self.diameter - self.thick) / 2.0

    @property
    def ring(self) -> RingWing:
        """As methods see it."""
        centre = np.array([self.trailing_edge + 0.75 * self.chord, 0.0, 0.0])
        return RingWing(self.name, centre, self.diameter, self.chord, _thickness(self.section))

    @property
    def piece(self) -> Piece:
        """The closed piece."""
        return Piece(self.name, self.name, partial(_torus, self), 2.05 * np.pi * self.diameter * self.chord, self.chord)

    def clears(self, hull: Sections) -> None:
        """Refuse one that cuts into the hull.

        Raises
        ------
        InputError
        """
        radius = radius_towards(hull, np.array([1.0, 0.0]))
        most = float(radius(np.linspace(self.trailing_edge, self.trailing_edge + self.chord, LEVELS)).max())
        if most >= self.inner:
            found = f"{shown(self.name)}, {self.inner:.4g} m in inner radius, where the hull has {most:.4g} m"
            raise InputError(found, "a duct around the hull", column="diameter")


def _is_mirrored(of: Planform) -> bool:
    return isinstance(of, FinKeys) and of.mirrored


def _relative(of: Planform) -> float:
    """Thickness over chord, of a plate over its mean chord."""
    if isinstance(of, PlateKeys):
        return of.thickness / of.chord
    return _thickness(of.section) if isinstance(of, FinKeys) else 0.0


def _halves(of: Planform, stations: int) -> tuple[Array, Callable[[Array], Array]]:
    """Shares of the chord, and half thicknesses there, m, at (n,) chords."""
    if isinstance(of, PlateKeys):
        q = np.r_[0.0, np.arange(stations + 1) / stations, 1.0]
        edge = np.r_[0.0, np.ones(stations + 1), 0.0]
        half = of.thickness / 2.0
        return q, lambda chord: half * edge[:, None] * np.ones_like(chord)
    q = 1.0 - np.cos(np.pi / 2.0 * np.arange(stations + 1) / stations)  # dense at the nose
    q[-1] = 1.0
    shape = half_thickness(q, _relative(of))
    return q, lambda chord: shape[:, None] * chord


def _solid(of: Planform, panels: int) -> TriangleMesh:
    """Sections from nose to trailing edge, each a loop about the span."""
    both = _is_mirrored(of)
    levels = 2 * LEVELS if both else LEVELS
    fine = np.sqrt(panels / (2 * STATIONS * (2 * levels + 4)))
    stations, levels = (max(4, 2 * round(n * fine / 2.0)) for n in (STATIONS, levels))
    q, halves = _halves(of, stations)
    y = np.linspace(-of.tip if both else of.root, of.tip, levels + 1)
    share = (np.abs(y) - of.root) / (of.tip - of.root)
    chord = of.root_chord + (of.tip_chord - of.root_chord) * share
    end = of.trailing_edge if of.tip_trailing_edge is None else of.tip_trailing_edge
    aft = of.trailing_edge + (end - of.trailing_edge) * share
    around = np.r_[0 : levels + 1, levels, levels:-1:-1, 0]
    side = np.r_[np.ones(levels + 1), 0.0, -np.ones(levels + 1), 0.0]
    half = halves(chord[around]) * side
    x = aft[around] + chord[around] * (1.0 - q[:, None])
    loops = np.stack([x, np.broadcast_to(y[around], x.shape), half], axis=-1)
    vertices, faces = lofted(loops)
    c, s = np.cos(of.roll), np.sin(of.roll)
    return TriangleMesh(vertices @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]).T, faces)


def _torus(duct: DuctKeys, panels: int) -> TriangleMesh:
    """The section carried around the axis."""
    ratio = np.pi * duct.diameter / (2.0 * duct.chord)
    stations = max(6, 2 * round(np.sqrt(panels / (8.0 * ratio)) / 2.0) * 2)
    around = max(FEWEST_AROUND, 4 * round(panels / (16.0 * stations)))
    q = 1.0 - np.cos(np.pi / 2.0 * np.arange(stations + 1) / stations)
    q[-1] = 1.0
    half = duct.chord * half_thickness(q, _thickness(duct.section))
    x = duct.trailing_edge + duct.chord * (1.0 - np.r_[q, q[-2:0:-1]])
    radius = duct.diameter / 2.0 + np.r_[half, -half[-2:0:-1]]
    turn = 2.0 * np.pi * np.arange(around) / around
    vertices = np.stack(
        [np.broadcast_to(x[:, None], (len(x), around)), radius[:, None] * np.cos(turn), radius[:, None] * np.sin(turn)],
        -1,
    )
    i, j = np.meshgrid(np.arange(len(x)), np.arange(around), indexing="ij")
    a, b = i * around + j, i * around + (j + 1) % around
    c, d = (i + 1) % len(x) * around + (j + 1) % around, (i + 1) % len(x) * around + j
    even = ((i + j) % 2 == 0)[..., None]
    one = np.where(even, np.stack([a, b, c], -1), np.stack([a, b, d], -1))
    two = np.where(even, np.stack([a, c, d], -1), np.stack([b, c, d], -1))
    faces = np.concatenate([one.reshape(-1, 3), two.reshape(-1, 3)])
    points = vertices.reshape(-1, 3)
    return TriangleMesh(points, faces if enclosed(points[faces]) > 0.0 else faces[:, ::-1])


@dataclass(frozen=True, slots=True, kw_only=True)
class File(ShapedBodyFile):
    """A body.toml whose shape is a hull with fins, sails, ducts and plates, or these alone.

    Attributes
    ----------
    hull : table
        Of revolution; without it the others are alone.
    fin, sail, duct, plate : array of tables
        What stands on the hull or around it; one at least of them all.
    """

    reader: ClassVar[str] = "finned"
    hull: Annotated[HullKeys | None, takes.OrEmpty()] = None
    fin: tuple[FinKeys, ...] = ()
    sail: tuple[SailKeys, ...] = ()
    duct: tuple[DuctKeys, ...] = ()
    plate: tuple[PlateKeys, ...] = ()

    def check(self) -> None:
        """Parts of different names, that stand on the hull and not in each other."""
        ShapedBodyFile.check(self)
        placed = tuple(self._placed())
        if not placed:
            raise InputError("no [[fin]]", "one [[fin]], [[sail]], [[duct]] or [[plate]] at least", column="fin")
        names: list[str] = [HULL]
        for key, part in placed:
            if part.name in names:
                raise InputError(f"two parts called {shown(part.name)}", "one name for each part", column=f"{key}.name")
            names.append(part.name)
        if self.hull is not None:
            hull = self.hull.sections
            for key, part in placed:
                try:
                    part.clears(hull) if isinstance(part, DuctKeys) else part.check_hull(hull)
                except InputError as why:
                    raise InputError(why.found, why.expected, column=f"{key}.{why.column}") from None
        for (_, one), (key, other) in combinations(placed, 2):
            if isinstance(one, Planform) and isinstance(other, Planform) and _cover(one, other):
                found = f"{shown(other.name)} over {shown(one.name)}"
                raise InputError(found, "parts that do not overlap outside of the hull", column=f"{key}.roll")

    def _placed(self) -> Iterator[tuple[str, Planform | DuctKeys]]:
        for table in ("fin", "sail", "duct", "plate"):
            for i, part in enumerate(getattr(self, table)):
                yield f"{table}[{i}]", part

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Hull and the rest."""
        own = tuple(part.piece for _, part in self._placed())
        return own if self.hull is None else (self.hull.piece, *own)

    def outlined(self, whole: Configuration, controls: tuple[Control, ...]) -> Outline:
        """What semi-empirical methods see of it.

        Parameters
        ----------
        whole : Configuration
            With volume and wetted surface.
        controls : tuple of Control
        """
        hulls = () if self.hull is None else (self.hull.sections,)
        foils: list[Foil] = []
        for _, part in self._placed():
            if isinstance(part, Planform):
                foils += part.foils(radius_towards(hulls[0], part.way) if hulls else None)
        turned, left = with_controls(foils, controls)
        rings = tuple(duct.ring for duct in self.duct)
        return Outline(hulls, turned, rings, (), whole.wetted_surface or 0.0, whole.volume or 0.0, left)


def _cover(one: Planform, other: Planform) -> bool:
    """Both point the same way, and their boxes along x and from the axis share a length."""
    if one.way @ other.way < SAME_WAY:
        return False
    (x0, r0), (x1, r1) = (
        (
            (min(p.flat.trailing_edges), max(e + c for e, c in zip(p.flat.trailing_edges, p.flat.chords, strict=True))),
            (p.root, p.tip),
        )
        for p in (one, other)
    )
    return all(max(a[0], b[0]) < min(a[1], b[1]) for a, b in ((x0, x1), (r0, r1)))


def mesh(pieces: tuple[Piece, ...], panels: int = PANELS) -> TriangleMesh:
    """What the pieces enclose together, of about so many triangles."""
    share = np.sqrt([piece.area for piece in pieces])
    counts = np.maximum(panels * share / share.sum(), 64).astype(int)
    whole = united([piece.surface(int(count)) for piece, count in zip(pieces, counts, strict=True)])
    return TriangleMesh(whole.vertices, whole.faces, remade=lambda other: mesh(pieces, other))


def read(path: Path) -> Body:
    """Read a body.toml whose shape is a hull with fins, sails, ducts and plates, or these alone.

    Raises
    ------
    InputError
        Everything missing, unknown, of the wrong unit or out of bounds, by file, line and key.
    """
    file = takes.declared(File, read_toml(path))
    shape = mesh(file.pieces)
    whole = computed(shape, ())
    return file.shaped(path, shape, whole, file.pieces, partial(file.outlined, whole))

"""A spheroid with fins of NACA four-digit sections, or such a fin alone.

The section is the one by which Groves, Huang & Chang close the trailing edge of SUBOFF's planes (Table 3).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np

from coeflab.bodies.body import Body, Configuration, ShapedBodyFile
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import lofted, surface_of, united
from coeflab.bodies.mesh.particulars import computed
from coeflab.bodies.outline import Foil, Outline
from coeflab.bodies.outlining import Radius, Trapezoid, of_parts, radius_towards, with_controls
from coeflab.bodies.pieces import HULL, Control, Piece, part_pieces
from coeflab.bodies.shape import Ellipsoid, Part, Parts, within_reach
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import read_toml
from coeflab.core.types import Array

summary = "a spheroid with fins of NACA 00xx sections, or such a fin alone, that controls may turn"
citations = ("groves1989",)

PANELS = 40_000
STATIONS, LEVELS = 80, 12
THINNEST, THICKEST = 4, 40
SECTION = re.compile(r"NACA 00(\d\d)")
Size = Annotated[takes.Length, takes.ABOVE_ZERO]


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


@dataclass(frozen=True, slots=True)
class SpheroidKeys(takes.Declaration):
    """A prolate spheroid along x.

    Attributes
    ----------
    length, diameter : float
        Its axes.
    middle : float
        x of its centre, FRD, from the datum.
    """

    length: Size
    diameter: Size
    middle: takes.Length = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class FinKeys(takes.Declaration):
    """A straight tapered fin with a flat tip; it stands radially off the x axis.

    Attributes
    ----------
    name : str
        One for each fin; controls and patches are called so.
    section : str
        NACA 00xx.
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
    mirrored : bool
        With its mirror image in the plane of its root, as one piece: one half of it is the fin on a symmetry plane.
    """

    name: takes.Text
    section: takes.Text
    roll: takes.Angle
    root: takes.Length
    tip: Size
    root_chord: Size
    tip_chord: Size
    trailing_edge: takes.Length
    tip_trailing_edge: takes.Length | None = None
    mirrored: takes.Flag = False

    def check(self) -> None:
        """A section that is known, a tip beyond the root."""
        found = SECTION.fullmatch(self.section)
        if found is None or not THINNEST <= int(found[1]) <= THICKEST:
            expected = f"NACA 00xx, xx from {THINNEST:02d} to {THICKEST}: symmetric, thickness in percent of the chord"
            raise InputError(shown(self.section), expected, column="section")
        if not 0.0 <= self.root < self.tip:
            found_root = f"a root at {self.root:g} m, the tip at {self.tip:g} m"
            raise InputError(found_root, "a root from 0 to less than the tip", column="root")
        if self.mirrored and self.root:
            raise InputError(f"a mirrored fin with its root at {self.root:g} m", "a root at 0", column="root")
        within_reach("fin", tip=self.tip, root_chord=self.root_chord, tip_chord=self.tip_chord)

    @property
    def span(self) -> float:
        """From root to tip, twice if mirrored, m."""
        return (self.tip - self.root) * (1.0 + self.mirrored)

    @property
    def chord(self) -> float:
        """Mean, m."""
        return (self.root_chord + self.tip_chord) / 2.0

    def foils(self, radius: Radius | None) -> tuple[Foil, ...]:
        """What of it stands out of a hull of a radius at x, one foil or two; alone without a hull."""
        ends = (self.trailing_edge, self.trailing_edge if self.tip_trailing_edge is None else self.tip_trailing_edge)
        flat = Trapezoid(self.root, self.tip, (self.root_chord, self.tip_chord), ends)
        way = np.array([np.cos(self.roll), np.sin(self.roll)])
        ways = {self.name: way, f"{self.name}_image": -way} if self.mirrored else {self.name: way}
        thickness = int(self.section[-2:]) / 100.0
        found = (flat.foil(name, one, np.zeros(2), thickness, radius) for name, one in ways.items())
        return tuple(foil for foil in found if foil is not None)

    @property
    def piece(self) -> Piece:
        """The closed piece."""
        return Piece(self.name, self.name, partial(_fin, self), 2.05 * self.chord * self.span, self.chord)


def _fin(fin: FinKeys, panels: int) -> TriangleMesh:
    """Sections from nose to trailing edge, each a loop about the span."""
    levels = 2 * LEVELS if fin.mirrored else LEVELS
    fine = np.sqrt(panels / (2 * STATIONS * (2 * levels + 4)))
    stations, levels = (max(4, 2 * round(n * fine / 2.0)) for n in (STATIONS, levels))
    q = 1.0 - np.cos(np.pi / 2.0 * np.arange(stations + 1) / stations)  # dense at the nose
    q[-1] = 1.0
    y = np.linspace(-fin.tip if fin.mirrored else fin.root, fin.tip, levels + 1)
    share = (np.abs(y) - fin.root) / (fin.tip - fin.root)
    chord = fin.root_chord + (fin.tip_chord - fin.root_chord) * share
    end = fin.trailing_edge if fin.tip_trailing_edge is None else fin.tip_trailing_edge
    aft = fin.trailing_edge + (end - fin.trailing_edge) * share
    around = np.r_[0 : levels + 1, levels, levels:-1:-1, 0]
    side = np.r_[np.ones(levels + 1), 0.0, -np.ones(levels + 1), 0.0]
    thickness = int(fin.section[-2:]) / 100.0
    half = half_thickness(q, thickness)[:, None] * (chord[around] * side)
    x = aft[around] + chord[around] * (1.0 - q[:, None])
    loops = np.stack([x, np.broadcast_to(y[around], x.shape), half], axis=-1)
    vertices, faces = lofted(loops)
    c, s = np.cos(fin.roll), np.sin(fin.roll)
    return TriangleMesh(vertices @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]).T, faces)


@dataclass(frozen=True, slots=True, kw_only=True)
class File(ShapedBodyFile):
    """A body.toml whose shape is a spheroid with fins, or fins alone.

    Attributes
    ----------
    hull : table
        The spheroid; without it the fins are alone.
    fin : array of tables
        Fins, one at least.
    """

    reader: ClassVar[str] = "finned"
    hull: Annotated[SpheroidKeys | None, takes.OrEmpty()] = None
    fin: tuple[FinKeys, ...] = ()

    def check(self) -> None:
        """Fins of different names."""
        ShapedBodyFile.check(self)
        if not self.fin:
            raise InputError("no [[fin]]", "one fin at least", column="fin")
        names = [fin.name for fin in self.fin]
        for i, name in enumerate(names):
            if name in (*names[:i], HULL):
                raise InputError(f"two parts called {shown(name)}", "one name for each part", column=f"fin[{i}].name")

    @property
    def spheroid(self) -> Parts | None:
        """The hull."""
        if self.hull is None:
            return None
        half = self.hull.diameter / 2.0
        form = Ellipsoid(self.hull.length / 2.0, half, half)
        return Parts((Part(HULL, form, np.array([self.hull.middle, 0.0, 0.0]), np.eye(3)),))

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Hull and fins."""
        fins = tuple(fin.piece for fin in self.fin)
        hull = self.spheroid
        return fins if hull is None else (*part_pieces(hull, (surface_of(hull.parts[0].form),)), *fins)

    def outlined(self, whole: Configuration, controls: tuple[Control, ...]) -> Outline:
        """What semi-empirical methods see of it.

        Parameters
        ----------
        whole : Configuration
            With volume and wetted surface.
        controls : tuple of Control
        """
        hulls = () if self.spheroid is None else of_parts(self.spheroid).hulls
        foils: list[Foil] = []
        for fin in self.fin:
            way = np.array([np.cos(fin.roll), np.sin(fin.roll)])
            foils += fin.foils(radius_towards(hulls[0], way) if hulls else None)
        turned, left = with_controls(foils, controls)
        return Outline(hulls, turned, (), (), whole.wetted_surface or 0.0, whole.volume or 0.0, left)


def mesh(pieces: tuple[Piece, ...], panels: int = PANELS) -> TriangleMesh:
    """What the pieces enclose together, of about so many triangles."""
    share = np.sqrt([piece.area for piece in pieces])
    counts = np.maximum(panels * share / share.sum(), 64).astype(int)
    whole = united([piece.surface(int(count)) for piece, count in zip(pieces, counts, strict=True)])
    return TriangleMesh(whole.vertices, whole.faces, remade=lambda other: mesh(pieces, other))


def read(path: Path) -> Body:
    """Read a body.toml whose shape is a spheroid with fins, ``[hull]`` and ``[[fin]]``, or fins alone.

    Raises
    ------
    InputError
        Everything missing, unknown, of the wrong unit or out of bounds, by file, line and key.
    """
    file = takes.declared(File, read_toml(path))
    shape = mesh(file.pieces)
    whole = computed(shape, ())
    return file.shaped(path, shape, whole, file.pieces, partial(file.outlined, whole))

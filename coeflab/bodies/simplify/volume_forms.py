"""Simple forms of a piece's volume: cylinders, ellipsoids and boxes in given axes; arrays in, arrays out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.solids import Surface
from coeflab.bodies.shape import Bar, Box, Cylinder, Ellipsoid, Plate, Tube, Turned, shadow
from coeflab.bodies.simplify.round_hull import round_hull
from coeflab.core.types import Array, brief
from coeflab.law.transforms import about_axis, relabelled

ALIKE = 0.02
MAKES: dict[str, Any] = {
    "cylinder": Cylinder, "tube": Tube, "plate": Plate, "ellipsoid": Ellipsoid, "box": Box, "bar": Bar,
}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A closed surface and what its fits need of it.

    Attributes
    ----------
    vertices : (n, 3) array
        m.
    areas : (m, 3) array
        Area vectors of its faces, m^2.
    volume : float
        m^3.
    centre : (3,) array
        Of the volume, m.
    spread : (3, 3) array
        Second moments of the volume about its centre, over the volume, m^2.
    """

    vertices: Array
    areas: Array
    volume: float
    centre: Array
    spread: Array

    @classmethod
    def of(cls, surface: Surface) -> Piece:
        """From vertices and faces."""
        vertices, faces = surface
        whole = mesh_integrals(vertices, faces)
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        return cls(
            vertices, np.cross(b - a, c - a) / 2.0, whole.volume, whole.centre, whole.second_moments / whole.volume
        )

    def extents(self, turn: Array) -> Array:
        """(3,) sizes along the columns of ``turn``, m."""
        return np.asarray(np.ptp(self.vertices @ turn, axis=0))

    def projected(self, turn: Array) -> Array:
        """(3,) projected areas along the columns of ``turn``, m^2."""
        return np.asarray(np.abs(self.areas @ turn).sum(axis=0) / 2.0)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """A form about its own axes.

    Attributes
    ----------
    form : str
        ``cylinder`` (radius, length), ``tube`` (radius, inner radius, length), ``ellipsoid`` (semi-axes) or ``box`` (sides).
    sizes : tuple of float
        m.
    rotation : (3, 3) array
        Columns are its axes.
    """

    form: str
    sizes: tuple[float, ...]
    rotation: Array

    @property
    def extents(self) -> Array:
        """(3,) sizes along its own axes, m."""
        if self.form == "cylinder":
            radius, length = self.sizes
            return np.array([length, 2.0 * radius, 2.0 * radius])
        if self.form == "tube":
            return np.array([self.sizes[2], 2.0 * self.sizes[0], 2.0 * self.sizes[0]])
        return np.array(self.sizes) * (2.0 if self.form == "ellipsoid" else 1.0)

    @property
    def projected(self) -> Array:
        """(3,) projected areas along its own axes, m^2."""
        x, y, z = self.extents
        if self.form == "cylinder":
            return np.array([np.pi / 4.0 * y * z, x * z, x * y])
        if self.form == "tube":
            return np.array([shadow(Tube(*self.sizes), axis) for axis in np.eye(3)])
        return np.array([y * z, x * z, x * y]) * (np.pi / 4.0 if self.form == "ellipsoid" else 1.0)

    def misfit(self, of: Piece) -> float:
        """Error of the length over the length, plus errors of the three projected areas over their sum.

        The volume has none. Length is the largest extent of the piece along the form's own axes.
        """
        extents, areas = of.extents(self.rotation), of.projected(self.rotation)
        longest = int(np.argmax(extents))
        length = abs(float(self.extents[longest] / extents[longest]) - 1.0)
        return length + float(np.abs(self.projected - areas).sum() / areas.sum())


def cylinders(of: Piece, frames: list[Array]) -> Iterator[Fit]:
    """About every axis of the frames: of the piece's volume and extent, and of its volume and area across the axis."""
    for frame in frames:
        for axis in frame.T:
            turn = about_axis(axis)
            length = float(of.extents(turn)[0])
            yield Fit("cylinder", (float(np.sqrt(of.volume / (np.pi * length))), length), turn)
            across = float(of.projected(turn)[1:].mean())
            radius = 2.0 * of.volume / (np.pi * across)
            yield Fit("cylinder", (radius, across / (2.0 * radius)), turn)


def ellipsoids(of: Piece, frames: list[Array]) -> Iterator[Fit]:
    """Of the piece's volume, length and largest projected area; round ones of its volume and length."""
    spread, principal = np.linalg.eigh(of.spread)
    unit = 3.0 * of.volume / (4.0 * np.pi)
    if spread[2] < (1.0 + ALIKE) * spread[0]:
        yield Fit("ellipsoid", (float(np.cbrt(unit)),) * 3, np.eye(3))
        return
    round_about = [k for k, i, j in ((2, 0, 1), (0, 1, 2)) if spread[j] < (1.0 + ALIKE) * spread[i]]
    if round_about:
        turn = about_axis(principal[:, round_about[0]])
        along, across = float(of.extents(turn)[0]) / 2.0, float(of.extents(turn)[1:].mean()) / 2.0
        along, across = (along, np.sqrt(unit / along)) if along > across else (unit / across**2, across)
        yield Fit("ellipsoid", (along, float(across), float(across)), turn)
        return
    for frame in frames:
        turn = relabelled(frame)
        areas, half = of.projected(turn), of.extents(turn) / 2.0
        sizes = _triple(half, areas / np.pi, unit)
        yield Fit("ellipsoid", sizes, turn)


def boxes(of: Piece, frames: list[Array]) -> Iterator[Fit]:
    """Of the piece's volume, length and largest projected area."""
    for frame in frames:
        turn = relabelled(frame)
        yield Fit("box", _triple(of.extents(turn), of.projected(turn), of.volume), turn)


def _triple(extents: Array, areas: Array, product: float) -> tuple[float, ...]:
    """Three sizes: the longest as given, its product with the next as the largest area, and all three as ``product``."""
    thin = int(np.argmax(areas))
    long = int(np.argmax(np.where(np.arange(3) == thin, 0.0, extents)))
    sizes = np.empty(3)
    sizes[thin], sizes[long], sizes[3 - thin - long] = product / areas[thin], extents[long], areas[thin] / extents[long]
    return tuple(float(s) for s in sizes)


def tubes(of: Piece, frames: list[Array]) -> Iterator[Fit]:
    """About every axis of the frames: of the piece's volume, and of its extents along and across the axis."""
    for frame in frames:
        for axis in frame.T:
            turn = about_axis(axis)
            length, *across = of.extents(turn)
            outer = float(np.mean(across)) / 2.0
            inner = outer**2 - of.volume / (np.pi * length)
            if inner > (HOLE * outer) ** 2:
                yield Fit("tube", (outer, float(np.sqrt(inner)), float(length)), turn)


def turned_form(of: Surface, piece: Piece) -> tuple[Turned, Array, Array] | None:
    """The body of revolution with a piece's volume, its rotation and its centre; None where the piece is not round.

    The radius at each station is that in which most of 72 rays from the axis meet the surface (`round_hull`), with as few
    stations as keep every other within 0.2 % of the largest radius.
    """
    spread = np.sqrt(np.linalg.eigvalsh(piece.spread))
    if min(spread[1] / spread[0], spread[2] / spread[1]) > OVAL:
        return None
    hull = round_hull(*of)
    if hull is None or hull.roundness < ROUND:
        return None
    along = (piece.vertices - hull.point) @ hull.rotation[:, 0]
    x = np.concatenate([[along.min()], hull.x, [along.max()]])
    radius = np.concatenate([hull.radius[:1], hull.radius, hull.radius[-1:]])
    selected = np.concatenate([[True], np.diff(x) > APART * np.ptp(x)])
    x, radius = _few(x[selected], radius[selected], CLOSE * float(radius.max()))
    rough, _ = Turned.about_its_centre(x, radius)
    scale = float(np.sqrt(piece.volume / rough.volume))
    if abs(scale - 1.0) > SAME:
        return None
    turn = about_axis(hull.rotation[:, 0])
    if turn[:, 0] @ hull.rotation[:, 0] < 0.0:
        x, radius = -x[::-1], radius[::-1]
    turned, middle = Turned.about_its_centre(x, radius * scale)
    return turned, turn, hull.point + turn[:, 0] * middle


def _few(x: Array, y: Array, within: float) -> tuple[Array, Array]:
    """The points that keep all others within a distance in y of the straight lines between them (Douglas & Peucker 1973)."""
    selected, stack = {0, len(x) - 1}, [(0, len(x) - 1)]
    while stack:
        low, high = stack.pop()
        if high - low < 2:
            continue
        off = np.abs(y[low : high + 1] - np.interp(x[low : high + 1], x[[low, high]], y[[low, high]]))
        worst = low + int(np.argmax(off))
        if off[worst - low] > within:
            selected.add(worst)
            stack += [(low, worst), (worst, high)]
    chosen = sorted(selected)
    return x[chosen], y[chosen]


HOLE, OVAL, ROUND, APART, CLOSE, SAME = 0.2, 1.1, 0.9, 1e-4, 2e-3, 0.03

"""Simple forms of a piece's volume: cylinders, ellipsoids and boxes in given axes; arrays in, arrays out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from coeflab.kernels.attitude import about_axis, relabelled
from coeflab.kernels.brief import brief
from coeflab.kernels.least_squares import Array
from coeflab.kernels.solids import Surface
from coeflab.kernels.surface_mesh import mesh_integrals

ALIKE = 0.02


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
            vertices,
            np.cross(b - a, c - a) / 2.0,
            whole.volume,
            whole.centre,
            whole.second_moments / whole.volume,
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
        ``cylinder`` (radius, length), ``ellipsoid`` (semi-axes) or ``box`` (sides).
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
        return np.array(self.sizes) * (2.0 if self.form == "ellipsoid" else 1.0)

    @property
    def projected(self) -> Array:
        """(3,) projected areas along its own axes, m^2."""
        x, y, z = self.extents
        if self.form == "cylinder":
            return np.array([np.pi / 4.0 * y * z, x * z, x * y])
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

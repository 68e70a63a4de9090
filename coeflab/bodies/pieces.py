"""A body as the closed pieces that it is made of, and the controls that turn some of them.

The pieces overlap: each appendage reaches into what it stands on. What they enclose together is the body.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import dense_meridian, meshed
from coeflab.bodies.mesh.source import MeshSource
from coeflab.bodies.mesh.structured_surface import revolved, rings
from coeflab.bodies.shape import Parts, Revolution, as_revolution
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.types import Array, brief, locking
from coeflab.law.transforms import skew

HULL, STERN = "hull", "stern"
LONG = 3.0  # triangles of a hull of revolution over their width: it bends less along than around
Regions = Callable[[Array], tuple[tuple[str, ...], NDArray[np.int64]]]
Direction = Annotated[tuple[float, float, float], takes.numbers(3, "none", "a direction [x, y, z]")]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """One closed piece of a body.

    Attributes
    ----------
    name : str
        What controls call it: ``plane_upper``.
    patch : str
        What its surface is called in a solver; several pieces may share one.
    surface : callable
        ``surface(panels)``: its triangles, about so many, m, FRD, from the datum. InputError where it encloses nothing.
    area : float
        Of its surface, about, m^2; triangles are shared out by its root.
    chord : float
        Mean chord of an appendage, length of a hull, m.
    stern : float, optional
        Of a hull: where its run begins, x from the datum, m, FRD; what lies aft of it is a patch of its own.
    regions : callable, optional
        ``regions(points)``: names of patches within the piece, none if it is one, and which of them each of (n, 3) points of
        its surface lies on, m, FRD, from the datum.
    turned : Revolution, optional
        What a piece that is round about x is made of.
    """

    name: str
    patch: str
    surface: Callable[[int], TriangleMesh]
    area: float
    chord: float
    stern: float | None = None
    regions: Regions | None = None
    turned: Revolution | None = None


def hull_piece(shape: Revolution, area: float, stern: float | None = None) -> Piece:
    """A body of revolution all in one piece, called ``hull``.

    Parameters
    ----------
    shape : Revolution
    area : float
        Of its surface, about, m^2.
    stern : float, optional
        Where its run begins, x from the datum, m, FRD.
    """
    return Piece(HULL, HULL, partial(_revolution, shape), area, shape.length, stern, turned=shape)


def _revolution(shape: Revolution, panels: int) -> TriangleMesh:
    """Rings graded to the ends, every corner on the meridian."""
    x, radius = dense_meridian(shape)
    places, radii, around = rings(x / LONG, radius, panels)
    vertices, faces = revolved(places * LONG, radii, around)
    return TriangleMesh(vertices + np.array([0.0, *shape.axis]), faces, shape.volume)


def mesh_piece(mesh: TriangleMesh, source: MeshSource) -> Piece:
    """A mesh as it is, called ``hull``; solids that its file names are patches of their own."""
    return Piece(HULL, HULL, lambda _panels: mesh, mesh.integrals.area, mesh.length, regions=source.solids)


def part_pieces(shape: Parts, areas: Iterable[float]) -> tuple[Piece, ...]:
    """Every part as a piece and a patch of its own name.

    Parameters
    ----------
    shape : Parts
    areas : iterable of float
        Of each part's surface, about, m^2.
    """

    def one(k: int, area: float) -> Piece:
        part, alone = shape.parts[k], Parts(shape.parts[k : k + 1])
        about_x = as_revolution(alone)
        surface = partial(meshed, alone) if about_x is None else partial(_revolution, about_x)
        length = 2.0 * float(part.form.half_extents(part.rotation)[0])
        return Piece(part.name, part.name, surface, area, length, turned=about_x)

    return tuple(one(k, area) for k, (_, area) in enumerate(zip(shape.parts, areas, strict=True)))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("hinge axis")
class Control:
    """What turns about one hinge.

    Attributes
    ----------
    name : str
        Of the angle: ``dr``. Pieces that turn about different hinges by one angle share its name.
    parts : tuple of str
        Names of the pieces.
    hinge : (3,) array
        A point on the hinge, m, FRD, from the datum.
    axis : (3,) array
        Along the hinge, a unit vector, FRD; a positive angle turns right-handed about it.
    limit, rate : float, optional
        Largest angle either way, rad, and how fast it turns, rad/s, where they are stated.
    """

    name: str
    parts: tuple[str, ...]
    hinge: Array
    axis: Array
    limit: float | None = None
    rate: float | None = None

    def turned(self, vertices: Array, angle: float) -> Array:
        """(n, 3) points after a turn by an angle, rad (Rodrigues)."""
        about = skew(self.axis)
        turn = np.eye(3) + np.sin(angle) * about + (1.0 - np.cos(angle)) * about @ about
        return np.asarray((vertices - self.hinge) @ turn.T + self.hinge)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ControlKeys(takes.Declaration):
    """A control: parts that turn together about one hinge. Two of the same name turn by the same angle.

    Attributes
    ----------
    name : str
        Of its angle, such as dr or ds.
    parts : list of str
        Names of the parts that turn.
    hinge : (3,) array
        A point on the hinge, [x, y, z], m, FRD, from the datum.
    axis : (3,) tuple
        Along the hinge, [x, y, z], FRD; a positive angle turns right-handed about it: [0, 0, 1] for a rudder, positive with
        its trailing edge to port, [0, 1, 0] for stern planes, positive with their trailing edges down.
    limit : float
        Largest angle either way; a vehicle is moved with none beyond it.
    rate : float
        Of the angle; at once unless given.
    """

    name: takes.Text
    parts: takes.Texts
    hinge: takes.Point
    axis: Direction
    limit: Annotated[takes.Angle, takes.ABOVE_ZERO] | None = None
    rate: Annotated[takes.Rate, takes.ABOVE_ZERO] | None = None

    def check(self) -> None:
        """Something turns, about a direction."""
        if not self.parts:
            raise InputError("no part", "one part at least that turns", column="parts")
        if not np.linalg.norm(self.axis) > 0.0:
            raise InputError("an axis without a direction", "[x, y, z], one of them not zero", column="axis")

    def build(self, pieces: tuple[Piece, ...], foils: tuple[str, ...] = ()) -> Control:
        """The control of a body of these pieces.

        Parameters
        ----------
        pieces : tuple of Piece
        foils : tuple of str
            Names of foils that were found on a mesh in one piece; estimates turn them, a tow does not.

        Raises
        ------
        InputError
            A part that the body does not have.
        """
        known = [*(piece.name for piece in pieces), *foils]
        for name in self.parts:
            if name not in known:
                found = f"no part {shown(name)} of the body"
                raise InputError(found, f"one of {', '.join(known) or 'none: it is in one piece'}", column="parts")
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        return Control(self.name, self.parts, self.hinge, axis, self.limit, self.rate)

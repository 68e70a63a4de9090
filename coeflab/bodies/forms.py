"""Simple forms, each about its own centre and axes: volume, second moments, extents and projected areas."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.closed_forms.revolution import MeridianIntegrals, meridian_integrals
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core.errors import InputError
from coeflab.core.limits import LONGEST_PART, SHORTEST_PART
from coeflab.core.types import Array

NEARLY_CENTRED = 1e-4  # of the length: closer to its centre of volume a revolution's origin is that centre


def within_reach(form: str, **dimensions: float) -> None:
    """Refuse dimensions of a form that no body has, m.

    Raises
    ------
    InputError
    """
    for name, value in dimensions.items():
        if not SHORTEST_PART <= value <= LONGEST_PART:
            found = f"{name.replace('_', ' ')} = {value:g} m of a {form}"
            expected = f"a length above zero, from {SHORTEST_PART:g} to {LONGEST_PART:g} m"
            raise InputError(found, expected, column=name, advice="Is the unit right?" if value > LONGEST_PART else "")


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A circular cylinder with flat ends, its axis along its own x; m."""

    radius: float
    length: float

    def __post_init__(self) -> None:
        within_reach("cylinder", radius=self.radius, length=self.length)

    @property
    def volume(self) -> float:
        """m^3."""
        return float(np.pi * self.radius**2 * self.length)

    @property
    def spread(self) -> Array:
        """(3,) second moments of the volume along its own axes, over the volume, m^2."""
        return np.array([self.length**2 / 12.0, self.radius**2 / 4.0, self.radius**2 / 4.0])

    def half_extents(self, rotation: Array) -> Array:
        """Half the size along the outer axes, m."""
        along = rotation[:, 0]
        across = np.sqrt(np.clip(1.0 - along**2, 0.0, None))
        return np.asarray(np.abs(along) * self.length / 2.0 + across * self.radius)


@dataclass(frozen=True, slots=True)
class Plate:
    """A thin rectangular plate: chord along its own x, span along its own y, normal along its own z; m."""

    chord: float
    span: float

    def __post_init__(self) -> None:
        within_reach("plate", chord=self.chord, span=self.span)

    @property
    def aspect(self) -> float:
        """Longer over shorter side."""
        return max(self.chord, self.span) / min(self.chord, self.span)

    @property
    def volume(self) -> float:
        """Nothing is displaced."""
        return 0.0

    @property
    def spread(self) -> Array:
        """(3,) second moments of the volume along its own axes, over the volume, m^2."""
        return np.array([self.chord**2, self.span**2, 0.0]) / 12.0

    def half_extents(self, rotation: Array) -> Array:
        """Half the size along the outer axes, m."""
        return np.asarray(np.abs(rotation) @ np.array([self.chord, self.span, 0.0]) / 2.0)


@dataclass(frozen=True, slots=True)
class Ellipsoid:
    """An ellipsoid of semi-axes along its own x, y, z, m; spheroids and spheres have equal ones."""

    x: float
    y: float
    z: float

    def __post_init__(self) -> None:
        within_reach("ellipsoid", semi_axis_x=self.x, semi_axis_y=self.y, semi_axis_z=self.z)

    @property
    def axes(self) -> Array:
        """(3,) semi-axes, m."""
        return np.array([self.x, self.y, self.z])

    @property
    def volume(self) -> float:
        """m^3."""
        return float(4.0 * np.pi / 3.0 * self.x * self.y * self.z)

    @property
    def spread(self) -> Array:
        """(3,) second moments of the volume along its own axes, over the volume, m^2."""
        return np.asarray(self.axes**2 / 5.0)

    def half_extents(self, rotation: Array) -> Array:
        """Half the size along the outer axes, m."""
        return np.asarray(np.sqrt(rotation**2 @ self.axes**2))


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangular box: length, width, height along its own x, y, z; m."""

    length: float
    width: float
    height: float

    def __post_init__(self) -> None:
        within_reach("box", length=self.length, width=self.width, height=self.height)

    @property
    def sides(self) -> Array:
        """(3,) length, width and height, m."""
        return np.array([self.length, self.width, self.height])

    @property
    def volume(self) -> float:
        """m^3."""
        return self.length * self.width * self.height

    @property
    def spread(self) -> Array:
        """(3,) second moments of the volume along its own axes, over the volume, m^2."""
        return np.asarray(self.sides**2 / 12.0)

    def half_extents(self, rotation: Array) -> Array:
        """Half the size along the outer axes, m."""
        return np.asarray(np.abs(rotation) @ self.sides / 2.0)


@dataclass(frozen=True, slots=True)
class Bar(Box):
    """A long bar of rectangular section, a tube of a frame: length, width, height along its own x, y, z; m."""


@dataclass(frozen=True, slots=True)
class Tube:
    """An open tube, a duct or a ring: outer and inner radius, its axis along its own x; m."""

    radius: float
    inner_radius: float
    length: float

    def __post_init__(self) -> None:
        within_reach("tube", radius=self.radius, inner_radius=self.inner_radius, length=self.length)
        if not self.inner_radius < self.radius:
            found = f"inner_radius = {self.inner_radius:g} m of a tube of radius {self.radius:g} m"
            raise InputError(found, "an inner radius below the outer one", column="inner_radius")

    @property
    def volume(self) -> float:
        """Of the wall, m^3."""
        return float(np.pi * (self.radius**2 - self.inner_radius**2) * self.length)

    @property
    def spread(self) -> Array:
        """(3,) second moments of the volume along its own axes, over the volume, m^2."""
        across = (self.radius**2 + self.inner_radius**2) / 4.0
        return np.array([self.length**2 / 12.0, across, across])

    def half_extents(self, rotation: Array) -> Array:
        """Half the size along the outer axes, m."""
        return Cylinder(self.radius, self.length).half_extents(rotation)


@dataclass(frozen=True, slots=True)
class Turned:
    """A body of revolution about its own x: stations along it, rising, from the centre of volume, and radii; m.

    The profile is straight between stations; a radius above zero at an end closes with a flat disc.
    """

    stations: tuple[float, ...]
    radii: tuple[float, ...]

    def __post_init__(self) -> None:
        x, radius = np.array(self.stations), np.array(self.radii)
        if len(x) != len(radius) or len(x) < 2:
            found = f"{len(x)} stations and {len(radius)} radii"
            raise InputError(found, "as many radii as stations, two at least", column="radii")
        if not np.all(np.diff(x) > 0.0):
            raise InputError("stations that do not rise", "stations from aft to fore", column="stations")
        if np.any(radius < 0.0):
            raise InputError(f"a radius of {radius.min():g} m", "radii of at least zero", column="radii")
        within_reach("revolution", length=float(np.ptp(x)), radius=float(radius.max()))

    @classmethod
    def about_its_centre(cls, stations: Array, radii: Array) -> tuple[Turned, float]:
        """The form of stations from any origin, and where its centre of volume lies on them, m."""
        found = cls(tuple(map(float, stations)), tuple(map(float, radii)))
        centre = found.quadrature.centre
        if abs(centre) <= NEARLY_CENTRED * found.length:
            return found, 0.0
        return cls(tuple(float(x) - centre for x in stations), found.radii), centre

    @property
    def length(self) -> float:
        """From end to end, m."""
        return self.stations[-1] - self.stations[0]

    @property
    def middle(self) -> float:
        """Half way between the ends, from the centre of volume, m."""
        return (self.stations[-1] + self.stations[0]) / 2.0

    @property
    def nodes(self) -> tuple[Array, Array, Array, Array]:
        """Stations, weights, radii and R dR/dx, m, by which the integrals of a straight profile are exact."""
        x, radius = np.array(self.stations), np.array(self.radii)
        place, weight = np.polynomial.legendre.leggauss(3)
        step, rise = np.diff(x)[:, None], np.diff(radius)[:, None]
        share = (place + 1.0) / 2.0
        radii = radius[:-1, None] + rise * share
        slopes = radii * rise / step
        places, weights = x[:-1, None] + step * share, step * weight / 2.0
        return places.ravel(), weights.ravel(), radii.ravel(), slopes.ravel()

    @property
    def quadrature(self) -> MeridianIntegrals:
        """Volume, centre along x, surface without flat ends, second moment."""
        return meridian_integrals(*self.nodes)

    @property
    def volume(self) -> float:
        """m^3."""
        return self.quadrature.volume

    @property
    def spread(self) -> Array:
        """(3,) second moments of the volume along its own axes, over the volume, m^2."""
        _, weight, radius, _ = self.nodes
        across = float(np.pi * weight @ radius**4) / 4.0
        return np.array([self.quadrature.second_moment, across, across]) / self.volume

    def half_extents(self, rotation: Array) -> Array:
        """Half the size along the outer axes, m."""
        along = rotation[:, :1] * np.array(self.stations)
        across = np.sqrt(np.clip(1.0 - rotation[:, :1] ** 2, 0.0, None)) * np.array(self.radii)
        return np.asarray((np.max(along + across, axis=1) - np.min(along - across, axis=1)) / 2.0)


@dataclass(frozen=True, slots=True)
class Finned:
    """Fins alike on a round hull whose axis is the form's own x: what they add to that hull; m.

    Two lie along its own y, four along y and z. ``radius`` is the hull's, ``semi_span`` reaches from the axis to a tip.
    """

    radius: float
    semi_span: float
    chord: float
    thickness: float
    count: int = 4

    def __post_init__(self) -> None:
        within_reach("finned section", radius=self.radius, semi_span=self.semi_span, chord=self.chord)
        within_reach("finned section", thickness=self.thickness)
        if not self.semi_span > self.radius:
            found = f"semi_span = {self.semi_span:g} m on a hull of radius {self.radius:g} m"
            raise InputError(found, "tips beyond the hull", column="semi_span")
        if not self.thickness < 2.0 * self.radius:
            raise InputError(f"thickness = {self.thickness:g} m", "less than the hull's diameter", column="thickness")
        if self.count not in (2, 4):
            raise InputError(f"{self.count} fins", "2 or 4", column="count")

    @property
    def root(self) -> float:
        """Where the edges of a root meet the hull, from the axis, m."""
        return float(np.sqrt(self.radius**2 - self.thickness**2 / 4.0))

    @property
    def volume(self) -> float:
        """Of the fins from their roots on, m^3."""
        return self.count * self.thickness * self.chord * (self.semi_span - self.root)

    @property
    def spread(self) -> Array:
        """(3,) second moments of the volume along its own axes, over the volume, m^2."""
        s, r = self.semi_span, self.root
        out, across = (s**2 + s * r + r**2) / 3.0, self.thickness**2 / 12.0
        y, z = (out, across) if self.count == 2 else ((out + across) / 2.0,) * 2
        return np.array([self.chord**2 / 12.0, y, z])

    def half_extents(self, rotation: Array) -> Array:
        """Half the size along the outer axes, m."""
        s, t = self.semi_span, self.thickness / 2.0
        slabs = [np.array([self.chord / 2.0, s, t]), np.array([self.chord / 2.0, t, s])][: self.count // 2]
        return np.asarray(np.max([np.abs(rotation) @ half for half in slabs], axis=0))


@dataclass(frozen=True, slots=True, eq=False)
class Faceted:
    """A closed surface of triangles, for what is like no simple form; m, from its centre of volume."""

    mesh: TriangleMesh

    @classmethod
    def about_its_centre(cls, mesh: TriangleMesh) -> tuple[Faceted, Array]:
        """The form of a mesh anywhere, and its centre of volume, m."""
        centre = mesh.centre_of_volume
        return cls(TriangleMesh(mesh.vertices - centre, mesh.faces)), centre

    @property
    def volume(self) -> float:
        """m^3."""
        return self.mesh.volume

    @property
    def spread(self) -> Array:
        """(3, 3) second moments of the volume about its centre, over the volume, m^2."""
        return np.asarray(self.mesh.integrals.second_moments / self.mesh.volume)

    def half_extents(self, rotation: Array) -> Array:
        """Half the size along the outer axes, m."""
        return np.asarray(np.ptp(self.mesh.vertices @ rotation.T, axis=0) / 2.0)


Form = Cylinder | Plate | Ellipsoid | Box | Bar | Tube | Turned | Finned | Faceted
CLASSES = {
    Cylinder: "cylinder", Plate: "plate", Ellipsoid: "ellipsoid", Box: "box", Bar: "bar", Tube: "tube",
    Turned: "revolution", Finned: "finned", Faceted: "mesh",
}  # fmt: skip


def shadow(form: Form, direction: NDArray[np.float64]) -> float:
    """Area projected along a unit direction given in the form's own axes, m^2; exact.

    Of a form that is not convex, faces that hide one another count in full.
    """
    x, y, z = (abs(float(d)) for d in direction)
    if isinstance(form, Cylinder):
        return float(np.pi * form.radius**2 * x + 2.0 * form.radius * form.length * np.hypot(y, z))
    if isinstance(form, Plate):
        return form.chord * form.span * z
    if isinstance(form, Box):
        return form.width * form.height * x + form.length * form.height * y + form.length * form.width * z
    if isinstance(form, Tube):
        wall = np.pi * (form.radius**2 - form.inner_radius**2)
        return float(wall * x + 2.0 * (form.radius + form.inner_radius) * form.length * np.hypot(y, z))
    if isinstance(form, Turned):
        return _shadow_of_turned(form, x, float(np.hypot(y, z)))
    if isinstance(form, Finned):
        chord, thick, span = form.chord, form.thickness, form.semi_span - form.root
        one = thick * span * x + chord * thick * y + chord * span * z
        other = thick * span * x + chord * span * y + chord * thick * z
        return 2.0 * one + (2.0 * other if form.count == 4 else 0.0)
    if isinstance(form, Faceted):
        corner = form.mesh.vertices[form.mesh.faces]
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        return float(np.abs(normal @ direction).sum() / 4.0)
    a, b, c = form.axes
    return float(np.pi * np.sqrt((b * c * x) ** 2 + (a * c * y) ** 2 + (a * b * z) ** 2))


def _shadow_of_turned(form: Turned, along: float, across: float) -> float:
    """Half of what the sides of all its cones and the flat ends project; along and across are cosines, both positive.

    A cone's element projects |across cos t - along dR/dx| R dx dt.
    """
    x, radius = np.array(form.stations), np.array(form.radii)
    slope = np.abs(np.diff(radius) / np.diff(x)) * along
    side = (radius[1:] + radius[:-1]) / 2.0 * np.diff(x)
    if across == 0.0:
        around = 2.0 * np.pi * slope
    else:
        ratio = np.clip(slope / across, 0.0, 1.0)
        partly = 4.0 * across * (np.sqrt(1.0 - ratio**2) + ratio * np.arcsin(ratio))
        around = np.where(slope >= across, 2.0 * np.pi * slope, partly)
    return float(side @ around + np.pi * (radius[0] ** 2 + radius[-1] ** 2) * along) / 2.0

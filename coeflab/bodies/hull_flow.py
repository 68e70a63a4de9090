"""Flow about a hull that several methods share: added mass of its sections, boundary layer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.closed_forms.revolution import lamb_end_correction
from coeflab.bodies.outline import Sections
from coeflab.core.types import Array, brief, locking
from coeflab.law.friction_line import friction_line
from coeflab.law.transforms import moved

# Shape factors: one-seventh power law; halfway from 1.4, measured on flat plates, to 2.4 at separation.
FLAT, STERN = 9.0 / 7.0, 1.9
FALLING = 0.99  # of the largest section: from there aft the pressure rises


def integral(values: Array, x: Array) -> Array:
    """Over falling stations x (m,), of values (..., m): from the aftmost to the foremost."""
    step = x[:-1] - x[1:]
    return np.asarray((values[..., :-1] + values[..., 1:]) @ step / 2.0)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("sway heave surface momentum")
class HullFlow:
    """A hull in a stream of speed U.

    Attributes
    ----------
    hull : Sections
    density, friction : float
        kg/m^3; C_F on its length.
    sway, heave : (m,) array
        Added mass of each section, kg/m, of the ellipse of its breadth and depth.
    surface, momentum : (m,) array
        Of what lies ahead of each station: wetted surface, and momentum area of the boundary layer, m^2.
    """

    hull: Sections
    density: float
    friction: float
    sway: Array
    heave: Array
    surface: Array
    momentum: Array

    @property
    def volume(self) -> float:
        """m^3."""
        return float(integral(self.hull.area, self.hull.x))

    @property
    def axis(self) -> Array:
        """Centre of volume across x, (y, z), m."""
        return np.asarray(integral(self.hull.area * self.hull.centre.T, self.hull.x) / self.volume)

    @property
    def diameter(self) -> float:
        """Of the circle of the largest section, m."""
        return float(2.0 * np.sqrt(self.hull.area.max() / np.pi))

    @property
    def added_mass(self) -> Array:
        """(6, 6) about the datum, kg, kg m, kg m^2: sections with Lamb's k1, k2 and k' of the spheroid of equal volume."""
        x, k = self.hull.x, lamb_end_correction(self.hull.length, self.volume)
        out = np.zeros((6, 6))
        out[0, 0] = k.axial * self.density * self.volume
        middle = float(integral(self.hull.area * x, x)) / self.volume
        lever = x - middle
        for row, turn, mass, sign in ((1, 5, self.sway, 1.0), (2, 4, self.heave, -1.0)):
            out[row, row] = k.lateral * integral(mass, x)
            out[turn, turn] = k.turning * integral(mass * lever**2, x)
            out[row, turn] = out[turn, row] = sign * k.lateral * integral(mass * lever, x)
        return moved(out, -np.array([middle, *self.axis]))

    @property
    def apparent(self) -> float:
        """k2 - k1 of the spheroid of the same length and volume."""
        k = lamb_end_correction(self.hull.length, self.volume)
        return k.lateral - k.axial

    def at(self, values: Array, x: float) -> float:
        """A value of the sections at a station; zero off the hull."""
        return float(np.interp(x, self.hull.x[::-1], values[::-1], left=0.0, right=0.0))

    def shape_factor(self, x: float) -> float:
        """Displacement over momentum thickness: of a flat plate, or of the stern, where the sections fall off."""
        largest = int(np.argmax(self.hull.area))
        falling = x < self.hull.x[largest] and self.at(self.hull.area, x) < FALLING * self.hull.area.max()
        return STERN if falling else FLAT

    def thickness(self, x: float, radius: float) -> float:
        """Of the boundary layer at a station where the hull has that radius, m, from its momentum area and a power law."""
        stations = np.clip(x, self.hull.x[-1], self.hull.x[0])
        area = float(np.interp(stations, self.hull.x[::-1], self.momentum[::-1]))
        n = 2.0 / (self.shape_factor(x) - 1.0)
        plane, ring = n / ((n + 1.0) * (n + 2.0)), n / (2.0 * n + 1.0) - n / (2.0 * n + 2.0)
        return float((np.sqrt((radius * plane) ** 2 + 2.0 * ring * area / np.pi) - radius * plane) / (2.0 * ring))

    def pressure_share(self, x: float, radius: float, low: float, high: float) -> float:
        """Mean of (u/U)^2 between two heights above the hull, m."""
        n, layer = 2.0 / (self.shape_factor(x) - 1.0), self.thickness(x, radius)
        if layer <= 0.0 or high <= low:
            return 1.0
        power = 2.0 / n + 1.0
        inside = [layer * min(h / layer, 1.0) ** power / power + max(h - layer, 0.0) for h in (low, high)]
        return float((inside[1] - inside[0]) / (high - low))


def hull_flow(hull: Sections, density: float, viscosity: float, speed: float) -> HullFlow:
    """The flow about one hull.

    Parameters
    ----------
    hull : Sections
    density, viscosity, speed : float
        kg/m^3, m^2/s, m/s.
    """
    friction = friction_line(speed * hull.length / viscosity)
    mean = hull.girth / (2.0 * np.pi)
    slant = np.hypot(np.diff(hull.x), np.diff(mean))
    surface = np.concatenate([[0.0], np.cumsum((hull.girth[:-1] + hull.girth[1:]) / 2.0 * slant)])
    return HullFlow(
        hull, density, friction, density * np.pi / 4.0 * hull.depth**2, density * np.pi / 4.0 * hull.breadth**2,
        surface, friction * surface / 2.0,
    )  # fmt: skip


def surge(axis: Array, nu: Array) -> Array:
    """Velocity u (n,) of the line along x through (y, z); not that of the datum where the body turns."""
    return np.asarray(nu[:, 0] + nu[:, 4] * axis[1] - nu[:, 5] * axis[0])


def axial(area: float, centre: Array, density: float, nu: Array, angles: dict[str, Array]) -> Array:  # noqa: ARG001
    """Drag along x of an area, with the velocity of its centre: X, M and N of it."""
    speed = surge(centre[1:], nu)
    force = -0.5 * density * area * np.abs(speed) * speed
    out = np.zeros((len(nu), 6))
    out[:, 0], out[:, 4], out[:, 5] = force, centre[2] * force, -centre[1] * force
    return out

"""Where a twin-hull glider's masses are: two pistons, a roller and the rest (equations 1 to 7 of the THAUV paper).

FRD axes about the reference point, the centre of buoyancy at no stroke, where the vehicle floats neutral::

    m = m_pr + m_pl + m_r + m_sb                                    r_s = (m_r r_r + m_sb r_sb) / m_s,   m_s = m_r + m_sb
    r_CG = (m_pr r_pr + m_pl r_pl + m_s r_s) / m
    r_r = (x, y + R sin(gamma), z - R (1 - cos(gamma)))             m_b = rho pi r^2 d_p   in each hull
    m_B = M_B - 2 m_b                                               r_CB = -m_b (r_pr + r_pl) / m_B

M_B is the displaced mass at no stroke (the text calls m_B so), equal to m. The pistons' weight moves with the stroke in
r_CG. In r_CB the water's lever is that of the pistons at no stroke, for it was calibrated as a constant.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Annotated, Any

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.types import Array

Triple = tuple[float, float, float]
PLACE: Any = takes.numbers(3, "length", "a point [x, y, z] of lengths")
POSITIVE = takes.Within(lambda v: "" if min(v) > 0.0 else "three lengths above zero")


@dataclass(frozen=True, slots=True)
class MassModel(takes.Declaration):
    """Pistons, roller and the rest.

    Attributes
    ----------
    piston : float
        Mass of each piston, kg.
    piston_radius : float
        m.
    piston_at : (float, float, float)
        Right piston at no stroke, m; the left one is its mirror image.
    density : float
        Of the water, kg/m^3.
    roller : float
        kg.
    roller_at : (float, float, float)
        Its centre of mass at no angle, m.
    roller_arm : float
        Radius on which that centre turns, m.
    rest : float
        Everything else, kg; its place follows from the moments of [mass].
    rest_gyration : (float, float, float)
        Radii of gyration of the rest about its own centre, m.
    """

    piston: Annotated[takes.Mass, takes.ABOVE_ZERO]
    piston_radius: Annotated[takes.Length, takes.ABOVE_ZERO]
    piston_at: Annotated[Triple, PLACE]
    density: Annotated[takes.Density, takes.ABOVE_ZERO]
    roller: Annotated[takes.Mass, takes.ABOVE_ZERO]
    roller_at: Annotated[Triple, PLACE]
    roller_arm: Annotated[takes.Length, takes.ABOVE_ZERO]
    rest: Annotated[takes.Mass, takes.ABOVE_ZERO]
    rest_gyration: Annotated[Triple, PLACE, POSITIVE]

    @property
    def total(self) -> float:
        """Mass of the vehicle, kg (equation 1); what it displaces at no stroke."""
        return 2.0 * self.piston + self.static

    @property
    def static(self) -> float:
        """Roller and rest, kg."""
        return self.roller + self.rest

    def pistons(self, stroke: float) -> tuple[Array, Array]:
        """Places (3,) of the right and the left piston, m, at a stroke, m."""
        x, y, z = self.piston_at
        return np.array([x + stroke, y, z]), np.array([x + stroke, -y, z])

    def roller_place(self, angle: float) -> Array:
        """(3,) m, at an angle, rad; above zero it leans to starboard (equation 4)."""
        x, y, z = self.roller_at
        arm = self.roller_arm
        return np.array([x, y + arm * sin(angle), z - (arm - arm * cos(angle))])

    def static_centre(self, angle: float, rest_at: Array) -> Array:
        """(3,) m, centre of gravity of roller and rest (equation 3)."""
        return np.asarray((self.roller * self.roller_place(angle) + self.rest * rest_at) / self.static)

    def centre_of_gravity(self, stroke: float, angle: float, rest_at: Array) -> Array:
        """(3,) m, of the vehicle (equation 2)."""
        right, left = self.pistons(stroke)
        static = self.static * self.static_centre(angle, rest_at)
        return np.asarray((self.piston * right + self.piston * left + static) / self.total)

    def ballast(self, stroke: float) -> float:
        """Water in one hull, kg (equation 5)."""
        return self.density * pi * self.piston_radius**2 * stroke

    def stroke(self, net_mass: float) -> float:
        """Stroke, m, that makes a net mass, kg."""
        return net_mass / (2.0 * self.ballast(1.0))

    def displaced(self, stroke: float) -> float:
        """Displaced mass, kg (equation 6)."""
        return self.total - 2.0 * self.ballast(stroke)

    def centre_of_buoyancy(self, stroke: float) -> Array:
        """(3,) m (equation 7)."""
        right, left = self.pistons(0.0)
        return np.asarray(-self.ballast(stroke) * (right + left) / self.displaced(stroke))

    def rest_place(self, ahead: float, below: float) -> Array:
        """(3,) m, of the rest where the sums of m x and m z at no stroke and angle are given, kg m; of m y it is zero."""
        right, left = self.pistons(0.0)
        others = self.piston * (right + left) + self.roller * self.roller_place(0.0)
        return np.asarray((np.array([ahead, 0.0, below]) - others) / self.rest)

    def moments(self, stroke: float, angle: float, rest_at: Array) -> Array:
        """(3,) m r_CG - m_B r_CB, kg m: the moment of weight and buoyancy is g times that, crossed with the vertical."""
        weight = self.total * self.centre_of_gravity(stroke, angle, rest_at)
        return np.asarray(weight - self.displaced(stroke) * self.centre_of_buoyancy(stroke))

    def inertia(self, stroke: float, angle: float, rest_at: Array) -> Array:
        """(3, 3) kg m^2 about the reference point, of the masses without water."""
        points = [*((self.piston, p) for p in self.pistons(stroke)), (self.roller, self.roller_place(angle))]
        out = self.rest * np.diag(np.square(self.rest_gyration))
        for mass, at in (*points, (self.rest, rest_at)):
            out = out + mass * (at @ at * np.eye(3) - np.outer(at, at))
        return np.asarray(out)

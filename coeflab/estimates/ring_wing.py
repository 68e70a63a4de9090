"""Ring wings, ducts and shrouds about x: lift by Weissinger, in the wake of the hull and of the fins ahead."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.fin_lift import carrier, left_behind_fins
from coeflab.bodies.hull_flow import hull_flow
from coeflab.bodies.outline import Outline, RingWing
from coeflab.core.types import Array, brief, locking
from coeflab.estimates import Contribution, Water

summary = "ring wings and ducts: lift by Weissinger in the wake of hull and fins, cross-flow drag"
citations = ("weissinger1955", "fletcher1957", "hoerner1965")

SHARE, DRAG_SHARE = 0.50, 0.50
PLATE = 1.17  # Hoerner: drag across, of a flat plate, on the projected area d c


def ring_slope(aspect: float) -> float:
    """Lift slope of a thin ring wing on diameter times chord, per rad; aspect is diameter over chord.

    pi^2 / (1 + pi l / 2 + l arctan(1.2 l)), l = chord over diameter (Weissinger 1955): pi^2 of short, pi a of long ones.
    """
    long = 1.0 / aspect
    return float(np.pi**2 / (1.0 + np.pi * long / 2.0 + long * np.arctan(1.2 * long)))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre")
class RingForce:
    """The force of a ring wing.

    Attributes
    ----------
    centre : (3,) array
    half : float
        Of the chord, m: its incidence is that of a circle so far behind.
    sway, heave, cross : float
        Lift per 1/2 rho u^2 and incidence, in each direction, and drag across per 1/2 rho and velocity squared, m^2.
    density : float
    """

    centre: NDArray[np.float64]
    half: float
    sway: float
    heave: float
    cross: float
    density: float

    def __call__(self, nu: Array, angles: dict[str, Array]) -> Array:
        """Forces about the datum, (n, 6)."""
        del angles
        ahead = (nu[:, :3] + np.cross(nu[:, 3:], self.centre))[:, :1]
        astern = ahead < 0.0
        behind = np.array([self.half, 0.0, 0.0])
        velocity = nu[:, :3] + np.cross(nu[:, 3:], np.where(astern, self.centre, self.centre - behind))
        side, down = velocity[:, 1], velocity[:, 2]
        lift = np.abs(ahead) * np.column_stack([np.zeros(len(nu)), self.sway * side, self.heave * down])
        drag = np.hypot(side, down)[:, None] * self.cross * velocity * np.array([0.0, 1.0, 1.0])
        force = -0.5 * self.density * (lift + drag)
        return np.hstack([force, np.cross(np.where(astern, self.centre - behind, self.centre), force)])


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """Lift and cross-flow drag of every ring wing.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    out = []
    for ring in outline.rings:
        area = ring.diameter * ring.chord
        slope = ring_slope(ring.diameter / ring.chord) * area * _pressure(outline, ring, water)
        sway, heave = (slope * left_behind_fins(outline, ring.centre, ring.diameter, row) for row in (1, 2))
        lift = RingForce(ring.centre, ring.chord / 2.0, sway, heave, 0.0, water.density)
        drag = RingForce(ring.centre, ring.chord / 2.0, 0.0, 0.0, PLATE * area, water.density)
        out += [
            Contribution(
                ring.name, "ring lift", "ring_wing", lift, SHARE, "weissinger1955", "approximation for l below 5"
            ),
            Contribution(ring.name, "ring cross-flow", "ring_wing", drag, DRAG_SHARE, "hoerner1965", "plates, 1.17"),
        ]
    return tuple(out)


def _pressure(outline: Outline, ring: RingWing, water: Water) -> float:
    """Share of the free stream's dynamic pressure in the hull's boundary layer at the ring."""
    x = float(ring.centre[0])
    hull = carrier(outline, ring.centre[1:], x)
    if hull is None:
        return 1.0
    flow = hull_flow(hull, water.density, water.viscosity, water.speed)
    radius = np.sqrt(max(float(np.interp(x, hull.x[::-1], hull.area[::-1])), 0.0) / np.pi)
    if radius >= ring.diameter / 2.0:
        return 1.0
    height, thin = ring.diameter / 2.0 - radius, 0.05 * ring.diameter
    return flow.pressure_share(x, radius, max(height - thin, 0.0), height + thin)

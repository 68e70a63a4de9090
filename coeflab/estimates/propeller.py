"""In-plane force of open propellers that turn about x: what they add to the side force and heave of a body at an angle and in a turn.

A propeller in yaw acts like a fin of its blades' side area (Ribner, NACA 819 and 820, 1945). Its thrust is no matter of an
estimate: `coeflab.bodies.wageningen` has the open-water series.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.fin_lift import carrier, left_behind_fins
from coeflab.bodies.hull_flow import hull_flow
from coeflab.bodies.outline import Outline, Propeller
from coeflab.core.types import Array, brief, locking
from coeflab.estimates import Contribution, Water

summary = "in-plane force of open propellers in oblique flow, behind hull and fins"
citations = ("ribner1945", "young1965", "bernitsas1981")

SHARE = 0.40
HUB = 0.2  # of the radius, where blades begin
LOADING = 0.5  # T / (1/2 rho V^2 A) of a body that drives itself, 0 to 1
ASPECT = 8.0  # of the fin that Ribner compares a propeller with
ANGLES, BLADES, NARROW = (15.0, 60.0), (2, 6), 0.25  # of Ribner's charts; A_E/A_0 of blades of aircraft


def inflow_factor(loading: float) -> float:
    """By how much thrust raises the in-plane force: 1 + a + T_c / (4 (2 + T_c)), a = (sqrt(1 + T_c) - 1) / 2.

    It equals Ribner's f(a) = (1 + a) ((1 + a) + (1 + 2 a)^2) / (1 + (1 + 2 a)^2).

    Parameters
    ----------
    loading : float
        T_c, thrust over 1/2 rho V^2 and the disc's area.
    """
    return float(1.0 + (np.sqrt(1.0 + loading) - 1.0) / 2.0 + loading / (4.0 * (2.0 + loading)))


def blade_angle(pitch_ratio: float, share: Array | float) -> Array:
    """Of a propeller of constant pitch at a share of its radius, rad."""
    return np.arctan2(pitch_ratio, np.pi * np.asarray(share))


def de_young(pitch_ratio: float, area_ratio: float) -> float:
    """In-plane force per 1/2 rho V^2, disc area and angle of an unloaded propeller (de Young 1965).

    4.25 s sin(beta + 8 deg) / (1 + 2 s), beta the blade angle at 0.75 R, s = 4 B c / (3 pi D) with the mean chord c.

    Parameters
    ----------
    pitch_ratio, area_ratio : float
        P/D; A_E/A_0.
    """
    solidity = 4.0 / (3.0 * np.pi) * _chords(area_ratio)
    angle = float(blade_angle(pitch_ratio, 0.75)) + np.radians(8.0)
    return float(4.25 * solidity * np.sin(angle) / (1.0 + 2.0 * solidity))


def side_area(pitch_ratio: float, area_ratio: float) -> float:
    """The same of a fin of aspect ratio 8 with the blades' side area (Ribner 1945, summary).

    Of B blades at all angles about x the half counts: B/2 times the integral of c sin(beta) dr.

    Parameters
    ----------
    pitch_ratio, area_ratio : float
        P/D; A_E/A_0.
    """
    share = np.asarray(HUB + (1.0 - HUB) * (np.arange(64) + 0.5) / 64.0, dtype=np.float64)
    projected = 0.5 * _chords(area_ratio) * (1.0 - HUB) * float(np.mean(np.sin(blade_angle(pitch_ratio, share))))
    slope = 2.0 * np.pi * ASPECT / (ASPECT + 2.0)
    return float(slope * projected * 2.0 / np.pi)  # D R / (pi R^2)


def _chords(area_ratio: float) -> float:
    """B c / D of the mean chord from the hub to the tip."""
    return area_ratio * np.pi / 4.0 / (0.5 * (1.0 - HUB))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre")
class InPlane:
    """The in-plane force of one propeller; ahead only.

    Attributes
    ----------
    centre : (3,) array
        Of the disc, m.
    sway, heave : float
        Force per 1/2 rho u and cross velocity, m^2.
    density : float
    """

    centre: NDArray[np.float64]
    sway: float
    heave: float
    density: float

    def __call__(self, nu: Array, angles: dict[str, Array]) -> Array:
        """Forces about the datum, (n, 6)."""
        del angles
        velocity = nu[:, :3] + np.cross(nu[:, 3:], self.centre)
        ahead = np.maximum(velocity[:, :1], 0.0)
        force = -0.5 * self.density * ahead * velocity * np.array([0.0, self.sway, self.heave])
        return np.hstack([force, np.cross(self.centre, force)])


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """The in-plane force of every propeller: two works, in the free stream and in the hull's boundary layer.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    out = []
    for one in outline.propellers:
        angle = float(np.degrees(blade_angle(one.pitch_ratio, 0.75)))
        doubts = (
            []
            if ANGLES[0] <= angle <= ANGLES[1]
            else [f"blade angle {angle:.0f} deg, outside {ANGLES[0]:g} to {ANGLES[1]:g}"]
        )
        doubts += [] if BLADES[0] <= one.blades <= BLADES[1] else [f"{one.blades} blades, more than {BLADES[1]}"]
        doubts += [] if one.area_ratio <= NARROW else ["blades broader than those of aircraft, which the works are for"]
        behind = [left_behind_fins(outline, one.centre, one.diameter, row) for row in (1, 2)]
        works = (
            ("de Young", de_young(one.pitch_ratio, one.area_ratio), "young1965", "slope at low incidence"),
            ("side area", side_area(one.pitch_ratio, one.area_ratio), "ribner1945", "summary: a fin of aspect ratio 8"),
        )
        for name, slope, work, place in works:
            area = slope * np.pi / 4.0 * one.diameter**2 * inflow_factor(LOADING)
            for stream, pressure in {"free stream": 1.0, "boundary layer": _pressure(outline, one, water)}.items():
                force = InPlane(one.centre, area * pressure * behind[0], area * pressure * behind[1], water.density)
                method = f"propeller, {name}, {stream}"
                out.append(
                    Contribution(one.name, "propeller in-plane", method, force, SHARE, work, place, "; ".join(doubts))
                )
    return tuple(out)


def _pressure(outline: Outline, one: Propeller, water: Water) -> float:
    """Share of the free stream's dynamic pressure over the disc, in the boundary layer of the hull ahead of it."""
    x = float(one.centre[0])
    hull = carrier(outline, one.centre[1:], x)
    if hull is None:
        return 1.0
    flow = hull_flow(hull, water.density, water.viscosity, water.speed)
    radius = np.sqrt(max(flow.at(hull.area, x), 0.0) / np.pi)
    return 1.0 if radius >= one.diameter / 2.0 else flow.pressure_share(x, radius, 0.0, one.diameter / 2.0 - radius)

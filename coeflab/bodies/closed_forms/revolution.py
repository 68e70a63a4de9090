"""Bodies of revolution: integrals of a meridian and added mass by sections."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core.types import Array

_gauss = lru_cache(32)(np.polynomial.legendre.leggauss)  # whose arrays nothing here changes


def graded_nodes(start: float, end: float, count: int, power: int = 1) -> tuple[Array, Array]:
    """Gauss-Legendre nodes and weights on [start, end], graded to both ends.

    ``power`` above 1 clusters them by t^power / (t^power + (1 - t)^power), which takes the roots at a round nose or tail
    out of the integrand.
    """
    nodes, weights = _gauss(count)
    t, w = (nodes + 1.0) / 2.0, weights / 2.0
    up, down = t**power, (1.0 - t) ** power
    share = up / (up + down)
    slope = power * (t * (1.0 - t)) ** (power - 1) / (up + down) ** 2
    return start + (end - start) * share, abs(end - start) * w * slope


@dataclass(frozen=True, slots=True)
class MeridianIntegrals:
    """Volume m^3, centre of volume m, wetted surface m^2 and axial second moment of volume about that centre m^5."""

    volume: float
    centre: float
    wetted_surface: float
    second_moment: float


def meridian_integrals(x: Array, weight: Array, radius: Array, radius_slope: Array) -> MeridianIntegrals:
    """Integrals of a body of revolution.

    Parameters
    ----------
    x, weight, radius : (n,) arrays
        Stations, quadrature weights and radii, m.
    radius_slope : (n,) array
        R dR/dx, m, which stays finite at a round end: S = 2 pi integral of sqrt(R^2 + (R R')^2) dx.
    """
    area = np.pi * radius**2 * weight
    volume = float(np.sum(area))
    centre = float(np.sum(area * x)) / volume
    surface = float(2.0 * np.pi * np.sum(weight * np.hypot(radius, radius_slope)))
    return MeridianIntegrals(volume, centre, surface, float(np.sum(area * (x - centre) ** 2)))


@dataclass(frozen=True, slots=True)
class EndCorrection:
    """Lamb's inertia coefficients of a spheroid: axial k1 and lateral k2 over its displaced mass, turning k' over the
    turning inertia that sections alone would give it.
    """

    axial: float
    lateral: float
    turning: float


def lamb_end_correction(length: float, volume: float) -> EndCorrection:
    """End correction from the spheroid of the same length and volume.

    Sections give a spheroid A22 = m and A55 = m a^2 / 5; Lamb's exact values over these are k2 and k'.
    """
    a = length / 2.0
    b = float(np.sqrt(3.0 * volume / (4.0 * np.pi * a)))
    exact = ellipsoid_added_mass(np.array([a, b, b]), 1.0)
    return EndCorrection(
        float(exact[0, 0] / volume), float(exact[1, 1] / volume), float(exact[4, 4] / (volume * a**2 / 5.0))
    )


def strip_added_mass(integrals: MeridianIntegrals, density: float, correction: EndCorrection | None = None) -> Array:
    """(6, 6) added mass about the centre of volume, x along the axis.

    Each section moves rho pi R^2 per length across the axis (Newman 1977, section 4.16), nothing along or about it.
    Sections alone know nothing of ends; ``correction`` multiplies by k2 and k' and adds k1 along the axis.
    """
    mass, inertia = density * integrals.volume, density * integrals.second_moment
    k = correction or EndCorrection(0.0, 1.0, 1.0)
    axial, lateral, turning = k.axial * mass, k.lateral * mass, k.turning * inertia
    return np.diag([axial, lateral, lateral, 0.0, turning, turning])

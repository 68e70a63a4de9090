"""A bottom or a free surface beside the body, by images: which side it is on, and the sign with which the mirrored panels count."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array

WALLS = {"bottom": (1.0, 1.0), "surface_zero": (-1.0, 1.0), "surface_infinite": (-1.0, -1.0)}
WALL_NAMES = {
    "bottom": "a flat bottom below",
    "surface_zero": "a free surface above at zero frequency, a lid",
    "surface_infinite": "a free surface above at infinite frequency, where the potential is zero",
}


@dataclass(frozen=True, slots=True)
class Wall:
    """A plane beside the body, by images.

    Attributes
    ----------
    point, normal : (3,) arrays
        A point of the plane, m, and its unit normal.
    factor : float
        1: no flow through it, a bottom, or a free surface at zero frequency; -1: no potential on it, a free surface at
        infinite frequency (Newman 1977, section 6.18).
    """

    point: Array
    normal: Array
    factor: float

    def behind(self, points: Array) -> Array:
        """Mirror points, (n, 3)."""
        return np.asarray(points - 2.0 * ((points - self.point) @ self.normal)[:, None] * self.normal)

    def distance(self, points: Array) -> float:
        """Of the nearest of them, m; below zero where some lie on the other side than most."""
        height = (points - self.point) @ self.normal
        return float(np.min(height * np.sign(height.mean() or 1.0)))

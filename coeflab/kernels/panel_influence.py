"""Influence of flat triangular panels on each other: solid angles and integrals of 1 / r, in plain numpy.

Near panels are integrated exactly: Van Oosterom & Strackee (1983), IEEE Trans. Biomed. Eng. 30, for the solid angle;
Wilton et al. (1984), IEEE Trans. Antennas Propag. 32, for 1 / r. Beyond `REACH` times a panel's size its area and second
moments about the centroid serve; the added mass of a 6:1 spheroid then changes by 3e-6 at 2,000 panels.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.kernels.least_squares import Array
from coeflab.kernels.panel_geometry import Panels

REACH = 5.0
BLOCK = 2**16
NEAR_BLOCK = 2**15


def exact_integrals(targets: Array, corners: Array, normals: Array) -> tuple[Array, Array]:
    """Solid angle and integral of 1 / r of triangle k seen from target k.

    Parameters
    ----------
    targets, normals : (n, 3) arrays
    corners : (n, 3, 3) array

    Returns
    -------
    angle : (n,) array
        Integral of (y - x) . n / r^3: positive where the panel is seen from behind, from inside the body; 0 in its
        plane.
    inverse : (n,) array
        Integral of 1 / r, m.
    """
    to = corners - targets[:, None]
    r = np.linalg.norm(to, axis=2)
    height = np.einsum("ni,ni->n", to[:, 0], normals)
    triple = np.einsum("ni,ni->n", to[:, 0], np.cross(to[:, 1], to[:, 2]))
    below = r.prod(axis=1)
    for k in range(3):
        below += np.einsum("ni,ni->n", to[:, k], to[:, k - 1]) * r[:, k - 2]
    flat = np.abs(height) <= 1e-12 * r.max(axis=1)
    angle = np.where(flat, 0.0, 2.0 * np.arctan2(triple, below))
    inverse = -height * angle
    for k in range(3):
        a, ra, rb = to[:, k - 1], r[:, k - 1], r[:, k]
        side = to[:, k] - a
        length = np.linalg.norm(side, axis=1)
        outward = np.einsum("ni,ni->n", a, np.cross(side, normals)) / length
        # In line with a side, beyond or on it, its share vanishes but the logarithm does not exist.
        gap = np.maximum(ra + rb - length, 1e-14 * length)
        inverse += outward * np.log((ra + rb + length) / gap)
    return angle, inverse


def influence(panels: Panels) -> tuple[NDArray[np.float32], Array]:
    """Solid angle of every panel from every centroid, and the single-layer potential of the normals.

    Parameters
    ----------
    panels : Panels
        About their middle and of unit size: squares of distances are taken from products of coordinates.

    Returns
    -------
    angles : (n, n) array
        Row: target; 0 on the diagonal. Worked out in double precision, kept in single.
    layer : (n, 3) array
        Integral of n / r over the surface, from each centroid.
    """
    count = panels.count
    angles, layer = np.empty((count, count), dtype=np.float32), np.empty((count, 3))
    far = _Far.of(panels)
    reach = (REACH * panels.size) ** 2
    step = max(1, BLOCK // count)

    def rows(start: int) -> None:
        targets = panels.centre[start : start + step]
        solid, inverse, square = far.seen_from(targets)
        i, j = np.nonzero(square < reach)
        for part in range(0, len(i), NEAR_BLOCK):
            a, b = i[part : part + NEAR_BLOCK], j[part : part + NEAR_BLOCK]
            solid[a, b], inverse[a, b] = exact_integrals(targets[a], panels.corners[b], panels.normal[b])
        own = np.arange(len(targets))
        solid[own, start + own] = 0.0
        angles[start : start + step] = solid
        layer[start : start + step] = inverse @ panels.normal

    with ThreadPoolExecutor(os.cpu_count()) as threads:
        list(threads.map(rows, range(0, count, step)))
    return angles, layer


@brief
@dataclass(frozen=True, slots=True)
class _Far:
    """Panels as sources with their second moments; products with (x, |x|^2, 1) of the targets."""

    square: Array
    height: Array
    spread: tuple[Array, Array]
    trace: Array
    area: Array

    @classmethod
    def of(cls, panels: Panels) -> _Far:
        """Columns of the products."""
        c, zero = panels.centre, np.zeros((panels.count, 1))
        linear = [np.hstack([-v, zero, np.sum(v * c, axis=1)[:, None]]).T for v in (panels.normal, *panels.spread)]
        square = np.hstack([-2.0 * c, zero + 1.0, np.sum(c**2, axis=1)[:, None]]).T
        return cls(square, linear[0], (linear[1], linear[2]), np.sum(panels.spread**2, axis=(0, 2)), panels.area)

    def seen_from(self, targets: Array) -> tuple[Array, Array, Array]:
        """Solid angle, integral of 1 / r and square of the distance, (m, n) each.

        Taylor series of 1/r and 1/r^3 about the centroid up to the second moments; the height over a plane is the same
        for all its points.
        """
        one = np.ones((len(targets), 1))
        lifted = np.hstack([targets, np.sum(targets**2, axis=1)[:, None], one])
        square = lifted @ self.square
        inverse = np.reciprocal(np.maximum(square, 1e-30))
        along, across = lifted @ self.spread[0], lifted @ self.spread[1]
        along *= along
        across *= across
        along += across
        along *= inverse
        along *= 3.0
        along -= self.trace
        along *= inverse
        # ``along`` is now M : grad grad (1/r) over 1/r, for second moments M; of 1/r^3 it is 5 times that plus 2 trace.
        solid = self.trace * inverse
        solid *= 2.0
        solid += 5.0 * along
        along *= 0.5
        along += 1.0
        solid *= 0.5
        solid += 1.0
        root = np.sqrt(inverse)
        root *= self.area
        along *= root
        solid *= root
        solid *= inverse
        solid *= lifted @ self.height
        return solid, along, square

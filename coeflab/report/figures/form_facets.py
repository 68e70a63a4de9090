"""Flat facets of simple forms about their own centres, for drawing; arrays in, arrays out.

Facets are (n, 4, 3), m, counter-clockwise seen from outside; where two corners coincide the facet is a triangle.
"""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array

AROUND, ALONG = 48, 24
CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def lathe_facets(x: Array, radius: Array) -> Array:
    """A body of revolution about x through (k,) stations and radii, x rising."""
    angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
    ring = np.stack([np.zeros(AROUND), np.cos(angle), np.sin(angle)], axis=1)
    rings = x[:, None, None] * np.array([1.0, 0.0, 0.0]) + radius[:, None, None] * ring
    ahead = np.roll(rings, -1, axis=1)
    facets = np.stack([rings[:-1], ahead[:-1], ahead[1:], rings[1:]], axis=2)
    return np.asarray(facets.reshape(-1, 4, 3))


def cylinder_facets(radius: float, length: float) -> Array:
    """Side and both ends, the axis along x."""
    half = length / 2.0
    return lathe_facets(np.array([-half, -half, half, half]), np.array([0.0, radius, radius, 0.0]))


def cut_cylinder_facets(radius: float, length: float, slices: int) -> Array:
    """The same in so many slices, for what is seen in part."""
    half, cap = length / 2.0, np.array([0.0, 0.5, 1.0]) * radius
    x = np.concatenate([[-half, -half], np.linspace(-half, half, slices + 1), [half, half]])
    return lathe_facets(x, np.concatenate([cap[:2], np.full(slices + 1, radius), cap[1::-1]]))


def ellipsoid_facets(axes: Array) -> Array:
    """An ellipsoid of (3,) semi-axes."""
    angle = np.linspace(0.0, np.pi, ALONG + 1)
    return np.asarray(lathe_facets(-np.cos(angle), np.sin(angle)) * axes)


def box_facets(sides: Array) -> Array:
    """A box of (3,) sides."""
    out = []
    for i in range(3):
        face = np.zeros((4, 3))
        face[:, i], face[:, (i + 1) % 3], face[:, (i + 2) % 3] = 1.0, CORNERS[:, 0], CORNERS[:, 1]
        out += [face, -face[::-1]]
    return np.array(out) * sides / 2.0


def plate_facets(chord: float, span: float) -> Array:
    """Both sides of a plate across z."""
    face = np.column_stack([CORNERS * [chord, span], np.zeros(4)]) / 2.0
    return np.array([face, face[::-1]])


def normals(facets: Array) -> Array:
    """(n, 3) unit normals; zero where a facet has no area."""
    across = np.cross(facets[:, 2] - facets[:, 0], facets[:, 3] - facets[:, 1])
    size = np.linalg.norm(across, axis=1, keepdims=True)
    return np.asarray(across / np.where(size > 0.0, size, 1.0))

"""Second moments of the volume of any shape."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Parts, Revolution, Shape
from coeflab.core.types import Array


def second_moments(shape: Shape) -> Array:
    """(3, 3) second moments of the volume about its centre, over the volume, m^2."""
    if isinstance(shape, TriangleMesh):
        return np.asarray(shape.integrals.second_moments / shape.volume)
    if isinstance(shape, Revolution):
        section = np.pi * shape.weight * shape.radius**2 / shape.volume
        along = float(section @ (shape.x - shape.centre_of_volume[0]) ** 2)
        across = float(section @ shape.radius**2) / 4.0
        return np.diag([along, across, across])
    return parts_spread(shape) / shape.volume


def parts_spread(shape: Parts) -> Array:
    """(3, 3) second moments of the volume of parts about its centre, m^5."""
    total, middle = np.zeros((3, 3)), shape.centre_of_volume
    for p in shape.parts:
        total += p.form.volume * (p.second_moments + np.outer(p.centre - middle, p.centre - middle))
    return total


def displaced(shape: Shape, density: float, point: Array) -> Array:
    """(6,) mass and moments of inertia about a point of the displaced water, kg and kg m^2; zeros of what displaces nothing.

    Parameters
    ----------
    shape : Shape
    density : float
        kg/m^3.
    point : (3,) array
        m, from the datum.
    """
    if not shape.volume > 0.0:
        return np.zeros(6)
    off = shape.centre_of_volume - point
    about = second_moments(shape) + np.outer(off, off)
    mass = density * shape.volume
    return mass * np.concatenate([np.ones(3), np.trace(about) - np.diag(about)])

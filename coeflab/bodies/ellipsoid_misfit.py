"""How far an ellipsoid is from the body that it stands for, by what both project and how their volume is spread."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Revolution, Shape, shadow
from coeflab.bodies.volume_moments import second_moments
from coeflab.core.types import Array, brief, locking

BOUND = 0.1  # the misfit up to which a simplified body is called an ellipsoid, too


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("areas spread")
class EllipsoidMisfit:
    """The ellipsoid over the body, less one.

    Attributes
    ----------
    areas : (3,) array
        Of the areas projected along x, y, z.
    spread : (3, 3) array
        Of the second moments of volume, about the centre of volume and over the volume; off the diagonal over the root of
        both of the body's own.
    """

    areas: Array
    spread: Array

    @property
    def rough(self) -> bool:
        """Whether one of them is over a tenth: the ellipsoid is only a rough guide to the body.

        Notes
        -----
        By strips, what a slender body moves sideways goes with the square of its depth, of which the projected area is the
        first power; what it moves when it turns goes with the second moment along its length; what a plate moves along its
        normal goes with its area to the power 3/2. The large entries are thus off by about as much as the worst of these,
        or half as much again; the small ones, as about the normal of a flat body, by more.
        """
        return max(float(np.max(np.abs(self.areas))), float(np.max(np.abs(self.spread)))) > BOUND

    def __str__(self) -> str:
        areas = ", ".join(f"{100.0 * v:+.0f}" for v in self.areas)
        spread = ", ".join(f"{100.0 * v:+.0f}" for v in np.diag(self.spread))
        words = f"ellipsoid over body, less one: projected areas {areas} %, second moments of volume {spread} % along x, y, z"
        skewed = float(np.max(np.abs(self.spread - np.diag(np.diag(self.spread)))))
        return words + (f"; skewed to the axes by {skewed:.0%}" if skewed > BOUND else "")


def ellipsoid_misfit(shape: Shape, axes: Array) -> EllipsoidMisfit:
    """Misfit of the ellipsoid of semi-axes along x, y, z, m, about the shape's centre of volume.

    Parameters
    ----------
    shape : Shape
        That displaces something. Areas of parts and of faces that hide one another count in full.
    axes : (3,) array
    """
    areas, spread = _areas(shape), second_moments(shape)
    own = np.array([axes[1] * axes[2], axes[0] * axes[2], axes[0] * axes[1]]) * np.pi
    size = np.sqrt(np.diag(spread))
    return EllipsoidMisfit(own / areas - 1.0, (np.diag(axes**2 / 5.0) - spread) / np.outer(size, size))


def _areas(shape: Shape) -> Array:
    if isinstance(shape, TriangleMesh):
        return shape.integrals.projected
    if isinstance(shape, Revolution):
        side = 2.0 * float(shape.weight @ shape.radius)
        return np.array([np.pi * float(np.max(shape.radius)) ** 2, side, side])
    return np.array([sum(shadow(p.form, p.rotation.T @ axis) for p in shape.parts) for axis in np.eye(3)])

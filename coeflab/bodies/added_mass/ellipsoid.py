"""Lamb's closed form for the ellipsoid that stands for the body.

How far an ellipsoid is from the body that it stands for, by what both project and how their volume is spread.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms import ellipsoid_added_mass
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Ellipsoid, Parts, Revolution, Shape, shadow
from coeflab.bodies.volume_moments import second_moments
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.law.added_mass import AddedMass, composed

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


summary = "Lamb's exact values for the ellipsoid of the body's length, volume and breadth-to-depth ratio"
citations = ("lamb1932", "carlson1995")
places: Mapping[str, int] = {"": 4}
exact_ellipsoids = 1

EQUIVALENT = "equivalent ellipsoid: the body's length and volume, breadth over depth by its second moments"

REPLACES_MESH = "Lamb's values of the ellipsoid that replaces the mesh"


def _axes(shape: Shape) -> NDArray[np.float64]:
    bc = 3.0 * shape.volume / (2.0 * np.pi * shape.length)
    ratio = shape.breadth_over_depth
    return np.array([shape.length / 2.0, np.sqrt(bc * ratio), np.sqrt(bc / ratio)])


def added_mass(body: Body, density: float, options: Mapping[str, Any] | None = None) -> AddedMass:
    """Added mass of the equivalent ellipsoid, about the body's reference point.

    Parameters
    ----------
    body : Body
        With a shape.
    density : float
        kg/m^3.
    options : mapping, optional
        None are known.

    Raises
    ------
    InputError
        No shape, one that displaces nothing, or any option.

    Notes
    -----
    Length (of the parts that displace water) and volume are the body's; breadth over depth is the root of the ratio of
    its second moments of volume along y and z, and the centre is its centre of volume. A body that is a single ellipsoid is taken as it is, in its own pose, and the result is exact, unless it stands for a mesh.
    Of any other the misfit is stated (`coeflab.bodies.added_mass.ellipsoid`); where it is over a tenth the result is rough.
    Lamb, Hydrodynamics (1932), sections 114-115 and 121 a.
    """
    parse_options(NoOptions, options or {}, "ellipsoid")
    shape = body.require_shape()
    if not shape.volume > 0.0:
        raise input_error("bodies.whose_parts_displace", name=body.name)
    axes, centre, turn, rough = _axes(shape), shape.centre_of_volume, np.eye(3), False
    if isinstance(shape, Parts) and len(shape.parts) == 1 and isinstance(shape.parts[0].form, Ellipsoid):
        axes, turn = shape.parts[0].form.axes, shape.parts[0].rotation
        words = [REPLACES_MESH if shape.stand_ins else "the body is an ellipsoid: exact"]
    else:
        misfit = ellipsoid_misfit(shape, axes)
        rough = misfit.rough
        words = [EQUIVALENT, str(misfit) + (f"; over {BOUND:.0%}: a rough guide" if rough else "")]
    matrix = composed([ellipsoid_added_mass(axes, density)], [turn], [centre], body.reference_point)
    size = " x ".join(f"{a:.5g}" for a in axes)
    words[0] += f"; semi-axes {size} m"
    return AddedMass(matrix, body.reference_point, body.datum, body.name, "ellipsoid", tuple(words), rough=rough)

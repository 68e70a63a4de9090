"""Lamb's closed form for the ellipsoid that stands for the body."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.ellipsoid_misfit import BOUND, ellipsoid_misfit
from coeflab.bodies.shape import Ellipsoid, Parts, Shape
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.texts import input_error
from coeflab.law.added_mass import AddedMass
from coeflab.law.definiteness import composed

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

"""Sections along x of a body of revolution, with Lamb's end correction as an option."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.options import one_of, parse_options
from coeflab.kernels.axisymmetric import lamb_end_correction, strip_added_mass
from coeflab.kernels.composition import composed
from coeflab.model.added_mass import AddedMass
from coeflab.model.body import Body
from coeflab.model.shape import as_revolution

summary = "circular sections along x, rho pi r^2 per length; end correction none or lamb"
citations = ("newman1977", "lamb1932")
presets: Mapping[str, Mapping[str, str]] = {"lamb": {"end_correction": "lamb"}}

NONE = "sections only: nothing along or about the axis, ends not corrected"


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the method.

    Attributes
    ----------
    end_correction : str
        ``none``: sections alone. ``lamb``: multiplied by k2 (sideways) and k' (turning) of the spheroid of the same
        length and volume, with its k1 along the axis.
    """

    end_correction: str = one_of("none", "none", "lamb")


def added_mass(body: Body, density: float, options: Mapping[str, Any] | None = None) -> AddedMass:
    """Added mass by strip theory, about the body's reference point.

    Parameters
    ----------
    body : Body
        A body of revolution about x: a hull form, or a single cylinder, spheroid or sphere along x.
    density : float
        kg/m^3.
    options : mapping, optional
        See `Options`.

    Raises
    ------
    InputError
        No shape, or another shape.
    """
    chosen = parse_options(Options, options or {}, "strip")
    shape = as_revolution(body.require_shape())
    if shape is None:
        raise InputError(
            f"{body.name}, which is no body of revolution about x",
            "a hull form, or a single cylinder, spheroid or sphere along x",
            advice="Use the method primitives or ellipsoid.",
        )
    method, statement, correction = "strip", NONE, None
    if chosen.end_correction == "lamb":
        correction = lamb_end_correction(shape.length, shape.volume)
        method = "strip:lamb"
        statement = (
            f"Lamb end correction: k1 {correction.axial:.4f}, k2 {correction.lateral:.4f}, k' {correction.turning:.4f} "
            "of the spheroid of the same length and volume"
        )
    own = strip_added_mass(shape.integrals, density, correction)
    matrix = composed([own], [np.eye(3)], [shape.centre_of_volume], body.reference_point)
    return AddedMass(matrix, body.reference_point, body.datum, body.name, method, (statement,))

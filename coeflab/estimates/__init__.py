"""Estimates: forces and derivatives of a body from its outline alone, one file a method, and what a method is.

An estimate is no measurement: each carries its method, its source, the range it was published for and a U95 from the
scatter that its source states and from the spread between methods.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.outline import Outline
from coeflab.core.errors import InputError
from coeflab.core.registry import Plugin, Registry
from coeflab.core.types import brief
from coeflab.law.coefficient import CoefficientSet

Forces = Callable[[NDArray[np.float64], dict[str, NDArray[np.float64]]], NDArray[np.float64]]


@brief
@dataclass(frozen=True, slots=True)
class Water:
    """What the body moves through.

    Attributes
    ----------
    density, viscosity, speed : float
        kg/m^3, kinematic m^2/s, m/s of the reference condition.
    """

    density: float
    viscosity: float
    speed: float


@brief
@dataclass(frozen=True, slots=True)
class Contribution:
    """What one part gives by one method.

    Attributes
    ----------
    part : str
        Of the outline.
    kind : str
        What the number is of: ``friction``, ``hull lift``, ``fin lift``, ``cross-flow drag`` ... ; contributions of one part
        and one kind by several methods are alternatives, others add up.
    method : str
        Name of the plugin.
    forces : callable
        ``forces(nu, angles)``: (n, 6) X, Y, Z, K, M, N, N and N m, FRD, about the datum, at (n, 6) velocities u, v, w, p, q, r
        of the datum through still water; ``angles`` holds (n,) control angles by name, rad.
    share : float
        95 % half-width over the value, from the scatter that the source states; 0.3 is 30 %.
    citation, place : str
        Key of a work and page or equation.
    outside : str
        Why the part lies outside the range of the source; empty where it is inside.
    """

    part: str
    kind: str
    method: str
    forces: Forces
    share: float
    citation: str
    place: str
    outside: str = ""


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Estimates:
    """All estimates of a body.

    Attributes
    ----------
    coefficients : CoefficientSet
        Primed; status ``estimate``, origin ``estimate``, U95 with covariance.
    contributions : tuple of Contribution
    shares : mapping of str to mapping of str to float
        Of each symbol: what each ``part, kind`` gives to its value, primed.
    forces : callable
        As of a contribution: the recommended sum, about the set's reference point.
    notes : tuple of str
        What is assumed or left out, one line each.
    """

    coefficients: CoefficientSet
    contributions: tuple[Contribution, ...]
    shares: dict[str, dict[str, float]]
    forces: Forces
    notes: tuple[str, ...]


@runtime_checkable
class EstimateMethod(Plugin, Protocol):
    """Estimates forces on parts of an outline."""

    def contributions(self, outline: Outline, water: Water) -> tuple[Contribution, ...]:
        """What the method gives for the parts that it is for; empty where there is none.

        Parameters
        ----------
        outline : Outline
        water : Water
        """
        ...


METHODS = Registry("coeflab.estimates", "method of estimates", EstimateMethod, __name__)  # type: ignore[type-abstract]


def estimated(body: Body, water: Water) -> Estimates:  # noqa: ARG001
    """Estimate all that the methods can of a body.

    Raises
    ------
    InputError
        The body has no outline, or no length that primes are made with.
    """
    raise InputError(f"{body.name}: estimates are not built yet", "a method")

"""From bodies to added-mass matrices: one plugin a file."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from coeflab.bodies.body import Body
from coeflab.core.registry import Plugin, Registry
from coeflab.law.added_mass import AddedMass

ADDED_MASS = Registry(__name__, "added-mass method", AddedMassMethod)  # type: ignore[type-abstract]


@runtime_checkable
class AddedMassMethod(Plugin, Protocol):
    """Computes the added-mass matrix of a body."""

    def added_mass(self, body: Body, density: float) -> AddedMass:
        """The matrix about the body's reference point, FRD.

        Parameters
        ----------
        body : Body
        density : float
            kg/m^3.
        """
        ...

"""From bodies to added-mass matrices: one plugin a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.law.added_mass import AddedMass


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


ADDED_MASS = Registry("coeflab.added_mass", "added-mass method", AddedMassMethod, __name__)  # type: ignore[type-abstract]

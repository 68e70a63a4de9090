"""From bodies to added-mass matrices: one plugin a file."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from coeflab.bodies.body import Body
    from coeflab.core.finding import Finding
    from coeflab.law.added_mass import AddedMass


@runtime_checkable
class AddedMassMethod(Plugin, Protocol):
    """Computes the added-mass matrix of a body.

    Attributes
    ----------
    presets : mapping of str to mapping
        Options by a name that people type after a colon: ``strip:lamb``.
    reproducible : mapping
        Options with which the numbers do not depend on optional packages.
    takes_surface, takes_sheets : bool
        Whether it takes the mesh itself where parts stand for one; sheets of no thickness of a mesh.
    places : mapping of str to int
        Its place in the recommendation by preset, ``""`` without one; what has none comes last.
    exact_ellipsoids : float
        Up to how many ellipsoids, far from each other, its form is exact.
    rough_share : float
        95 % half-width of a diagonal entry of a rough guide, over entry and displaced water together; see
        `coeflab.bodies.rough_guide`.
    finer : callable or None
        ``finer(result, options)``: what half of the error would cost, None where nobody needs less. A method that has it resolves
        any closed surface: its error falls with its mesh.
    """

    presets: Mapping[str, Mapping[str, Any]] = MappingProxyType({})
    reproducible: Mapping[str, Any] = MappingProxyType({})
    takes_surface: bool = False
    takes_sheets: bool = False
    places: Mapping[str, int] = MappingProxyType({})
    exact_ellipsoids: float = 0
    rough_share: float = 1.3
    finer: Callable[[AddedMass, Mapping[str, Any]], Finding | None] | None = None

    def added_mass(self, body: Body, density: float, options: Mapping[str, Any] | None = None) -> AddedMass:
        """The matrix about the body's reference point, FRD.

        Parameters
        ----------
        body : Body
        density : float
            kg/m^3.
        options : mapping, optional
            Of the plugin's `Options`.
        """
        ...


ADDED_MASS = Registry("coeflab.added_mass", "added-mass method", AddedMassMethod, __name__)  # type: ignore[type-abstract]


def resolving() -> tuple[str, ...]:
    """Methods whose error falls with their mesh on any closed surface: rough guides are measured by them."""
    return tuple(name for name in ADDED_MASS.usable() if ADDED_MASS.load(name).finer is not None)

"""Standard manoeuvres: one plugin a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Mapping

    from coeflab.motion.manoeuvre import Figure, Manoeuvre
    from coeflab.motion.trajectory import Trajectory
    from coeflab.motion.vehicle import Vehicle


@runtime_checkable
class ManoeuvrePlugin(Plugin, Protocol):
    """Says what a manoeuvre orders, and reads its figures off the motion."""

    plane: str

    def plan(self, vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
        """What is ordered when.

        Parameters
        ----------
        vehicle : Vehicle
        options : mapping of str to value
            Of the plugin's `Options`.
        """
        ...

    def figures(self, trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
        """Figures of the motion, each with a status.

        Parameters
        ----------
        trajectory : Trajectory
        vehicle : Vehicle
        options : mapping of str to value
            Those that planned it.
        """
        ...


MANOEUVRES = Registry("coeflab.manoeuvres", "manoeuvre", ManoeuvrePlugin, __name__)  # type: ignore[type-abstract]

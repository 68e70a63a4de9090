"""From parameter files to motions: one plugin a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Mapping

    from coeflab.motion.manoeuvre import Manoeuvre
    from coeflab.motion.trajectory import Trajectory


@runtime_checkable
class Simulator(Plugin, Protocol):
    """Moves a vehicle through a manoeuvre."""

    def simulate(self, vehicle: Any, manoeuvre: Manoeuvre, options: Mapping[str, Any]) -> Trajectory:
        """The motion, as far as it goes; how it ended is a status of it.

        Parameters
        ----------
        vehicle : Vehicle
            Or the noun that a simulator of an application moves.
        manoeuvre : Manoeuvre
        options : mapping of str to value
            Of the plugin's `Options`.
        """
        ...


SIMULATORS = Registry("coeflab.simulators", "simulator", Simulator, __name__)  # type: ignore[type-abstract]

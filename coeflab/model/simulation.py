"""A manoeuvre of a parameter file, as it was asked for and as it came out."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from coeflab.kernels.brief import brief
from coeflab.model.manoeuvre import Figure, Manoeuvre
from coeflab.model.trajectory import Trajectory
from coeflab.model.vehicle import Vehicle


@brief
@dataclass(frozen=True, slots=True)
class Simulation:
    """What was asked and what came out.

    Attributes
    ----------
    vehicle : Vehicle
    manoeuvre : Manoeuvre
    trajectory : Trajectory
    figures : tuple of Figure
    statements : tuple of str
        Assumptions of vehicle, manoeuvre and motion.
    determined : float
        Time from which on the motion leans on terms that no data give, s; infinite where it never does.
    citations : tuple of str
        Works that the manoeuvre and the simulator rest on.
    undetermined : str
        Why the file determines nothing of the motion, from its first instant; empty where it determines its beginning.
    """

    vehicle: Vehicle
    manoeuvre: Manoeuvre
    trajectory: Trajectory
    figures: tuple[Figure, ...]
    statements: tuple[str, ...]
    determined: float = inf
    citations: tuple[str, ...] = ()
    undetermined: str = ""

"""A parameter file sent through a manoeuvre."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

from coeflab.core.errors import InputError
from coeflab.core.symbols import MOTIONS
from coeflab.manoeuvres import MANOEUVRES
from coeflab.model.approach import UNCOVERED, unlimited
from coeflab.model.manoeuvre import Figure, Manoeuvre
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.trajectory import Trajectory
from coeflab.model.vehicle import PLANES, Vehicle, vehicle
from coeflab.simulators import SIMULATORS


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
    """

    vehicle: Vehicle
    manoeuvre: Manoeuvre
    trajectory: Trajectory
    figures: tuple[Figure, ...]
    statements: tuple[str, ...]
    determined: float = inf


def moved(
    parameters: ParameterFile, manoeuvre: str, free: Sequence[str] = (), hold: Sequence[str] = (), **how: Any
) -> Vehicle:
    """The vehicle of a file as a manoeuvre needs it.

    Parameters
    ----------
    parameters : ParameterFile
    manoeuvre : str
        Its plane is taken where the file does not know enough of all six motions.
    free, hold : sequence of str
        Motions that may change, and those of them that are held after all.
    **how
        ``tables`` and ``measured`` of `coeflab.model.vehicle.vehicle`.

    Raises
    ------
    InputError
        Nothing may move.
    """
    plane = MANOEUVRES.load(manoeuvre).plane
    wanted = tuple(free)
    if hold:
        whole = wanted or vehicle(parameters, plane=plane, **how).free
        wanted = tuple(m for m in whole if m not in hold)
        strange = [m for m in hold if m not in MOTIONS]
        if strange or not wanted:
            raise InputError(
                f"{', '.join(strange or hold)} held", f"some of {', '.join(whole)}, not all of them", column="--hold"
            )
    return vehicle(parameters, wanted, plane, **how)


def simulate(
    parameters: ParameterFile,
    manoeuvre: str,
    options: Mapping[str, Any],
    simulator: Mapping[str, Any] | None = None,
    free: Sequence[str] = (),
    hold: Sequence[str] = (),
    **how: Any,
) -> Simulation:
    """Plan the manoeuvre, move the vehicle, read the figures off.

    Parameters
    ----------
    parameters : ParameterFile
    manoeuvre : str
        A plugin of `coeflab.manoeuvres`.
    options : mapping
        Of the manoeuvre.
    simulator : mapping, optional
        Options of the simulator ``rigid_body``.
    free, hold : sequence of str
    **how
        See `moved`.
    """
    plugin = MANOEUVRES.load(manoeuvre)
    body = moved(parameters, manoeuvre, free, hold, **how)
    plan = plugin.plan(body, options)
    trajectory = SIMULATORS.load("rigid_body").simulate(body, plan, simulator or {})
    statements = tuple(dict.fromkeys((*body.statements, *plan.statements, *trajectory.statements)))
    until, why = determined_until(trajectory, body)
    figures = plugin.figures(trajectory, body, options)
    return Simulation(body, plan, trajectory, figures, (*statements, *([why] if why else [])), until)


def determined_until(trajectory: Trajectory, vehicle: Vehicle) -> tuple[float, str]:
    """Time up to which the file determines the motion, and why not beyond, in words."""
    speed = float(trajectory.velocity[0, 0])
    for rate in ("r", "q"):
        lacking = unlimited(vehicle, rate, speed) if rate in vehicle.free and speed > 0.0 else ""
        if lacking:
            beyond = [
                trajectory.time[f] for n, f in trajectory.outside.items() if not n.endswith(UNCOVERED) and f.any()
            ]
            if beyond:
                first = float(min(times[0] for times in beyond))
                return first, f"drawn up to {first:.4g} s, from where on it is not determined: {lacking}"
    return inf, ""


def with_intervals(figures: Sequence[Figure], bounds: Mapping[str, tuple[float, float]]) -> tuple[Figure, ...]:
    """Figures with the intervals that were found for some of them."""
    return tuple(replace(f, low=bounds[f.name][0], high=bounds[f.name][1]) if f.name in bounds else f for f in figures)


def planes() -> str:
    """The planes and their motions, in words."""
    return "; ".join(f"{name}: {' '.join(motions)}" for name, motions in PLANES.items())

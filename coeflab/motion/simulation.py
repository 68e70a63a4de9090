"""Parameter files sent through manoeuvres."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import inf
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Severity
from coeflab.core.machine import one_thread
from coeflab.core.options import of_a_file
from coeflab.core.texts import input_error, remark
from coeflab.law.coefficient import Status
from coeflab.law.symbols import MOTIONS
from coeflab.motion.approach import at_once, decisive, undetermined_at_once
from coeflab.motion.manoeuvre import Manoeuvre, PlannedManoeuvre, Simulation
from coeflab.motion.manoeuvres import MANOEUVRES
from coeflab.motion.simulators import SIMULATORS
from coeflab.motion.trajectory import Trajectory, Uncovered
from coeflab.motion.turn_limits import linear_growth, unlimited
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.force_law import ahead_from
from coeflab.vehicle.parameter_file import ParameterFile

SWING, SWINGS = (
    float(np.radians(5.0)),
    6,
)  # rad/s from one extreme of the roll rate to the next; that many are an oscillation

STALL_UNSEEN = (
    15.0 + 1e-9
)  # deg of a control, those of the first turn: beyond it is said that estimated foils do not stall


def manoeuvres_of(
    planned: Iterable[PlannedManoeuvre], files: Mapping[str, ParameterFile], progress: Callable[[str], None]
) -> tuple[Simulation, ...]:
    """Every manoeuvre of a plan.

    Parameters
    ----------
    planned : iterable of PlannedManoeuvre
    files : mapping of str to ParameterFile
        By name.
    progress : callable
        Takes what is being done, in words.

    Raises
    ------
    InputError
        By file and key: a parameter file that the study does not make, a file that cannot move so, options out of range.
    """
    out = []
    for asked in planned:
        parameters = files.get(asked.parameter_file)
        if parameters is None:
            raise input_error(
                "motion.parameter_file_study", asked.file, column=asked.key("parameter_file"),
                parameter_file=shown(asked.parameter_file), files=", ".join(files),
            )  # fmt: skip
        try:
            options = of_a_file(MANOEUVRES.load(asked.name).Options, asked.options, asked.name)
            out.append(simulate(parameters, asked.name, options, accelerations=asked.accelerations))
        except InputError as why:
            raise InputError(
                why.found, why.expected, file=asked.file, column=asked.key(why.column or "name"), advice=why.advice
            ) from None
        progress(f"simulated {asked.name} of {asked.parameter_file}")
    return tuple(out)


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
        ``tables`` and ``accelerations`` of `coeflab.motion.vehicle.vehicle`.

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
                f"{', '.join(map(shown, strange)) or ', '.join(hold)} held",
                f"some of {', '.join(whole)}, not all of them",
                column="--hold",
            )
    return vehicle(parameters, wanted, plane, **how)


@one_thread()
def unstable_course(body: Vehicle, speed: float) -> str:
    """Whether straight motion in the horizontal plane is unstable with controls fixed, in words; empty where it is not."""
    growth = linear_growth(body, ("v", "r"), speed) if speed > 0.0 and {"v", "r"} <= set(body.free) else 0.0
    if growth <= 0.0:
        return ""
    return f"with controls fixed, straight motion at {speed:.3g} m/s is unstable in the horizontal plane: a disturbance grows at {growth:.3g} 1/s"


def simulate(
    parameters: ParameterFile,
    manoeuvre: str,
    options: Mapping[str, Any],
    integration: Mapping[str, Any] | None = None,
    free: Sequence[str] = (),
    hold: Sequence[str] = (),
    simulator: str = "rigid_body",
    **how: Any,
) -> Simulation:
    """Plan the manoeuvre, move the vehicle, read the figures off.

    Parameters
    ----------
    parameters : ParameterFile
    manoeuvre : str
        A plugin of `coeflab.motion.manoeuvres`.
    options : mapping
        Of the manoeuvre.
    integration : mapping, optional
        Options of the simulator.
    free, hold : sequence of str
    simulator : str
        A plugin of `coeflab.motion.simulators`.
    **how
        See `moved`.
    """
    plugin = MANOEUVRES.load(manoeuvre)
    body = moved(parameters, manoeuvre, free, hold, **how)
    plan = plugin.plan(body, options)
    mover = SIMULATORS.load(simulator)
    with SIMULATORS.guarded(simulator):
        trajectory = mover.simulate(body, plan, integration or {})
    statements = tuple(
        dict.fromkeys((*body.statements, *plan.statements, *at_once(body, plan.phases), *trajectory.statements))
    )
    until, why = determined_until(trajectory, body)
    rolling = rolls(trajectory) if "p" in body.free else ""
    course = unstable_course(body, float(trajectory.velocity[0, 0]))
    beyond = beyond_estimates(parameters, plan, trajectory)
    figures = plugin.figures(trajectory, body, options)
    works = tuple(dict.fromkeys((*plugin.citations, *mover.citations)))
    nothing = undetermined_at_once(body, plan, figures)
    return Simulation(
        body,
        plan,
        trajectory,
        figures,
        (*statements, *filter(None, (course, rolling, why)), *beyond, *doubts(parameters)),
        until,
        works,
        nothing,
    )


def doubts(parameters: ParameterFile) -> tuple[str, ...]:
    """What a file was warned of, in words: it holds for whatever is computed with it."""
    return tuple(remark(f) for f in parameters.findings if f.severity in (Severity.WARN, Severity.FAIL))


def beyond_estimates(parameters: ParameterFile, plan: Manoeuvre, trajectory: Trajectory) -> tuple[str, ...]:
    """Where a manoeuvre goes beyond what estimates from a shape hold, in words; nothing of other files.

    Parameters
    ----------
    parameters : ParameterFile
    plan : Manoeuvre
    trajectory : Trajectory
    """
    found = {c.symbol.removesuffix("'") for c in parameters.coefficients if c.status is Status.ESTIMATE}
    out = []
    u, v = trajectory.velocity[:, 0], trajectory.velocity[:, 1]
    drift = float(np.degrees(np.max(np.arctan2(np.abs(v), u), initial=0.0, where=u > 0.0)))
    angle = ahead_from(parameters) if any(s.startswith("X") for s in found) else None
    if angle is not None and drift >= angle:
        out.append(
            f"limit: drift reaches {drift:.0f} deg; from {angle:d} deg on the law of the estimates gives an X that points ahead"
        )
    for control, called in (("dr", "rudder"), ("ds", "stern planes")):
        largest = float(np.degrees(max((abs(p.orders.get(control, 0.0)) for p in plan.phases), default=0.0)))
        if largest > STALL_UNSEEN and any(s[1:] == control for s in found):
            out.append(f"limit: {largest:.3g} deg of {called}; foils of the estimates do not stall")
    return tuple(out)


def rolls(trajectory: Trajectory) -> str:
    """That the roll rate oscillates, in words; empty below six swings of `SWING` from one extreme to the next."""
    rate, t = trajectory.velocity[:, 3], trajectory.time
    at = np.flatnonzero(np.diff(np.sign(np.diff(rate)))) + 1
    swings = np.abs(np.diff(rate[at]))
    large = swings > SWING
    if np.count_nonzero(large) < SWINGS:
        return ""
    period = 2.0 * float(np.mean(np.diff(t[at])[large]))
    return (
        f"roll rate oscillates: {np.count_nonzero(large)} swings of more than {np.degrees(SWING):g} deg/s, the largest "
        f"{np.degrees(np.max(swings)):.2g} deg/s, period about {period:.2g} s, roll up to "
        f"{np.degrees(np.max(np.abs(trajectory.angles[:, 0]))):.2g} deg"
    )


def determined_until(trajectory: Trajectory, vehicle: Vehicle) -> tuple[float, str]:
    """Time up to which the file determines the motion, and why not beyond, in words."""
    speed = float(trajectory.velocity[0, 0])
    for rate in ("r", "q"):
        lacking = unlimited(vehicle, rate, speed) if rate in vehicle.free and speed > 0.0 else ""
        if lacking:
            left = decisive((name for name, f in trajectory.outside.items() if f.any()), rate)
            if any(isinstance(name, Uncovered) for name in left):
                return 0.0, f"not determined: {lacking}"
            if left:
                first = float(min(trajectory.time[trajectory.outside[name]][0] for name in left))
                return first, f"stopped at {first:.4g} s: {lacking}"
    return inf, ""

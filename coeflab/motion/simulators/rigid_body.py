"""Six degrees of freedom about the reference point, with quaternion attitude, current, thrusters and control surfaces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.options import bounded, one_of, parse_options
from coeflab.core.texts import input_error
from coeflab.motion.approach import in_current
from coeflab.motion.manoeuvre import Manoeuvre
from coeflab.motion.marching import march, march_by_tolerance
from coeflab.motion.media import through_media
from coeflab.motion.trajectory import WITHOUT_DATA, Trajectory
from coeflab.motion.vehicle import Vehicle

summary = "six degrees of freedom (Fossen), quaternion attitude; adaptive LSODA or fixed-step RK4, plain or compiled"
citations = ("fossen2011", "hairer1996", "hindmarsh1983")


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the simulator.

    Attributes
    ----------
    integrator : str
        ``adaptive``: scipy's LSODA, stiff or not. ``rk4``: classical Runge-Kutta of a fixed step, cut where orders change.
    tolerance : float
        Of a step of the adaptive integrator, relative and absolute.
    step : float
        Of rk4, s; 0: a quarter of the time of the fastest small motion, and at most 0.05 L/U.
    kernel : str
        Of rk4: ``numpy``, ``compiled`` (numba, the extra "fast"), or ``auto``: compiled where numba is installed. Both give
        the same numbers to 1e-12.
    record : float
        Time between rows, s; 0: every step of rk4; of the adaptive integrator a hundredth of the time or a tenth of L/U.
    north, east, down : float
        Current, m/s, steady and the same everywhere.
    outside : str
        ``flag`` the rows outside of what the coefficients cover, or ``stop`` at the first of them.
    """

    integrator: str = one_of("adaptive", "adaptive", "rk4")
    tolerance: float = bounded(1e-9, 1e-13, 1e-3)
    step: float = bounded(0.0, 0.0, 1e3)
    kernel: str = one_of("auto", "auto", "numpy", "compiled")
    record: float = bounded(0.0, 0.0, 1e4)
    north: float = bounded(0.0, -100.0, 100.0)
    east: float = bounded(0.0, -100.0, 100.0)
    down: float = bounded(0.0, -100.0, 100.0)
    outside: str = one_of("flag", "flag", "stop")


def simulate(vehicle: Vehicle, manoeuvre: Manoeuvre, options: Mapping[str, Any] | None = None) -> Trajectory:
    """The motion of a vehicle through a manoeuvre.

    Parameters
    ----------
    vehicle : Vehicle
    manoeuvre : Manoeuvre
    options : mapping, optional
        See `Options`.

    Raises
    ------
    InputError
        Orders that the vehicle cannot follow, a step that the scheme does not stand, no numba where it was asked for.
    """
    o = parse_options(Options, options or {}, "rigid_body")
    current = np.array([o.north, o.east, o.down])
    if o.integrator == "adaptive" and o.step > 0.0:
        raise input_error("motion.step_for_adaptive_integrator", column="rigid_body.step", step=o.step)

    def moved(body: Vehicle, one: Manoeuvre) -> Trajectory:
        if o.integrator == "adaptive":
            return march_by_tolerance(body, one, o.record, o.tolerance, current).trajectory()
        return march(body, one, o.step, o.record, o.kernel, current).trajectory()

    if manoeuvre.others and o.down:
        raise InputError(f"a current of {o.down:g} m/s down through a surface", "none", column="rigid_body.down")
    motion = through_media(vehicle, manoeuvre, moved) if manoeuvre.others else moved(vehicle, manoeuvre)
    motion = replace(motion, statements=(*motion.statements, *in_current(current)))
    return _stopped_outside(motion) if o.outside == "stop" else motion


def _stopped_outside(motion: Trajectory) -> Trajectory:
    """The motion up to the first row that the coefficients do not cover."""
    flagged = {name: flags for name, flags in motion.outside.items() if name != WITHOUT_DATA and np.any(flags)}
    firsts = {name: int(np.argmax(flags)) for name, flags in flagged.items()}
    if not firsts:
        return motion
    name = min(firsts, key=lambda n: firsts[n])
    row = firsts[name]
    values = " ".join(f"{v:.4g}" for v in motion.velocity[row])
    time = float(motion.time[row])
    return motion.ended_at(
        row, f"stopped at {time:.6g} s, outside of what the coefficients cover: {name}. u v w p q r = {values}"
    )

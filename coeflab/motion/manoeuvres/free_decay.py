"""Free decay: the vehicle is let go at an angle of roll or pitch (ITTC 7.5-02-07-04.5)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.options import bounded, measured, one_of, parse_options
from coeflab.core.texts import input_error
from coeflab.motion.approach import judged
from coeflab.motion.dynamics import from_euler
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase
from coeflab.motion.readings import decay
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.vehicle import Vehicle

summary = "free decay of roll or pitch from an angle: period and damping ratio"
citations = ("ittc_roll_decay",)
plane = ""
NAME = "free_decay"
RATES = {"roll": "p", "pitch": "q"}


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the free decay.

    Attributes
    ----------
    motion
        Which angle.
    angle
        At which it is let go; 10 deg by default.
    speed
        Ahead, while it decays.
    duration
        s.
    """

    motion: str = one_of("roll", "roll", "pitch")
    angle: float = measured(float(np.radians(10.0)), 1e-4, 1.4, "angle")
    speed: float = measured(0.0, 0.0, 100.0, "speed")
    duration: float = bounded(60.0, 0.1, 1e5)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """One phase without orders.

    Raises
    ------
    InputError
        The motion is held.
    """
    o = parse_options(Options, options, NAME)
    if RATES[o.motion] not in vehicle.free:
        raise input_error("motion.motion_held", column=f"{NAME}.motion", rates=RATES[o.motion], motion=o.motion)
    nu = np.zeros(6)
    nu[0] = o.speed
    attitude = from_euler(o.angle, 0.0, 0.0) if o.motion == "roll" else from_euler(0.0, o.angle, 0.0)
    return Manoeuvre(NAME, (Phase("decay", {}, o.duration),), nu, attitude, statements=("no thrust",))


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Period and damping ratio."""
    o = parse_options(Options, options, NAME)
    t, angle = trajectory.time, trajectory.angles[:, 0 if o.motion == "roll" else 1]
    found = decay(t, angle)
    status, why = ("ok", "") if found else ("not reached", f"fewer than three extremes in {t[-1]:g} s")
    return (
        judged(
            Figure("period", found[0] if found else None, "s", "damped, from successive extremes", status, why),
            trajectory, float(t[-1]),
        ),
        judged(
            Figure(
                "damping ratio", found[1] if found else None, "1", "of critical, from the logarithmic decrement (ITTC)",
                status, why,
            ), trajectory, float(t[-1]),
        ),
    )  # fmt: skip

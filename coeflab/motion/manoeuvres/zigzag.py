"""Zigzag (Kempf): rudder or unequal thrusters are reversed whenever the heading has changed by the execute angle (IMO MSC.137(76))."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.options import bounded, measured, orders, parse_options
from coeflab.core.texts import input_error
from coeflab.motion import approach
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase, Until
from coeflab.motion.readings import crossing, extreme, value_at
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.turn_limits import unlimited
from coeflab.motion.vehicle import Vehicle

summary = "zigzag 10/10, 20/20 or any: overshoot angles, initial turning time and distance, reach, period"
citations = ("imo_msc137", "ittc_free_running")
plane = "horizontal"
NAME = "zigzag"


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the zigzag.

    Attributes
    ----------
    rudder
        Angle, 10 deg by default.
    heading
        Change of heading at which the rudder is reversed; 0: the rudder's angle, so that 20 deg of rudder are a 20/20 zigzag.
    commands
        Thruster commands such as left=30 right=60; they take the place of the rudder, and thrusters that mirror each other
        exchange them at every reversal. The heading is then 10 deg unless stated.
    executes
        How often the rudder is laid over.
    speed
        Of the approach; 0: that of the parameter file.
    longest
        Of each leg, s.
    """

    rudder: float = measured(float(np.radians(10.0)), 1e-4, 1.2, "angle")
    heading: float = measured(0.0, 0.0, 1.5, "angle")
    commands: tuple[str, ...] = orders()
    executes: int = bounded(5, 2, 50)
    speed: float = measured(0.0, 0.0, 100.0, "speed")
    longest: float = bounded(300.0, 1.0, 1e5)

    @property
    def execute(self) -> float:
        """Change of heading at which the rudder is reversed, rad."""
        return self.heading or self.rudder


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """One phase a leg, first to starboard."""
    o = parse_options(Options, options, NAME)
    nu = approach.along(vehicle, o.speed)
    if o.commands:
        standing: dict[str, float] = {}
        sides, words = _by_thrusters(vehicle, o.commands, nu)
    else:
        angle = approach.within_limit(vehicle, "dr", o.rudder, f"{NAME}.rudder") * approach.turning_sense(
            vehicle, "dr", "r", float(nu[0])
        )
        standing, thrust = approach.propulsion(vehicle, float(nu[0]))
        sides = {"dr": angle}, {"dr": -angle}
        words = (thrust, f"first rudder {np.degrees(angle):+.4g} deg, to starboard by the coefficients of the file")
    phases = tuple(
        Phase(f"execute {k + 1}", sides[k % 2], o.longest, Until("heading", k % 2 == 0, (-1.0) ** k * o.execute))
        for k in range(o.executes)
    )
    return Manoeuvre(NAME, phases, nu, orders=standing, statements=words)


def _by_thrusters(
    vehicle: Vehicle, commands: tuple[str, ...], nu: NDArray[np.float64]
) -> tuple[tuple[dict[str, float], dict[str, float]], tuple[str, ...]]:
    """Orders that turn to starboard and to port, and what that means, in words."""
    given = approach.thruster_orders(vehicle, commands)
    other = approach.mirrored(vehicle, given)
    turning = approach.yaw_acceleration(vehicle, approach.mirrored(vehicle, other), nu) - approach.yaw_acceleration(
        vehicle, other, nu
    )
    if turning == 0.0:
        raise input_error("motion.turns_to_neither_side", column=f"{NAME}.commands", commands=" ".join(commands))
    sides = (approach.mirrored(vehicle, other), other) if turning > 0.0 else (other, approach.mirrored(vehicle, other))
    first = " ".join(f"{name}={value:g}" for name, value in sides[0].items())
    return sides, (f"thrusters instead of a rudder: first {first} (to starboard), then exchanged",)


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Overshoots after the second and third execute, times and distances."""
    o = parse_options(Options, options, NAME)
    t, psi, reached = trajectory.time, trajectory.heading, (*trajectory.reached, None, None)
    lacking = unlimited(vehicle, "r", float(trajectory.velocity[0, 0]))

    def figure(name: str, value: float | None, unit: str, text: str, when: float | None) -> Figure:
        status, why = ("ok", "") if value is not None else ("not reached", f"not within {t[-1]:g} s")
        return approach.judged(Figure(name, value, unit, text, status, why), trajectory, when, lacking)

    first = reached[0]
    distance = None if first is None else value_at(t, trajectory.position[:, 0], first)
    both = "along the first course to the second execute (IMO MSC.137(76), where both angles are 10 deg)"
    out = [
        figure("initial turning time", first, "s", "to the second execute (ITTC 7.5-02-06-01)", first),
        figure("initial turning distance", distance, "m", both, first),
    ]
    for k, word in ((1, "first"), (2, "second")):
        begins = reached[k - 1]
        peak = None if begins is None else extreme(t, psi, largest=k == 1, after=begins)
        over = None if peak is None else abs(peak[1]) - o.execute
        text = f"heading beyond {np.degrees(o.execute):g} deg after the {('second', 'third')[k - 1]} execute (IMO MSC.137(76))"
        out.append(figure(f"{word} overshoot", over, "rad", text, None if peak is None else peak[0]))
    back = None if first is None else crossing(t, psi, 0.0, rises=False, after=first)
    again = None if back is None else crossing(t, psi, 0.0, rises=True, after=back)
    third = None if again is None else crossing(t, psi, 0.0, rises=False, after=again)
    period = None if third is None or back is None else third - back
    return (
        *out,
        figure("reach", back, "s", "from the first execute to the first return to the course (ITTC)", back),
        figure("period", period, "s", "between two returns to the course from the same side (ITTC)", third),
    )

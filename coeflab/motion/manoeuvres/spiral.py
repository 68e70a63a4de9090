"""Direct spiral (Dieudonne): rudder from one side to the other and back, held at each angle (IMO MSC/Circ.1053)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.options import bounded, measured, parse_options
from coeflab.motion.approach import along, judged, propulsion, turning_sense, undetermined, within_limit
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase
from coeflab.motion.readings import settled
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.turn_limits import unlimited
from coeflab.motion.vehicle import Vehicle

summary = "direct spiral: steady yaw rate over rudder angle, height of the loop at rudder zero"
citations = ("imo_msc137",)
plane = "horizontal"
NAME = "spiral"
SETTLED = 0.01


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the spiral.

    Attributes
    ----------
    largest
        Rudder angle at which it begins, to starboard.
    steps
        Angles between that and zero.
    speed
        Of the approach; 0: that of the parameter file.
    hold
        Time at each angle, in body lengths at the approach speed.
    """

    largest: float = measured(float(np.radians(15.0)), 1e-4, 1.2, "angle")
    steps: int = bounded(3, 1, 50)
    speed: float = measured(0.0, 0.0, 100.0, "speed")
    hold: float = bounded(40.0, 1.0, 1e4)


def _angles(o: Options) -> list[float]:
    down = np.linspace(o.largest, -o.largest, 2 * o.steps + 1)
    return [float(a) for a in (*down, *down[::-1][1:])]


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """One phase an angle: starboard, through zero, port, and back."""
    o = parse_options(Options, options, NAME)
    nu = along(vehicle, o.speed)
    within_limit(vehicle, "dr", o.largest, f"{NAME}.largest")
    sense = turning_sense(vehicle, "dr", "r", float(nu[0]))
    orders, words = propulsion(vehicle, float(nu[0]))
    hold = o.hold * vehicle.length / float(nu[0])
    phases = tuple(
        Phase(f"{k + 1}: {np.degrees(a):+.4g} deg", {"dr": sense * a}, hold) for k, a in enumerate(_angles(o))
    )
    rudder = "angles are positive to starboard, by the coefficients of the file"
    return Manoeuvre(NAME, phases, nu, orders=orders, statements=(words, rudder))


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Yaw rate at every angle and the loop; not determined where only unknown nonlinear terms would end the growth."""
    o = parse_options(Options, options, NAME)
    angles = _angles(o)
    out, at_zero = [], []
    for k, angle in enumerate(angles):
        way = "down" if k <= 2 * o.steps else "up"
        rows = trajectory.phase == k
        rate = None
        if np.count_nonzero(rows) > 3:
            t, r = trajectory.time[rows], trajectory.heading_rate[rows]
            top = float(np.max(np.abs(trajectory.heading_rate)))
            rate = settled(t, r, 0.2 * float(t[-1] - t[0]), SETTLED * top + 1e-12)
        status, why = ("ok", "") if rate is not None else ("not reached", "the rate still changes in the last fifth")
        text = f"steady, rudder {np.degrees(angle):+.4g} deg, on the way {way} (IMO MSC/Circ.1053)"
        figure = Figure(f"yaw rate at {np.degrees(angle):+.4g} deg, {way}", rate, "rad/s", text, status, why)
        end = float(trajectory.time[rows][-1]) if np.any(rows) else None
        out.append(judged(figure, trajectory, end))
        if abs(angle) < 1e-12:
            at_zero.append((rate, end))
    height = None
    if len(at_zero) == 2 and at_zero[0][0] is not None and at_zero[1][0] is not None:
        height = abs(at_zero[0][0] - at_zero[1][0])
    text = "difference of the two steady yaw rates at rudder zero (IMO MSC/Circ.1053)"
    loop = Figure("loop height", height, "rad/s", text, "ok" if height is not None else "not reached")
    out.append(judged(loop, trajectory, at_zero[-1][1] if at_zero else None))
    lacking = unlimited(vehicle, "r", float(trajectory.velocity[0, 0]))
    return tuple(undetermined(f, lacking) for f in out)

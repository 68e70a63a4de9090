"""Pull-out: the rudder goes amidships out of a steady turn, to either side (IMO MSC/Circ.1053)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.options import bounded, measured, parse_options
from coeflab.motion import approach
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase
from coeflab.motion.readings import settled
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.turn_limits import unlimited
from coeflab.motion.vehicle import Vehicle

summary = "pull-out from turns to either side: residual yaw rates, which differ where the vehicle is unstable"
citations = ("imo_msc137",)
plane = "horizontal"
NAME = "pull_out"
SETTLED = 0.01


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the pull-out.

    Attributes
    ----------
    rudder
        Of the turns before; 15 deg by default.
    speed
        Of the approach; 0: that of the parameter file.
    turn, after
        Time in the turn and after the rudder is amidships, in body lengths at the approach speed.
    """

    rudder: float = measured(float(np.radians(15.0)), 1e-4, 1.2, "angle")
    speed: float = measured(0.0, 0.0, 100.0, "speed")
    turn: float = bounded(40.0, 1.0, 1e4)
    after: float = bounded(60.0, 1.0, 1e4)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """Starboard turn, amidships, port turn, amidships."""
    o = parse_options(Options, options, NAME)
    nu = approach.along(vehicle, o.speed)
    angle = approach.within_limit(vehicle, "dr", o.rudder, f"{NAME}.rudder") * approach.turning_sense(
        vehicle, "dr", "r", float(nu[0])
    )
    orders, words = approach.propulsion(vehicle, float(nu[0]))
    length = vehicle.length / float(nu[0])
    turn, after = o.turn * length, o.after * length
    phases = (
        Phase("starboard turn", {"dr": angle}, turn),
        Phase("amidships after starboard", {"dr": 0.0}, after),
        Phase("port turn", {"dr": -angle}, turn),
        Phase("amidships after port", {"dr": 0.0}, after),
    )
    return Manoeuvre(NAME, phases, nu, orders=orders, statements=(words,))


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Residual yaw rates after either turn."""
    parse_options(Options, options, NAME)
    top = float(np.max(np.abs(trajectory.heading_rate)))
    out = []
    for k, side in ((1, "starboard"), (3, "port")):
        rows = trajectory.phase == k
        rate, end = None, None
        if np.count_nonzero(rows) > 3:
            t, r = trajectory.time[rows], trajectory.heading_rate[rows]
            end = float(t[-1])
            rate = settled(t, r, 0.2 * float(t[-1] - t[0]), SETTLED * top + 1e-12)
        status, why = ("ok", "") if rate is not None else ("not reached", "the rate still changes in the last fifth")
        text = f"steady yaw rate, rudder amidships after a turn to {side} (IMO MSC/Circ.1053)"
        out.append(
            approach.judged(Figure(f"residual yaw rate, {side}", rate, "rad/s", text, status, why), trajectory, end)
        )
    lacking = unlimited(vehicle, "r", float(trajectory.velocity[0, 0]))
    return tuple(approach.undetermined(f, lacking) for f in out)

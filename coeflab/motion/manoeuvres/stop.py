"""Stopping: the thrust is taken away or turned round (IMO MSC.137(76); MSC/Circ.1053)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.options import bounded, measured, parse_options
from coeflab.motion.approach import along, judged, propulsion
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase, Until
from coeflab.motion.readings import value_at
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.parameter_parts import THRUST

summary = "stopping from a straight run: track reach, head reach and time, thrust off or astern"
citations = ("imo_msc137",)
plane = "horizontal"
NAME = "stop"


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the stop.

    Attributes
    ----------
    speed
        Of the approach; 0: that of the parameter file.
    astern
        Thrust astern as a share of the thrust ahead; 0: thrust off, which never stops a body whose resistance goes with u^2.
    remaining
        Share of the approach speed at which it counts as stopped.
    longest
        s.
    """

    speed: float = measured(0.0, 0.0, 100.0, "speed")
    astern: float = bounded(1.0, 0.0, 10.0)
    remaining: float = bounded(0.01, 0.0, 0.9)
    longest: float = bounded(600.0, 1.0, 1e6)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """One phase with the thrust astern, until the speed is down."""
    o = parse_options(Options, options, NAME)
    nu = along(vehicle, o.speed)
    ahead, _ = propulsion(vehicle, float(nu[0]))
    thrust = -o.astern * ahead.get(THRUST, 0.0)
    stopped = Until("u", False, o.remaining * float(nu[0]))
    words = f"thrust {thrust:.4g} N at once at time zero" if thrust else "thrust off at time zero"
    down = f"stopped where u is down to {o.remaining:g} of the approach speed of {nu[0]:g} m/s"
    return Manoeuvre(
        NAME, (Phase("stopping", {THRUST: thrust}, o.longest, stopped),), nu, orders=ahead, statements=(words, down)
    )


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Reaches and time."""
    o = parse_options(Options, options, NAME)
    t, u = trajectory.time, trajectory.velocity[:, 0]
    when = trajectory.reached[0]
    steps = np.linalg.norm(np.diff(trajectory.position, axis=0), axis=1)
    track = np.concatenate([[0.0], np.cumsum(steps)])
    status = "ok" if when is not None else "not reached"
    why = "" if when is not None else f"still {u[-1]:.3g} m/s after {t[-1]:g} s"

    def at(values: Any) -> float | None:
        return None if when is None else value_at(t, values, when)

    return tuple(
        judged(Figure(name, at(values), unit, text, status, why), trajectory, when)
        for name, values, unit, text in (
            ("stopping time", t, "s", f"until u is {o.remaining:g} of the approach speed"),
            ("track reach", track, "m", "along the track (IMO MSC.137(76))"),
            ("head reach", trajectory.position[:, 0], "m", "along the first course (MSC/Circ.1053)"),
            (
                "lateral deviation",
                trajectory.position[:, 1],
                "m",
                "from the first course, to starboard (MSC/Circ.1053)",
            ),
        )
    )

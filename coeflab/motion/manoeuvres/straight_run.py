"""Straight run: from an approach speed under constant thrust, controls amidships (ITTC 7.5-02-06-01)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from coeflab.core.options import bounded, measured, orders, parse_options
from coeflab.motion.approach import along, judged, propulsion, thruster_orders
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase
from coeflab.motion.readings import settled
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.vehicle import Vehicle

summary = "straight run under constant thrust or thruster commands: speed it settles at, deviation from the course"
citations = ("ittc_free_running",)
plane = "horizontal"
NAME = "straight_run"


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the straight run.

    Attributes
    ----------
    speed
        Speed at the start; 0: that of the parameter file.
    commands
        Thruster commands such as left=60; none: constant thrust that keeps the speed.
    duration
        s.
    """

    speed: float = measured(0.0, 0.0, 100.0, "speed")
    commands: tuple[str, ...] = orders()
    duration: float = bounded(60.0, 0.1, 1e6)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """The run as one phase."""
    o = parse_options(Options, options, NAME)
    nu = along(vehicle, o.speed)
    orders, words = thruster_orders(vehicle, o.commands), "thrusters as commanded"
    if not orders:
        orders, words = propulsion(vehicle, float(nu[0]))
    return Manoeuvre(NAME, (Phase("run", {}, o.duration),), nu, orders=orders, statements=(words,))


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Final speed, and how far the track leaves the course."""
    parse_options(Options, options, NAME)
    t, end = trajectory.time, float(trajectory.time[-1])
    speed = settled(t, trajectory.speed, 0.1 * (end - t[0]), 1e-3 * float(trajectory.speed.max()))
    north, east, down = (float(v) for v in trajectory.position[-1])
    settled_at = "ok" if speed is not None else "not reached"
    found = (
        Figure("steady speed", speed, "m/s", "mean of the last tenth, where it varies by less than 0.1 %", settled_at),
        Figure("distance", north, "m", "along the first course"),
        Figure("deviation", east, "m", "from the first course, to starboard"),
        Figure("depth change", down, "m", "down"),
    )
    return tuple(judged(f, trajectory, end) for f in found)

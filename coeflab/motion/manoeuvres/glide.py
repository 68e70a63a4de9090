"""Glide: let go without thrust, and the steady glide or spiral that weight, buoyancy and the water bring about."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.options import bounded, measured, parse_options
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.motion.approach import judged
from coeflab.motion.dynamics import from_euler
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase
from coeflab.motion.readings import settled
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.vehicle import Vehicle

summary = (
    "glide without thrust, straight or in a spiral: speed, glide angle, angle of attack, pitch, rate of turn, radius"
)
citations = ("leonard_graver2001",)
plane = "vertical"
NAME = "glide"
LEAST, STEADY, ROUNDING = 1e-6, 1e-3, 1e-12
SLOWEST_TURN = 1e-6  # rad/s


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the glide.

    Attributes
    ----------
    speed
        Ahead, where it is let go.
    pitch
        At which it is let go; 0: level.
    duration
        s.
    """

    speed: float = measured(0.1, 1e-3, 100.0, "speed")
    pitch: float = measured(0.0, -1.4, 1.4, "angle")
    duration: float = bounded(600.0, 1.0, 1e6)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """One phase without orders.

    Raises
    ------
    InputError
        Weight and buoyancy are equal, or a motion of the vertical plane is held.
    """
    o = parse_options(Options, options, NAME)
    net = vehicle.weight - vehicle.buoyancy
    net = 0.0 if abs(net) < ROUNDING * vehicle.weight else net
    if abs(net) <= LEAST * vehicle.weight:
        raise input_error("motion.net_weight", column="hydrostatics", net=net)
    held = [m for m in "uwq" if m not in vehicle.free]
    if held:
        raise InputError(f"{', '.join(held)} held", "u, w and q that may change", column=NAME)
    nu = np.zeros(6)
    nu[0] = o.speed
    words = f"no thrust; net weight {net:.4g} N"
    return Manoeuvre(NAME, (Phase("glide", {}, o.duration),), nu, from_euler(0.0, o.pitch, 0.0), statements=(words,))


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """What it settles at: means of the last tenth of the time."""
    parse_options(Options, options, NAME)
    t, nu = trajectory.time, trajectory.velocity
    window, end = 0.1 * float(t[-1] - t[0]), float(t[-1])
    speed, angles, sinking = trajectory.speed, trajectory.angles, np.gradient(trajectory.position[:, 2], t)
    alpha = np.arctan2(nu[:, 2], nu[:, 0])
    zeta = -np.arcsin(np.clip(sinking / np.maximum(speed, LEAST), -1.0, 1.0))
    turn = trajectory.heading_rate
    steady = settled(t, speed, window, STEADY * float(np.max(speed)))
    status = "ok" if steady is not None else "not reached"
    why = "" if steady is not None else f"the speed still changes after {end:g} s"
    last = t >= end - window

    def mean(values: Array) -> float | None:
        return float(np.mean(values[last])) if steady is not None else None

    rate = mean(turn)
    found = [
        ("steady speed", steady, "m/s", "mean of the last tenth, where it varies by less than 0.1 %"),
        ("glide angle", mean(zeta), "rad", "of the track, below zero on a dive"),
        ("angle of attack", mean(alpha), "rad", "atan2(w, u)"),
        ("pitch", mean(angles[:, 1]), "rad", "above zero with the bow up"),
        ("sinking speed", mean(sinking), "m/s", "downward"),
        ("roll", mean(angles[:, 0]), "rad", "above zero with the starboard side down"),
        ("rate of turn", rate, "rad/s", "of the heading, to starboard"),
    ]
    if rate is not None and abs(rate) > SLOWEST_TURN:
        level = mean(trajectory.horizontal_speed)
        found.append(("radius", None if level is None else level / abs(rate), "m", "of the circle over ground"))
    return tuple(
        judged(Figure(name, value, unit, text, status, why), trajectory, end) for name, value, unit, text in found
    )

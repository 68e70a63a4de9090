"""Turning circle: a constant rudder angle, or unequal thrusters, from a straight run (IMO MSC.137(76), ITTC 7.5-02-06-01)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.options import bounded, measured, one_of, orders, parse_options
from coeflab.motion import approach
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase, Until
from coeflab.motion.readings import crossing, settled, value_at
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.turn_limits import unlimited
from coeflab.motion.vehicle import Vehicle

summary = "turning circle: advance, transfer, tactical and steady turning diameter, drift angle and loss of speed"
citations = ("imo_msc137", "ittc_free_running")
plane = "horizontal"
NAME = "turning_circle"
SETTLED = 2e-3
SWINGS = float(np.radians(0.5))  # half of the range of an angle: less is not named
STRAIGHT = 1e-6  # r L/V below which a turn is rounding


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the turning circle.

    Attributes
    ----------
    rudder
        Angle without sign; the sense that turns to the asked side is found from the coefficients. Unless given, the limit of a
        rudder that goes less far than 15 deg.
    side
        Side that the vehicle turns to.
    speed
        Of the approach; 0: that of the parameter file.
    commands
        Thruster commands such as left=0 right=60; they take the place of the rudder, and the side is theirs.
    turns
        Full turns to either side, at the end of which it stops, whatever steers.
    longest
        s; a vehicle that has not made its turns by then stops.
    """

    rudder: float = measured(float(np.radians(15.0)), 1e-4, 1.2, "angle")
    side: str = one_of("starboard", "starboard", "port")
    speed: float = measured(0.0, 0.0, 100.0, "speed")
    commands: tuple[str, ...] = orders()
    turns: float = bounded(2.0, 0.25, 50.0)
    longest: float = bounded(600.0, 1.0, 1e6)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """One phase, until the turns are made."""
    o = parse_options(Options, options, NAME)
    nu = approach.along(vehicle, o.speed)
    sign = 1.0 if o.side == "starboard" else -1.0
    done = Until("turned", True, 2.0 * np.pi * o.turns)
    if o.commands:
        orders = approach.thruster_orders(vehicle, o.commands)
        phase = Phase("turning", orders, o.longest, done)
        return Manoeuvre(NAME, (phase,), nu, statements=("thrusters as commanded from time zero",))
    angle = o.rudder if "rudder" in options else approach.reached(vehicle, "dr", o.rudder)
    angle = approach.within_limit(vehicle, "dr", angle, f"{NAME}.rudder")
    order = angle * sign * approach.turning_sense(vehicle, "dr", "r", float(nu[0]))
    orders, words = approach.propulsion(vehicle, float(nu[0]))
    rudder = f"rudder {np.degrees(order):+.4g} deg turns to {o.side} by the coefficients of the file"
    return Manoeuvre(
        NAME, (Phase("turning", {"dr": order}, o.longest, done),), nu, orders=orders, statements=(words, rudder)
    )


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Figures of the turn; where only unknown nonlinear terms would limit it, those that lean on them are not determined."""
    parse_options(Options, options, NAME)
    t, lacking = trajectory.time, unlimited(vehicle, "r", float(trajectory.velocity[0, 0]))
    side = 1.0 if trajectory.heading[-1] >= 0.0 else -1.0
    heading, across = side * trajectory.heading, side * trajectory.position[:, 1]
    quarter, half = (crossing(t, heading, a, rises=True) for a in (np.pi / 2.0, np.pi))
    out = []
    for name, when, values, text in (
        ("advance", quarter, trajectory.position[:, 0], "along the first course to 90 deg (IMO MSC.137(76))"),
        ("transfer", quarter, across, "across the first course to 90 deg (ITTC 7.5-02-06-01)"),
        ("time to 90 deg", quarter, t, "heading changed by 90 deg"),
        ("tactical diameter", half, across, "across the first course to 180 deg (IMO MSC.137(76))"),
        ("time to 180 deg", half, t, "heading changed by 180 deg"),
    ):
        value = None if when is None else value_at(t, values, when)
        unit = "s" if name.startswith("time") else "m"
        status = "ok" if value is not None else "not reached"
        why = "" if value is not None else f"heading changed by {np.degrees(heading[-1]):.3g} deg in {t[-1]:g} s"
        out.append(approach.judged(Figure(name, value, unit, text, status, why), trajectory, when, lacking))
    return (*out, *(approach.undetermined(f, lacking) for f in _steady(trajectory, vehicle)))


def swinging(trajectory: Trajectory, vehicle: Vehicle) -> str:
    """Which of pitch and roll swings most over the second half, and how to turn without it, in words; empty below `SWINGS`."""
    half = trajectory.time >= 0.5 * (trajectory.time[0] + trajectory.time[-1])
    swings = {
        name: float(np.ptp(trajectory.angles[half, i])) / 2.0
        for i, (name, rate) in enumerate((("roll", "p"), ("pitch", "q")))
        if rate in vehicle.free
    }
    name = max(swings, key=lambda n: swings[n], default="")
    if not name or swings[name] < SWINGS or not {"v", "r"} <= set(vehicle.free):
        return ""
    return f"; {name} swings by +-{np.degrees(swings[name]):.2g} deg. In the horizontal plane alone: --free u,v,r"


def _steady(trajectory: Trajectory, vehicle: Vehicle) -> list[Figure]:
    """Rate of heading and horizontal speed, so that a turn which climbs or rolls has the diameter of its track."""
    t, speeds = trajectory.time, trajectory.speed
    turning, ahead = trajectory.heading_rate, trajectory.horizontal_speed
    window = 0.1 * float(t[-1] - t[0])
    rate = settled(t, turning, window, SETTLED * float(np.max(np.abs(turning))) + 1e-12)
    speed = settled(t, speeds, window, SETTLED * float(np.max(speeds)))
    flat = settled(t, ahead, window, SETTLED * float(np.max(speeds)))
    turns = rate is not None and abs(rate) * vehicle.length > STRAIGHT * float(np.max(speeds))
    why = "" if turns else "the vehicle does not turn"
    if rate is None or speed is None or flat is None:
        why = f"rate and speed still change by more than {100 * SETTLED:g} % in the last tenth{swinging(trajectory, vehicle)}"
    drift = float(np.arcsin(np.clip(trajectory.velocity[-1, 1] / max(float(speeds[-1]), 1e-9), -1.0, 1.0)))
    values: tuple[float | None, ...] = (None,) * 4
    if turns and rate is not None and speed is not None and flat is not None:
        values = 2.0 * flat / abs(rate), rate, drift, speed / float(speeds[0])
    status = "not reached" if why else "ok"
    rows = (
        ("steady turning diameter", "m", "of the circle seen from above, through the water (ITTC 7.5-02-06-01)"),
        ("steady yaw rate", "rad/s", "of the heading, once it is steady"),
        ("steady drift", "rad", "asin(v/U), once it is steady"),
        ("speed in turn / approach speed", "1", "once it is steady"),
    )
    return [
        approach.judged(Figure(n, v, u, d, status, why), trajectory, float(t[-1]))
        for (n, u, d), v in zip(rows, values, strict=True)
    ]

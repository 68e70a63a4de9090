"""Depth change: planes to dive until a pitch is reached, then reversed until the vehicle is level again.

The stern planes; the bow planes where the file knows those alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.options import bounded, measured, one_of, parse_options
from coeflab.motion.approach import SURFACES, along, judged_rows, propulsion, turning_sense, within_limit
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase, Until
from coeflab.motion.readings import extreme, value_at
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.turn_limits import unlimited
from coeflab.motion.vehicle import Vehicle

summary = "depth change by the stern or bow planes: time to execute, overshoot of pitch and of depth"
citations = ("gertler1967",)
plane = "vertical"
NAME = "depth_change"


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the depth change.

    Attributes
    ----------
    planes, pitch
        Angle of the planes and pitch at which they are reversed; 10 deg each by default.
    way
        Dive or rise.
    speed
        Of the approach; 0: that of the parameter file.
    longest
        Of each leg, s.
    """

    planes: float = measured(float(np.radians(10.0)), 1e-4, 1.2, "angle")
    pitch: float = measured(float(np.radians(10.0)), 1e-4, 1.4, "angle")
    way: str = one_of("dive", "dive", "rise")
    speed: float = measured(0.0, 0.0, 100.0, "speed")
    longest: float = bounded(300.0, 1.0, 1e5)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """Planes over, planes reversed, planes amidships."""
    o = parse_options(Options, options, NAME)
    nu = along(vehicle, o.speed)
    sign = -1.0 if o.way == "dive" else 1.0
    known = {v for t in vehicle.law.terms for v in t.variables}
    planes = "db" if "db" in known and "ds" not in known else "ds"
    angle = within_limit(vehicle, planes, o.planes, f"{NAME}.planes")
    sense = turning_sense(vehicle, planes, "q", float(nu[0]))
    order = sign * angle * sense
    orders, words = propulsion(vehicle, float(nu[0]))
    level = max(5.0 * vehicle.length / float(nu[0]), 1.0)
    phases = (
        Phase("over", {planes: order}, o.longest, Until("pitch", o.way == "rise", sign * o.pitch)),
        Phase("reversed", {planes: -order}, o.longest, Until("pitch", o.way == "dive", 0.0)),
        Phase("amidships", {planes: 0.0}, level),
    )
    first = f"first {SURFACES[planes]} {np.degrees(order):+.4g} deg, to {o.way} by the coefficients of the file, whose positive {planes} turns the bow {'up' if sense > 0.0 else 'down'}"
    return Manoeuvre(NAME, phases, nu, orders=orders, statements=(words, first))


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Times and overshoots."""
    o = parse_options(Options, options, NAME)
    t, depth, pitch = trajectory.time, trajectory.position[:, 2], trajectory.pitch
    down = o.way == "dive"
    lacking = unlimited(vehicle, "q", float(trajectory.velocity[0, 0]))
    execute, level = (*trajectory.reached, None, None)[:2]
    peak = None if execute is None else extreme(t, pitch, largest=not down, after=execute)
    deepest = None if execute is None else extreme(t, depth, largest=down, after=execute)
    away = np.abs(depth - depth[0])
    rows = (
        ("time to execute", execute, "s", execute, f"until pitch is {np.degrees(o.pitch):g} deg"),
        ("depth at execute", None if execute is None else value_at(t, away, execute), "m", execute, "changed so far"),
        (
            "overshoot of pitch", None if peak is None else abs(peak[1]) - o.pitch, "rad", None if peak is None else peak[0],
            "beyond the execute pitch, after the planes are reversed",
        ),
        (
            "overshoot of depth",
            None if deepest is None or execute is None else abs(deepest[1] - value_at(t, depth, execute)), "m",
            None if deepest is None else deepest[0], "from the reversal of the planes to the extreme of depth",
        ),
        ("time to level", level, "s", level, "until pitch first passes zero; it may pass it again"),
        (
            "depth at the end", float((depth[-1] - depth[0]) * (1.0 if down else -1.0)), "m", float(t[-1]),
            f"after {t[-1]:.4g} s, from the start, {'down' if down else 'up'}; planes amidships from time to level, nothing keeps it",
        ),
    )  # fmt: skip
    return judged_rows(rows, trajectory, lacking, "q")

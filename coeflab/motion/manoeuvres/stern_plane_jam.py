"""Stern-plane jam and recovery: the planes stay at an angle, and after a time of reaction the crew takes off power, puts the bow planes over or frees the planes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.options import bounded, measured, one_of, parse_options
from coeflab.motion.approach import along, judged_rows, propulsion, turning_sense, within_limit
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase, Until
from coeflab.motion.readings import extreme, value_at
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.turn_limits import unlimited
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.parameter_parts import THRUST

summary = "stern planes jammed to dive or rise, then recovery by power, bow planes or freed planes: excursions of depth and pitch"
citations = ("gertler1967",)
plane = "vertical"
NAME = "stern_plane_jam"
LENGTHS, AFTER = 3.0, 20.0  # of way until the crew acts, where no time is asked for, and of way after level pitch


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the jam.

    Attributes
    ----------
    planes
        Angle of the jam; 10 deg by default.
    way
        Dive or rise.
    reaction
        Time until the recovery begins, s; 0: three lengths of way.
    power
        Thrust of the recovery as a share of that of the approach: 0 stopped, below zero astern.
    bow
        Angle of the bow planes against the jam; 0: amidships.
    freed
        Time from the beginning of the recovery until the stern planes are amidships again, s; 0: never.
    speed
        Of the approach; 0: that of the parameter file.
    longest
        Of the recovery, s.
    """

    planes: float = measured(float(np.radians(10.0)), 1e-4, 1.2, "angle")
    way: str = one_of("dive", "dive", "rise")
    reaction: float = bounded(0.0, 0.0, 1e4)
    power: float = bounded(0.0, -10.0, 10.0)
    bow: float = measured(0.0, 0.0, 1.2, "angle")
    freed: float = bounded(0.0, 0.0, 1e4)
    speed: float = measured(0.0, 0.0, 100.0, "speed")
    longest: float = bounded(300.0, 1.0, 1e5)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """Jammed, recovered until level, and a while beyond.

    Raises
    ------
    InputError
        Planes that the file does not know, an angle beyond their limit, power where the speed is held.
    """
    o = parse_options(Options, options, NAME)
    nu = along(vehicle, o.speed)
    speed, sign = float(nu[0]), -1.0 if o.way == "dive" else 1.0
    jam = sign * turning_sense(vehicle, "ds", "q", speed) * within_limit(vehicle, "ds", o.planes, f"{NAME}.planes")
    approach, words = propulsion(vehicle, speed)
    if not approach and "power" in options:
        raise InputError("power where the speed is held", "a free speed", column=f"{NAME}.power", advice="--free u,w,q")
    orders = {THRUST: o.power * approach[THRUST]} if approach else {}
    if o.bow:
        orders["db"] = (
            -sign * turning_sense(vehicle, "db", "q", speed) * within_limit(vehicle, "db", o.bow, f"{NAME}.bow")
        )
    lengths = vehicle.length / speed
    reaction, level = o.reaction or LENGTHS * lengths, Until("pitch", o.way == "dive", 0.0)
    recovery: tuple[Phase, ...] = (Phase("recovery", orders, o.longest, level),)
    if o.freed:
        recovery = (Phase("recovery", orders, o.freed), Phase("freed", {"ds": 0.0}, o.longest, level))
    phases = (Phase("jam", {"ds": jam}, reaction), *recovery, Phase("level", {}, max(AFTER * lengths, 1.0)))
    steps = [f"thrust {o.power:g} of the approach's"] * bool(approach)
    steps += [f"bow planes (db) {np.degrees(orders['db']):+.4g} deg"] if o.bow else []
    steps += [f"stern planes amidships {o.freed:g} s later"] if o.freed else ["stern planes stay jammed"]
    limits = (
        f"stern planes (ds) jammed at {np.degrees(jam):+.4g} deg, to {o.way}; after {reaction:.4g} s {', '.join(steps)}"
    )
    return Manoeuvre(NAME, phases, nu, orders=approach, statements=(words, limits))


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Excursions of depth and pitch, and times."""
    o = parse_options(Options, options, NAME)
    t, down = trajectory.time, 1.0 if o.way == "dive" else -1.0
    depth = down * (trajectory.position[:, 2] - trajectory.position[0, 2])
    pitch = -down * trajectory.pitch
    begun = min(float(t[-1]), o.reaction or LENGTHS * vehicle.length / float(trajectory.velocity[0, 0]))
    level = trajectory.reached[2 if o.freed else 1] if len(trajectory.reached) > 1 + bool(o.freed) else None
    if level is not None and abs(value_at(t, pitch, level)) > np.pi / 2.0:  # upside down
        level = None
    deepest, steepest = extreme(t, depth, largest=True, after=0.0), extreme(t, pitch, largest=True, after=0.0)
    turned = deepest is not None and deepest[0] < t[-1]
    lacking = unlimited(vehicle, "q", float(trajectory.velocity[0, 0]))
    way, bow = ("down", "down") if o.way == "dive" else ("up", "up")
    rows = (
        ("depth at recovery", value_at(t, depth, begun), "m", begun, f"changed {way} when the recovery begins"),
        ("pitch at recovery", value_at(t, pitch, begun), "rad", begun, f"bow {bow}"),
        ("depth excursion", deepest[1] if deepest is not None and turned else None, "m", deepest[0] if deepest else None, f"largest change {way} from the start"),
        ("time to depth excursion", deepest[0] if deepest is not None and turned else None, "s", deepest[0] if deepest else None, "from the jam"),
        ("largest pitch", steepest[1] if steepest else None, "rad", steepest[0] if steepest else None, f"bow {bow}, not wrapped"),
        ("time to level", level, "s", level, "from the jam until pitch passes zero"),
        ("speed at the end", float(np.linalg.norm(trajectory.velocity[-1, :3])), "m/s", float(t[-1]), f"after {t[-1]:.4g} s"),
    )  # fmt: skip
    return judged_rows(rows, trajectory, lacking, "q")

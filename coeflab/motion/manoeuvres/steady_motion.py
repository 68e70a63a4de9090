"""Steady motion: trim finds commands, and the vehicle starts in the motion with them and goes on without any further order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.options import bounded, measured, orders, parse_options
from coeflab.core.texts import input_error
from coeflab.motion.approach import judged, thruster_orders
from coeflab.motion.dynamics import from_euler, rotations
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.trim.steady_motion import MOTION
from coeflab.motion.trim.trim import trim
from coeflab.motion.vehicle import Vehicle

summary = "a steady motion and its commands from trim, held: radius and climb of the helix, and departure from it"
citations = ("fossen2011",)
plane = "vertical"
NAME = "steady_motion"
NO_TURN = 1e-9
NAMED = ("speed", "sway", "heave", "yaw_rate", "roll", "pitch")  # as `MOTION` has them


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the steady motion.

    Attributes
    ----------
    speed, sway, heave
        u, v and w through the water. What is not named of these, yaw_rate, roll and pitch is zero where commands can keep that, and
        found as `coeflab trim` finds it elsewhere.
    yaw_rate
        Rate of heading.
    roll, pitch
        Constant attitude.
    near
        Among several trims the nearest to these commands, such as rotor1=2000 rotor1.tilt=1.39, angles in rad, on the command line in deg; none: the
        least effort.
    starts
        Cold starts of the trim.
    duration
        s.
    """

    speed: float = measured(0.0, -100.0, 100.0, "speed")
    sway: float = measured(0.0, -100.0, 100.0, "speed")
    heave: float = measured(0.0, -100.0, 100.0, "speed")
    yaw_rate: float = measured(0.0, -10.0, 10.0, "rate")
    roll: float = measured(0.0, -1.5, 1.5, "angle")
    pitch: float = measured(0.0, -1.4, 1.4, "angle")
    near: tuple[str, ...] = orders()
    starts: int = bounded(4, 0, 1000)
    duration: float = bounded(60.0, 0.1, 1e6)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """The motion as one phase under the commands of its trim.

    Raises
    ------
    InputError
        There is no such steady motion, by the equation that stays violated.
    """
    o = parse_options(Options, options, NAME)
    wanted = dict(zip(MOTION, (o.speed, o.sway, o.heave, o.yaw_rate, o.roll, o.pitch), strict=True))
    near = thruster_orders(vehicle, o.near)
    found = trim(vehicle, wanted, near=near, starts=o.starts)
    words: tuple[str, ...] = ("commands of the trim",)
    named = {k: v for option, (k, v) in zip(NAMED, wanted.items(), strict=True) if option in options}
    if not found.point.outcome.solved and 0 < len(named) < len(wanted):
        found = trim(vehicle, named, near=near, starts=o.starts)
        open_ = [n for n, u in zip(NAMED, found.motion.unknowns, strict=False) if n not in options and u.low < u.high]
        words = (
            *words,
            f"{', '.join(open_)} found by the trim: at zero, where they stand unless named, no commands keep this motion",
        )
    if not found.point.outcome.solved:
        raise input_error("motion.no_such_steady_motion", column=NAME, point=found.point.words()[0])
    values = found.point.values
    orders = {name: value for name, value in values.items() if name not in MOTION}
    attitude = from_euler(values["roll"], values["pitch"], 0.0)
    return Manoeuvre(
        NAME, (Phase("steady", {}, o.duration),), found.velocity, attitude, orders, (*words, *found.point.words()),
    )  # fmt: skip


def helix(velocity: np.ndarray, attitude: np.ndarray, yaw_rate: float, time: np.ndarray) -> np.ndarray:
    """(n, 3) path of constant body velocities, roll, pitch and rate of heading from the origin, heading north.

    Parameters
    ----------
    velocity : (3,) array
        u v w.
    attitude : (4,) array
        At the start.
    yaw_rate : float
        rad/s.
    time : (n,) array
        s.
    """
    north, east, down = rotations(np.asarray(attitude)[None, :])[0] @ velocity
    turned = yaw_rate * time
    # sin(x)/x and (1 - cos x)/x stay right where the turn vanishes.
    along, aside = time * np.sinc(turned / np.pi), time * np.sinc(turned / (2.0 * np.pi)) * np.sin(turned / 2.0)
    return np.column_stack([north * along - east * aside, north * aside + east * along, down * time])


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Helix of the motion, and how far the simulated one leaves it."""
    o = parse_options(Options, options, NAME)
    end = float(trajectory.time[-1])
    start, nu = np.asarray(trajectory.attitude[0]), np.asarray(trajectory.velocity)
    level = float(trajectory.horizontal_speed[0])
    turn = o.yaw_rate if "yaw_rate" in options else float(trajectory.heading_rate[0])
    due = helix(nu[0, :3], start, turn, np.asarray(trajectory.time))
    sinking = float((rotations(start[None, :])[0] @ nu[0, :3])[2])
    turns = abs(turn) * vehicle.length > NO_TURN * max(level, NO_TURN)
    rate = abs(turn) if turns else 1.0
    period = 2.0 * np.pi / rate
    straight = "" if turns else "a straight course"
    found = (
        Figure("radius", level / rate if turns else None, "m", "horizontal speed over rate of heading", why=straight),
        Figure("period", period if turns else None, "s", "of one turn", why=straight),
        Figure("descent a turn", sinking * period if turns else None, "m", "down in one turn", why=straight),
        Figure("climb", -sinking + 0.0, "m/s", "up"),
        Figure(
            "departure from the path", float(np.max(np.linalg.norm(trajectory.position - due, axis=1))), "m",
            "largest distance from the path of constant velocities",
        ),
        Figure(
            "departure of the velocity", float(np.max(np.linalg.norm(nu[:, :3] - nu[0, :3], axis=1))), "m/s",
            "largest change of u v w",
        ),
    )  # fmt: skip
    return tuple(judged(f if f.value is not None else _without(f), trajectory, end) for f in found)


def _without(figure: Figure) -> Figure:
    return Figure(figure.name, None, figure.unit, figure.definition, "not reached", figure.why)

"""Trim: the commands of a given steady motion, or the steady motion of given commands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.machine import one_thread
from coeflab.core.symbols import CONTROLS
from coeflab.kernels.brief import brief
from coeflab.kernels.linearisation import growth
from coeflab.kernels.wind_axes import incidence
from coeflab.model.operating_point import OperatingPoint, Unknown, nearest, operating_point
from coeflab.model.outside import outside_in_words
from coeflab.model.table import Table, number
from coeflab.model.trim_equations import MOTION, SteadyMotion, steady_motion
from coeflab.model.vehicle import Vehicle

Array = NDArray[np.float64]
STRAIGHT = 1e-9


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Trim:
    """A steady motion with the commands that keep it.

    Attributes
    ----------
    motion : SteadyMotion
    point : OperatingPoint
    velocity : (6,) array
        u v w p q r through the water at the reference point.
    others : tuple of (dict of str to float, str)
        Other solutions and their stability.
    """

    motion: SteadyMotion
    point: OperatingPoint
    velocity: Array
    others: tuple[tuple[dict[str, float], str], ...]

    @property
    def figures(self) -> dict[str, tuple[float | None, str]]:
        """Speed, incidence and radius with their units; None where there is none, as the radius of a straight course."""
        u, v, w = self.velocity[:3]
        speed = float(np.linalg.norm(self.velocity[:3]))
        alpha, beta = (float(a[0]) for a in incidence(np.array([u]), np.array([v]), np.array([w])))
        turn, pitch, roll = (self.point.values[k] for k in ("yaw_rate", "pitch", "roll"))
        sinking = -np.sin(pitch) * u + np.cos(pitch) * (np.sin(roll) * v + np.cos(roll) * w)
        level = float(np.sqrt(max(speed**2 - sinking**2, 0.0)))
        turning = abs(turn) * self.motion.vehicle.length > STRAIGHT * max(level, STRAIGHT)
        p, q, r = (float(x) + 0.0 for x in self.velocity[3:])
        return {
            "speed": (speed, "m/s"), "alpha": (alpha + 0.0, "rad"), "beta": (beta + 0.0, "rad"),
            "climb": (float(-sinking) + 0.0, "m/s"), "p": (p, "rad/s"), "q": (q, "rad/s"), "r": (r, "rad/s"),
            "radius": (level / abs(turn) if turning else None, "m"),
        }  # fmt: skip

    def figure_table(self) -> Table:
        """What the solution means, angles in degrees."""
        rows = []
        for name, (value, unit) in self.figures.items():
            factor = np.degrees(1.0) if unit.startswith("rad") else 1.0
            rows.append((name, number(None if value is None else value * factor, 6), unit.replace("rad", "deg")))
        return Table("Motion", ("", "value", "unit"), tuple(rows), (), frozenset({0, 2}))

    def other_table(self) -> Table:
        """Other solutions, angles in degrees."""
        unknowns = [u for u in self.point.unknowns if u.low < u.high]
        rows = tuple(
            (*(u.shown(values[u.name]).partition(" ")[0] for u in unknowns), state) for values, state in self.others
        )
        headers = tuple(f"{u.name} [{u.shown(0.0).partition(' ')[2]}]" for u in unknowns)
        return Table("Other solutions", (*headers, "small motions"), rows, (), frozenset({len(headers)}))


@one_thread()
def trim(
    vehicle: Vehicle,
    motion: Mapping[str, float],
    commands: Mapping[str, float] | None = None,
    near: Mapping[str, float] | None = None,
    starts: int = 8,
    seed: int = 0,
) -> Trim:
    """Find a steady motion and its commands.

    Parameters
    ----------
    vehicle : Vehicle
    motion, commands : mapping
        What is given, SI; see `coeflab.model.trim_equations.steady_motion`.
    near : mapping, optional
        A point by names of unknowns: among several solutions the nearest to it is taken, each unknown in its scale.
        Otherwise the least effort: commands over their limits, and departures from straight, level and upright.
    starts, seed : int
        Seeded cold starts.

    Raises
    ------
    InputError
        Nothing given, nothing to be found, or a name or value that the vehicle does not have.
    """
    if not motion and not commands:
        raise InputError("neither a motion nor a command", "--speed, --yaw-rate, --command or the like")
    steady = steady_motion(vehicle, motion, commands or {})
    unknowns = _ruled(steady.unknowns, near or {})
    if not any(u.low < u.high for u in unknowns):
        raise InputError("a motion and commands that leave nothing to find", "something left open", column="command")
    start = [near[u.name] if near and u.name in near else _first(u, vehicle) for u in unknowns]
    found = operating_point(unknowns, steady.equations, steady.left, start, starts, seed)
    values = steady.modes(found.found.point)
    state = growth(values)
    statements = (*_beyond(vehicle, steady, found), *_unstated(vehicle, unknowns), *vehicle.statements)
    if found.outcome.solved:
        found = replace(found, modes=tuple(complex(v) for v in values), growth=state)
    others = tuple(
        ({u.name: float(x) + 0.0 for u, x in zip(unknowns, y, strict=True)}, growth(steady.modes(y)))
        for y in found.found.others
    )
    return Trim(
        steady, replace(found, statements=tuple(dict.fromkeys(statements))), steady.state(found.found.point)[0], others
    )


def _ruled(unknowns: tuple[Unknown, ...], near: Mapping[str, float]) -> tuple[Unknown, ...]:
    names = [u.name for u in unknowns]
    strange = [n for n in near if n not in names]
    if strange:
        raise InputError(shown(strange[0]), f"one of {', '.join(names)}", column="near")
    return nearest(unknowns, near) if near else unknowns


def _first(u: Unknown, vehicle: Vehicle) -> float:
    """Straight ahead at the file's speed, commands in the middle between none and their upper limit."""
    if u.name == "u":
        start = vehicle.speed
    elif u.name in MOTION or u.name in CONTROLS or u.name.endswith(".tilt"):
        start = 0.0
    else:
        start = u.high / 2.0 if np.isfinite(u.high) else u.scale
    return float(min(max(start, u.low), u.high))


def _beyond(vehicle: Vehicle, steady: SteadyMotion, found: OperatingPoint) -> tuple[str, ...]:
    """Motions of the solution that no data behind the coefficients cover."""
    if not found.outcome.solved:
        return ()
    (velocity, _), (angles, _) = steady.state(found.found.point), steady.commands(found.found.point)
    return outside_in_words(vehicle, velocity, dict(zip(CONTROLS, angles, strict=True)))


def _unstated(vehicle: Vehicle, unknowns: tuple[Unknown, ...]) -> list[str]:
    stated = {s.control for s in vehicle.surfaces}
    return [
        f"{u.name}: no limit in the file, {u.shown(u.high)} either way taken."
        for u in unknowns
        if u.name in CONTROLS and u.name not in stated and u.low < u.high
    ]

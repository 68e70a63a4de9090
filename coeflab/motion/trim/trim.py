"""Trim: the commands of a given steady motion, or the steady motion of given commands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding
from coeflab.core.keywords import all_spoken
from coeflab.core.machine import one_thread
from coeflab.core.missed import suggesting
from coeflab.core.table import Table, number
from coeflab.core.texts import remark, text_of
from coeflab.core.types import Array, dataclass, in_angles
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.law.transforms import incidence
from coeflab.motion.small_motions import growth
from coeflab.motion.trajectory import outside_in_words, refusal
from coeflab.motion.trim.operating_point import OperatingPoint, Unknown, nearest, operating_point
from coeflab.motion.trim.steady_motion import CLIMB, MOTION, SteadyMotion, steady_motion
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.imported_numbers import AIR

if TYPE_CHECKING:
    import pandas as pd


STRAIGHT = 1e-9
LEVEL = 1e-6  # of the speed


@suggesting
@dataclass(frozen=True, slots=True, eq=False, repr=False)
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
    refused : tuple of Finding
        That a table of the law has no value at the solution.
    """

    motion: SteadyMotion
    point: OperatingPoint
    velocity: Array
    others: tuple[tuple[dict[str, float], str], ...]
    refused: tuple[Finding, ...] = ()

    def __repr__(self) -> str:
        commands = ", ".join(f"{name} {value:.4g}" for name, value in self.commands.items())
        return in_angles(self, f"{self.point.outcome.value}: {commands}")

    @property
    def solved(self) -> bool:
        """Whether commands keep the motion; where none do, commands and figures are not numbers.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.trim("remus100", speed=1.5).solved, cf.trim("huuv", speed=5.0).solved
        (True, False)
        """
        return self.point.outcome.solved

    @property
    def statements(self) -> tuple[str, ...]:
        """What was assumed, and what no data cover."""
        return all_spoken(self.point.statements)

    @property
    def commands(self) -> dict[str, float]:
        """Thrusters in their units, control angles in rad, ``thrust`` in N where no thruster gives it.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.trim("remus100", speed=1.5).commands["thrust"] > 0.0
        True
        """
        return {u.name: self.point.values[u.name] if self.solved else np.nan for u in self.motion.command_unknowns}

    def frame(self) -> pd.DataFrame:
        """A row a figure and a command: value and unit.

        Examples
        --------
        >>> import coeflab as cf
        >>> round(float(cf.trim("remus100", speed=1.5).frame().loc["speed", "value"]), 6)
        1.5
        """
        import pandas as pd

        rows = {**self.figures, **{u.name: (self.commands[u.name], u.unit) for u in self.motion.command_unknowns}}
        return pd.DataFrame(
            [(np.nan if v is None else v, unit) for v, unit in rows.values()], list(rows), ["value", "unit"]
        )

    @property
    def figures(self) -> dict[str, tuple[float | None, str]]:
        """Speed, incidence and radius with their units; None where there is none: the radius of a straight course, all of an unsolved one."""
        u, v, w = self.velocity[:3]
        speed = float(np.linalg.norm(self.velocity[:3]))
        alpha, beta = (float(a[0]) for a in incidence(np.array([u]), np.array([v]), np.array([w])))
        turn, climb = self.point.values["yaw_rate"], self.motion.rising(self.point.found.point)
        level = float(np.sqrt(max(speed**2 - climb**2, 0.0)))
        turning = abs(turn) * self.motion.vehicle.length > STRAIGHT * max(level, STRAIGHT)
        p, q, r = (float(x) + 0.0 for x in self.velocity[3:])
        out: dict[str, tuple[float | None, str]] = {
            "speed": (speed, "m/s"), "alpha": (alpha + 0.0, "rad"), "beta": (beta + 0.0, "rad"),
            CLIMB: (climb + 0.0, "m/s"), "p": (p, "rad/s"), "q": (q, "rad/s"), "r": (r, "rad/s"),
            "radius": (level / abs(turn) if turning else None, "m"),
        }  # fmt: skip
        return out if self.solved else {name: (None, unit) for name, (_, unit) in out.items()}

    @property
    def depth_is_kept(self) -> bool:
        """Whether the solution neither rises nor sinks."""
        climb, speed = (self.figures[name][0] or 0.0 for name in (CLIMB, "speed"))
        return abs(climb) <= LEVEL * max(speed, STRAIGHT)

    @property
    def state_in_words(self) -> str:
        """Speed, pitch and climb of the solution; empty of an unsolved one."""
        if not self.solved:
            return ""
        pitch = next(u for u in self.point.unknowns if u.name == "pitch")
        climb = "depth kept" if self.depth_is_kept else f"climb {number(self.figures[CLIMB][0], 4)} m/s, depth not kept"
        ask = (
            f"; {CLIMB} = 0 asks for it"
            if self.motion.climb is None and pitch.low < pitch.high and not self.depth_is_kept
            else ""
        )
        return f"steady motion at u = {number(self.point.values['u'], 4)} m/s: pitch {pitch.shown(self.point.values['pitch'], 4)}, {climb}{ask}"

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
        What is given, SI; see `coeflab.motion.trim.trim.steady_motion`.
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
        raise InputError("neither a motion nor a command", "a speed, a yaw rate, commands or the like")
    steady = steady_motion(vehicle, motion, commands or {})
    unknowns = _ruled(steady.unknowns, near or {})
    if not any(u.low < u.high for u in unknowns):
        raise InputError("a motion and commands that leave nothing to find", "something left open", column="command")
    start = [near[u.name] if near and u.name in near else _first(u, vehicle) for u in unknowns]
    found = operating_point(unknowns, steady.equations, steady.left, start, starts, seed)
    values = steady.modes(found.found.point)
    state = growth(values)
    lacking = _without_added_mass(vehicle) if found.outcome.solved else []
    refused = _refused(vehicle, steady, found)
    statements = (
        *map(remark, refused),
        *_beyond(vehicle, steady, found),
        *_unstated(vehicle, unknowns),
        *([text_of("motion.roots_in_air", lacking=", ".join(lacking))] if lacking else []),
        *vehicle.statements,
    )
    if found.outcome.solved:
        found = replace(found, modes=tuple(complex(v) for v in values), growth=state)
    others = tuple(
        ({u.name: float(x) + 0.0 for u, x in zip(unknowns, y, strict=True)}, growth(steady.modes(y)))
        for y in found.found.others
    )
    found = replace(found, statements=tuple(dict.fromkeys(statements)))
    return Trim(steady, found, steady.state(found.found.point)[0], others, refused)


def _without_added_mass(vehicle: Vehicle) -> list[str]:
    """Accelerations, across and turning, that no added mass is known of; in water the roots are then those in air."""
    if AIR[0] < vehicle.density <= AIR[1]:
        return []
    at = [MOTIONS.index(m) for m in vehicle.free if m in "vwqr"]
    return [f"{COMPONENTS[i]}{MOTIONS[i]}dot'" for i in at if vehicle.water.matrix[i, i] <= 0.0]


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


def _refused(vehicle: Vehicle, steady: SteadyMotion, found: OperatingPoint) -> tuple[Finding, ...]:
    """That tables which refuse to be read beyond their data have no value at the solution."""
    (velocity, _), (angles, _) = steady.state(found.found.point), steady.commands(found.found.point)
    if not found.outcome.solved or not vehicle.law.refused(velocity[None, :], angles[None, :])[0]:
        return ()
    return (refusal("law.refused_point", vehicle),)


def _beyond(vehicle: Vehicle, steady: SteadyMotion, found: OperatingPoint) -> tuple[str, ...]:
    """Motions of the solution that no data behind the coefficients cover."""
    if not found.outcome.solved:
        return ()
    (velocity, _), (angles, _) = steady.state(found.found.point), steady.commands(found.found.point)
    return outside_in_words(vehicle, velocity, dict(zip(CONTROLS, angles, strict=True)))


def _unstated(vehicle: Vehicle, unknowns: tuple[Unknown, ...]) -> list[str]:
    stated = {s.control for s in vehicle.surfaces}
    still = "u" in vehicle.free and vehicle.resistance(vehicle.speed) == 0.0
    surge = (
        ["surge has no law in the file: no term of X resists a straight run, which takes no thrust."] if still else []
    )
    return surge + [
        f"{u.name}: no limit in the file, {u.shown(u.high)} either way taken."
        for u in unknowns
        if u.name in CONTROLS and u.name not in stated and u.low < u.high
    ]

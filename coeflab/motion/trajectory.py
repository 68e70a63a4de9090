"""A motion as it was computed, and how it ended.

Where a motion leaves what the coefficients cover.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from coeflab.core.cards import html_by
from coeflab.core.finding import Finding, Severity
from coeflab.core.table import number
from coeflab.core.texts import remark
from coeflab.core.types import Array, in_angles, locked, locked_columns, locking
from coeflab.law.force_law import SLOWEST
from coeflab.law.symbols import ANGLE_NAMES, ANGULAR, CONTROLS, LINEAR, MOTIONS
from coeflab.motion.dynamics import euler_angles, rotations
from coeflab.motion.vehicle import Vehicle, control_rows

STEEPEST = 1e-6


class Ended(StrEnum):
    """How a computation of a motion ended."""

    COMPLETE = "complete"
    NOT_FINITE = "not_finite"
    OUT_OF_RANGE = "out_of_range"
    STEP_TOO_SMALL = "step_too_small"
    TOO_FAST = "too_fast"


@dataclass(frozen=True, slots=True, eq=False)
@locking("time position attitude velocity heading controls")
class Trajectory:
    """A motion, one row a time.

    Attributes
    ----------
    time : (n,) array
        s.
    position : (n, 3) array
        Of the reference point, NED, m.
    attitude : (n, 4) array
        Unit quaternion, scalar first, body to NED.
    velocity : (n, 6) array
        u v w p q r through the water at the reference point, FRD, m/s and rad/s.
    heading : (n,) array
        Turned since the start, rad, not wrapped.
    controls : mapping of name to (n,) array
        Angles dr ds db in rad, commands of thrusters in their units, tilts in rad.
    phase : (n,) int array
        Index into ``phases``.
    phases : tuple of str
    reached : tuple of float or None
        Time at which each phase ended by its condition; None where it ended by time, or was never begun.
    outside : mapping of str to (n,) bool array
        For every covered variable, whether the motion is outside of what the coefficients cover.
    ended : Ended
    why : str
        In words, with time and state, where it is not complete.
    statements : tuple of str
        What was assumed.
    """

    time: Array
    position: Array
    attitude: Array
    velocity: Array
    heading: Array
    controls: Mapping[str, Array]
    phase: NDArray[np.int64]
    phases: tuple[str, ...]
    reached: tuple[float | None, ...]
    outside: Mapping[str, NDArray[np.bool_]]
    ended: Ended
    why: str = ""
    statements: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "phase", locked(self.phase, int))
        object.__setattr__(self, "outside", locked_columns(self.outside, bool))

    @property
    def angles(self) -> Array:
        """(n, 3) roll, pitch and yaw, rad."""
        return euler_angles(np.asarray(self.attitude))

    @property
    def pitch(self) -> Array:
        """(n,) rad, counted on past the vertical, where roll of `angles` jumps by half a turn and its pitch comes back."""
        roll, pitch, _ = self.angles.T
        over = np.cumsum(np.cos(np.diff(roll, prepend=roll[:1])) < 0.0) % 2 == 1
        return np.asarray(np.unwrap(np.where(over, np.pi - pitch, pitch)))

    @property
    def speed(self) -> Array:
        """(n,) through the water, m/s."""
        return np.asarray(np.linalg.norm(self.velocity[:, :3], axis=1))

    @property
    def heading_rate(self) -> Array:
        """(n,) rate of the heading, rad/s: (q sin(phi) + r cos(phi)) / cos(theta) (Fossen 2011, equation 2.28)."""
        roll, pitch, _ = self.angles.T
        turned = self.velocity[:, 4] * np.sin(roll) + self.velocity[:, 5] * np.cos(roll)
        return np.asarray(turned / np.maximum(np.cos(pitch), STEEPEST))

    @property
    def horizontal_speed(self) -> Array:
        """(n,) horizontal part of the speed through the water, m/s."""
        moved = np.einsum("nij,nj->ni", rotations(np.asarray(self.attitude)), self.velocity[:, :3])
        return np.asarray(np.hypot(moved[:, 0], moved[:, 1]))

    def __repr__(self) -> str:
        turned, last = float(np.degrees(self.heading[-1])), float(self.time[-1] - self.time[0])
        ended = self.ended.value.replace("_", " ")
        return in_angles(self, f"{last:.4g} s in {len(self.time)} rows, {ended}, heading turned {turned:.4g} deg")

    def _repr_html_(self) -> str:
        """Track, beginning, end and range, for notebooks."""
        return html_by("motion", self)

    def ended_at(self, row: int, why: str) -> Trajectory:
        """The rows up to one, at which the motion ended because it left what it may not leave."""
        selected, time = slice(0, row + 1), float(self.time[row])
        rows = {
            name: getattr(self, name)[selected]
            for name in ("time", "position", "attitude", "velocity", "heading", "phase")
        }
        return replace(
            self, **rows, controls={k: v[selected] for k, v in self.controls.items()},
            outside={k: v[selected] for k, v in self.outside.items()},
            reached=tuple(t if t is not None and t <= time else None for t in self.reached),
            ended=Ended.OUT_OF_RANGE, why=why,
        )  # fmt: skip

    def until(self, time: float) -> Trajectory:
        """The rows up to a time."""
        n = max(int(np.searchsorted(self.time, time, side="right")), 1)
        rows = {
            name: getattr(self, name)[:n] for name in ("time", "position", "attitude", "velocity", "heading", "phase")
        }
        return replace(
            self, **rows, controls={k: v[:n] for k, v in self.controls.items()},
            outside={k: v[:n] for k, v in self.outside.items()},
        )  # fmt: skip


Flags = NDArray[np.bool_]
# A value on the edge of a range is inside, with the rounding of a motion; motions below MOVING count as none.
SLACK, MOVING = 1e-6, 1e-3
ASTERN, TABLE_EDGE = "astern", "beyond a table's edge"


class Uncovered(str):
    """A variable that no range speaks of, as flags of a motion name it."""

    __slots__ = ("variable",)
    variable: str

    def __new__(cls, variable: str) -> Uncovered:
        """The name in words."""
        self = super().__new__(cls, f"{variable}: no data cover it")
        self.variable = variable
        return self

    def __getnewargs__(self) -> tuple[str]:
        return (self.variable,)


WITHOUT_DATA = Uncovered("u'")  # of a vehicle without any range, as of estimates


def outside(vehicle: Vehicle, velocity: Array, controls: Mapping[str, Array]) -> dict[str, Flags]:
    """For every variable, (n,) whether the motion lies outside of its ranges.

    Where the vehicle has no ranges at all, as of estimates, u' is flagged too: there are no data to be within.
    A motion or control that no range speaks of is named ``r': no data cover it`` and flagged where it is not small (beyond
    0.001 in prime form, or in rad). Further entries: ``astern``, and ``beyond a table's edge`` where tables stand in the law.

    Parameters
    ----------
    vehicle : Vehicle
    velocity : (n, 6) array
    controls : mapping of str to (n,) array
        dr, ds, db, rad.
    """
    values = _values(vehicle, velocity, controls)
    out: dict[str, Flags] = {}
    spoken = set()
    for name, ranges in covered_ranges(vehicle).items():
        if name in values:
            motion, x = values[name]
            spoken.add(motion)
            inside = [(x >= low - SLACK) & (x <= high + SLACK) for low, high in ranges]
            out[name] = np.asarray(~np.any(inside, axis=0))
    for name in (*(f"{m}'" for m in MOTIONS[bool(vehicle.covered) :]), *(c for c in CONTROLS if c in controls)):
        motion, x = values[name]
        if motion not in spoken and np.any(np.abs(x) > MOVING):
            out[Uncovered(name)] = np.abs(x) > MOVING
    speed = np.maximum(np.linalg.norm(velocity[:, :3], axis=1), SLOWEST)
    out[ASTERN] = velocity[:, 0] < -SLACK * speed
    if np.any(vehicle.law.tabled):
        out[TABLE_EDGE] = vehicle.law.held(velocity, control_rows(controls, len(velocity)))
    return out


def ended_by_tables(vehicle: Vehicle, motion: Trajectory) -> Trajectory:
    """The motion up to the last row at which every table has a value: one that refuses to be read beyond its data ends it.

    Parameters
    ----------
    vehicle : Vehicle
    motion : Trajectory
    """
    refused = vehicle.law.refused(motion.velocity, control_rows(motion.controls, len(motion.time)))
    if not np.any(refused):
        return motion
    row = max(int(np.argmax(refused)) - 1, 0)
    found = refusal("law.refused", vehicle, float(motion.time[row]))
    return motion.ended_at(row, remark(found))


def refusal(code: str, vehicle: Vehicle, time: float | None = None) -> Finding:
    """That the tables of a vehicle which refuse to be read beyond their data have no value."""
    names = dict.fromkeys(
        t.symbol.split(" ")[0] for t in vehicle.law.terms if t.hull is not None and t.hull.rule == "refuse"
    )
    return Finding.of(
        code, vehicle.name, Severity.WARN, statistic=time, tables=list(names), advice='extrapolation = "clamp"'
    )


def outside_in_words(vehicle: Vehicle, velocity: Array, controls: Mapping[str, float]) -> tuple[str, ...]:
    """A sentence for every variable of one motion that lies outside of its ranges.

    Parameters
    ----------
    vehicle : Vehicle
    velocity : (6,) array
    controls : mapping of str to float
        dr, ds, db, rad.
    """
    rows, angles = velocity[None, :], {c: np.array([x]) for c, x in controls.items()}
    values, flags = _values(vehicle, rows, angles), outside(vehicle, rows, angles)
    out = []
    for name, ranges in covered_ranges(vehicle).items():
        if name in values and flags[name][0]:
            factor, unit = (180.0 / np.pi, " deg") if name in CONTROLS or name.startswith("asin") else (1.0, "")
            spans = " or ".join(f"{number(low * factor)} to {number(high * factor)}{unit}" for low, high in ranges)
            here = f"{number(float(values[name][1][0]) * factor)}{unit}"
            out.append(f"{ANGLE_NAMES.get(name, name)} = {here} is outside the data, {spans}.")
    return tuple(out)


def _values(vehicle: Vehicle, velocity: Array, controls: Mapping[str, Array]) -> dict[str, tuple[str, Array]]:
    """Every variable that a range can speak of: the motion or control behind it, and its (n,) values."""
    speed = np.maximum(np.linalg.norm(velocity[:, :3], axis=1), SLOWEST)
    primes = {m: velocity[:, k] / speed for k, m in enumerate(MOTIONS)}
    primes |= {m: primes[m] * vehicle.length for m in ANGULAR}
    values: dict[str, tuple[str, Array]] = {f"{m}'": (m, primes[m]) for m in MOTIONS}
    values |= {f"asin({m}/U)": (m, np.arcsin(np.clip(primes[m], -1.0, 1.0))) for m in LINEAR}
    return values | {c: (c, controls[c]) for c in CONTROLS if c in controls}


def covered_ranges(vehicle: Vehicle) -> dict[str, list[tuple[float, float]]]:
    """Ranges of every variable, from low to high, those that touch joined."""
    out: dict[str, list[tuple[float, float]]] = {}
    for c in sorted(vehicle.covered, key=lambda c: c.low):
        joined = out.setdefault(c.variable, [])
        if joined and c.low <= joined[-1][1] + SLACK:
            joined[-1] = joined[-1][0], max(joined[-1][1], c.high)
        else:
            joined.append((c.low, c.high))
    return {name: out[name] for name in dict.fromkeys(c.variable for c in vehicle.covered)}

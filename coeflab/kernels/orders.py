"""What is ordered in each phase of a manoeuvre, as arrays, and what a march through it gives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.kernels.least_squares import Array
from coeflab.kernels.motion_law import Ints

WATCHED = ("heading", "yaw_rate", "pitch", "pitch_rate", "roll", "roll_rate", "depth", "u", "speed", "turned")
COMPLETE, NOT_FINITE, TOO_FAST, STEP_TOO_SMALL = range(4)
NEAR = 1e-9


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Orders:
    """Orders of p phases.

    Attributes
    ----------
    angles : (p, 3) array
        Ordered dr, ds, db, rad.
    begin : (3,) array
        Angles at the start, rad.
    rate : (3,) array
        Of the angles, rad/s; infinite: at once.
    wrench : (p, 6) or (m, p, 6) array
        Of the thrusters.
    watched : (p,) int array
        Index into `WATCHED` of what ends the phase; -1 for none.
    sign : (p,) array
        1 where it must rise through the value, -1 where it must fall.
    value : (p,) array
    longest : (p,) array
        s, positive.
    """

    angles: Array
    begin: Array
    rate: Array
    wrench: Array
    watched: Ints
    sign: Array
    value: Array
    longest: Array

    @property
    def count(self) -> int:
        """Number of phases."""
        return len(self.longest)

    def steps(self, step: float) -> int:
        """Steps that the longest course of the manoeuvre takes."""
        return int(np.ceil(float(np.sum(self.longest)) / step - NEAR))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Marching:
    """Motions of m members through p phases.

    Attributes
    ----------
    times : (n,) array
        Of the records, s.
    records : (m, n, 14) array
        States; not a number after a member's end.
    switch_time : (m, p) array
        When each phase ended; not a number where it did not.
    switch_state : (m, p, 14) array
    met : (m, p) bool array
        Whether a phase ended by its condition, not by time.
    ended : (m,) int array
        `COMPLETE`, `NOT_FINITE`, `TOO_FAST` or `STEP_TOO_SMALL`.
    end_time : (m,) array
    end_state : (m, 14) array
        The last that is finite.
    """

    times: Array
    records: Array
    switch_time: Array
    switch_state: Array
    met: NDArray[np.bool_]
    ended: Ints
    end_time: Array
    end_state: Array


def blank(members: int, orders: Orders, step: float, every: int) -> Marching:
    """A march that has not begun, to be filled; a record each so many steps."""
    phases = orders.count
    times = np.asarray(np.arange(orders.steps(step) // every + 1) * every * step, dtype=np.float64)
    return Marching(
        times=times,
        records=np.full((members, len(times), 14), np.nan),
        switch_time=np.full((members, phases), np.nan),
        switch_state=np.full((members, phases, 14), np.nan),
        met=np.zeros((members, phases), dtype=np.bool_),
        ended=np.zeros(members, dtype=np.int64),
        end_time=np.zeros(members),
        end_state=np.zeros((members, 14)),
    )


def watched_value(which: int, state: Array) -> Array:
    """(n,) what `WATCHED` names, of states (14, n)."""
    w, x, y, z = state[3:7]
    match WATCHED[which]:
        case "heading":
            return np.asarray(state[13])
        case "yaw_rate":
            return np.asarray(state[12])
        case "pitch":
            return np.asarray(np.arcsin(np.clip(2 * (w * y - x * z), -1.0, 1.0)))
        case "pitch_rate":
            return np.asarray(state[11])
        case "roll":
            return np.asarray(np.arctan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
        case "roll_rate":
            return np.asarray(state[10])
        case "depth":
            return np.asarray(state[2])
        case "u":
            return np.asarray(state[7])
        case "turned":
            return np.asarray(np.abs(state[13]))
    return np.asarray(np.sqrt(state[7] ** 2 + state[8] ** 2 + state[9] ** 2))


def ramp(begin: Array, target: Array, rate: Array, since: Array) -> Array:
    """(3, n) angles a time after the order was given; angles (3, 1 or n), rate (3,), time (n,)."""
    reach, since = np.broadcast_arrays(reach_time(begin, target, rate), np.maximum(since, 0.0))
    part = np.divide(since, reach, out=np.ones(reach.shape), where=reach > since)
    return np.asarray(np.where(part < 1.0, begin + (target - begin) * part, target))


def reach_time(begin: Array, target: Array, rate: Array) -> Array:
    """(3, n) time from the order until each angle stands."""
    return np.asarray(np.abs(target - begin) / rate[:, None])

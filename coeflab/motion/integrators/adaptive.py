"""The same march by scipy's LSODA, phase by phase: steps as long as the motion allows, stiff or not."""

from __future__ import annotations

import math
import warnings
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from coeflab.core.types import Array, dataclass
from coeflab.motion.dynamics import Dynamics
from coeflab.motion.orders import (
    NEAR,
    NOT_FINITE,
    STEP_TOO_SMALL,
    TOO_FAST,
    Marching,
    Orders,
    blank,
    ramp,
    reach_time,
    watched_value,
)
from coeflab.motion.rates_of_one import rates_of_one


def march_adaptive(
    dynamics: Dynamics,
    orders: Orders,
    start: Array,
    interval: float,
    fastest: float = 1e3,
    tolerance: float = 1e-9,
    method: str = "LSODA",
) -> Marching:
    """Move one vehicle.

    Parameters
    ----------
    dynamics : Dynamics
    orders : Orders
    start : (14,) array
    interval : float
        Time between records, s.
    fastest : float
        A vehicle that is faster stops, m/s.
    tolerance : float
        Relative and absolute, of a step.
    method : str
        A solver class of `scipy.integrate`.
    """
    out = blank(1, orders, interval, 1)
    out.records[0, 0] = start
    at, begin = _At(0.0, start.copy()), orders.begin.copy()
    spun = None if orders.late is None else orders.late.begin[:1]
    # A motion that runs away overflows in the solver, and LSODA warns that it gives up: both end as a status of the motion.
    with warnings.catch_warnings(), np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        warnings.filterwarnings("ignore", message="lsoda: ", category=UserWarning)
        for k in range(orders.count):
            phase = _Phase(dynamics, orders, k, begin, at.time, fastest, spun)
            for length in phase.pieces():
                at = phase.move(at, phase.since + length, out, tolerance, method)
                if at.ended or at.met:
                    break
            out.end_time[0], out.end_state[0], out.ended[0] = at.time, at.state, at.ended
            if at.ended:
                break
            out.switch_time[0, k], out.switch_state[0, k], out.met[0, k] = at.time, at.state, at.met
            begin, spun = phase.angles(at.time)[:, 0], phase.spinning(at.time)
    return out


ONE = np.zeros(1, dtype=np.int64)


@dataclass(frozen=True, slots=True, eq=False)
class _At:
    """Where the vehicle is, and what has happened."""

    time: float
    state: Array
    met: bool = False
    ended: int = 0


class _NotFiniteError(ArithmeticError):
    """Rates that are no numbers."""


@dataclass(frozen=True, slots=True, eq=False)
class _Phase:
    """One phase and the orders that stand in it."""

    dynamics: Dynamics
    orders: Orders
    number: int
    begin: Array
    since: float
    fastest: float
    spun: Array | None = None

    def angles(self, time: float) -> Array:
        """(3, 1) angles of the control surfaces."""
        target = self.orders.angles[self.number][:, None]
        return ramp(self.begin[:, None], target, self.orders.rate, np.array([time - self.since]))

    def spinning(self, time: float) -> Array | None:
        """(1, k) what thrusters with a lag do."""
        if self.orders.late is None or self.spun is None:
            return None
        return self.orders.late.actual(self.spun, ONE, ONE + self.number, np.array([time - self.since]))

    def pushed(self, time: float) -> list[float]:
        """Force and moment of the thrusters."""
        steady, actual = self.orders.wrench.reshape(-1, self.orders.count, 6)[0, self.number], self.spinning(time)
        if self.orders.late is None or actual is None:
            return [float(x) for x in steady]
        return [float(x) for x in steady + self.orders.late.wrench(actual, ONE, ONE + self.number)[:, 0]]

    def pieces(self) -> list[float]:
        """Times after the order at which a control surface stands or a thruster passes a knot, and the end of the phase."""
        target = self.orders.angles[self.number][:, None]
        reach = reach_time(self.begin[:, None], target, self.orders.rate)[:, 0]
        if self.orders.late is not None and self.spun is not None:
            reach = np.append(reach, self.orders.late.knots(self.spun, ONE, ONE + self.number)[:, 0])
        longest = float(self.orders.longest[self.number])
        return [*sorted({float(t) for t in reach if 0.0 < t < longest}), longest]

    def level(self, state: Array) -> float:
        """How far the state is beyond the value that ends the phase."""
        watched = int(self.orders.watched[self.number])
        if watched < 0:
            return 1.0
        here = watched_value(watched, state[:, None])[0]
        return float(self.orders.sign[self.number] * (here - self.orders.value[self.number]))

    def _level_inside(self, time: float, inside: Callable[[float], Array]) -> float:
        return self.level(inside(time))

    def move(self, at: _At, until: float, out: Marching, tolerance: float, method: str) -> _At:
        """As far as a time, smooth all the way, or to the event before it."""
        from scipy import integrate
        from scipy.optimize import brentq

        one, steady = rates_of_one(self.dynamics), None if self.orders.late else self.pushed(at.time)
        standing = self.angles(at.time)[:, 0].tolist()
        moving = standing != self.angles(until)[:, 0].tolist()

        def rates(time: float, state: Array) -> list[float]:
            angles = self.angles(time)[:, 0].tolist() if moving else standing
            found = one(state.tolist(), angles, steady or self.pushed(time))
            # LSODA never comes back from rates that are no numbers.
            if not math.isfinite(sum(found)):
                raise _NotFiniteError
            return found

        watched, due = self.orders.watched[self.number] >= 0, _due(out)
        row = bisect_right(due, at.time)
        level, limit = self.level(at.state), self.fastest**2
        try:
            solver = getattr(integrate, method)(rates, at.time, at.state, until, rtol=tolerance, atol=tolerance)
            while solver.status == "running":
                solver.step()
                if solver.status == "failed":
                    return _At(at.time, at.state, ended=STEP_TOO_SMALL)
                now, state = float(solver.t), solver.y
                after = self.level(state) if watched else 1.0
                met = level < 0.0 <= after
                if met or due[row] <= now:
                    inside = solver.dense_output()
                    if met:
                        now = float(brentq(self._level_inside, at.time, now, (inside,), xtol=1e-12, rtol=1e-14))
                        state = inside(now)
                    while due[row] <= now:
                        out.records[0, row] = _upright(inside(min(out.times[row], now)))
                        row += 1
                u, v, w = state[7:10].tolist()
                fast = u * u + v * v + w * w > limit
                at, level = _At(now, state, met, TOO_FAST if fast else 0), after
                if met or fast:
                    break
        except (_NotFiniteError, OverflowError):
            return _At(at.time, _upright(at.state), ended=NOT_FINITE)
        return replace(at, state=_upright(at.state))


def _due(out: Marching) -> list[float]:
    """Times from which on a step holds a record, a rounding early, and an end that never comes."""
    near = NEAR * out.times[-1] / max(len(out.times) - 1, 1)
    return [*(out.times - near).tolist(), math.inf]


def _upright(state: Array) -> Array:
    """A copy whose quaternion has length one."""
    out = np.array(state)
    out[3:7] /= np.sqrt(out[3:7] @ out[3:7])
    return out

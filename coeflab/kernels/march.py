"""Fixed-step march of many vehicles through a manoeuvre: classical Runge-Kutta of order four, steps cut where orders change.

A phase ends where its quantity crosses a value, or by time. Members switch at times of their own; the crossing is found
on repeated shorter steps, and a step also ends where a control surface reaches its order, so that the order of four holds
through the whole manoeuvre.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.dynamics import Dynamics
from coeflab.kernels.least_squares import Array
from coeflab.kernels.motion_law import Ints
from coeflab.kernels.orders import (
    NEAR,
    NOT_FINITE,
    TOO_FAST,
    Marching,
    Orders,
    blank,
    ramp,
    reach_time,
    watched_value,
)

SECANTS = 8


def march(
    dynamics: Dynamics, orders: Orders, start: Array, step: float, every: int = 1, fastest: float = 1e3
) -> Marching:
    """March all members.

    Parameters
    ----------
    dynamics : Dynamics
    orders : Orders
    start : (m, 14) array
    step : float
        s.
    every : int
        A record each so many steps.
    fastest : float
        A member that is faster stops, m/s.
    """
    with np.errstate(all="ignore"):
        return _March(dynamics, orders, start, step, fastest).run(every)


class _March:
    """Where every member is, one column a member; changed in place."""

    def __init__(self, dynamics: Dynamics, orders: Orders, start: Array, step: float, fastest: float) -> None:
        count = len(start)
        self.dynamics, self.orders, self.step, self.fastest = dynamics, orders, step, fastest
        self.state = start.T.copy()
        self.phase = np.zeros(count, dtype=np.int64)
        self.begun = np.zeros(count)
        self.begin = np.repeat(orders.begin[:, None], count, axis=1)
        self.live = np.ones(count, dtype=np.bool_)
        self.wrench = np.broadcast_to(orders.wrench, (count, *orders.wrench.shape[-2:]))
        self.level = self._level(self.state, self.phase)

    def run(self, every: int) -> Marching:
        """All steps."""
        steps = self.orders.steps(self.step)
        self.out = blank(len(self.phase), self.orders, self.step, every)
        self.out.records[:, 0] = self.state.T
        for j in range(1, steps + 1):
            remain = np.where(self.live, self.step, 0.0)
            while (moving := np.flatnonzero(remain > 0.0)).size:
                self._move(moving, j * self.step, remain)
            if j % every == 0:
                there = self.live | (self.out.end_time >= j * self.step - NEAR * self.step) & (self.out.ended == 0)
                self.out.records[there, j // every] = self.state.T[there]
            if not self.live.any():
                break
        return self.out

    def _move(self, who: Ints, until: float, remain: Array) -> None:
        """One step of some members, as far as nothing changes."""
        orders, left = self.orders, remain[who]
        since = until - left - self.begun[who]
        room = orders.longest[self.phase[who]] - since
        kinks = reach_time(self.begin[:, who], orders.angles[self.phase[who]].T, orders.rate) - since
        kinks[kinks <= NEAR * self.step] = np.inf
        length = np.minimum(np.minimum(left, room), kinks.min(axis=0))
        trial = self._step(who, since, length)
        level = self._level(trial, self.phase[who])
        crossed = (self.level[who] < 0.0) & (level >= 0.0)
        if np.any(crossed):
            at = np.flatnonzero(crossed)
            length[at], trial[:, at] = self._crossing(who[at], since[at], length[at], level[at])
            level[at] = 0.0
        sound = np.isfinite(trial).all(axis=0)
        speed = np.sqrt(np.sum(trial[7:10] ** 2, axis=0))
        kept = who[sound]
        self.state[:, kept], self.level[kept] = trial[:, sound], level[sound]
        remain[who] = np.where(length >= left, 0.0, left - length)
        now = until - left
        self._stop(who[~sound], now[~sound], NOT_FINITE, remain)
        now = now + length
        runaway = sound & (speed > self.fastest)
        self._stop(who[runaway], now[runaway], TOO_FAST, remain)
        over = sound & ~runaway & (crossed | (room - length <= NEAR * self.step))
        if np.any(over):
            self._switch(who[over], now[over], crossed[over], remain)

    def _step(self, who: Ints, since: Array, length: Array) -> Array:
        """States after a step, (14, n), the quaternion of length one."""
        dynamics = self.dynamics if len(who) == len(self.phase) else self.dynamics.members(who)
        state, phase = self.state[:, who], self.phase[who]
        wrench, begin, target = self.wrench[who, phase].T, self.begin[:, who], self.orders.angles[phase].T
        first, middle, last = (ramp(begin, target, self.orders.rate, since + f * length) for f in (0.0, 0.5, 1.0))
        half = 0.5 * length
        k1 = dynamics.rates(state, first, wrench)
        k2 = dynamics.rates(state + half * k1, middle, wrench)
        k3 = dynamics.rates(state + half * k2, middle, wrench)
        k4 = dynamics.rates(state + length * k3, last, wrench)
        out = state + length / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        out[3:7] /= np.sqrt(np.sum(out[3:7] ** 2, axis=0))
        return out

    def _crossing(self, who: Ints, since: Array, length: Array, level: Array) -> tuple[Array, Array]:
        """Step lengths at which the quantities cross, by the secant that keeps its bracket (Illinois), and the states there."""
        a, at_a, b, at_b = np.zeros(len(who)), self.level[who].copy(), length.copy(), level.copy()
        side = np.zeros(len(who))
        found, trial = b, self.state[:, who]
        for _ in range(SECANTS):
            found = np.clip(np.where(at_b > at_a, (a * at_b - b * at_a) / (at_b - at_a), b), a, b)
            trial = self._step(who, since, found)
            here = self._level(trial, self.phase[who])
            below = here < 0.0
            at_b = np.where(below, np.where(side < 0, 0.5 * at_b, at_b), here)
            at_a = np.where(below, here, np.where(side > 0, 0.5 * at_a, at_a))
            a, b = np.where(below, found, a), np.where(below, b, found)
            side = np.where(below, -1.0, 1.0)
        return found, trial

    def _level(self, state: Array, phase: Ints) -> Array:
        """(n,) how far each is beyond the value that ends its phase; a phase that ends by time alone stays at one."""
        watched = self.orders.watched[phase]
        out = np.ones(len(phase))
        for which in np.unique(watched[watched >= 0]):
            at = np.flatnonzero(watched == which)
            chosen = phase[at]
            out[at] = self.orders.sign[chosen] * (watched_value(int(which), state[:, at]) - self.orders.value[chosen])
        return out

    def _switch(self, who: Ints, now: Array, met: NDArray[np.bool_], remain: Array) -> None:
        """The next phase of some members, or their end."""
        orders, phase = self.orders, self.phase[who]
        self.out.switch_time[who, phase], self.out.met[who, phase] = now, met
        self.out.switch_state[who, phase] = self.state.T[who]
        last = phase + 1 == orders.count
        self._stop(who[last], now[last], 0, remain)
        on = who[~last]
        since = now[~last] - self.begun[on]
        self.begin[:, on] = ramp(self.begin[:, on], orders.angles[phase[~last]].T, orders.rate, since)
        self.phase[on] += 1
        self.begun[on] = now[~last]
        self.level[on] = self._level(self.state[:, on], self.phase[on])

    def _stop(self, who: Ints, now: Array, how: int, remain: Array) -> None:
        self.live[who], remain[who] = False, 0.0
        self.out.ended[who], self.out.end_time[who], self.out.end_state[who] = how, now, self.state.T[who]

"""Fixed-step march of many vehicles through a manoeuvre: classical Runge-Kutta of order four, steps cut where orders change.

A phase ends where its quantity crosses a value, or by time. Members switch at times of their own; the crossing is found
on repeated shorter steps, and a step also ends where a control surface reaches its order, so that the order of four holds
through the whole manoeuvre.

Steps that the classical Runge-Kutta scheme of order four stands: eigenvalues of the rates beside its region of stability.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.law.force_law import Ints
from coeflab.motion.dynamics import Dynamics
from coeflab.motion.orders import NEAR, NOT_FINITE, TOO_FAST, Marching, Orders, blank, ramp, reach_time, watched_value

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
        late = orders.late
        self.spun = np.zeros((count, 0)) if late is None else np.broadcast_to(late.begin, (count, len(late.lag))).copy()
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
        kinks = reach_time(self.begin[:, who], orders.angles[self.phase[who]].T, orders.rate)
        if orders.late is not None:
            kinks = np.vstack([kinks, orders.late.knots(self.spun[who], who, self.phase[who])])
        kinks = kinks - since
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
        selected = who[sound]
        self.state[:, selected], self.level[selected] = trial[:, sound], level[sound]
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
        begin, target = self.begin[:, who], self.orders.angles[phase].T
        first, middle, last = (
            (
                ramp(begin, target, self.orders.rate, since + f * length),
                self._pushed(who, phase, since + f * length),
            )
            for f in (0.0, 0.5, 1.0)
        )
        half = 0.5 * length
        k1 = dynamics.rates(state, *first)
        k2 = dynamics.rates(state + half * k1, *middle)
        k3 = dynamics.rates(state + half * k2, *middle)
        k4 = dynamics.rates(state + length * k3, *last)
        out = state + length / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        out[3:7] /= np.sqrt(np.sum(out[3:7] ** 2, axis=0))
        return out

    def _pushed(self, who: Ints, phase: Ints, since: Array) -> Array:
        """(6, n) force and moment of the thrusters."""
        steady, late = self.wrench[who, phase].T, self.orders.late
        if late is None:
            return np.asarray(steady)
        return np.asarray(steady + late.wrench(late.actual(self.spun[who], who, phase, since), who, phase))

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
        if orders.late is not None:
            self.spun[on] = orders.late.actual(self.spun[on], on, phase[~last], since)
        self.phase[on] += 1
        self.begun[on] = now[~last]
        self.level[on] = self._level(self.state[:, on], self.phase[on])

    def _stop(self, who: Ints, now: Array, how: int, remain: Array) -> None:
        self.live[who], remain[who] = False, 0.0
        self.out.ended[who], self.out.end_time[who], self.out.end_state[who] = how, now, self.state.T[who]


DIFFERENCE = 1e-6
MOVING = slice(3, 13)
FARTHEST, HALVINGS = 4.0, 40
NEUTRAL = 1e-9


def fast_eigenvalues(
    dynamics: Dynamics, state: Array, controls: Array, wrench: Array, scale: Array
) -> NDArray[np.complex128]:
    """(m, 10) eigenvalues of small motions in attitude and velocity about states, by central differences.

    Parameters
    ----------
    dynamics : Dynamics
    state : (14, m) array
    controls : (3,) array
    wrench : (6,) array
    scale : (14,) array
        Size of each state; differences are 1e-6 of it.
    """
    members = state.shape[1]
    moved = range(14)[MOVING]
    steps = np.zeros((14, 2 * len(moved)))
    for column, row in enumerate(moved):
        steps[row, 2 * column], steps[row, 2 * column + 1] = DIFFERENCE * scale[row], -DIFFERENCE * scale[row]
    count = steps.shape[1]
    points = np.repeat(state, count, axis=1) + np.tile(steps, members)
    chosen = dynamics.members(np.repeat(np.arange(members), count))
    rates = chosen.rates(
        points, np.repeat(controls[:, None], points.shape[1], 1), np.repeat(wrench[:, None], points.shape[1], 1)
    )
    rates = rates[MOVING].reshape(len(moved), members, len(moved), 2)
    slopes = (rates[..., 0] - rates[..., 1]) / (2.0 * DIFFERENCE * scale[MOVING])
    return np.asarray(np.linalg.eigvals(slopes.transpose(1, 0, 2)), dtype=np.complex128)


def largest_step(eigenvalues: NDArray[np.complex128]) -> float:
    """Longest step at which no decaying motion grows in the scheme; infinite where none decays.

    The scheme multiplies a motion exp(lambda t) by R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24 in a step, z = lambda h (Hairer &
    Wanner, Solving Ordinary Differential Equations II, section IV.2): real z down to -2.785, imaginary z up to 2.828.
    """
    flat = eigenvalues.ravel()
    size = np.abs(flat)
    decaying = flat[(flat.real < -NEUTRAL * np.max(size, initial=0.0)) & (size > 0.0)]
    if not decaying.size:
        return float("inf")
    size = np.abs(decaying)
    low, high = np.zeros(len(size)), np.full(len(size), FARTHEST)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        z = middle * (decaying / size)
        stable = np.abs(1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)))) <= 1.0
        low, high = np.where(stable, middle, low), np.where(stable, high, middle)
    return float(np.min(low / size))

"""The march of `coeflab.motion.integrators.fixed_step`, compiled by numba: members side by side on all cores, the same numbers to rounding.

Only imported where numba is installed and wanted. The machine code is kept between runs.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.law.force_law import SLOWEST, ForceLaw, Ints
from coeflab.law.rigid_body import axes_in_earth, kinematics, weighed
from coeflab.law.transforms import along_body
from coeflab.motion.dynamics import FIRST, FLAT, Dynamics
from coeflab.motion.integrators import fixed_step
from coeflab.motion.integrators.fixed_step import SECANTS
from coeflab.motion.orders import NEAR, NOT_FINITE, TOO_FAST, Marching, Orders, blank

# Few arrays, because every call counts the references of each: the source column of each variable; its prime, low and high;
# powers of V; rows of the pool and component of each term; for which of X, Y, Z each group of drag, side force and lift speaks,
# nothing where no incidence is needed; coefficients.
Law = tuple[Ints, Array, Ints, NDArray[np.uint64], Array, Array]
PAIRS = len(FIRST)
INVERSE, LOAD, CURRENT = PAIRS, PAIRS + 6, PAIRS + 7  # rows of the body's array, below the forms of the pairs
jitted = numba.njit(cache=True, error_model="numpy")
inlined = numba.njit(cache=True, error_model="numpy", forceinline=True)
# The same source as the plain rates; numba does not see that it changed: touch this file after an edit of theirs.
_along_body, _axes_in_earth = inlined(along_body), inlined(axes_in_earth)
_kinematics, _weighed = inlined(kinematics), inlined(weighed)


@inlined
def _term_force(law: Law, s: Array, controls: Array, out: Array, pool: Array) -> None:
    """The terms' forces into ``out`` (6,); ``pool`` holds 1, powers of V, variables and their absolute values."""
    source, bounds, powers, gathered, wind, coefficient = law
    speed = math.sqrt(s[7] ** 2 + s[8] ** 2 + s[9] ** 2)
    alpha, beta = 0.0, 0.0
    if len(wind):
        alpha = math.atan2(s[9] + 0.0, s[7] + 0.0)
        beta = math.asin(min(max(s[8] / speed, -1.0), 1.0)) if speed > 0.0 else 0.0
    pool[0] = 1.0
    at = 1
    for power in powers:
        pool[at] = speed if power == 1 else speed * speed if power == 2 else max(speed, SLOWEST) ** power
        at += 1
    count = len(source)
    for k in range(count):
        which = source[k]
        if which < 6:
            value = s[7 + which]
        elif which < 9:
            value = controls[which - 6]
        else:
            value = speed if which == 9 else alpha if which == 10 else beta
        if bounds[k, 0] != 0.0:
            value *= bounds[k, 0] / max(speed, SLOWEST)
        value = min(max(value, bounds[k, 1]), bounds[k, 2])
        pool[at + k] = value
        pool[at + count + k] = abs(value)
    for i in range(6 + len(wind)):
        out[i] = 0.0
    last = gathered.shape[1] - 1
    for t in range(len(gathered)):
        product = pool[gathered[t, 0]]
        for f in range(1, last):
            product *= pool[gathered[t, f]]
        out[gathered[t, last]] += product * coefficient[t]
    for g in range(0, len(wind), 3):
        drag, side, lift = out[6 + g], out[7 + g], out[8 + g]
        if drag != 0.0 or side != 0.0 or lift != 0.0:
            ca, sa, cb, sb = math.cos(alpha), math.sin(alpha), math.cos(beta), math.sin(beta)
            ahead, aside, below = _along_body(ca, sa, cb, sb, drag, side, lift)
            out[0] += ahead * wind[g]
            out[1] += aside * wind[g + 1]
            out[2] += below * wind[g + 2]


@inlined
def _rates(
    law: Law, body: Array, s: Array, controls: Array, wrench: Array, out: Array, total: Array, pool: Array
) -> None:
    """Time derivatives of the state ``s`` into ``out``; ``total`` and ``pool`` are working space."""
    axes = _axes_in_earth(s[3], s[4], s[5], s[6])
    moved = _kinematics(axes, s[3], s[4], s[5], s[6], s[7], s[8], s[9], s[10], s[11], s[12])
    for k in range(3):
        out[k] = moved[k] + body[CURRENT, k]
    for k in range(3, 7):
        out[k] = moved[k]
    _term_force(law, s, controls, total, pool)
    weight = _weighed(body[LOAD, 0], body[LOAD, 1], body[LOAD, 2], body[LOAD, 3], axes[2], axes[5], axes[8])
    fx, fy, fz = total[0] + weight[0] + wrench[0], total[1] + weight[1] + wrench[1], total[2] + weight[2] + wrench[2]
    mx, my, mz = total[3] + weight[3] + wrench[3], total[4] + weight[4] + wrench[4], total[5] + weight[5] + wrench[5]
    at = 0
    for j in range(7, 13):
        for k in range(j, 13):
            pair = s[j] * s[k]
            fx += body[at, 0] * pair
            fy += body[at, 1] * pair
            fz += body[at, 2] * pair
            mx += body[at, 3] * pair
            my += body[at, 4] * pair
            mz += body[at, 5] * pair
            at += 1
    for a in range(6):
        k = INVERSE + a
        out[7 + a] = (
            body[k, 0] * fx + body[k, 1] * fy + body[k, 2] * fz + body[k, 3] * mx + body[k, 4] * my + body[k, 5] * mz
        )
    out[13] = moved[7] / moved[8] if moved[8] > FLAT else 0.0


@inlined
def _ramp(begin: Array, target: Array, rate: Array, since: float, out: Array) -> None:
    since = max(since, 0.0)  # a rounding below zero would divide by the zero time of a surface that moves at once
    for k in range(3):
        out[k] = target[k]
        if target[k] != begin[k]:
            reach = abs(target[k] - begin[k]) / rate[k]
            if reach > since:
                out[k] = begin[k] + (target[k] - begin[k]) * (since / reach)


@jitted
def _level(watched: int, sign: float, value: float, s: Array) -> float:
    """How far the state is beyond the value that ends the phase."""
    if watched < 0:
        return 1.0
    w, x, y, z = s[3], s[4], s[5], s[6]
    if watched == 0:
        here = s[13]
    elif watched == 1:
        here = s[12]
    elif watched == 2:
        here = math.asin(min(max(2 * (w * y - x * z), -1.0), 1.0))
    elif watched == 3:
        here = s[11]
    elif watched == 4:
        here = math.atan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
    elif watched == 5:
        here = s[10]
    elif watched == 6:
        here = s[2]
    elif watched == 7:
        here = s[7]
    elif watched == 9:
        here = abs(s[13])
    else:
        here = math.sqrt(s[7] ** 2 + s[8] ** 2 + s[9] ** 2)
    return float(sign * (here - value))


@jitted
def _step(
    law: Law, body: Array, s: Array, begin: Array, target: Array, rate: Array, wrench: Array, since: float,
    length: float, space: tuple[Array, ...], out: Array,
) -> None:  # fmt: skip
    """One Runge-Kutta step from ``s`` into ``out``; ``space`` is room for rates, a state, angles, forces and the pool."""
    k1, k2, k3, k4, there, controls, total, pool = space
    half = 0.5 * length
    _ramp(begin, target, rate, since, controls)
    _rates(law, body, s, controls, wrench, k1, total, pool)
    for j in range(14):
        there[j] = s[j] + half * k1[j]
    _ramp(begin, target, rate, since + half, controls)
    _rates(law, body, there, controls, wrench, k2, total, pool)
    for j in range(14):
        there[j] = s[j] + half * k2[j]
    _rates(law, body, there, controls, wrench, k3, total, pool)
    for j in range(14):
        there[j] = s[j] + length * k3[j]
    _ramp(begin, target, rate, since + length, controls)
    _rates(law, body, there, controls, wrench, k4, total, pool)
    for j in range(14):
        out[j] = s[j] + length / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j])
    size = math.sqrt(out[3] ** 2 + out[4] ** 2 + out[5] ** 2 + out[6] ** 2)
    for j in range(3, 7):
        out[j] /= size


@jitted
def _crossing(
    law: Law, body: Array, s: Array, begin: Array, target: Array, rate: Array, wrench: Array, since: float, longest: float,
    space: tuple[Array, ...], out: Array, before: float, after: float, watched: int, sign: float, value: float,
) -> float:  # fmt: skip
    """Step length at which the quantity crosses, and the state there into ``out``; as `coeflab.motion.integrators.fixed_step` finds it."""
    a, at_a, b, at_b, side, length = 0.0, before, longest, after, 0, longest
    for _ in range(SECANTS):
        length = min(max((a * at_b - b * at_a) / (at_b - at_a), a), b) if at_b > at_a else b
        _step(law, body, s, begin, target, rate, wrench, since, length, space, out)
        here = _level(watched, sign, value, out)
        if here < 0.0:
            at_b = 0.5 * at_b if side < 0 else at_b
            a, at_a, side = length, here, -1
        else:
            at_a = 0.5 * at_a if side > 0 else at_a
            b, at_b, side = length, here, 1
    return length


@jitted
def _member(
    i: np.int64, law: Law, body: Array, angles: Array, begun_at: Array, rate: Array, wrenches: Array, watched: Ints,
    sign: Array, value: Array, longest: Array, start: Array, step: float, steps: int, every: int, fastest: float,
    records: Array, switch_time: Array, switch_state: Array, met: NDArray[np.bool_], ended: Ints, end_time: Array, end_state: Array,
) -> None:  # fmt: skip
    """The whole course of one member."""
    pool = np.empty(1 + len(law[2]) + 2 * len(law[0]))
    space = (
        np.empty(14),
        np.empty(14),
        np.empty(14),
        np.empty(14),
        np.empty(14),
        np.empty(3),
        np.empty(6 + len(law[4])),
        pool,
    )
    s, trial, begin = start.copy(), np.empty(14), begun_at.copy()
    phase, begun, live = 0, 0.0, True
    level = _level(watched[0], sign[0], value[0], s)
    records[0] = s
    for number in range(1, steps + 1):
        left = step
        while left > 0.0:
            now = number * step - left
            since = now - begun
            rest = longest[phase] - since
            length = min(left, rest)
            for c in range(3):
                kink = abs(angles[phase, c] - begin[c]) / rate[c] - since
                if kink > NEAR * step:
                    length = min(length, kink)
            wrench, target = wrenches[phase], angles[phase]
            _step(law, body, s, begin, target, rate, wrench, since, length, space, trial)
            new = _level(watched[phase], sign[phase], value[phase], trial)
            crossed = level < 0.0 <= new
            if crossed:
                length = _crossing(
                    law, body, s, begin, target, rate, wrench, since, length, space, trial,
                    level, new, watched[phase], sign[phase], value[phase],
                )  # fmt: skip
            sound = True
            for x in trial:
                sound = sound and math.isfinite(x)
            if not sound:
                ended[i], end_time[i], live = NOT_FINITE, now, False
                break
            s[:], level = trial, new
            left = 0.0 if length >= left else left - length
            now += length
            if math.sqrt(s[7] ** 2 + s[8] ** 2 + s[9] ** 2) > fastest:
                ended[i], end_time[i], live = TOO_FAST, now, False
                break
            if crossed or rest - length <= NEAR * step:
                switch_time[phase], met[phase] = now, crossed
                switch_state[phase] = s
                if phase + 1 == len(longest):
                    end_time[i], live = now, False
                    break
                _ramp(begin, target, rate, now - begun, begin)
                phase, begun = phase + 1, now
                level = _level(watched[phase], sign[phase], value[phase], s)
        if number % every == 0 and (live or (ended[i] == 0 and end_time[i] >= number * step - NEAR * step)):
            records[number // every] = s
        if not live:
            break
    end_state[:] = s


@numba.njit(cache=True, parallel=True, error_model="numpy")
def _all(
    shared: tuple[Ints, Array, Ints, NDArray[np.uint64], Array], coefficient: Array, bodies: Array, angles: Array,
    begun_at: Array, rate: Array, wrenches: Array, watched: Ints, sign: Array, value: Array,
    longest: Array, start: Array, step: float, steps: int, every: int, fastest: float, records: Array,
    switch_time: Array, switch_state: Array, met: NDArray[np.bool_], ended: Ints, end_time: Array, end_state: Array,
) -> None:  # fmt: skip
    """Every member on copies of its own: two cores that count the references of one array wait for each other."""
    for unsigned in numba.prange(len(start)):
        i = np.int64(unsigned)
        source, bounds, powers, gathered, wind = shared
        own = coefficient[i % len(coefficient)].copy()
        law = (source.copy(), bounds.copy(), powers.copy(), gathered.copy(), wind.copy(), own)
        body = bodies[i % len(bodies)].copy()
        _member(
            i, law, body, angles, begun_at, rate, wrenches[i % len(wrenches)], watched, sign, value, longest,
            start[i], step, steps, every, fastest, records[i], switch_time[i], switch_state[i], met[i], ended, end_time,
            end_state[i],
        )  # fmt: skip


def march(
    dynamics: Dynamics, orders: Orders, start: Array, step: float, every: int = 1, fastest: float = 1e3
) -> Marching:
    """As `coeflab.motion.integrators.fixed_step.march`, which moves laws whose tables are no boxes, and thrusters with a lag."""
    if dynamics.law.curved or orders.late is not None:
        return fixed_step.march(dynamics, orders, start, step, every, fastest)
    steps = orders.steps(step)
    out = blank(len(start), orders, step, every)
    _all(
        _terms(dynamics.law), np.array(np.atleast_2d(dynamics.law.coefficient)), _bodies(dynamics), orders.angles, orders.begin, orders.rate,
        orders.wrench.reshape(-1, orders.count, 6), orders.watched, orders.sign, orders.value, orders.longest,
        np.ascontiguousarray(start), step, steps, every, fastest, out.records, out.switch_time, out.switch_state, out.met,
        out.ended, out.end_time, out.end_state,
    )  # fmt: skip
    return out


def rates(dynamics: Dynamics, state: Array, controls: Array, wrench: Array) -> Array:
    """(14,) as `Dynamics.rates` of one vehicle, state (14,), angles (3,) and wrench (6,): to compare both."""
    law = (*_terms(dynamics.law), np.array(dynamics.law.coefficient).reshape(-1))
    out, total, pool = np.empty(14), np.empty(6 + len(law[4])), np.empty(1 + len(law[2]) + 2 * len(law[0]))
    _rates(law, _bodies(dynamics)[0], state, controls, wrench, out, total, pool)
    return out


def _terms(law: ForceLaw) -> tuple[Ints, Array, Ints, NDArray[np.uint64], Array]:
    gathered = np.column_stack([law.gathered.T, law.component]).astype(np.uint64)
    wind = np.array(law.wind if law.angled else (), dtype=np.float64).ravel()
    return law.source, np.column_stack([law.prime, law.low, law.high]), law.powers, gathered, wind


def _bodies(dynamics: Dynamics) -> Array:
    """(1 or m, 29, 6) forms of the pairs, inverse inertia, excess of weight and its lever, current."""
    forms = dynamics.quadratics.reshape(-1, 6, PAIRS).transpose(0, 2, 1)
    inverse, lever = dynamics.inverse.reshape(-1, 6, 6), dynamics.lever.T
    out = np.zeros((max(len(forms), len(inverse), len(lever), len(dynamics.excess)), CURRENT + 1, 6))
    out[:, :INVERSE], out[:, INVERSE:LOAD] = forms, inverse
    out[:, LOAD, 0], out[:, LOAD, 1:4], out[:, CURRENT, :3] = dynamics.excess, lever, dynamics.current
    return out

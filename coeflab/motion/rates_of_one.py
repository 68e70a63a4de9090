"""Rates of one vehicle in plain numbers: for a single state several times quicker than arrays of one column.

The same equations and the same law as `coeflab.motion.dynamics`, of which it takes its numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.types import Array
from coeflab.law.force_law import SLOWEST, ForceLaw
from coeflab.law.rigid_body import axes_in_earth, kinematics, weighed
from coeflab.law.transforms import along_body
from coeflab.motion.dynamics import FIRST, FLAT, SECOND, Dynamics

Numbers = Sequence[float]
Rates = Callable[[Numbers, Numbers, Numbers], list[float]]
Force = Callable[[Numbers, Numbers], list[float]]


def term_force_of_one(law: ForceLaw) -> Force:
    """The law's terms as a function of a state (14,) and the angles dr ds db, giving X Y Z K M N.

    Parameters
    ----------
    law : ForceLaw
        Of one vehicle: coefficients (t,) or (1, t).
    """
    if law.curved:
        one = replace(law, coefficient=law.coefficient.reshape(-1))

        def whole(state: Numbers, angles: Numbers) -> list[float]:
            moving, turned = np.array(state[7:13])[:, None], np.array(angles)[:, None]
            return [float(x) for x in one.term_force(moving, turned)[:, 0]]

        return whole
    limits = (law.prime.tolist(), law.low.tolist(), law.high.tolist())
    variables = list(zip(law.source.tolist(), *limits, strict=True))
    powers, angled, wind = law.powers.tolist(), law.angled, np.array(law.wind, dtype=float).tolist()
    places, coefficients = len(law.along), law.coefficient.reshape(-1).tolist()
    gathered = [[row for row in rows if row] for rows in law.gathered.T.tolist()]
    terms = list(zip(law.component.tolist(), coefficients, gathered, strict=True))

    def force(state: Numbers, angles: Numbers) -> list[float]:
        u, v, w = state[7], state[8], state[9]
        speed = math.sqrt(u * u + v * v + w * w)
        alpha = beta = 0.0
        if angled:
            alpha = math.atan2(w + 0.0, u + 0.0)
            beta = math.asin(min(max(v / speed, -1.0), 1.0)) if speed > 0.0 else 0.0
        base = (u, v, w, state[10], state[11], state[12], *angles, speed, alpha, beta)
        slow = speed if speed > SLOWEST else SLOWEST
        pool = [1.0]
        pool += [speed if n == 1 else speed * speed if n == 2 else slow**n for n in powers]
        values = []
        for source, prime, low, high in variables:
            value = base[source]
            if prime:
                value = value * prime / slow
            values.append(low if value < low else high if value > high else value)
        pool += values
        pool += [abs(value) for value in values]
        out = [0.0] * places
        for component, coefficient, rows in terms:
            product = coefficient
            for row in rows:
                product *= pool[row]
            out[component] += product
        if any(out[6:]):
            turned = math.cos(alpha), math.sin(alpha), math.cos(beta), math.sin(beta)
            for group, speaks in enumerate(wind):
                for k, value in enumerate(along_body(*turned, *out[6 + 3 * group : 9 + 3 * group])):
                    out[k] += value * speaks[k]
        return out[:6]

    return force


def _sparse(matrix: Array) -> list[list[tuple[int, float]]]:
    """Rows as pairs of column and entry, without zeros."""
    return [[(int(j), float(row[j])) for j in np.flatnonzero(row)] for row in matrix]


def rates_of_one(dynamics: Dynamics) -> Rates:
    """Time derivatives of a state (14,) as a function of it, the angles dr ds db and the thrusters' wrench (6,).

    Parameters
    ----------
    dynamics : Dynamics
        Of one vehicle.
    """
    force = term_force_of_one(dynamics.law)
    quadratics = dynamics.quadratics.reshape(6, len(FIRST))
    wanted = np.flatnonzero(np.any(quadratics, axis=0))
    pairs = [(7 + int(FIRST[k]), 7 + int(SECOND[k])) for k in wanted]
    forms = _sparse(quadratics[:, wanted])
    inverse = _sparse(dynamics.inverse.reshape(6, 6))
    excess, lever = float(dynamics.excess[0]), dynamics.lever[:, 0].tolist()
    north, east, below = dynamics.current.tolist()

    def rates(state: Numbers, angles: Numbers, wrench: Numbers) -> list[float]:
        axes = axes_in_earth(*state[3:7])
        *out, turning, flat = kinematics(axes, *state[3:13])
        out[0], out[1], out[2] = out[0] + north, out[1] + east, out[2] + below
        total = force(state, angles)
        products = [state[i] * state[j] for i, j in pairs]
        weight = weighed(excess, *lever, *axes[2::3])
        for i, form in enumerate(forms):
            total[i] += wrench[i]
            for k, entry in form:
                total[i] += entry * products[k]
            total[i] += weight[i]
        for row in inverse:
            acceleration = 0.0
            for j, entry in row:
                acceleration += entry * total[j]
            out.append(acceleration)
        out.append(turning / flat if flat > FLAT else 0.0)
        return out

    return rates

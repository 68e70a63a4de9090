"""Rates of one vehicle in plain numbers: for a single state several times quicker than arrays of one column.

The same equations and the same law as `coeflab.kernels.dynamics`, of which it takes its numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from coeflab.kernels.dynamics import FIRST, FLAT, SECOND, Dynamics
from coeflab.kernels.least_squares import Array
from coeflab.kernels.motion_law import SLOWEST, MotionLaw

Numbers = Sequence[float]
Rates = Callable[[Numbers, Numbers, Numbers], list[float]]
Force = Callable[[Numbers, Numbers], list[float]]


def term_force_of_one(law: MotionLaw) -> Force:
    """The law's terms as a function of a state (14,) and the angles dr ds db, giving X Y Z K M N.

    Parameters
    ----------
    law : MotionLaw
        Of one vehicle: coefficients (t,) or (1, t).
    """
    limits = (law.prime.tolist(), law.low.tolist(), law.high.tolist())
    variables = list(zip(law.source.tolist(), *limits, strict=True))
    powers, angled = law.powers.tolist(), law.angled
    coefficients = law.coefficient.reshape(-1).tolist()
    gathered = [[row for row in rows if row] for rows in law.gathered.T.tolist()]
    terms = list(zip(law.component.tolist(), coefficients, gathered, strict=True))

    def force(state: Numbers, angles: Numbers) -> list[float]:
        u, v, w = state[7], state[8], state[9]
        speed = math.sqrt(u * u + v * v + w * w)
        alpha = beta = 0.0
        if angled:
            alpha = math.atan2(w, u)
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
        out = [0.0] * 9
        for component, coefficient, rows in terms:
            product = coefficient
            for row in rows:
                product *= pool[row]
            out[component] += product
        drag, side, lift = out[6:]
        if drag or side or lift:
            ca, sa, cb, sb = math.cos(alpha), math.sin(alpha), math.cos(beta), math.sin(beta)
            out[0] += -ca * cb * drag - ca * sb * side + sa * lift
            out[1] += -sb * drag + cb * side
            out[2] += -sa * cb * drag - sa * sb * side - ca * lift
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
    excess, (lx, ly, lz) = float(dynamics.excess[0]), dynamics.lever[:, 0].tolist()
    north, east, below = dynamics.current.tolist()

    def rates(state: Numbers, angles: Numbers, wrench: Numbers) -> list[float]:
        _, _, _, w, x, y, z, u, v, down, p, q, r, _ = state
        ax, ay, az = 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)
        bx, by, bz = 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)
        cx, cy, cz = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
        total = force(state, angles)
        products = [state[i] * state[j] for i, j in pairs]
        for i, form in enumerate(forms):
            total[i] += wrench[i]
            for k, entry in form:
                total[i] += entry * products[k]
        total[0] += excess * az
        total[1] += excess * bz
        total[2] += excess * cz
        total[3] += ly * cz - lz * bz
        total[4] += lz * az - lx * cz
        total[5] += lx * bz - ly * az
        flat = ax * ax + ay * ay
        turned_north, turned_east = r * bx - q * cx, r * by - q * cy
        out = [
            ax * u + bx * v + cx * down + north,
            ay * u + by * v + cy * down + east,
            az * u + bz * v + cz * down + below,
            -0.5 * (x * p + y * q + z * r),
            0.5 * (w * p + y * r - z * q),
            0.5 * (w * q + z * p - x * r),
            0.5 * (w * r + x * q - y * p),
        ]
        for row in inverse:
            acceleration = 0.0
            for j, entry in row:
                acceleration += entry * total[j]
            out.append(acceleration)
        out.append((ax * turned_east - ay * turned_north) / flat if flat > FLAT else 0.0)
        return out

    return rates

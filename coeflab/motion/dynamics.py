"""Rates of the whole state of many vehicles at once, one column a vehicle.

The same equations as `coeflab.motion.dynamics`: every product of two velocities (the ideal fluid's and -C_RB(nu) nu)
is one quadratic form of the 21 pairs, so that a member of an ensemble may have a mass and an added mass of its own.

Equations of motion of many vehicles at once: restoring forces, accelerations and the rates of the whole state.

Equations (Fossen 2011, equations 3.42, 4.6, 6.9, 2.68 and property 8.1), about the reference point, with the velocity nu
through a steady irrotational current::

    (M_RB + M_A) nu_dot = tau(nu, controls) - C_RB(nu) nu + g(attitude) + thrust        eta_dot = J(q) nu + current

with -C_A(nu) nu inside tau. The state is position (NED), attitude (quaternion, body to NED, scalar first), nu, and the
heading turned since the start.

Rates of one vehicle in plain numbers: for a single state several times quicker than arrays of one column.

The same equations and the same law as `coeflab.motion.dynamics`, of which it takes its numbers.

Small motions about a steady one: derivatives of the rates, and their eigenvalues.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass
from coeflab.law.force_law import SLOWEST, ForceLaw
from coeflab.law.rigid_body import axes_in_earth, kinematics, weighed
from coeflab.law.transforms import along_body

FIRST, SECOND = np.triu_indices(6)
FLAT = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Dynamics:
    """What a march needs to know of vehicles.

    Attributes
    ----------
    law : ForceLaw
        Its terms; the ideal quadratics are those of ``quadratics``.
    quadratics : (6, 21) or (m, 6, 21) array
        Force of every pair of velocities u u, u v, .. r r.
    inverse : (6, 6) or (m, 6, 6) array
        Accelerations of unit forces; zero rows for what is held.
    excess : (1,) or (m,) array
        Weight less buoyancy, N.
    lever : (3, 1) or (3, m) array
        W r_G - B r_B, N m.
    current : (3,) array
        North, east, down, m/s.
    """

    law: ForceLaw
    quadratics: Array
    inverse: Array
    excess: Array
    lever: Array
    current: Array

    def members(self, chosen: NDArray[np.int64]) -> Dynamics:
        """Those of some members; what all share stays shared."""
        law = self.law
        if law.coefficient.ndim == 2:
            law = replace(law, coefficient=law.coefficient[chosen])
        return Dynamics(
            law,
            self.quadratics[chosen] if self.quadratics.ndim == 3 else self.quadratics,
            self.inverse[chosen] if self.inverse.ndim == 3 else self.inverse,
            self.excess[chosen] if len(self.excess) > 1 else self.excess,
            self.lever[:, chosen] if self.lever.shape[1] > 1 else self.lever,
            self.current,
        )

    def rates(self, state: Array, controls: Array, wrench: Array) -> Array:
        """Time derivatives of the states, (14, n).

        Parameters
        ----------
        state : (14, n) array
            As `coeflab.motion.dynamics` has it.
        controls : (3, n) array
            dr, ds, db, rad.
        wrench : (6, n) array
            Of the thrusters.
        """
        nu = state[7:13]
        # Numbers are several times quicker than arrays of one.
        moving = tuple(state[3:13] if state.shape[1] > 1 else state[3:13, 0].tolist())
        axes = axes_in_earth(*moving[:4])
        *steady, turning, flat = kinematics(axes, *moving)
        out = np.empty_like(state)
        for k, rate in enumerate(steady):
            out[k] = rate
        out[:3] += self.current[:, None]
        total = self.law.term_force(nu, controls) + wrench
        pairs = nu[FIRST] * nu[SECOND]
        total += (
            self.quadratics @ pairs if self.quadratics.ndim == 2 else np.einsum("nip,pn->in", self.quadratics, pairs)
        )
        for k, force in enumerate(weighed(self.excess, *self.lever, *axes[2::3])):
            total[k] += force
        out[7:13] = self.inverse @ total if self.inverse.ndim == 2 else np.einsum("nij,jn->in", self.inverse, total)
        out[13] = np.where(flat > FLAT, turning / np.maximum(flat, FLAT), 0.0)
        return out


def forms_of_pairs(quadratics: Array) -> Array:
    """(.., 6, 21) forms of the pairs from (.., 6, 6, 6) quadratics."""
    both = quadratics + np.swapaxes(quadratics, -1, -2)
    return np.asarray(both[..., FIRST, SECOND] * np.where(FIRST == SECOND, 0.5, 1.0))


STATE = 14
POSITION, ATTITUDE, VELOCITY, HEADING = slice(0, 3), slice(3, 7), slice(7, 13), 13


def rotations(attitude: Array) -> Array:
    """(n, 3, 3) rotations, body to earth, of unit quaternions (n, 4)."""
    return np.array(axes_in_earth(*attitude.T)).T.reshape(-1, 3, 3).swapaxes(1, 2)


def euler_angles(attitude: Array) -> Array:
    """(n, 3) roll, pitch and yaw, rad, of unit quaternions; yaw within -pi and pi."""
    turned = rotations(attitude)
    roll = np.arctan2(turned[:, 2, 1], turned[:, 2, 2])
    pitch = -np.arcsin(np.clip(turned[:, 2, 0], -1.0, 1.0))
    return np.column_stack([roll, pitch, np.arctan2(turned[:, 1, 0], turned[:, 0, 0])])


def from_euler(roll: float, pitch: float, yaw: float) -> Array:
    """(4,) unit quaternion of roll, pitch and yaw, rad (Fossen 2011, appendix E)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll / 2, pitch / 2, yaw / 2]), np.sin([roll / 2, pitch / 2, yaw / 2])
    return np.array(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    )


def restoring(attitude: Array, weight: float, buoyancy: float, centre: Array, centre_of_buoyancy: Array) -> Array:
    """(n, 6) force and moment of weight and buoyancy about the reference point (Fossen 2011, equation 4.6, as a force)."""
    lever = weight * np.asarray(centre) - buoyancy * np.asarray(centre_of_buoyancy)
    return np.column_stack(weighed(weight - buoyancy, *lever, *axes_in_earth(*attitude.T)[2::3]))


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


Growth = Literal["stable", "neutral", "unstable"]
STEP = 1e-5
NEUTRAL = 1e-6
DUST = 1e-10  # of the largest entry of its row, for changes that count as one: less is rounding of the differences
KINK = 1e-4  # of a slope: slopes to either side differ by more where a curve has a knot
ALIKE = 1e10  # condition of the eigenvectors, beyond which left ones are rounding


def linearised(rates: Callable[[Array], Array], state: Array, scale: Array) -> Array:
    """Derivatives of the rates by the state, (n, n), by central differences.

    Parameters
    ----------
    rates : callable
        (n,) -> (n,), time derivatives of the state.
    state : (n,) array
    scale : (n,) array
        Differences are 1e-5 of it.
    """
    steps = STEP * scale
    columns = [(rates(state + d) - rates(state - d)) / (2.0 * h) for d, h in zip(np.diag(steps), steps, strict=True)]
    return np.column_stack(columns)


def modes(matrix: Array) -> NDArray[np.complex128]:
    """Eigenvalues, the least stable first; of a pair the one with positive imaginary part first."""
    found = np.asarray(np.linalg.eigvals(matrix), dtype=complex)
    return found[np.lexsort((-found.imag, -np.round(found.real, 12)))]


def growth(values: NDArray[np.complex128]) -> Growth:
    """``stable``, ``neutral`` or ``unstable``: the sign of the largest real part, neutral within 1e-6 of the fastest."""
    if values.size == 0:
        return "neutral"
    largest = float(np.max(values.real))
    if abs(largest) <= NEUTRAL * max(1.0, float(np.max(np.abs(values)))):
        return "neutral"
    return "unstable" if largest > 0.0 else "stable"


@dataclass(frozen=True, slots=True, eq=False)
class Slopes:
    """Derivatives by extrapolated central differences.

    Attributes
    ----------
    matrix : (m, n) array
    error : (m, n) array
        Twice the change when the steps are halved once more.
    kinks : (m, n) bool array
        Where slopes to either side differ: the entry is their mean.
    """

    matrix: Array
    error: Array
    kinks: Array

    def grown(self, rows: int, columns: int) -> Slopes:
        """With further rows and columns of zeros."""
        wider = ((0, rows), (0, columns))
        return Slopes(np.pad(self.matrix, wider), np.pad(self.error, wider), np.pad(self.kinks, wider))


def slopes(function: Callable[[Array], Array], point: Array, scale: Array, low: Array, high: Array) -> Slopes:
    """Differentiate a function at a point.

    Differences with the steps h = 1e-5 ``scale`` and h/2, extrapolated: 2 D(h/2) - D(h). That is exact for v|v| at v = 0, whose
    central difference is off by h. Next to a bound the differences go to its inner side alone.

    Parameters
    ----------
    function : callable
        (n,) -> (m,).
    point, scale : (n,) array
    low, high : (n,) array
        Bounds of the point; may be infinite.
    """
    middle = function(point)
    columns = []
    for i, h in enumerate(STEP * scale):
        ahead, behind = point[i] + h <= high[i], point[i] - h >= low[i]
        if not ahead and not behind:  # one value alone, as of a tilt that does not move
            ahead = behind = True

        def moved(step: float, i: int = i) -> Array:
            shifted = point.copy()
            shifted[i] += step
            return function(shifted)

        sides = [
            ((moved(step) - middle) / step if ahead else None, (middle - moved(-step)) / step if behind else None)
            for step in (h, h / 2.0, h / 4.0)
        ]
        means = [np.mean([s for s in pair if s is not None], axis=0) for pair in sides]
        first, second = 2.0 * means[1] - means[0], 2.0 * means[2] - means[1]
        jumps = [a - b for a, b in sides if a is not None and b is not None]
        jump = np.abs(2.0 * jumps[1] - jumps[0]) if jumps else np.zeros(len(middle))
        columns.append((first, 2.0 * np.abs(second - first), jump))
    matrix, error, jump = (np.array([c[k] for c in columns]).reshape(len(scale), len(middle)).T for k in range(3))
    size = np.abs(matrix) * scale
    largest = np.max(size, axis=1, initial=0.0, keepdims=True)
    kinks = (jump > KINK * np.abs(matrix)) & (jump * scale > 1e2 * DUST * largest) & (jump > 1e2 * error)
    dust = (size < DUST * largest) & ~kinks
    return Slopes(np.where(dust, 0.0, matrix), error, kinks)


def participation(matrix: Array) -> Array:
    """(n, n) share of every state (columns) in every mode (rows, in the order of `modes`); each row sums to one.

    Share of state k in mode i: abs(W[i, k] V[k, i]), V the right eigenvectors and W their inverse (Perez-Arriaga, Verghese and
    Schweppe 1982). Where eigenvectors coincide there is no inverse, and V alone is taken.

    Parameters
    ----------
    matrix : (n, n) array
    """
    values, right = np.linalg.eig(matrix)
    if len(values) and np.linalg.cond(right) < ALIKE:
        parts = np.abs(right * np.linalg.inv(right).T)
    else:
        parts = np.abs(right) ** 2
    parts = parts / np.sum(parts, axis=0, keepdims=True)
    left = list(range(len(values)))
    out = []
    for value in modes(matrix):
        nearest = min(left, key=lambda i: abs(values[i] - value))
        left.remove(nearest)
        out.append(parts[:, nearest])
    return np.array(out).reshape(len(values), len(values))

"""The hydrodynamic force of a vehicle as monomials of its motion, ready for many states at once.

A base row is u v w p q r, the control angles dr ds db, the speed V and the incidence alpha = atan2(w, u),
beta = asin(v/V). A variable is one of them, as it is or primed (v/V, r L/V, no control), and held within the range that its
table covers. A term is ``coefficient * V^n * product of variables``, along a body axis or along drag, side force or lift.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief
from coeflab.law.transforms import body_forces, incidence

BASE = ("u", "v", "w", "p", "q", "r", "dr", "ds", "db", "V", "alpha", "beta")
SPEED, ALPHA, BETA = BASE.index("V"), BASE.index("alpha"), BASE.index("beta")
WIND = ("D", "S", "L")
CONTROLS = BASE[6:9]
SLOWEST = 1e-9
# X0' V^2 turns from drag ahead to drag astern within |u| < V / 10, so that no simulator meets a jump at u = 0.
REVERSAL = 10.0

Ints = NDArray[np.int64]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class MotionLaw:
    """Terms of a law as arrays.

    Attributes
    ----------
    source : (v,) int array
        Column of the base row behind each variable.
    prime : (v,) array
        Zero: as it is. Otherwise the variable is the column times this over V (1 for velocities, L for rates).
    low, high : (v,) array
        Range that the variable is held in; infinite where it is free.
    tabled : (v,) bool array
        Whether that range is where a table has data, so that a motion beyond it is worth a word.
    component : (t,) int array
        X Y Z K M N as 0 to 5, D S L as 6 to 8.
    coefficient : (t,) or (m, t) array
        SI; one row a member where the members differ.
    speed_power : (t,) int array
        Of V.
    signed, absolute : (t, v) int array
        Powers of each variable and of its absolute value.
    ideal : (6, 6, 6) or (m, 6, 6, 6) array
        Quadratics that are added: force i = sum of ideal[i, j, k] nu_j nu_k.
    powers, gathered, primed, along, angled
        Made of the others, once: distinct powers of V; (f, t) rows of the pool whose product is each term; variables that are
        primed; (9, t) which component each term adds to; whether any needs the incidence.
    """

    source: Ints
    prime: Array
    low: Array
    high: Array
    tabled: NDArray[np.bool_]
    component: Ints
    coefficient: Array
    speed_power: Ints
    signed: Ints
    absolute: Ints
    ideal: Array
    powers: Ints = field(init=False, repr=False)
    gathered: Ints = field(init=False, repr=False)
    primed: Ints = field(init=False, repr=False)
    along: Array = field(init=False, repr=False)
    angled: bool = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "powers", np.unique(self.speed_power))
        object.__setattr__(self, "gathered", self._gathered())
        object.__setattr__(self, "primed", np.flatnonzero(self.prime))
        object.__setattr__(self, "along", (self.component == np.arange(9)[:, None]).astype(np.float64))
        object.__setattr__(self, "angled", bool(np.any(self.component >= 6) or np.any(self.source >= ALPHA)))

    def _gathered(self) -> Ints:
        """(f, t) rows of the pool, which holds 1, powers of V, variables and their absolute values."""
        at_variable = 1 + len(self.powers)
        at_absolute = at_variable + len(self.source)
        rows = []
        for power, signed, absolute in zip(self.speed_power, self.signed, self.absolute, strict=True):
            row = [1 + int(np.searchsorted(self.powers, power))] if power else []
            row += [at_variable + int(v) for v in np.flatnonzero(signed) for _ in range(signed[v])]
            row += [at_absolute + int(v) for v in np.flatnonzero(absolute) for _ in range(absolute[v])]
            rows.append(row)
        longest = max((len(r) for r in rows), default=0)
        filled = [r + [0] * (max(longest, 1) - len(r)) for r in rows]
        return np.array(filled, dtype=np.int64).reshape(len(rows), max(longest, 1)).T.copy()

    def force(self, nu: Array, controls: Array) -> Array:
        """X Y Z K M N, shape (n, 6).

        Parameters
        ----------
        nu : (n, 6) array
            Velocities through the water at the reference point, FRD.
        controls : (n, 3) array
            dr, ds, db, rad.
        """
        return self.term_force(nu.T, controls.T).T + self._ideal(nu)

    def _ideal(self, nu: Array) -> Array:
        if self.ideal.ndim == 4:
            return np.asarray(np.einsum("nijk,nj,nk->ni", self.ideal, nu, nu, optimize=True))
        pairs = (nu[:, :, None] * nu[:, None, :]).reshape(len(nu), 36)
        return np.asarray(pairs @ self.ideal.reshape(6, 36).T)

    def term_force(self, nu: Array, controls: Array) -> Array:
        """X Y Z K M N of the terms alone, shape (6, n), for velocities (6, n) and controls (3, n)."""
        speed = np.sqrt(nu[0] ** 2 + nu[1] ** 2 + nu[2] ** 2)
        base = np.zeros((len(BASE), len(speed)))
        base[:6], base[6:9], base[SPEED] = nu, controls, speed
        if self.angled:
            base[ALPHA], base[BETA] = incidence(nu[0], nu[1], nu[2])
        products = self._products(base)
        if self.coefficient.ndim == 2:
            products *= self.coefficient.T
        else:
            products *= self.coefficient[:, None]
        along = self.along @ products
        out = along[:6]
        if self.angled:
            out[:3] += np.array(body_forces(base[ALPHA], base[BETA], along[6], along[7], along[8]))
        return np.asarray(out)

    def _products(self, base: Array) -> Array:
        """(t, n) every term before its coefficient."""
        speed = base[SPEED]
        values = self._values(base)
        np.clip(values, self.low[:, None], self.high[:, None], out=values)
        pool = np.empty((1 + len(self.powers) + 2 * len(values), len(speed)))
        pool[0] = 1.0
        for row, power in enumerate(self.powers, 1):
            pool[row] = speed if power == 1 else speed * speed if power == 2 else np.maximum(speed, SLOWEST) ** power
        split = 1 + len(self.powers) + len(values)
        pool[split - len(values) : split] = values
        np.abs(values, out=pool[split:])
        out = pool[self.gathered[0]]
        for rows in self.gathered[1:]:
            out *= pool[rows]
        return np.asarray(out)

    def _values(self, base: Array) -> Array:
        """(v, n) variables as they are, not yet held."""
        values = base[self.source]
        if self.primed.size:
            values[self.primed] *= self.prime[self.primed, None] / np.maximum(base[SPEED], SLOWEST)
        return values

    def held(self, nu: Array, controls: Array) -> NDArray[np.bool_]:
        """(n,) whether a variable lies beyond the range of its table, where the table's edge stands in."""
        speed = np.sqrt(np.sum(nu[:, :3] ** 2, axis=1))
        base = np.vstack([nu.T, controls.T, speed, *incidence(nu[:, 0], nu[:, 1], nu[:, 2])])
        values = self._values(base).T
        return np.asarray(np.any(((values < self.low) | (values > self.high)) & self.tabled, axis=1))

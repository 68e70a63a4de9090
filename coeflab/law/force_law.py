"""The hydrodynamic force of a vehicle: one kind of term, one law as the sum of such terms, and its value at many states at once.

A term is ``coefficient * V^n * product of variables``, along a body axis or along drag, side force or lift. A variable is one of
u v w p q r, of the control angles dr ds db, or of the incidence alpha = atan2(w, u), beta = asin(v/V); as it is or primed (v/V,
r L/V, no control), and held within the hull of its table's data.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief, locked
from coeflab.law.domain import SLACK, Domain
from coeflab.law.scaling import powers_of
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.law.terms import Term
from coeflab.law.transforms import body_forces, incidence

BASE = ("u", "v", "w", "p", "q", "r", "dr", "ds", "db", "V", "alpha", "beta")
SPEED, ALPHA, BETA = BASE.index("V"), BASE.index("alpha"), BASE.index("beta")
WIND = ("D", "S", "L")
CONTROLS = BASE[6:9]
SLOWEST = 1e-9
MOVED = 1e-6  # of a hull: a motion on its edge is inside, with the rounding of its integration

EVERYWHERE = (True, True, True)

Ints = NDArray[np.int64]


class Reading(NamedTuple):
    """How a term reads a variable: times ``prime`` over V where that is not zero, and held between ``low`` and ``high``.

    ``tabled``: that range is where a table has data, so that a motion beyond it is worth a word. ``table``: whose hull holds
    the variable together with others, where that is no box.
    """

    prime: float = 0.0
    low: float = -np.inf
    high: float = np.inf
    tabled: bool = False
    table: str = ""


PLAIN = Reading()
# X0' V^2 turns from drag ahead to drag astern within |u| < V / 10, so that no simulator meets a jump at u = 0.
AHEAD = Reading(10.0, -1.0, 1.0)


@brief
@dataclass(frozen=True, slots=True)
class ForceTerm:
    """One term of a force law.

    Attributes
    ----------
    symbol : str
        Derivative without prime, or response and term of a table.
    component : str
        X Y Z K M N, or D S L.
    term : Term
        The product of variables, without the speed.
    coefficient : float
        SI, with the density in it.
    speed_power : int
        Of V = |(u, v, w)|.
    per_prime : float
        SI coefficient of one unit of what the file states, so that draws of it can be scaled.
    kind : {"prime", "rest", "potential", "table"}
        A derivative, primed; one about a state of rest, SI whatever V is; a product of the ideal fluid; a term of a table.
    prime : float
        The number that the file states.
    potential : float or None
        Part of the coefficient that an ideal fluid gives, SI; None where that is not known.
    readings : tuple of (variable, Reading)
        Of the variables that are not read as they are.
    note : str
        U95 and origin, in words.
    hull : Domain or None
        Of the table's data.
    into : (3,) bool
        Of drag, side force and lift: which of X, Y and Z it acts in; sources along the body speak for the others.
    """

    symbol: str
    component: str
    term: Term
    coefficient: float
    speed_power: int
    per_prime: float
    kind: Literal["prime", "rest", "potential", "table"] = "prime"
    prime: float = 0.0
    potential: float | None = None
    readings: tuple[tuple[str, Reading], ...] = ()
    note: str = ""
    hull: Domain | None = None
    into: tuple[bool, bool, bool] = EVERYWHERE

    @property
    def ahead(self) -> bool:
        """Whether the term is a force by V^2 alone that turns with the course, such as X0': see `AHEAD`."""
        return self.readings == (("u", AHEAD),)

    @property
    def product(self) -> Term:
        """The product of variables without the sign of the course that `AHEAD` gives."""
        return Term() if self.ahead else self.term

    @property
    def variables(self) -> tuple[str, ...]:
        """Of its product."""
        return tuple(v for v, _, _ in self.term.factors)

    @property
    def in_file(self) -> str:
        """What the parameter file calls its number."""
        return self.symbol if self.kind == "table" else f"{self.symbol}'"

    @property
    def length_power(self) -> int:
        """The k of 1/2 rho L^k; 0 for SI."""
        return 0 if self.kind in ("rest", "table") else powers_of(self.symbol)[1]

    @property
    def written(self) -> float:
        """The number that a program states: the prime, or SI for damping about a state of rest."""
        return self.coefficient if self.kind == "rest" else self.prime

    @property
    def pair(self) -> tuple[int, int] | None:
        """The product of two velocities that the term is near straight motion; None for others."""
        factors, degree = self.product.factors, self.product.degree
        if any(a for _, _, a in factors) or degree > 2 or degree + self.speed_power != 2:
            return None
        at = sorted(MOTIONS.index(v) for v, n, _ in factors for _ in range(n))
        first, second = [0] * (2 - len(at)) + at
        return first, second


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ForceLaw:
    """Terms, and the ideal fluid's quadratics of the products that they leave open.

    Attributes
    ----------
    terms : tuple of ForceTerm
    ideal : (6, 6, 6) or (m, 6, 6, 6) array
        Q of `coeflab.law.rigid_body.ideal_quadratics`, zero where a measured term speaks: force i = sum of Q[i, j, k] nu_j nu_k.
    left_out : tuple of str
        Symbols with a value that are no part of the law: accelerations, and controls where they are not asked for.
    strict : bool
        Whether the force is NaN where a table refuses to be read. A motion goes on with the value at the edge, and ends there.
    coefficient : (t,) or (m, t) array
        SI; one row a member where the members differ. Those of the terms unless given.
    source, prime, low, high, tabled
        Made of the terms, once, (v,): column of the base row behind each variable, and its `Reading`.
    wind : (g, 3) bool
        The distinct `ForceTerm.into` of the terms.
    component, speed_power : (t,) int array
        X Y Z K M N as 0 to 5, D S L of group g of `wind` as 6 + 3 g and on; of V.
    powers, gathered, primed, along, angled
        Distinct powers of V; (f, t) rows of the pool whose product is each term; variables that are primed; (6 + 3 g, t) which
        component each term adds to; whether any needs the incidence.
    regions : tuple of _Region
        The hull of every table.
    curved : bool
        Whether one of them is no box, or tapers: then variables are not held one by one.
    """

    terms: tuple[ForceTerm, ...]
    ideal: Array
    left_out: tuple[str, ...] = ()
    strict: bool = False
    coefficient: Array = field(default_factory=lambda: np.empty(0))
    source: Ints = field(init=False, repr=False)
    prime: Array = field(init=False, repr=False)
    low: Array = field(init=False, repr=False)
    high: Array = field(init=False, repr=False)
    tabled: NDArray[np.bool_] = field(init=False, repr=False)
    wind: tuple[tuple[bool, bool, bool], ...] = field(init=False, repr=False)
    component: Ints = field(init=False, repr=False)
    powers: Ints = field(init=False, repr=False)
    gathered: Ints = field(init=False, repr=False)
    primed: Ints = field(init=False, repr=False)
    along: Array = field(init=False, repr=False)
    angled: bool = field(init=False, repr=False)
    regions: tuple[_Region, ...] = field(init=False, repr=False)
    curved: bool = field(init=False, repr=False)

    def __post_init__(self) -> None:
        readings = [dict(t.readings) for t in self.terms]
        of_terms = [
            [((v, r.get(v, PLAIN)), n, a) for v, n, a in t.term.factors]
            for t, r in zip(self.terms, readings, strict=True)
        ]
        variables = list(dict.fromkeys(v for factors in of_terms for v, _, _ in factors))
        wind = tuple(dict.fromkeys(t.into for t in self.terms if t.component in WIND)) or (EVERYWHERE,)
        own = self.coefficient if self.coefficient.size else [t.coefficient for t in self.terms]
        result = {
            "ideal": locked(self.ideal),
            "coefficient": locked(own),
            "source": np.array([BASE.index(v) for v, _ in variables], dtype=np.int64),
            "prime": np.array([r.prime for _, r in variables], dtype=np.float64),
            "low": np.array([r.low for _, r in variables], dtype=np.float64),
            "high": np.array([r.high for _, r in variables], dtype=np.float64),
            "tabled": np.array([r.tabled for _, r in variables], dtype=bool),
            "wind": wind,
            "component": np.array([place_of(t, wind) for t in self.terms], dtype=np.int64),
            "powers": np.unique(np.array([t.speed_power for t in self.terms], dtype=np.int64)),
        }
        for name, value in result.items():
            object.__setattr__(self, name, value)
        object.__setattr__(self, "gathered", self._gathered(of_terms, variables))
        object.__setattr__(self, "primed", np.flatnonzero(self.prime))
        rows = np.arange(6 + 3 * len(wind))[:, None]
        object.__setattr__(self, "along", (self.component == rows).astype(np.float64))
        object.__setattr__(self, "regions", self._regions(variables))
        read = [self.source, *(r.source for r in self.regions if r.together)]
        object.__setattr__(self, "angled", bool(np.any(self.component >= 6) or np.any(np.concatenate(read) >= ALPHA)))
        object.__setattr__(self, "curved", any(r.together for r in self.regions))

    def _regions(self, variables: list[tuple[str, Reading]]) -> tuple[_Region, ...]:
        hulls: dict[int, tuple[Domain, dict[str, Reading], list[int]]] = {}
        for i, t in enumerate(self.terms):
            if t.hull is not None:
                hulls.setdefault(id(t.hull), (t.hull, {}, []))[1].update(t.readings)
                hulls[id(t.hull)][2].append(i)
        at = {v: i for i, v in enumerate(variables)}
        out = []
        for hull, readings, terms in hulls.values():
            each = [(v, readings[v]) for v in hull.variables]
            rows = [at.get(v, -1) for v in each] if any(r.table for _, r in each) else []
            out.append(
                _Region(
                    hull, np.array([BASE.index(v) for v, _ in each]), np.array([r.prime for _, r in each]), np.array(rows, dtype=np.int64),
                    np.array(terms, dtype=np.int64),
                )
            )  # fmt: skip
        return tuple(out)

    def _gathered(
        self, of_terms: list[list[tuple[tuple[str, Reading], int, bool]]], variables: list[tuple[str, Reading]]
    ) -> Ints:
        """(f, t) rows of the pool, which holds 1, powers of V, variables and their absolute values."""
        at = {v: 1 + len(self.powers) + i for i, v in enumerate(variables)}
        rows = []
        for t, factors in zip(self.terms, of_terms, strict=True):
            row = [1 + int(np.searchsorted(self.powers, t.speed_power))] if t.speed_power else []
            for absolute in (False, True):
                row += sorted(
                    at[v] + absolute * len(variables) for v, n, a in factors if a is absolute for _ in range(n)
                )
            rows.append(row)
        longest = max((len(r) for r in rows), default=0)
        filled = [r + [0] * (max(longest, 1) - len(r)) for r in rows]
        return np.array(filled, dtype=np.int64).reshape(len(rows), max(longest, 1)).T.copy()

    def force(self, nu: Array, controls: Array | None = None) -> Array:
        """X Y Z K M N, shape (n, 6).

        Parameters
        ----------
        nu : (n, 6) array
            Velocities through the water at the reference point, FRD.
        controls : (n, 3) array, optional
            dr, ds, db, rad; zero unless given.
        """
        angles = np.zeros((3, len(nu))) if controls is None else controls.T
        out = np.asarray(self.term_force(nu.T, angles).T + self._ideal(nu))
        if self.strict:
            out[self.refused(nu, angles.T, SLACK)] = np.nan
        return out

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
            for k, speaks in enumerate(self.wind):
                turned = np.array(body_forces(base[ALPHA], base[BETA], *along[6 + 3 * k : 9 + 3 * k]))
                out[:3] += turned * np.array(speaks)[:, None]
        return np.asarray(out)

    def _products(self, base: Array) -> Array:
        """(t, n) every term before its coefficient."""
        values = self._values(base)
        np.clip(values, self.low[:, None], self.high[:, None], out=values)
        if not self.curved:
            return self._multiplied(values, base[SPEED])
        near, shares = values.copy(), list[tuple[Ints, Array]]()
        for r in self.regions:
            if r.together:
                nearest, free = r.hull.read(r.points(base))
                used = r.rows >= 0
                near[r.rows[used]] = nearest.T[used]
                shares += [(r.terms, free)] if np.any(free) else []
        out = self._multiplied(near, base[SPEED])
        if shares:
            beyond = self._multiplied(values, base[SPEED])
            for terms, free in shares:
                out[terms] += free * (beyond[terms] - out[terms])
        return out

    def _multiplied(self, values: Array, speed: Array) -> Array:
        """(t, n) every term before its coefficient, of variables (v, n) where they are read."""
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
        """(n,) whether a state lies beyond the data of a table, where the table's edge stands in."""
        base = _base(nu, controls)
        values = self._values(base).T
        out = np.any(((values < self.low) | (values > self.high)) & self.tabled, axis=1)
        for r in self.regions:
            if r.together:
                out |= ~r.hull.contains(r.points(base), MOVED)
        return np.asarray(out)

    def refused(self, nu: Array, controls: Array, slack: float = MOVED) -> NDArray[np.bool_]:
        """(n,) whether a table that refuses to be read beyond its data would have to be; nothing is read without a speed.

        Parameters
        ----------
        nu : (n, 6) array
        controls : (n, 3) array
        slack : float
            Of the hull.
        """
        base, out = _base(nu, controls), np.zeros(len(nu), dtype=bool)
        for r in self.regions:
            if r.hull.rule == "refuse":
                still = base[SPEED] <= SLOWEST if np.all(self._powers_of_speed(r.terms) > 0) else False
                out |= ~r.hull.contains(r.points(base), slack) & np.logical_not(still)
        return out

    def _powers_of_speed(self, terms: Ints) -> Ints:
        return np.array([self.terms[i].speed_power for i in terms], dtype=np.int64)


def place_of(term: ForceTerm, wind: Sequence[tuple[bool, bool, bool]]) -> int:
    """Where a term adds up: X Y Z K M N as 0 to 5, D S L of group g of ``wind`` as 6 + 3 g and on."""
    if term.component not in WIND:
        return COMPONENTS.index(term.component)
    return 6 + 3 * wind.index(term.into) + WIND.index(term.component)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class _Region:
    """The hull of one table in a law: base row and prime of its variables, their rows where they are held together, its terms."""

    hull: Domain
    source: Ints
    prime: Array
    rows: Ints
    terms: Ints

    @property
    def together(self) -> bool:
        """Whether its variables are held together, and not one by one."""
        return len(self.rows) > 0

    def points(self, base: Array) -> Array:
        """(n, d) its variables."""
        values = base[self.source].copy()
        primed = np.flatnonzero(self.prime)
        values[primed] *= self.prime[primed, None] / np.maximum(base[SPEED], SLOWEST)
        return np.asarray(values.T)


def _base(nu: Array, controls: Array) -> Array:
    """(b, n) every variable as it is."""
    speed = np.sqrt(np.sum(nu[:, :3] ** 2, axis=1))
    return np.vstack([nu.T, controls.T, speed, *incidence(nu[:, 0], nu[:, 1], nu[:, 2])])

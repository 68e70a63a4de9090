"""The steady hydrodynamic force that a parameter file states, as a function of the velocities.

Measured terms are taken as measured, potential part and all. Where an added-mass matrix is known, those products of two
velocities that no measured term speaks of get their share of -C_A(nu) nu of the added mass that the vehicle moves with
(`coeflab.vehicle.inertia`), so that nothing is counted twice and nothing known is left out.

The force law of a parameter file as arrays: derivatives, controls and fitted tables.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.types import Array, brief, locked
from coeflab.fits.rows.regression import MOMENT_COEFFICIENTS
from coeflab.law.coefficient import Coefficient
from coeflab.law.motion_law import BASE, REVERSAL, WIND, MotionLaw
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROLS, LINEAR, MOTIONS, derivative
from coeflab.law.terms import Term, parse_suffix
from coeflab.vehicle.inertia import water_inertia
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ANGLE_OF, ParameterModel

SLOWEST = 1e-9


@brief
@dataclass(frozen=True, slots=True)
class LawTerm:
    """One term of the law: coefficient times velocities times a power of the speed.

    Attributes
    ----------
    symbol : str
        Without prime.
    component : str
    term : Term
        Over u v w p q r in m/s and rad/s, without the speed.
    coefficient : float
        SI, with the density in it.
    speed_power : int
        Of U = |(u, v, w)|.
    potential : float or None
        Part of the coefficient that an ideal fluid gives; None where that is not known.
    """

    symbol: str
    component: str
    term: Term
    coefficient: float
    speed_power: int
    potential: float | None

    @property
    def pair(self) -> tuple[int, int] | None:
        """The product of two velocities that the term is near straight motion; None for others."""
        if any(a for _, _, a in self.term.factors) or self.term.degree > 2 or self.term.degree + self.speed_power != 2:
            return None
        at = sorted(MOTIONS.index(v) for v, n, _ in self.term.factors for _ in range(n))
        first, second = [0] * (2 - len(at)) + at
        return first, second


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ForceLaw:
    """Terms, and the ideal fluid's quadratics of the products that they leave open.

    Attributes
    ----------
    terms : tuple of LawTerm
    ideal : (6, 6, 6) array
        Q of `coeflab.law.rigid_body.ideal_quadratics`, zero where a measured term speaks.
    left_out : tuple of str
        Symbols with a value that are no part of the law: controls and accelerations.
    """

    terms: tuple[LawTerm, ...]
    ideal: Array
    left_out: tuple[str, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "ideal", locked(self.ideal))

    def force(self, nu: Array) -> Array:
        """X Y Z K M N, shape (n, 6), for velocities (n, 6) at the reference point."""
        speed = np.maximum(np.linalg.norm(nu[:, :3], axis=1), SLOWEST)
        columns = dict(zip(MOTIONS, nu.T, strict=True))
        out = np.einsum("ijk,nj,nk->ni", self.ideal, nu, nu)
        for t in self.terms:
            out[:, COMPONENTS.index(t.component)] += t.coefficient * speed**t.speed_power * t.term.evaluate(columns)
        return np.asarray(out)


def force_law(parameters: ParameterFile) -> ForceLaw:
    """The law of a parameter file at its density.

    Literature values stand in where nothing was fitted, as in the file. Coefficients without a value give nothing.
    """
    density, primes = parameters.conditions.density, parameters.scaling
    terms, left_out = [], []
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None:
            continue
        if any(f in CONTROLS or f.endswith("dot") for f in d.factors):
            left_out.append(d.text)
            continue
        term = parse_suffix(d.text[1:])
        scale = primes.unit(d.text, density)
        if c.law == "rest" and c.value_si is not None:
            value, power = c.value_si, 0
            scale = value / c.value if c.value else 0.0
        else:
            value, power = scale * c.value, 2 - term.degree
        potential = None if c.potential is None else c.potential * scale
        terms.append(LawTerm(d.text, d.component, term, value, power, potential))
    ideal = np.zeros((6, 6, 6))
    if parameters.added_mass is not None:
        ideal = np.where(_open(terms), ideal_quadratics(water_inertia(parameters).matrix), 0.0)
    return ForceLaw(tuple(terms), ideal, tuple(left_out))


def open_pairs(parameters: ParameterFile) -> NDArray[np.bool_]:
    """(6, 6, 6), by force and two velocities: the products that no measured term of a parameter file speaks of."""
    return _open(force_law(parameters).terms)


def _open(terms: Sequence[LawTerm]) -> NDArray[np.bool_]:
    out = np.ones((6, 6, 6), dtype=bool)
    for t in terms:
        if t.pair is not None:
            i, (j, k) = COMPONENTS.index(t.component), t.pair
            out[i, j, k] = out[i, k, j] = False
    return out


FREE = (-np.inf, np.inf)
AHEAD = ("u", REVERSAL, -1.0, 1.0, False)
Variable = tuple[str, float, float, float, bool]


@brief
@dataclass(frozen=True, slots=True)
class MotionTerm:
    """One term before it becomes a row of arrays.

    Attributes
    ----------
    symbol : str
        Of the coefficient, primed as in the file, or response and term of a table.
    component : str
        X Y Z K M N, or D S L.
    coefficient : float
        SI.
    per_prime : float
        SI coefficient of one unit of what the file states, so that draws of it can be scaled.
    speed_power : int
    factors : tuple of (Variable, power, absolute)
    """

    symbol: str
    component: str
    coefficient: float
    per_prime: float
    speed_power: int
    factors: tuple[tuple[Variable, int, bool], ...]


def motion_terms(parameters: ParameterFile, tables: bool) -> tuple[tuple[MotionTerm, ...], tuple[str, ...]]:
    """Every term, and what has to be said of them.

    A fitted table speaks for the components that no derivative speaks for; with ``tables`` it is the other way round.

    Parameters
    ----------
    parameters : ParameterFile
    tables : bool
        Whether fitted tables come first.
    """
    derivatives = _derivatives(parameters)
    used = _used(parameters, derivatives, tables)
    fitted, statements = _fitted(used, parameters)
    if tables:
        by_table = {c for m in used for c in _components(m)}
        derivatives = tuple(t for t in derivatives if t.component not in by_table or not _of_motion(t))
    return derivatives + fitted, statements


def open_products(parameters: ParameterFile, tables: bool) -> Array:
    """(6, 6, 6) quadratics of the ideal fluid that neither a measured derivative nor a table of measured forces speaks of.

    A table over alpha or beta speaks of all products of u with w or v in its component, one over a rate of those with it,
    unless it says that the potential part is not in its values.
    """
    return np.where(open_places(parameters, tables), force_law(parameters).ideal, 0.0)


def open_places(parameters: ParameterFile, tables: bool) -> np.ndarray:
    """(6, 6, 6), by force and two velocities: whether `open_products` has a place for a product."""
    out = open_pairs(parameters)
    for m in _used(parameters, _derivatives(parameters), tables):
        if not m.contains_potential:
            continue
        moved = sorted({MOTIONS.index(v) for name in m.names for v in _moves(name)} | {0})
        for c in _components(m):
            i = COMPONENTS.index(c)
            out[np.ix_([i], moved, moved)] = False
    return out


def _moves(variable: str) -> tuple[str, ...]:
    name = ANGLE_OF.get(variable, variable)
    return (name,) if name in MOTIONS else ()


def _used(parameters: ParameterFile, derivatives: tuple[MotionTerm, ...], tables: bool) -> tuple[ParameterModel, ...]:
    """Tables that speak: all that are forces, or those of components without a derivative.

    Raises
    ------
    InputError
        Two of one component that both have a force at no angle and no rate.
    """
    spoken = set() if tables else {t.component for t in derivatives if _of_motion(t)}
    used = [m for m in parameters.models if _components(m) and not _components(m) & spoken]
    for c in COMPONENTS:
        based = [m for m in used if c in _components(m) and any(t.value and not t.factors for t in m.terms)]
        if len({"wind" if _place_of(m) in WIND else m.names for m in based}) > 1:
            names = " and ".join(f"{m.response} over {', '.join(m.names)}" for m in based)
            raise InputError(
                f"{names}, each with a force at rest of its own", f"one table of {c} with a constant", column="models",
                advice="Fit one table over all of its variables, or give derivatives.",
            )  # fmt: skip
    return tuple(used)


def _of_motion(term: MotionTerm) -> bool:
    return not term.factors or any(v[0] not in CONTROLS for v, _, _ in term.factors)


def _place_of(model: ParameterModel) -> str:
    """X Y Z K M N, or D S L; empty where the response is no force."""
    name = model.response.removesuffix("'")
    found = MOMENT_COEFFICIENTS.get(name) or (name[2:] if name.startswith("C_") and name[2:] in WIND else name)
    return found if found in (*COMPONENTS, *WIND) else ""


def _components(model: ParameterModel) -> set[str]:
    place = _place_of(model)
    return {"X", "Y", "Z"} if place in WIND else {place} if place else set()


def _derivatives(parameters: ParameterFile) -> tuple[MotionTerm, ...]:
    """Derivatives and controls. A force that has only V in it, such as X0, turns with the direction of motion."""
    primes = {c.symbol.removesuffix("'"): c for c in parameters.coefficients}
    out = []
    for t in force_law(parameters).terms:
        value = primes[t.symbol].value
        factors = tuple((_free(v), n, a) for v, n, a in t.term.factors)
        if not factors and t.component == "X" and t.speed_power == 2:
            factors = ((AHEAD, 1, False),)
        per_prime = t.coefficient / value if value else _scale(primes[t.symbol], parameters)
        out.append(MotionTerm(t.symbol + "'", t.component, t.coefficient, per_prime, t.speed_power, factors))
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None or not any(f in CONTROLS for f in d.factors):
            continue
        term = parse_suffix(d.text[1:])
        motions = sum(n for v, n, _ in term.factors if v not in CONTROLS)
        scale = parameters.scaling.unit(d.text, parameters.conditions.density)
        factors = tuple((_free(v), n, a) for v, n, a in term.factors)
        out.append(MotionTerm(c.symbol, d.component, scale * c.value, scale, 2 - motions, factors))
    return tuple(out)


def _scale(c: Coefficient, parameters: ParameterFile) -> float:
    """SI coefficient of one unit of a coefficient that is zero."""
    at = parameters.conditions
    return parameters.scaling.unit(c.symbol, at.density, at.speed if c.law == "rest" else 1.0)


def _free(name: str) -> Variable:
    return (name, 0.0, *FREE, False)


def _fitted(
    used: tuple[ParameterModel, ...], parameters: ParameterFile
) -> tuple[tuple[MotionTerm, ...], tuple[str, ...]]:
    out: list[MotionTerm] = []
    statements = [
        f"the table of {m.response} is no force that a motion needs and was left out"
        for m in parameters.models
        if not _components(m)
    ]
    for m in used:
        component, scale, power = _place(m, parameters)
        variables = _variables(m, parameters.scaling.length)
        for t in m.terms:
            if t.value is None:
                statements.append(f"{m.response}: {t.symbol} is not determined by the data and counts as zero")
                continue
            factors = tuple((variables[f.variable], f.power, f.absolute) for f in t.factors)
            out.append(MotionTerm(f"{m.response} {t.symbol}", component, scale * t.value, scale, power, factors))
    if used:
        names = ", ".join(dict.fromkeys(m.response for m in used))
        statements.append(f"tables of {names}: beyond the box of their data the value at the edge stands in")
    return tuple(out), tuple(statements)


def _place(model: ParameterModel, parameters: ParameterFile) -> tuple[str, float, int]:
    """Component, SI force of one unit of the response, power of the speed."""
    pressure, length = 0.5 * parameters.conditions.density, parameters.scaling.length
    component = _place_of(model)
    arm = length if component in "KMN" else 1.0
    if model.unit != "1":
        return component, 1.0, 0
    return component, pressure * (model.area.value if model.area else length**2) * arm, 2


def _variables(model: ParameterModel, length: float) -> dict[str, Variable]:
    out: dict[str, Variable] = {}
    for v, low, high in zip(model.variables, model.domain.low, model.domain.high, strict=True):
        prime = 0.0
        if v.unit == "1":
            prime = 1.0 if v.name in LINEAR else length if v.name in ANGULAR else 0.0
        out[v.name] = (v.name, prime, low, high, True)
    return out


def as_arrays(terms: Iterable[MotionTerm], ideal: np.ndarray) -> MotionLaw:
    """The terms as a `MotionLaw`, in their order."""
    listed = list(terms)
    variables = list(dict.fromkeys(v for t in listed for v, _, _ in t.factors))
    at = {v: i for i, v in enumerate(variables)}
    signed = np.zeros((len(listed), len(variables)), dtype=np.int64)
    absolute = np.zeros_like(signed)
    for row, t in enumerate(listed):
        for v, n, a in t.factors:
            (absolute if a else signed)[row, at[v]] += n
    order = (*COMPONENTS, *WIND)
    return MotionLaw(
        source=np.array([BASE.index(v[0]) for v in variables], dtype=np.int64),
        prime=np.array([v[1] for v in variables], dtype=np.float64),
        low=np.array([v[2] for v in variables], dtype=np.float64),
        high=np.array([v[3] for v in variables], dtype=np.float64),
        tabled=np.array([v[4] for v in variables], dtype=bool),
        component=np.array([order.index(t.component) for t in listed], dtype=np.int64),
        coefficient=np.array([t.coefficient for t in listed], dtype=np.float64),
        speed_power=np.array([t.speed_power for t in listed], dtype=np.int64),
        signed=signed,
        absolute=absolute,
        ideal=ideal,
    )


def force_of_tables(parameters: ParameterFile, nu: Array) -> Array | None:
    """(n, 6) what the fitted tables change in the force of the derivatives and of the ideal fluid; None where there is none."""
    stated = {c.symbol for c in parameters.coefficients}
    tabled = [t for t in motion_terms(parameters, tables=False)[0] if t.symbol not in stated]
    if not tabled:
        return None
    beside = open_products(parameters, tables=False) - force_law(parameters).ideal
    return as_arrays(tabled, beside).force(nu, np.zeros((len(nu), len(CONTROLS))))

"""Slope at the origin beside the secant over a range, and over which range the secant would meet a value from elsewhere.

A nonlinear force has no single derivative: a slope at the origin, a line through a sweep and an oscillation test each
give another number. The first harmonic of ``b |x|^n sign(x)`` under ``x = A sin(wt)`` is ``b A^(n-1) c_n`` with
``c_n = 2 Gamma(n/2 + 1) / (sqrt(pi) Gamma((n + 3)/2))``: 1, 8/(3 pi), 3/4 for n = 1, 2, 3 (describing function,
Gelb & Vander Velde 1968).
"""

from __future__ import annotations

from collections.abc import Mapping
from math import gamma, pi, sqrt

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.table import coefficient, plus_minus
from coeflab.core.texts import text_of
from coeflab.core.types import dataclass
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.law.named_terms import canonical

FARTHEST = 3.0  # reaches: beyond, a slope from rest speaks of other motions than those measured


@dataclass(frozen=True, slots=True)
class Secant:
    """A slope at the origin and the secant from 0 to ``reach``.

    Attributes
    ----------
    symbol, variable : str
    slope, secant : float
    half_width : float
        95 % of the secant, scatter of the points only.
    reach : float
        Largest motion in the data.
    """

    symbol: str
    variable: str
    slope: float
    secant: float
    half_width: float
    reach: float

    def __str__(self) -> str:
        return (
            f"{self.symbol}' is {coefficient(self.slope)} at the origin and "
            f"{plus_minus(self.secant, self.half_width)} (scatter) as secant over {self.variable}' = 0 .. {self.reach:.3g}."
        )


@dataclass(frozen=True, slots=True)
class Explanation:
    """Whether the range of motion could explain a difference to a value from elsewhere.

    Attributes
    ----------
    secant : Secant
    reference : float
    equal_at : float or None
        Range over which the secant equals the reference, up to three times the data's; None if there is none.
    harmonic_at : float or None
        Amplitude of an oscillation whose first harmonic gives the reference.
    possible : bool
        Whether either lies inside the data.
    sentence : str
    """

    secant: Secant
    reference: float
    equal_at: float | None
    harmonic_at: float | None
    possible: bool
    sentence: str


def _powers(model: FittedModel, symbol: str) -> tuple[str, dict[int, int]]:
    """Variable of a slope, and the model's terms odd in that variable alone: power -> index."""
    if symbol not in model.symbols:
        raise InputError(shown(symbol), f"one of {', '.join(model.symbols)}", column="secant")
    key = canonical(model.terms[model.symbols.index(symbol)])
    if len(key) != 1 or key[0][1:] != (1, True):
        raise InputError(shown(symbol), "a slope at the origin such as Yr", column="secant")
    variable = key[0][0]
    found = {}
    for i, term in enumerate(model.terms):
        k = canonical(term)
        if len(k) == 1 and k[0][0] == variable and k[0][2]:
            found[k[0][1]] = i
    return variable, found


def secant(model: FittedModel, symbol: str) -> Secant:
    """Slope and secant of a linear coefficient.

    Parameters
    ----------
    model : FittedModel
    symbol : str
        A slope at the origin of the model, such as ``Yr``.

    Raises
    ------
    InputError
        The model has no such slope.
    """
    variable, powers = _powers(model, symbol)
    reach = float(np.max(np.abs(model.x[variable])))
    weights = np.zeros(len(model.terms))
    for n, i in powers.items():
        weights[i] = reach ** (n - 1)
    value = float(sum(weights[i] * model.fit.coefficients[i] for i in powers.values()))
    deviation = float(np.sqrt(max(float(weights @ model.fit.covariance @ weights), 0.0)))
    own = model.symbols.index(symbol)
    factor = float(model.fit.half_width[own]) / max(float(np.sqrt(model.fit.covariance[own, own])), 1e-300)
    return Secant(symbol, variable, model.named(symbol)[0], value, factor * deviation, reach)


def _meets(coefficients: Mapping[int, float], value: float, limit: float) -> float | None:
    """Smallest positive x up to ``limit`` with sum b_n x^(n-1) = value."""
    highest = max(coefficients)
    polynomial = [coefficients.get(n, 0.0) for n in range(highest, 0, -1)]
    polynomial[-1] -= value
    roots = np.asarray(np.roots(polynomial), dtype=np.complex128)
    real = roots.real[np.abs(roots.imag) < 1e-9 * np.maximum(np.abs(roots), 1e-12)]
    real = real[(real > 0.0) & (real <= limit)]
    return float(real.min()) if real.size else None


def explain(model: FittedModel, symbol: str, reference: float, origin: str) -> Explanation:
    """Say over which range the model's secant would equal a value from elsewhere.

    Parameters
    ----------
    model : FittedModel
    symbol : str
        A slope at the origin of the model.
    reference : float
        The primed value from elsewhere, on the same length and reference point.
    origin : str
        What that value is, for example ``Roddy (1990), PMM``.

    Returns
    -------
    Explanation
        The sentence says so when the range does not explain the difference, and that the amplitude of the other test
        is unknown here.
    """
    _, powers = _powers(model, symbol)
    coefficients = {n: float(model.fit.coefficients[i]) for n, i in powers.items()}
    return explained(secant(model, symbol), coefficients, reference, origin)


def explained(here: Secant, coefficients: Mapping[int, float], reference: float, origin: str) -> Explanation:
    """Say over which range the secant of an odd curve would equal a value from elsewhere.

    Parameters
    ----------
    here : Secant
    coefficients : mapping of int to float
        Power n, odd in the motion: its coefficient.
    reference : float
        The primed value from elsewhere, on the same length and reference point.
    origin : str
        What that value is, for example ``Roddy (1990), PMM``.
    """
    variable = here.variable
    harmonic = {n: b * 2.0 * gamma(n / 2 + 1) / (sqrt(pi) * gamma((n + 3) / 2)) for n, b in coefficients.items()}
    limit = FARTHEST * here.reach
    equal_at, harmonic_at = _meets(coefficients, reference, limit), _meets(harmonic, reference, limit)
    found = [x for x in (equal_at, harmonic_at) if x is not None]
    possible = any(x <= here.reach for x in found)
    x = f"{variable}'"
    head = f"{here} {origin} gives {coefficient(reference)}. "
    if not found:
        tail = f"No range up to {x} = {limit:.3g} makes them equal: the range of {x} does not explain the difference."
    else:
        where = "The secant would equal it over 0 .. " + (
            f"{x} = {equal_at:.3g}" if equal_at is not None else f"no {x} up to {limit:.3g}"
        )
        where += ", the first harmonic of an oscillation at " + (
            f"an amplitude of {x} = {harmonic_at:.3g}" if harmonic_at is not None else "no such amplitude"
        )
        if possible:
            tail = text_of("fits.range_may_explain", where=where, x=x)
        else:
            tail = text_of("fits.beyond_data", where=where, x=x, reach=here.reach)
    return Explanation(here, reference, equal_at, harmonic_at, possible, head + tail)

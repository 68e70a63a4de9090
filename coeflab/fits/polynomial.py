"""Polynomials in one motion variable: resistance, side force, moments over an angle, a velocity or a rate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.options import bounded, measured, one_of, parse_options, words
from coeflab.core.texts import input_error
from coeflab.fits.results.fit_result import FitResult, independent, result_of
from coeflab.fits.results.fitted_model import FittedModel, coefficient_of, in_words
from coeflab.fits.results.lack_of_fit import residuals_in_words
from coeflab.fits.rows.only_moving import AREAS, PRIMES, allowed, area_of, area_settings, named_response, only_moving
from coeflab.fits.rows.regression import ANGLES, Area, collect, model_of
from coeflab.fits.rows.too_few import each_with_rows
from coeflab.fits.statistics.extended_precision import sharpened
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.domain import Extrapolation
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS, primed
from coeflab.law.terms import Term, power_terms
from coeflab.tables.force_table import ForceTable

summary = "polynomials in one variable (angle, velocity, rate, control), with their domain and intervals"
citations = ("mackinnon1985", "bell2002", "imbens2016")

LONGEST_SYMBOL = 5


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    variable : str
        ``alpha``, ``beta`` and controls in radians; velocities and rates primed.
    responses : tuple of str
        X Y Z K M N, C_D C_S C_L or C_l C_m C_n; by default every component that the tables have.
    degree : int
        The highest power.
    parity : str
        ``odd`` or ``even`` powers only, or ``full``.
    extrapolation : str
        What a reader outside the data is to do.
    area : float
        0 is the square of the primes' length.
    area_name : str
        What the area is.
    """

    variable: str = one_of("beta", "alpha", "beta", "v", "w", "p", "q", "r", "dr", "ds", "db")
    responses: tuple[str, ...] = words()
    degree: int = bounded(3, 0, 20)
    parity: str = one_of("full", "full", "odd", "even")
    extrapolation: str = one_of("refuse", "refuse", "clamp", "taper")
    area: float = measured(0.0, 0.0, 1e6, "area")
    area_name: str = one_of(PRIMES, *AREAS)


def _symbol(name: str, term: Term, area: Area) -> str:
    """SNAME where there is one (``Yvvv'``), else the response with the term (``C_D_beta^2``)."""
    if name in COMPONENTS and area.name == PRIMES and not any(v in ANGLES for v, _, _ in term.factors):
        return primed(name + term.suffix)
    return f"{named_response(name, area)}_{term if term.factors else 0}"


def _model(
    tables: Sequence[ForceTable],
    name: str,
    terms: tuple[Term, ...],
    area: Area,
    chosen: Options,
    notes: tuple[str, ...],
) -> FittedModel:
    rows = collect(tables, (chosen.variable,), name, area)
    symbols = tuple(_symbol(name, t, area) for t in terms)
    parity = "" if chosen.parity == "full" else f", {chosen.parity}"
    model = model_of(
        rows,
        terms,
        symbols,
        f"polynomial of degree {chosen.degree}{parity}, in {chosen.variable}",
        rule=Extrapolation(chosen.extrapolation),
    )
    exact = sharpened(model.fit, terms, rows.x, rows.y, rows.errors)
    found = replace(model, response=named_response(name, area), fit=exact)
    freer = f"Try a higher degree, such as degree = {chosen.degree + (1 if chosen.parity == 'full' else 2)}"
    freer += "." if chosen.parity == "full" else ", or parity = full."
    return replace(
        found, statements=(*notes, *found.secants, *residuals_in_words(found, freer), *in_words(exact, symbols))
    )


def _coefficients(
    model: FittedModel, chosen: Options, area: Area, citation: str
) -> tuple[list[Coefficient], NDArray[np.float64]]:
    """Those of a model that have SNAME names, with the covariance of standard uncertainties (U95/2)."""
    named = chosen.variable not in ANGLES and area.name == PRIMES and model.response.removesuffix("'") in COMPONENTS
    keep = [i for i, t in enumerate(model.terms) if named and t.degree <= LONGEST_SYMBOL]
    x = model.x[chosen.variable]
    low, high = float(x.min()), float(x.max())
    if chosen.variable in ("v", "w"):
        low, high = float(np.arcsin(max(low, -1.0))), float(np.arcsin(min(high, 1.0)))
    out = [
        coefficient_of(model, i, citation, Status.TOO_FEW_POINTS, symbol=model.symbols[i].removesuffix("'"),
            estimator=model.one_size(i) or model.form, window=(low, high), window_over=chosen.variable,
        )
        for i in keep
    ]  # fmt: skip
    return out, model.covariance[np.ix_(keep, keep)]


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit a polynomial in one variable to every response.

    Only rows in which no other variable moves are used.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point.
    scaling : Scaling
        Length of the primes.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        Without sweeps; a primed component over a velocity, rate or control also gives SNAME coefficients, whose U95
        holds the scatter only, as one form says nothing about another.

    Raises
    ------
    InputError
        No such sweep, a response that the tables lack, more terms than rows of every response, or an area without its name.
    """
    chosen = parse_options(Options, options, "polynomial")
    area = area_of(chosen.area, chosen.area_name, scaling)
    terms = power_terms((chosen.variable,), chosen.degree, "tensor", {chosen.variable: chosen.parity})
    if not terms:
        raise InputError("an odd polynomial of degree 0", "a degree of at least 1", column="polynomial.degree")
    used, notes = only_moving(tables, (chosen.variable,), scaling.length)
    names = chosen.responses or tuple(c for c in COMPONENTS if allowed(used, c, area))
    if not names:
        raise input_error("fits.no_usable_force_sweep", column="polynomial.responses", variable=chosen.variable)
    first = tables[0]
    models, few = each_with_rows(
        tuple(dict.fromkeys(names)), lambda n: _model(allowed(used, n, area) or used, n, terms, area, chosen, notes), first.campaign
    )  # fmt: skip
    parts = [_coefficients(m, chosen, area, first.source.citation) for m in models]
    coefficients = [c for some, _ in parts for c in some]
    settings = {
        "variable": chosen.variable, "degree": str(chosen.degree), "parity": chosen.parity,
        "extrapolation": chosen.extrapolation, **area_settings(area),
    }  # fmt: skip
    return result_of(
        "polynomial", first, scaling, coefficients, independent([block for _, block in parts]), citations=citations,
        settings=settings, models=models, findings=few,
    )  # fmt: skip

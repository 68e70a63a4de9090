"""A control surface in its own flow: C_D, C_L and C_m of the effective angle delta - alpha.

Equations 15-17 of the HUUV paper: the forces of the elevators depend on delta - alpha only. C_L and C_m are odd (linear
and, if wanted, cubic), C_D is even (constant and quadratic).

Signs. alpha = atan2(w, u) in FRD, L is upward and normal to the flow, M nose up. With **delta - alpha** a surface at
delta = alpha lies along the flow, so a positive delta turns its leading edge *down* and lowers lift: the linear
coefficient of C_L is negative. With **delta + alpha** a positive delta turns the trailing edge down, as in Feldman's
equations (1979), and raises lift: the linear coefficient is positive. The text of the HUUV paper prints delta - alpha
for axes that fit x forward, y port, z up, where alpha has the other sign; in FRD that is delta + alpha. Its figures
of the elevator are not in that text, so which way its delta is positive is not known. The fit states what the data say.

Validity: the intervals are those of scatter. Where it grows fivefold towards the largest angle, those of C_D2 cover 93.2 %
of campaigns of 51 rows, and 92.8 % of those of 27 rows (both sweeps of delta at three angles of attack).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import comb
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.options import measured, one_of, parse_options
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import finite
from coeflab.fits.results.fit_result import FitResult, result_of
from coeflab.fits.results.fitted_model import FittedModel, coefficient_of
from coeflab.fits.results.lack_of_fit import residuals_in_words
from coeflab.fits.rows.only_moving import AREAS, PRIMES, area_of, area_settings, only_moving
from coeflab.fits.rows.regression import Area, Rows, collect, model_of
from coeflab.fits.statistics.linear_model import fit_linear
from coeflab.fits.statistics.robust_errors import t_probability
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.scaling import Scaling
from coeflab.law.terms import Term, design
from coeflab.tables.force_table import ForceTable

summary = "drag, lift and moment of a control surface over its angle to the flow, delta - alpha"
citations = ("huuv2025", "feldman1979", "mackinnon1985", "bell2002")
NEEDS = {"C_D": "X", "C_L": "Z", "C_m": "M"}
DERIVATIVES = {"C_L": ("Zds", -1.0), "C_m": ("Mds", 1.0)}
NEAR_ZERO = float(np.radians(0.3))
UNLIKELY = 0.01
EFFECTIVE = "e"


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    effective : {"delta-alpha", "delta+alpha"}
        Angle between surface and flow. With ``delta-alpha`` a positive delta lowers lift, with ``delta+alpha`` it raises it.
    cubic : {"no", "yes"}
        Whether C_L and C_m have a cubic term.
    area : float
        0 is L^2, the square of the scaling's length.
    area_name : str
        What that area is, needed with ``area``.
    surface : {"ds", "db"}
        Which control angle.
    """

    effective: str = one_of("delta-alpha", "delta-alpha", "delta+alpha")
    cubic: str = one_of("no", "no", "yes")
    area: float = measured(0.0, 0.0, 1e6, "area")
    area_name: str = one_of(PRIMES, *AREAS)
    surface: str = one_of("ds", "ds", "db")


def _powers(response: str, chosen: Options) -> tuple[int, ...]:
    if response == "C_D":
        return (0, 2)
    return (1, 3) if chosen.cubic == "yes" else (1,)


def _expanded(power: int, surface: str, sign: float) -> dict[Term, float]:
    """(delta + sign alpha)^power as products of delta and alpha."""
    out = {}
    for k in range(power + 1):
        factors = [(surface, power - k), ("alpha", k)]
        out[Term(tuple((v, n, False) for v, n in factors if n))] = comb(power, k) * sign**k
    return out


def _over_both(rows: Rows, powers: Sequence[int], chosen: Options, form: str) -> FittedModel:
    """The law over delta and alpha, its coefficients tied so that only the effective angle counts."""
    if np.ptp(rows.x["alpha"]) <= NEAR_ZERO and np.all(np.abs(rows.x["alpha"]) <= NEAR_ZERO):
        rows = replace(rows, x={chosen.surface: rows.x[chosen.surface]})
        terms = tuple(Term(((chosen.surface, n, False),)) if n else Term() for n in powers)
        return model_of(rows, terms, tuple(f"{rows.response}_{t}" for t in terms), f"{form}, at alpha = 0")
    parts = [_expanded(n, chosen.surface, _sign(chosen)) for n in powers]
    terms = tuple(t for p in parts for t in p)
    ties: list[Array] = []
    for p in parts:
        lead, *others = p
        for t in others:
            tie = np.zeros(len(terms))
            tie[terms.index(t)], tie[terms.index(lead)] = 1.0, -p[t] / p[lead]
            ties.append(tie)
    constraint = np.array(ties), np.zeros(len(ties))
    symbols = tuple(f"{rows.response}_{t}" for t in terms)
    return model_of(rows, terms, symbols, form, constraint=constraint)


def _shares(powers: Sequence[int], model: FittedModel, chosen: Options) -> Array:
    """How much of each coefficient of the effective angle every term over delta and alpha has, shape (terms, powers)."""
    out = np.zeros((len(model.terms), len(powers)))
    for k, n in enumerate(powers):
        for term, share in _expanded(n, chosen.surface, _sign(chosen)).items():
            if term in model.terms:
                out[model.terms.index(term), k] = share
    return out


def _over_effective(rows: Rows, powers: Sequence[int], chosen: Options, form: str) -> FittedModel:
    """The law as the paper writes it: a listing over the effective angle, whose domain stays delta and alpha."""
    used = replace(rows, x={EFFECTIVE: rows.x[chosen.surface] + _sign(chosen) * rows.x["alpha"], **rows.x})
    if np.ptp(used.x[EFFECTIVE]) <= NEAR_ZERO:
        raise input_error("fits.one_angle", column="control_surface", campaign=rows.campaign)
    terms = tuple(Term(((EFFECTIVE, n, False),)) if n else Term() for n in powers)
    return model_of(used, terms, tuple(f"{rows.response}{n}" for n in powers), form)


def _sign(chosen: Options) -> float:
    return -1.0 if chosen.effective == "delta-alpha" else 1.0


def _effective_angle_note(rows: Rows, model: FittedModel, chosen: Options) -> str:
    """Whether alpha acts as the effective angle says: the slope that is left over for alpha alone."""
    alpha = rows.x["alpha"]
    if np.ptp(alpha) <= NEAR_ZERO:
        return "alpha does not change: that only the effective angle counts is assumed, not tested."
    extra = fit_linear(np.column_stack([design(model.terms, model.x), alpha]), rows.y, rows.errors)
    left, half, freedom = float(extra.coefficients[-1]), float(extra.half_width[-1]), float(extra.freedom[-1])
    error = float(np.sqrt(extra.covariance[-1, -1]))
    if not np.isfinite(half) or error == 0.0:
        return "The rows do not show whether alpha acts through the effective angle alone."
    chance = float(t_probability(left / error, freedom))
    found = f"a slope of {left:.3g} +- {half:.2g} per radian is left for alpha alone (p = {chance:.2g})"
    if chance >= UNLIKELY:
        return f"As the effective angle assumes, alpha and delta act together: {found}."
    other = "delta+alpha" if chosen.effective == "delta-alpha" else "delta-alpha"
    turned = -2.0 * _sign(chosen) * float(extra.coefficients[0])
    advice = (
        f"Try effective = {other}."
        if abs(left - turned) < abs(left)
        else "The table contains more than the surface's own force, or C_L and C_m need their cubic term."
    )
    return f"alpha acts on {model.response} otherwise than through {chosen.effective}: {found}. {advice}"


def _lifts(model: FittedModel) -> str:
    value, half = model.named("C_L1")
    if not np.isfinite(half) or abs(value) <= half:
        return "The rows do not show which sign of delta raises lift."
    return f"A {'positive' if value > 0.0 else 'negative'} delta raises lift."


def _fitted(rows: Rows, area: Area, chosen: Options) -> tuple[FittedModel, FittedModel]:
    """The law over delta and alpha, and the same over the effective angle."""
    powers = _powers(rows.response, chosen)
    parity = {(0, 2): "constant + square", (1, 3): "line + cubic", (1,): "line"}[powers]
    by = f"{area.name} ({area.area:.6g} m^2)"
    by += f" and the length {area.length:.6g} m" if rows.response == "C_m" else ""
    form = f"{parity} in e = {chosen.effective.replace('-', ' - ').replace('+', ' + ')} [rad], by {by}"
    listing = _over_effective(rows, powers, chosen, form)
    model = _over_both(rows, powers, chosen, f"{form}, over {chosen.surface} and alpha")
    listing = replace(listing, domain=model.domain)
    if listing.remainder is not None:
        model = replace(model, remainder=listing.remainder.over(_shares(powers, model, chosen)))
    statements = [_effective_angle_note(rows, listing, chosen)] if rows.response != "C_D" else []
    if rows.response == "C_L":
        statements.insert(0, _lifts(listing))
    tied = tuple(x for x in model.statements if "collinear" not in x)
    freer = "Fit a narrower range of angles, or a surface over delta and alpha."
    if len(powers) == 1:
        freer = "Try cubic = yes."
    model = replace(model, statements=(*residuals_in_words(model, freer), *tied))
    return model, replace(listing, statements=(*statements, *residuals_in_words(listing, freer), *listing.statements))


def _coefficient(model: FittedModel, area: Area, scaling: Scaling, surface: str, citation: str) -> Coefficient | None:
    """Zds' or Mds' at alpha = 0, where Z = -L and d(effective angle)/d(delta) = 1."""
    if model.response not in DERIVATIVES:
        return None
    symbol, sign = DERIVATIVES[model.response]
    k = area.area / scaling.length**2
    i = model.symbols.index(f"{model.response}1")
    found = coefficient_of(model, i, citation, Status.TOO_FEW_POINTS, symbol=symbol.replace("ds", surface), value=finite(float(model.fit.coefficients[i])),
        estimator=f"{model.response}1, {model.form}",
    )  # fmt: skip
    return found.scaled(sign * k, "1")


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit the forces of a control surface over its angle to the flow.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point; the forces of the surface itself. Rows that drift, turn, or move
        another surface are left out.
    scaling : Scaling
        Its length divides moments, and its square is the area by default.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        Models of those of ``C_D``, ``C_L`` and ``C_m`` whose columns X, Z, M the tables have: first over delta and
        alpha with tied coefficients, which the parameter file keeps, then the same over the effective angle ``e``,
        ``C_D0 C_D2 C_L1 C_L3 C_m1 C_m3``. The coefficients are the primes ``Zds'`` and ``Mds'`` at zero angle of
        attack; errors of the two are taken as independent.

    Raises
    ------
    InputError
        No column of the control angle, none of X Z M, one of them missing that a response needs, area without a name,
        or no more rows than terms.
    """
    chosen = parse_options(Options, options, "control_surface")
    area = area_of(chosen.area, chosen.area_name, scaling)
    first = tables[0]
    column = {"ds": "delta_s", "db": "delta_b"}[chosen.surface]
    moved = [t for t in tables if chosen.surface in t.controls]
    if not moved:
        raise InputError(f"no {column} in {first.campaign}", f"a column {column} [deg]", column="control_surface")
    used, left_out = only_moving(moved, (chosen.surface, "alpha"), scaling.length)
    responses = [r for r, c in NEEDS.items() if any(c in t.forces for t in used)]
    if not responses:
        raise InputError(f"none of X, Z, M in {first.campaign}", "at least one of them", column="control_surface")
    pairs = [_fitted(collect(used, (chosen.surface, "alpha"), r, area), area, chosen) for r in responses]
    models = [replace(m, statements=(*left_out, *m.statements)) for m, _ in pairs] + [m for _, m in pairs]
    fitted_ones = [_coefficient(m, area, scaling, chosen.surface, first.source.citation) for _, m in pairs]
    coefficients = [c for c in fitted_ones if c is not None]
    covariance = np.diag([np.nan if c.u95 is None else (c.u95 / 2.0) ** 2 for c in coefficients])
    settings = {"effective": chosen.effective, "cubic": chosen.cubic, "surface": chosen.surface, **area_settings(area)}
    return result_of(
        "control_surface", first, scaling, coefficients, covariance, citations=citations, settings=settings, models=tuple(models)
    )  # fmt: skip

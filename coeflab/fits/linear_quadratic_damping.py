"""Linear and quadratic damping of every axis, X = Xu u + Xu|u| |u|u and its like for Y Z K M N.

Fossen (2011), sections 6.4 and 8.1 for the form; equations 13-18 and 25-30 of the TJ-FlyingFish paper for its use.
Only rows in which nothing but that axis's velocity moves are used, so the regression is dimensional.

Signs: SNAME's derivatives are those of the force that the fluid exerts, so damping is *negative*. The TJ-FlyingFish
paper writes F = -(Xu + Xu|u| |u|) u and prints the same numbers with a plus sign.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.options import one_of, parse_options, words
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import finite
from coeflab.fits.results.fit_result import FitResult, independent, result_of
from coeflab.fits.results.fitted_model import FittedModel, coefficient_of
from coeflab.fits.results.lack_of_fit import residuals_in_words
from coeflab.fits.rows.regression import Rows, all_known, model_of
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import ANGULAR, COMPONENTS, LINEAR, MOMENTS, MOTIONS, derivative
from coeflab.law.terms import Term
from coeflab.tables.force_table import ForceTable

summary = "linear and quadratic damping of every axis, from rows in which only its velocity moves"
citations = ("fossen2011", "tj_flyingfish", "mackinnon1985", "bell2002")
FORMS = {"both": ("{0}", "{0}|{0}|"), "linear": ("{0}",), "quadratic": ("{0}|{0}|",)}
AT_REST = 1e-6


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    axes : tuple of str
        Which of u v w p q r.
    terms : {"both", "linear", "quadratic"}
        Terms of every axis.
    offset : {"no", "yes"}
        Whether a force at rest is fitted too. There is none physically; it shows the bias of a balance.
    """

    axes: tuple[str, ...] = words(*MOTIONS)
    terms: str = one_of("both", *FORMS)
    offset: str = one_of("no", "no", "yes")


def _terms(axis: str, chosen: Options) -> tuple[Term, ...]:
    known = {"{0}": Term(((axis, 1, False),)), "{0}|{0}|": Term(((axis, 1, False), (axis, 1, True)))}
    rest = (Term(),) if chosen.offset == "yes" else ()
    return tuple(known[t] for t in FORMS[chosen.terms]) + rest


def _alone(table: ForceTable, axis: str, with_rest: bool) -> NDArray[np.bool_]:
    """Rows in which only ``axis`` moves; rows at rest where the force at rest is wanted."""
    keep = np.ones(len(table), dtype=bool)
    for group in (LINEAR, ANGULAR):
        largest = max(float(np.max(np.abs(table.motion[m]), initial=0.0)) for m in group)
        for m in group:
            still = np.abs(table.motion[m]) <= AT_REST * largest
            if m != axis:
                keep &= still
            elif not with_rest:
                keep &= ~still
    for angle in table.controls.values():
        keep &= angle == 0.0
    return keep


def _rows(tables: Sequence[ForceTable], axis: str, chosen: Options) -> Rows | None:
    """The rows of one axis, None where no table has any."""
    component = COMPONENTS[MOTIONS.index(axis)]
    parts = []
    for t in tables:
        if component in t.forces:
            index = np.flatnonzero(_alone(t, axis, chosen.offset == "yes") & t.usable[component])
            if index.size and np.any(t.motion[axis][index] != 0.0):
                parts.append((t, index))
    if not parts:
        return None
    readings = [t.forces[component][i] for t, i in parts]
    return Rows(
        x={axis: np.concatenate([t.motion[axis][i] for t, i in parts])},
        y=np.concatenate(readings),
        errors=all_known([t.errors[component][i] if component in t.errors else None for t, i in parts]),
        rounding=np.concatenate([t.digits[component][i] for t, i in parts]),
        labels=tuple(t.labels[k] for t, i in parts for k in i),
        response=component,
        tables=tuple(t.name for t, _ in parts),
        campaign=tables[0].campaign,
        body=tables[0].body,
    )


def _symbols(rows: Rows, terms: Sequence[Term]) -> tuple[str, ...]:
    """Xu, Xu|u|, and in words the force at rest, which is not SNAME's X0."""
    return tuple(rows.response + t.suffix if t.factors else f"{rows.response} at rest" for t in terms)


def _notes(model: FittedModel, axis: str) -> tuple[str, ...]:
    """Units, sign and doubts of one axis in words."""
    laws = [s for s, t in zip(model.symbols, model.terms, strict=True) if t.factors]
    out = [
        f"{' and '.join(f'{s} in {derivative(s).unit}' for s in laws)}; derivatives of the fluid's force, so negative "
        f"values damp. A paper that writes {model.response} = -(...) {axis} prints them with the other sign."
    ]
    for s in laws:
        value, half = model.named(s)
        if np.isfinite(half) and value - half > 0.0:
            out.append(f"{s} is positive beyond its interval: it drives the motion. Check the axes and the signs.")
        elif np.isfinite(half) and abs(value) <= half:
            out.append(f"{s} cannot be distinguished from zero by these rows.")
    if np.all(model.x[axis] >= 0.0) or np.all(model.x[axis] <= 0.0):
        out.append(f"All rows have {axis} of one sign; the form assumes an equal and opposite force the other way.")
    return tuple(out)


def _fitted(rows: Rows, axis: str, chosen: Options) -> FittedModel:
    terms = _terms(axis, chosen)
    symbols = _symbols(rows, terms)
    law = " + ".join(f"{s} {t}" if t.factors else s for s, t in zip(symbols, terms, strict=True))
    unit = "N*m" if rows.response in MOMENTS else "N"
    model = model_of(rows, terms, symbols, f"{rows.response} = {law}", unit=unit)
    return replace(model, statements=(*_notes(model, axis), *residuals_in_words(model), *model.statements))


def _coefficients(model: FittedModel, axis: str, citation: str) -> tuple[list[Coefficient], Array]:
    """Dimensional coefficients of one axis with the covariance of their standard uncertainties (U95 / 2)^2."""
    index = [i for i, t in enumerate(model.terms) if t.factors]
    low, high = float(model.domain.low[0]), float(model.domain.high[0])
    over = f"{model.form}, {axis} from {low:g} to {high:g} {'rad/s' if axis in ANGULAR else 'm/s'}"
    out = [
        coefficient_of(model, i, citation, Status.TOO_FEW_POINTS, value=finite(float(model.fit.coefficients[i])),
            unit=derivative(model.symbols[i]).unit, estimator=over, law="rest",
        )
        for i in index
    ]  # fmt: skip
    return out, model.covariance[np.ix_(index, index)]


def _too_few(rows: Rows, axis: str, chosen: Options, citation: str) -> list[Coefficient]:
    return [
        Coefficient(
            rows.response + t.suffix, None, None, Status.TOO_FEW_POINTS, rows.body, origin="fit",
            table=", ".join(rows.tables), campaign=rows.campaign, n_points=len(rows.y), citation=citation, law="rest",
        )
        for t in _terms(axis, chosen) if t.factors
    ]  # fmt: skip


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit the damping of every axis that the tables of one campaign move alone.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point.
    scaling : Scaling
        Length of the primes of the coefficients; the models are dimensional.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        One model per axis in N or N m over m/s or rad/s, and the coefficients primed by ``scaling`` at the density and
        speed of the campaign (``coefficients.to_si(conditions)`` gives back the numbers of the models). Their U95 holds
        the scatter of the points and what their residuals show that the form leaves out.

    Raises
    ------
    InputError
        Unknown axis; no row in which only one of the axes moves; too few such rows on every axis.
    """
    chosen = parse_options(Options, options, "linear_quadratic_damping")
    if wrong := [a for a in chosen.axes if a not in MOTIONS]:
        raise InputError(
            shown(wrong[0]), f"some of {', '.join(MOTIONS)}", column="linear_quadratic_damping.axes"
        )  # fmt: skip
    first, tables = tables[0], [t.at_one_density() for t in tables]
    gathered = {a: r for a in dict.fromkeys(chosen.axes) if (r := _rows(tables, a, chosen)) is not None}
    if not gathered:
        raise input_error(
            "fits.row_only_one", column="linear_quadratic_damping", campaign=first.campaign, axes=", ".join(chosen.axes),
        )  # fmt: skip
    models: list[FittedModel] = []
    coefficients: list[Coefficient] = []
    blocks: list[Array] = []
    shortfall: InputError | None = None
    for axis, rows in gathered.items():
        try:
            model = _fitted(rows, axis, chosen)
        except InputError as why:
            shortfall = why
            few = _too_few(rows, axis, chosen, first.source.citation)
            coefficients += few
            blocks.append(np.full((len(few), len(few)), np.nan))
            continue
        found, block = _coefficients(model, axis, first.source.citation)
        models.append(model)
        coefficients += found
        blocks.append(block)
    if not models and shortfall is not None:
        raise shortfall
    result = result_of(
        "linear_quadratic_damping", first, scaling, coefficients, independent(blocks), citations=citations,
        settings={"axes": " ".join(chosen.axes), "terms": chosen.terms, "offset": chosen.offset}, models=tuple(models),
        conditions=first.conditions,
    )  # fmt: skip
    return replace(result, coefficients=result.coefficients.to_prime())

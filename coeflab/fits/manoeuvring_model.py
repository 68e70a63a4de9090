"""Manoeuvring models: any SNAME terms, fitted jointly over drift, rotating-arm and combined tables of campaigns.

Of several campaigns each has its own intercepts and its own scatter; its rows are moved to the point of the first.

Term sets: Gertler & Hagen (1967), Feldman (1979). HC2: MacKinnon & White (1985), degrees of freedom: Bell & McCaffrey
(2002). Valid inside the convex hull of the data; U95 holds the scatter of the points about the chosen form, and what
their residuals show that it leaves out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from coeflab.core.errors import shown
from coeflab.core.options import one_of, parse_options, words
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.fits.joint.components import Component
from coeflab.fits.joint.model import joint_models
from coeflab.fits.joint.one_point import about_one_point, differences
from coeflab.fits.joint.rows import joint_name, joint_rows
from coeflab.fits.results.fit_result import FitResult, result_of
from coeflab.fits.results.fitted_model import FittedModel, coefficient_of
from coeflab.fits.results.lack_of_fit import next_terms_in_words, residuals_in_words
from coeflab.fits.rows.asked_terms import AskedTerms, asked_terms
from coeflab.fits.rows.secant import secant
from coeflab.fits.rows.too_few import each_with_rows
from coeflab.fits.statistics.remainder import companions
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.named_terms import (
    Equation,
    NamedTerm,
    canonical,
    read_equation,
    split_equations,
)
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import MOTIONS
from coeflab.tables.force_table import ForceTable

summary = (
    "manoeuvring model of any SNAME terms over one or several campaigns, with linear equations between coefficients"
)
citations = ("gertler1967", "feldman1979", "mackinnon1985", "bell2002", "chow1960", "tipton2015")
joins_campaigns = True

MORE_TERMS = "Add terms of a higher power or of two motions, or fit a narrower range."
UNWEIGHTED = (
    "Equal weights: the stated standard errors are the noise of one run, not the error of the model. weights = yes "
    "uses them."
)
UNUSED = "Stated standard errors of single runs are not used; weights = yes uses them inside every campaign."
WEIGHTED = "Rows are weighted by their stated standard errors, as asked."


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    terms : tuple of str
        SNAME symbols such as ``Yv``, ``Yv|v|``, ``Nrr|r|``; each must occur in the data.
    set : str
        Terms of a standard set as well; horizontal if no terms are given. Those that the data do not excite are
        reported as not determined.
    components : tuple of str
        Components of the set; none given means all that the tables have.
    intercepts : str
        ``yes`` adds Y0, N0 ... to every component, one for each of several campaigns; ``no`` leaves only those that the
        terms name. Named ones are shared by all campaigns.
    constraints : tuple of str
        Linear equations, kept exactly and tested against the free fit: ``Mw = -Nv``; a text is split at commas and
        semicolons.
    weights : str
        ``yes`` weighs rows by their standard errors.
    """

    terms: tuple[str, ...] = words()
    set: str = one_of("", "horizontal", "vertical", "none")
    components: tuple[str, ...] = words()
    intercepts: str = one_of("yes", "yes", "no")
    constraints: tuple[str, ...] = words()
    weights: str = one_of("no", "yes", "no")


def _with_secants(model: FittedModel) -> list[str]:
    """Secants beside the slopes that the model has more than a line for."""
    out = []
    for symbol, term, value in zip(model.symbols, model.terms, model.fit.coefficients, strict=True):
        key = canonical(term)
        if len(key) == 1 and key[0][0] in MOTIONS and key[0][1:] == (1, True) and np.isfinite(value):
            others = [
                float(b)
                for t, b in zip(model.terms, model.fit.coefficients, strict=True)
                for k in [canonical(t)]
                if len(k) == 1 and k[0][0] == key[0][0] and k[0][2] and k[0][1] > 1
            ]
            if others and np.all(np.isfinite(others)):
                out.append(str(secant(model, symbol)))
    return out


def _window(model: FittedModel, index: int) -> tuple[float, float] | None:
    """Range of the motion of a coefficient of one variable: radians for v' and w', else as it is."""
    names = {v for v, _, _ in model.terms[index].factors}
    if len(names) != 1:
        return None
    name = names.pop()
    low, high = float(model.x[name].min()), float(model.x[name].max())
    if name in ("v", "w"):
        return float(np.arcsin(np.clip(low, -1.0, 1.0))), float(np.arcsin(np.clip(high, -1.0, 1.0)))
    return low, high


def _coefficients(model: FittedModel, citation: str, *, lines: bool) -> list[Coefficient]:
    bent = {t.factors[0][0]: t.suffix for t in companions(model.terms)} if lines else {}
    joint = f"joint least squares, {model.response}' = {' + '.join(model.symbols)}"
    out = []
    for i, symbol in enumerate(model.symbols):
        more: dict[str, Any] = {"estimator": joint}
        if model.recommended(i) is None:
            more["estimator"] = model.one_size(i) or joint
        elif not np.any(model.terms[i].evaluate(model.x)):
            more = {"n_points": 0, "estimator": f"from the equations alone, no motion of {symbol} in its rows"}
        else:
            more["window"] = _window(model, i)
            if straight := bent.get(model.terms[i].suffix, ""):
                more["estimator"] += f"; U95 holds {model.response}{straight}, which the set has not"
        out.append(coefficient_of(model, i, citation, **more))
    return out


def _covariance(spread: Array, models: Sequence[FittedModel], coefficients: Sequence[Coefficient]) -> Array:
    """(U95/2)^2 on the diagonal, beside it the sandwich and, inside a component, the form; NaN where there is no U95."""
    size = np.linalg.norm(spread, axis=1)
    unit = spread / np.where(size > 0.0, size, 1.0)[:, None]
    scatter = np.array([np.nan if c.u95 is None or c.parts.random is None else c.parts.random for c in coefficients])
    out = (unit @ unit.T) * np.outer(scatter, scatter) / 4.0
    out[np.diag_indices(len(scatter))] = scatter**2 / 4.0
    at = 0
    for m in models:
        block = slice(at, at + len(m.symbols))
        out[block, block] += 0.0 if m.remainder is None else m.remainder.covariance / 4.0
        at = block.stop
    return np.asarray(out)


def _not_their_own_images(equations: Sequence[Equation], tables: Sequence[ForceTable]) -> None:
    """Refuse to tie components of which one is the other's, turned: every reading would count twice."""
    turned = next((t for t in tables if t.by_symmetry in {o.name for o in tables}), None)
    between = next((e for e in equations if len({symbol[0] for symbol, _ in e.weights}) > 1), None)
    if turned is None or between is None:
        return
    raise input_error(
        "fits.over_turned_symmetry", column="manoeuvring_model.constraints", between=shown(between), name=turned.name,
        by_symmetry=turned.by_symmetry,
    )  # fmt: skip


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit the model over all tables of one or several campaigns.

    Parameters
    ----------
    tables : sequence of ForceTable
        With reference points from one datum; the coefficients are about that of the first.
    scaling : Scaling
        Length of the primes.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        One model per component; coefficients that the rows leave open have no value and say so, as do those of a component
        with no more rows than terms.

    Raises
    ------
    InputError
        Unknown, repeated or unexcited terms; more terms than rows of every component; equations that are unreadable or cannot hold.
    """
    given = {k: split_equations(o) if k == "constraints" and isinstance(o, str) else o for k, o in options.items()}
    chosen = parse_options(Options, given, "manoeuvring_model")
    equations = [read_equation(c, "manoeuvring_model.constraints") for c in chosen.constraints]
    _not_their_own_images(equations, tables)
    apart, tables = differences(tables, scaling.length), about_one_point(tables)
    asked = asked_terms(chosen.terms, _set_of(chosen) or "none", chosen.components, tables,
                        intercepts=chosen.intercepts == "yes", place="manoeuvring_model")  # fmt: skip
    weighted = chosen.weights == "yes"
    names = tuple(dict.fromkeys(t.component for t in asked.fitted))
    parts, few = each_with_rows(
        names, lambda c: _component(c, asked, tables, scaling.length, weighted=weighted), joint_name(t.campaign for t in tables)
    )  # fmt: skip
    components = {p.name: replace(p, lines=not chosen.terms) for p in parts}
    stated = {c: p.data.rows.errors is not None for c, p in components.items()}
    n_runs = sum(map(len, tables))
    joint = joint_models(components, equations, "manoeuvring model", n_runs=n_runs)
    unused = UNUSED if len({t.campaign for t in tables}) > 1 else UNWEIGHTED
    weight_words = {c: [WEIGHTED] if weighted else [unused] if known else [] for c, known in stated.items()}
    tied = {symbol[0] for e in equations for symbol, _ in e.weights}
    missed = {
        m.response: ()
        if m.response in tied
        else next_terms_in_words(m, (own := components[m.response]).errors, _set_of(chosen), own.intercepts)
        for m in joint.models
    }
    finished = tuple(
        _finished(m, apart, (*missed[m.response], *weight_words[m.response]), asked.idle) for m in joint.models
    )
    first, campaign, body = tables[0], joint_name(t.campaign for t in tables), joint_name(t.body for t in tables)
    citation = joint_name(t.source.citation for t in tables)
    coefficients = [c for m in finished for c in _coefficients(m, citation, lines=not chosen.terms)]
    open_ones = [
        Coefficient(t.symbol, None, None, Status.NOT_DETERMINED, body, origin="fit", campaign=campaign,
                    estimator="no motion in the tables")
        for t in asked.idle
    ]  # fmt: skip
    few = (*few, *(why.finding(campaign) for why in joint.short.values()))
    short = {c for f in few for c in str(f["variable"]).split(", ")}
    open_ones += [
        Coefficient(t.symbol, None, None, Status.TOO_FEW_POINTS, body, origin="fit", campaign=campaign,
                    estimator="no more usable rows than terms")
        for t in asked.fitted if t.component in short
    ]  # fmt: skip
    every = coefficients + open_ones
    settings = {
        "terms": " ".join(t.symbol for t in asked.fitted), "constraints": ", ".join(map(str, equations)) or "none",
        "weights": chosen.weights,
    }  # fmt: skip
    covariance = _covariance(np.vstack([joint.spread, np.zeros((len(open_ones), n_runs))]), finished, every)
    return result_of(
        "manoeuvring_model", first, scaling, every, covariance, citations=citations, settings=settings, models=finished,
        campaign=campaign, body=body, poolings=joint.poolings, differences=apart, findings=few,
    )  # fmt: skip


def _component(
    name: str, asked: AskedTerms, tables: Sequence[ForceTable], length: float, *, weighted: bool
) -> Component:
    """Terms, rows and weights of one force component."""
    own = tuple(t for t in asked.fitted if t.component == name)
    variables = tuple(dict.fromkeys(v for t in own for v, _, _ in t.term.factors)) or ("u",)
    data = joint_rows(tables, variables, name, length)
    if weighted and data.rows.errors is None:
        raise input_error("fits.no_standard_errors_2", column="manoeuvring_model.weights", name=name)
    free = name in asked.own
    return Component(name, own, data.without_campaigns_at_rest() if free else data, own=free).weighed(stated=weighted)


def _set_of(chosen: Options) -> str:
    """The set whose terms are fitted; empty for none."""
    used = chosen.set or ("none" if chosen.terms else "horizontal")
    return "" if used == "none" else used


def _finished(model: FittedModel, first: Sequence[str], more: Sequence[str], idle: Sequence[NamedTerm]) -> FittedModel:
    """The model with what a reader must know about it, in words."""
    absent = [t.symbol for t in idle if t.component == model.response]
    statements = [
        *first,
        *model.secants,
        *residuals_in_words(model, MORE_TERMS),
        *model.statements,
        *_with_secants(model),
        *more,
    ]
    if absent:
        statements.insert(0, f"Not determined, since no table varies their motion: {', '.join(absent)}.")
    return replace(model, statements=tuple(statements))

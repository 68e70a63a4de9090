"""Fitted force laws and tables, as tables to be shown."""

from __future__ import annotations

import math

import numpy as np

from coeflab.model.fitted_model import FittedModel
from coeflab.model.table import ABSENT, Table, number, percent, probability


def terms(model: FittedModel) -> Table:
    """Every coefficient with its interval; what the data leave open is said below, not printed as a number."""
    rows = []
    for symbol, term, value, half in zip(
        model.symbols, model.terms, model.fit.coefficients, model.half_width, strict=True
    ):
        known = math.isfinite(value)
        rows.append(
            (
                symbol,
                str(term),
                number(float(value), 5) if known else "not determined",
                number(float(half), 3) if known else ABSENT,
                percent(float(half), float(value)) if known else ABSENT,
            )
        )
    notes = model.statements
    title = f"{model.response} [{model.unit if model.unit != '1' else '-'}], {model.form}: {model.campaign}"
    return Table(title, ("", "term", "value", "95 %", "95 %"), tuple(rows), notes, frozenset({0, 1}))


def quality(models: tuple[FittedModel, ...]) -> Table:
    """How well each response is held, and how well a left-out point is predicted."""
    rows = tuple(
        (
            m.response,
            m.form,
            str(m.n_points),
            str(m.fit.rank),
            number(m.fit.rms, 3),
            number(m.fit.press_rms, 3),
            percent(m.fit.press_rms, float(m.y.max() - m.y.min()) or None),
            number(m.fit.r_squared, 5),
            number(m.fit.aicc, 5),
            probability(m.fit.runs_probability),
            number(m.fit.condition, 3),
            "; ".join(
                f"{v} {number(float(a), 3)} .. {number(float(b), 3)}"
                for v, a, b in zip(m.domain.variables, m.domain.low, m.domain.high, strict=True)
            ),
            m.domain.rule.value,
        )
        for m in models
    )
    headers = (
        "", "form", "n", "terms", "rms", "left out", "of range", "R2", "AICc", "runs", "condition", "domain", "outside",
    )  # fmt: skip
    notes = (
        "left out: rms error of every point predicted from the others (PRESS); runs: probability of so few or so many "
        "runs of one sign by chance; outside: what a reader beyond the domain is to do.",
    )
    return Table("Quality of the fitted models", headers, rows, notes, frozenset({0, 1, 11, 12}))


MOST_POINTS = 5
LARGEST_MATRIX = 8


def influence(model: FittedModel) -> Table:
    """The points that move the fit most, by Cook's distance."""
    d = model.fit.cooks_distance
    order = [int(i) for i in np.argsort(-np.nan_to_num(d), kind="stable")[:MOST_POINTS] if np.isfinite(d[i])]
    rows = tuple(
        (
            model.labels[i],
            number(float(d[i]), 3),
            number(float(model.fit.leverage[i]), 3),
            number(float(model.fit.residuals[i]), 3),
            number(float(model.fit.left_out[i]), 3),
        )
        for i in order
    )
    headers = ("point", "Cook's distance", "leverage", "residual", "left out")
    notes = ("left out: residual when the point is predicted from the others.",)
    return Table(f"Most influential points of {model.response}: {model.campaign}", headers, rows, notes, frozenset({0}))


def correlations(model: FittedModel) -> Table:
    """Correlations of the coefficients; empty where there are too many to read."""
    if len(model.symbols) > LARGEST_MATRIX:
        return Table("Correlations", (), ())
    rows = tuple(
        (
            symbol,
            *(number(float(c), 2) if np.isfinite(c) else ABSENT for c in model.fit.correlation[i, : i + 1]),
            *([""] * (len(model.symbols) - i - 1)),
        )
        for i, symbol in enumerate(model.symbols)
    )
    title = f"Correlations of the coefficients of {model.response}: {model.campaign}"
    return Table(title, ("", *model.symbols), rows, (), frozenset({0}))

"""Fitted force laws and tables, as tables to be shown."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from coeflab.core.symbols import FLOW_ANGLES
from coeflab.model.fitted_model import FittedModel
from coeflab.model.table import ABSENT, Table, number, percent, probability
from coeflab.presentation.variables import domain_in_words


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
            domain_in_words(m),
            m.domain.rule.value,
        )
        for m in models
    )
    headers = (
        "", "form", "n", "terms", "rms", "left out", "of range", "R2", "AICc", "runs", "condition", "domain", "outside",
    )  # fmt: skip
    notes: tuple[str, ...] = (
        "left out: rms error of every point predicted from the others (PRESS); runs: probability of so few or so many "
        "runs of one sign by chance; outside: what a reader beyond the domain is to do.",
    )
    angles = dict.fromkeys(v for m in models for v in m.domain.variables if v in FLOW_ANGLES)
    notes = (*notes, *(FLOW_ANGLES[v] for v in angles))
    return Table("Quality of the fitted models", headers, rows, notes, frozenset({0, 1, 11, 12}))


MOST_POINTS = 5
LARGEST_MATRIX = 8
CLOSE, MOST_PAIRS = 0.9, 12


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
    """Correlations of the coefficients; of more than eight, the pairs beyond 0.9."""
    title = f"Correlations of the coefficients of {model.response}: {model.campaign}"
    if len(model.symbols) > LARGEST_MATRIX:
        return _close_pairs(model, title)
    rows = tuple(
        (
            symbol,
            *(number(float(c), 2) if np.isfinite(c) else ABSENT for c in model.fit.correlation[i, : i + 1]),
            *([""] * (len(model.symbols) - i - 1)),
        )
        for i, symbol in enumerate(model.symbols)
    )
    return Table(title, ("", *model.symbols), rows, (), frozenset({0}))


def _close_pairs(model: FittedModel, title: str) -> Table:
    pairs = [(float(model.fit.correlation[i, j]), i, j) for i, j in combinations(range(len(model.symbols)), 2)]
    close = sorted((p for p in pairs if abs(p[0]) > CLOSE), key=lambda p: (-abs(p[0]), p[1:]))
    rows = tuple((model.symbols[i], model.symbols[j], number(r, 3)) for r, i, j in close[:MOST_PAIRS])
    said = f"{len(close)} of {len(pairs)} pairs lie beyond {CLOSE} in magnitude"
    notes = (f"{said}; the closest {MOST_PAIRS} are shown." if len(close) > MOST_PAIRS else f"{said}.",)
    return Table(title, ("", "with", "correlation"), rows, notes, frozenset({0, 1}))


def diagnostics(models: Sequence[FittedModel]) -> Table:
    """Influence, prediction, conditioning and the order of signs, one row a model."""
    rows = []
    for m in models:
        f = m.fit
        with_left_out = f.left_out[np.isfinite(f.left_out)]
        spread = float(np.sum((m.y - m.y.mean()) ** 2))
        whole = len(with_left_out) == m.n_points and spread > 0.0
        most = 2.0 * f.rank / m.n_points
        rows.append(
            (
                m.response,
                m.form,
                number(float(np.sum(with_left_out**2)), 3) if len(with_left_out) else ABSENT,
                number(1.0 - float(np.sum(with_left_out**2)) / spread, 5) if whole else ABSENT,
                number(float(np.max(f.leverage)), 3),
                f"{int(np.sum(f.leverage > most))} > {number(most, 2)}",
                number(float(np.nanmax(f.cooks_distance)), 3) if np.any(np.isfinite(f.cooks_distance)) else ABSENT,
                number(f.condition, 3),
                f"{max(f.digits, 0.0):.0f}",
                probability(f.runs_probability),
            )
        )
    headers = (
        "", "form", "PRESS", "predicted R2", "largest leverage", "high leverage", "largest Cook", "condition", "digits", "runs",
    )  # fmt: skip
    notes = (
        "PRESS: sum of squares of every point predicted from the others (Allen 1974); high leverage: points above 2 rank / n; "
        "largest Cook: above 1 a point decides the fit (Cook 1977); condition: of the column-scaled terms; digits: those "
        "of the worst coefficient that it leaves sure; runs: probability of the runs test (Wald & Wolfowitz 1940), rows in "
        "the order of the table.",
    )
    return Table("Diagnostics of the fitted models", headers, tuple(rows), notes, frozenset({0, 1}))

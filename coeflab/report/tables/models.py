"""Fitted force laws and tables, and the campaigns of a joint fit side by side, as tables to be shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table, coefficient, number, percent, probability
from coeflab.fits.statistics.least_squares import factorise
from coeflab.fits.statistics.linear_model import variation
from coeflab.law.symbols import FLOW_ANGLES
from coeflab.law.terms import design
from coeflab.report.figures.variables import domain_in_words
from coeflab.report.texts import table_of, text_of

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.fits.results.out_of_sample import OutOfSample
    from coeflab.fits.results.pooling import Pooling


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
            percent(m.fit.press_rms, float(abs(m.y.mean()) if m.is_constant else m.y.max() - m.y.min()) or None),
            number(m.fit.r_squared, 5),
            number(m.fit.aicc, 5),
            probability(m.fit.runs_probability),
            number(m.fit.condition, 3),
            domain_in_words(m),
            m.domain.rule.value,
        )
        for m in models
    )
    notes: tuple[str, ...] = (text_of("models.quality_notes"),)
    if any(m.is_constant for m in models):
        notes = (*notes, "of range: of the mean, for a model that is one constant.")
    angles = dict.fromkeys(v for m in models for v in m.domain.variables if v in FLOW_ANGLES)
    notes = (*notes, *(FLOW_ANGLES[v] for v in angles))
    return table_of("models.quality", rows, notes)


def qualities(models: tuple[FittedModel, ...]) -> tuple[Table, ...]:
    """`quality` of each campaign, with its name where there are several; the last one has the notes."""
    campaigns = tuple(dict.fromkeys(m.campaign for m in models))
    if len(campaigns) < 2:
        return (quality(models),)
    each = [(c, quality(tuple(m for m in models if m.campaign == c))) for c in campaigns]
    notes = tuple(dict.fromkeys(n for _, t in each for n in t.notes))
    return tuple(replace(t, title=f"{t.title}, {c}", notes=notes if c == campaigns[-1] else ()) for c, t in each)


MOST_POINTS = 5
LARGEST_MATRIX = 8
CLOSE, MOST_PAIRS = 0.9, 12


def influence(model: FittedModel) -> Table:
    """The points that move the fit most, by Cook's distance."""
    f = model.fit
    d = f.cooks_distance
    order = [int(i) for i in np.argsort(-np.nan_to_num(d), kind="stable")[:MOST_POINTS] if np.isfinite(d[i])]
    columns = (d, f.leverage, f.residuals, f.left_out)
    rows = ((model.labels[i], *(number(float(values[i]), 3) for values in columns)) for i in order)
    return table_of("models.influence", rows, response=model.response, campaign=model.campaign)


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
    words = f"{len(close)} of {len(pairs)} pairs lie beyond {CLOSE} in magnitude"
    notes = (f"{words}; the closest {MOST_PAIRS} are shown." if len(close) > MOST_PAIRS else f"{words}.",)
    return table_of("models.close_pairs", rows, notes, title=title)


def diagnostics(models: Sequence[FittedModel]) -> Table:
    """Influence, prediction, conditioning and the order of signs, one row a model."""
    rows = []
    for m in models:
        f = m.fit
        with_left_out = f.left_out[np.isfinite(f.left_out)]
        spread = variation(factorise(design(m.terms, m.x)), m.y)
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
    return table_of("models.diagnostics", rows)


NOT_AVAILABLE = "not available"


def campaigns(fits: Sequence[FitResult]) -> Table:
    """What every campaign adds to a joint fit, and how well the others predict it; no rows without a joint fit."""
    rows = tuple(row for f in fits for p in f.poolings for row in _rows(p))
    return table_of("models.campaigns", rows)


def _rows(p: Pooling) -> list[tuple[str, ...]]:
    out: list[tuple[str, ...]] = [
        (p.response, s.campaign, str(s.n_points), coefficient(s.intercept), coefficient(s.half_width), number(s.noise, 3),
         number(s.rms, 3), number(s.rms_alone, 3), _share(s.left_out), "")
        for s in p.shares
    ]  # fmt: skip
    n = sum(s.n_points for s in p.shares)
    whole = (sum(s.n_points * s.rms**2 for s in p.shares) / n) ** 0.5
    verdict = {None: NOT_AVAILABLE, True: f"rejected, {p.statistic}", False: p.statistic}[p.rejected]
    out.append(
        (p.response, "all", str(n), ABSENT, ABSENT, ABSENT, number(whole, 3), ABSENT, _share(p.every_third), verdict)
    )
    return out


def _share(seen: OutOfSample) -> str:
    return f"{100.0 * seen.rms:.2f} %" if seen.is_known else NOT_AVAILABLE

"""The coefficients of a study with their budget, a table a campaign; what symmetry makes zero in one line."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from coeflab.core.table import ABSENT, Table, percent
from coeflab.core.wording import in_sentences, listed
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.symbols import primed, read_factors
from coeflab.report.document import Section
from coeflab.report.tables import force_tables
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables import results as tables
from coeflab.report.tables.budgets import SET_IN_A_COMPUTATION, grid_of_some, sentences_on_open
from coeflab.report.texts import table_of, text_of, texts_of
from coeflab.study.study import Study
from coeflab.study.symmetry import zeros

SLOPES = (
    "A slope is the weighted median of many fits to the whole sweep (docs/slope_at_origin.md); no published value is used. n: points in its fit. "
    "U95, the half-width of the 95 % interval, covers {}; what it leaves out stands below each table. --full has its parts."
)

OPEN_SIGN = ", sign open"


def in_one_line(found: Sequence[Coefficient]) -> str:
    """Their names and how far from zero they may be; empty without any."""
    if not found:
        return ""
    most = max(abs(c.value or 0.0) + (c.u95 or 0.0) for c in found)
    return f"Zero by symmetry, and zero within U95: {listed([primed(c.symbol) for c in found])}; |value| + U95 is at most {most:.1e}."


def form_not_assessed(found: Sequence[Coefficient]) -> str:
    """Which intervals hold no error of the form, in one line; empty where all do."""
    without = [c for c in found if c.status is Status.FORM_ASSUMED and c.u95 is not None and c.parts.model_form is None]
    if not without:
        return ""
    end = " includes only the random and slope parts, not the error of the assumed force law."
    return in_sentences("U95 of ", [primed(c.symbol) for c in without], end, join=listed)


def _covered(study: Study, found: Sequence[Table]) -> tuple[str, ...]:
    """How slopes are found, what U95 covers of all and of some, and what an open sign means."""
    every, some = tables.covered(study)
    whole = SLOPES.format(listed([*every[1:], *every[0].split(", ")]))
    only = (in_sentences(f"It covers the {name} only for ", places) for name, places in some.items())
    has_open = any(OPEN_SIGN in cell for t in found for row in t.rows for cell in row)
    return (whole, *only, *((text_of("coefficients.open"),) if has_open else ()))


def coefficients_section(study: Study) -> Section:
    """What was found, by campaign; every column of it in the appendix."""
    is_swept = any(f.sweeps for f in study.fits)
    text: tuple[str, ...] = (
        () if is_swept else texts_of("coefficients.fixed") if study.coefficients else texts_of("coefficients.none")
    )
    result = {
        fit: t for fit in dict.fromkeys((f.campaign, f.body) for f in study.fits) if (t := _table(study, *fit)).rows
    }
    apart = {t.campaign for t in study.plan.tows if t.added is not None}
    found = tuple(t for (campaign, _), t in result.items() if campaign not in apart)
    text = _covered(study, found) if is_swept else text
    if any(c.status is Status.SINGLE_ESTIMATOR for c in study.coefficients):
        text += (text_of("coefficients.unbounded"),)
    if any(c.status is Status.FORM_REJECTED for c in study.coefficients):
        text += (Status.FORM_REJECTED.advice,)
    if apart:
        text += (text_of("coefficients.of_tows"),)
    whole = tables.coefficients(study)
    appendix = (
        (Section("all-coefficients", "All columns", texts_of("coefficients.parts"), (whole,), appendix=True),)
        if whole.rows
        else ()
    )
    return Section("coefficients", "Coefficients", text, found, subsections=appendix)


def _table(study: Study, campaign: str, body: str) -> Table:
    mine = [c for c in study.coefficients if c.campaign == campaign and c.status is not Status.NO_TABLE]
    zero = zeros(study, campaign, mine)
    order = {symbol: i for i, symbol in enumerate(study.plan.wanted)}
    tied = {
        c.symbol
        for f in study.fits
        if f.campaign == campaign and f.tied is not None
        for c in f.coefficients.coefficients
    }
    tied -= {s.symbol for f in study.fits if f.campaign == campaign for s in f.sweeps}
    shown = sorted((c for c in mine if c not in zero), key=lambda c: order.get(c.symbol, len(order)))
    rows = tuple(
        (
            primed(c.symbol), *noun_tables.with_status(c), f"{percent(c.u95, c.value)}{OPEN_SIGN * _is_open(c)}",
            str(c.n_points) if c.n_points else ABSENT,
        )
        for c in shown
    )  # fmt: skip
    budgets = [b for b in study.budgets if b.campaign == campaign]
    open_parts = dict.fromkeys(name for b in budgets for name in b.unassessed)
    held = any(b.part("grid") is not None for b in budgets)
    computed = bool(budgets) and all(b.kind == "cfd" for b in budgets)
    notes = [
        in_one_line(zero), form_not_assessed(shown), shorter_ranges(shown, tied),
        *sentences_on_open(grid_of_some(n, budgets, held) for n in open_parts if not (computed and n in SET_IN_A_COMPUTATION)),
        force_tables.unused([t for t in study.tables if t.campaign in campaign.split(", ")]), _wrong(study, campaign),
    ]  # fmt: skip
    return table_of(
        "coefficients.table", rows, tuple(n for n in notes if n), campaign=campaign, body=body.replace("_", " ")
    )


def shorter_ranges(found: Sequence[Coefficient], tied: Collection[str]) -> str:
    """Terms of force laws that end before a slope of their component over the same motion does, with their ends.

    Parameters
    ----------
    found : sequence of Coefficient
        Of one campaign.
    tied : collection of str
        Symbols of the terms.

    Returns
    -------
    str
        Empty without any.
    """
    windows = [(c, c.window_over or _motion(c.symbol), max(map(abs, c.window))) for c in found if c.window]
    reach = {(c.symbol[0], over): most for c, over, most in windows if c.symbol not in tied}
    by: dict[str, list[str]] = {}
    for c, over, most in windows:
        if c.symbol in tied and most < 0.99 * reach.get((c.symbol[0], over), 0.0):
            end = f"|{over}'| = {most:.3g}" if c.window_is_rate else f"{np.degrees(most):.3g} deg"
            by.setdefault(end, []).append(primed(c.symbol))
    each = [f"{listed(symbols)}, up to {end}" for end, symbols in by.items()]
    return in_sentences("Fitted to a shorter range: ", each) if each else ""


def _motion(symbol: str) -> str:
    """The first motion of a term's product, which its window is over."""
    return next((name for name, _ in read_factors(symbol.removesuffix("'")[1:]) or ()), "v")


def _is_open(c: Coefficient) -> bool:
    """Whether the data leave the sign of a value open."""
    return c.value is not None and c.u95 is not None and bool(abs(c.value) <= c.u95)


def _wrong(study: Study, campaign: str) -> str:
    """Rows that the fits of a campaign left out as they do not fit the others; empty without any."""
    found = [s for f in study.fits if f.campaign == campaign for s in f.sweeps if len(s.wrong)]
    each = [f"{', '.join(s.labels[i] for i in s.wrong)} ({primed(s.symbol)})" for s in found]
    return in_sentences("Left out by the fit, as they do not fit the other points: ", each) if each else ""

"""Fits carried out: what a fit is refused for, and its budgets in it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import input_error, words
from coeflab.fits import FITS, CompletingFit
from coeflab.fits.joint.moving import LEFT_OUT, fits_about
from coeflab.fits.joint.rows import joint_name
from coeflab.fits.results.fit_result import FitResult, Shared, covariance_of
from coeflab.fits.rows.sweeps import FEWEST_SETTINGS, arm_shift
from coeflab.fits.rows.too_few import FEW_ROWS
from coeflab.fits.uncertainty.budget import Budget, as_estimates, budgets_of, with_budget
from coeflab.fits.uncertainty.model_budget import with_model_budgets
from coeflab.law.coefficient import Status
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import MOTIONS, derivative, primed
from coeflab.tables.assumptions import carried
from coeflab.tables.force_table import AT_REST, ForceTable
from coeflab.tables.planar_motion import PlanarMotionTable

FEWEST = 3
COMBINES = "manoeuvring_model"  # the fit of rows that vary several motions at once


def fitted(
    name: str,
    tables: Sequence[ForceTable],
    scaling: Scaling,
    options: Mapping[str, Any],
    earlier: Sequence[FitResult] = (),
) -> tuple[FitResult, tuple[Budget, ...]]:
    """One fit with its budgets in it, and these; one that completes another is given that, budgets and all.

    Parameters
    ----------
    name : str
        Of the fit.
    tables : sequence of ForceTable
        Of one campaign, or of several where the fit joins them.
    scaling : Scaling
        Length of the primes.
    options : mapping of str to value
        Of the fit.
    earlier : sequence of FitResult
        That it may complete.
    """
    _refuse_several(name, tables)
    _refuse_unsuited(name, tables)

    def once(some: Sequence[ForceTable], by: Scaling) -> FitResult:
        with FITS.guarded(name):
            plugin = FITS.load(name)
            if isinstance(plugin, CompletingFit):
                own = [f for f in earlier if (f.fit, f.campaign) == (plugin.completes, tables[0].campaign)]
                if own:
                    return plugin.complete(own[-1], some, by, options)
            return plugin.fit(some, by, options)

    fit = once(tables, scaling)
    found = budgets_of(fit, {t.name: t for t in tables})
    fit, more = with_model_budgets(with_budget(fit, found), tables, scaling, once)
    assumed = carried([f for t in tables for f in t.findings], fit.coefficients.coefficients)
    fit = replace(fit, findings=(*fit.findings, *few_rows(fit, tables), *assumed))
    if all(t.source.kind == "estimate" for t in tables):
        return as_estimates(fit), tuple(replace(b, u95=None) for b in (*found, *more))
    return fit, (*found, *more)


def rejoined(
    fits: Sequence[FitResult],
    asked: Sequence[tuple[str, Sequence[ForceTable], Scaling, Mapping[str, Any]]],
    *,
    unnamed_alike: bool = False,
) -> tuple[FitResult, ...]:
    """Fits that lost slopes on their way to their point, brought there by what the other fits of the body measured.

    Rotating runs are fitted about the point where nothing drifts; alone, a fit takes to its point what its own campaign can move.

    Parameters
    ----------
    fits : sequence of FitResult
    asked : sequence of (str, sequence of ForceTable, Scaling, mapping)
        Of each: name of the fit, tables, scaling and options.
    unnamed_alike : bool
        Campaigns that name no body, whose body bears their own name, are of one.
    """
    out, joined = list(fits), list[int]()
    for i, f in enumerate(fits):
        given = {s for g in fits if _completes(g, f) for s in g.coefficients.available}
        if not set(_undetermined(f)) - given:
            continue
        name, tables, scaling, options = asked[i]
        point, first = f.coefficients.reference_point, tables[0]
        at = first.point if isinstance(first, PlanarMotionTable) else point + np.array([arm_shift(tables), 0.0, 0.0])
        rest = [
            k for k, g in enumerate(fits)
            if k != i and not _completes(g, f) and _of_one_body(f, g, unnamed_alike) and g.coefficients.datum == f.coefficients.datum
            and g.coefficients.scaling == f.coefficients.scaling
        ]  # fmt: skip
        own, _ = fitted(name, [t.about(at) for t in tables], scaling, options)
        here = fits_about([own, *(fits[k] for k in rest)], point)
        out[i] = here[0]
        joined.append(i)
        for k, g in zip(rest, here[1:], strict=True):
            if np.allclose(fits[k].coefficients.reference_point, point):
                shared = tuple(s for s in out[k].shared if (s.fit, s.campaign) != (f.fit, f.campaign))
                mine = tuple(s for s in g.shared if (s.fit, s.campaign) == (f.fit, f.campaign))
                out[k] = replace(out[k], shared=(*shared, *mine))
    for j, i in [(j, i) for j in joined for i, g in enumerate(fits) if _completes(g, fits[j])]:
        others = [
            h for h in out
            if h.campaign != out[j].campaign and (h.sweeps or h.tied) and _of_one_body(h, out[j], unnamed_alike) and _at_one_point(h, out[j])
        ]  # fmt: skip
        out[i] = _completed(out[j], others, *asked[i])
        out[j] = replace(out[j], findings=_without(out[j].findings, out[i].coefficients.available))
    return tuple(out)


def _at_one_point(a: FitResult, b: FitResult) -> bool:
    one, two = a.coefficients, b.coefficients
    return (
        one.datum == two.datum and one.scaling == two.scaling and np.allclose(one.reference_point, two.reference_point)
    )


def _completed(
    f: FitResult, others: Sequence[FitResult], name: str, tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]
) -> FitResult:  # fmt: skip
    """The law beyond slopes that were moved, beside what the other fits of the body know of the drift of its runs."""
    among = [f, *others]
    every = [c for g in among for c in g.coefficients.coefficients]
    own, speaks, symbols = len(f.coefficients.coefficients), dict[tuple[str, frozenset[str]], str](), dict[str, int]()
    for k, c in enumerate(every):
        d = derivative(c.symbol)
        if c.value is not None and speaks.setdefault((d.component, frozenset(d.factors)), str(c.campaign)) == str(
            c.campaign
        ):
            symbols.setdefault(c.symbol, k)
    taken = list(symbols.values())
    covariance = covariance_of(among)
    known = replace(
        f.coefficients, coefficients=tuple(every[k] for k in taken), covariance=covariance[np.ix_(taken, taken)]
    )
    law, _ = fitted(name, tables, scaling, options, [replace(f, coefficients=known)])
    if law.tied is None:
        return law
    spread = law.tied.moves @ np.nan_to_num(covariance[taken])
    ends = np.cumsum([0, *(len(g.coefficients.coefficients) for g in among)])
    shared = [Shared(g.fit, g.campaign, spread[:, a:b]) for g, a, b in zip(among, ends[:-1], ends[1:], strict=True)]
    mine = [at for at, k in enumerate(taken) if k < own]
    tied = replace(law.tied, symbols=tuple(law.tied.symbols[at] for at in mine), moves=law.tied.moves[:, mine])
    return replace(law, tied=tied, shared=tuple(shared))


def _without(findings: Sequence[Finding], given: Collection[str]) -> tuple[Finding, ...]:
    """What was left out, without what another fit gives."""
    out = []
    for f in findings:
        left = tuple(s for s in f["symbols"] if s.removesuffix("'") not in given) if f.code == LEFT_OUT else ()
        if left:
            facts = {fact.name: fact.value for fact in f.facts} | {"symbols": left}
            out.append(Finding.of(f.code, f.subject, f.severity, statistic=f.statistic, advice=f.advice, **facts))
        elif f.code != LEFT_OUT:
            out.append(f)
    return tuple(out)


def _completes(g: FitResult, f: FitResult) -> bool:
    """Its terms move with the coefficients of f where those are, about the point of both: no move brings them there again."""
    return g.tied is not None and (g.tied.fit, g.campaign) == (f.fit, f.campaign)


def _of_one_body(f: FitResult, g: FitResult, unnamed_alike: bool) -> bool:
    return f.body == g.body or (unnamed_alike and all(one.body == one.campaign for one in (f, g)))


def _undetermined(f: FitResult) -> list[str]:
    """Slopes that a fit has about its own point and not about its tables'."""
    own = [*(s.symbol for s in f.sweeps if s.value is not None), *(o.symbol for o in f.oscillations)]
    return [s for s in own if s in f.coefficients and f.coefficients[s].status is Status.NOT_DETERMINED]


def _refuse_several(name: str, tables: Sequence[ForceTable]) -> None:
    """Refuse several campaigns in a fit that knows nothing of their intercepts and scatter."""
    campaigns = joint_name(t.campaign for t in tables)
    if len({t.campaign for t in tables}) > 1 and not FITS.load(name).joins_campaigns:
        able = [n for n in FITS.usable() if FITS.load(n).joins_campaigns]
        raise InputError(f"{name} over the campaigns {campaigns}", f"a fit that joins campaigns: {', '.join(able)}",
                         column="fit", advice="Or fit each campaign by itself.")  # fmt: skip


def _refuse_unsuited(name: str, tables: Sequence[ForceTable]) -> None:
    """Refuse a fit of steady forces to oscillating runs, and the reverse."""
    with FITS.guarded(name):
        series = FITS.load(name).reads_series
    odd = next((t for t in tables if isinstance(t, PlanarMotionTable) != series), None)
    if odd is not None:
        what = "steady forces" if series else "oscillating runs"
        able = [n for n in FITS.usable() if FITS.load(n).reads_series != series]
        few = ", ".join(able) if len(able) < FEWEST else "slope_at_origin, tied_law or another fit of steady forces"
        raise InputError(f"{name} over {what}", f"fits of those: {few}", file=odd.name, column="fits")


def few_rows(fit: FitResult, tables: Sequence[ForceTable]) -> tuple[Finding, ...]:
    """Sweeps with fewer points than the simplest form has parameters, the rows that they have, and the fit of the others."""
    out = []
    odd = [s for s in fit.sweeps if s.parity == "odd" and s.value is None and len(s.x) < FEWEST_SETTINGS]
    for table, variable in dict.fromkeys((s.table, s.variable) for s in odd):
        own = [s for s in odd if (s.table, s.variable) == (table, variable)]
        longest = max(own, key=lambda s: len(s.x))
        combined = next((_combined(t) for t in tables if t.name == table), 0)
        joint = combined >= FEWEST_SETTINGS
        out.append(
            Finding.of(
                FEW_ROWS, table, Severity.WARN, statistic=len(longest.x), threshold=FEWEST_SETTINGS,
                advice=COMBINES if joint else f"{variable}'", by="combined" if joint else "alone", variable=f"{variable}'",
                combined=combined, rows=longest.labels, symbols=[primed(s.symbol) for s in own],
            )
        )  # fmt: skip
    return tuple(out)


def refuse_empty(fits: Sequence[FitResult]) -> None:
    """Refuse fits of which none has a number, for too few rows.

    Raises
    ------
    InputError
        With the table and the sweep that has too few.
    """
    few = [f for fit in fits for f in fit.findings if f.code == FEW_ROWS]
    swept = [s.value for fit in fits for s in fit.sweeps]
    numbers = [*swept, *(c.value for fit in fits for c in fit.coefficients.coefficients)]
    if not few or any(fit.models for fit in fits) or any(value is not None for value in numbers):
        return
    points, text = int(few[0].statistic or 0), words(few[0])
    raise input_error(
        "study.usable_point_sweep", few[0].subject, points=points, value="s" * (points != 1), few=few[0]["variable"],
        expected=text.rule, advice=text.advice,
    )  # fmt: skip


def _combined(table: ForceTable) -> int:
    """Rows in which more than one of v, w, p, q, r is not at rest."""
    sizes = [np.abs(table.motion[m]) for m in MOTIONS[1:]]
    moving = [size > AT_REST * float(np.max(size, initial=0.0)) for size in sizes]
    return int(np.sum(np.sum(moving, axis=0) > 1))

"""Coefficients beside those of others: published columns, campaigns, distances, verdicts."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from coeflab.core.provenance import work
from coeflab.core.table import ABSENT, Table, as_printed, coefficient, percent, plus_minus, with_u95
from coeflab.core.texts import remark
from coeflab.core.types import Array
from coeflab.core.wording import in_sentences, listed
from coeflab.law.coefficient import NAMED_STATUSES, Status
from coeflab.law.symbols import ANGLE_NAMES, primed
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables.results import NO_DATA
from coeflab.report.texts import table_of
from coeflab.study.study import Study
from coeflab.study.validation import WIDE
from coeflab.tables.force_table import ForceTable
from coeflab.vehicle.published_values import Comparison, Reference, Relation

VERDICTS = {True: "pass", False: "fail", None: "no verdict"}
WEAK = f"our U95 and the source's uncertainty together exceed {100.0 * WIDE:.0f} % of the published value"


def weight(c: Comparison) -> float:
    """Our U95 and the uncertainty that the source states, root sum of squares, over the published value; 0 without them."""
    return c.combined / abs(c.published) if c.combined and c.published else 0.0


def is_weak(c: Comparison) -> bool:
    """Whether a comparison passes that would also pass with a value far from the published one."""
    return bool(c.passed) and weight(c) > WIDE


def verdicts(study: Study) -> Table:
    """Ours against the authors' own evaluation of the same data: the only comparison with a verdict."""
    rows = [
        (
            primed(c.coefficient.symbol),
            c.coefficient.campaign or ABSENT,
            *with_u95(c.coefficient.value, c.coefficient.u95),
            c.shown or as_printed(c.published),
            *with_u95(None if c.difference is None else abs(c.difference), c.combined),
            "weak pass" if is_weak(c) else VERDICTS[c.passed],
            c.reference,
        )
        for c in study.comparisons
        if c.relation is Relation.RE_ANALYSIS
    ]
    return table_of(
        "comparisons.verdicts",
        rows,
        (
            *([f"weak pass: {WEAK} (root sum of squares)."] if any(row[-2] == "weak pass" for row in rows) else []),
            "combined: our U95 and the uncertainty that the source states, shown beside it; the verdict does not use it.",
        ),
        RE_ANALYSIS=Relation.RE_ANALYSIS,
        meaning=Relation.RE_ANALYSIS.meaning,
    )


def side_by_side(study: Study) -> Table:
    """The wanted coefficients beside every published column, lengths named; no verdict here."""
    columns = list(
        dict.fromkeys((c.reference, c.reading) for c in study.comparisons if c.relation is not Relation.RE_ANALYSIS)
    )
    twice = {name for name, _ in columns if sum(n == name for n, _ in columns) > 1}
    published_by: dict[tuple[str | None, str], dict[tuple[str, str], str]] = {}
    for result in study.comparisons:
        key = (result.coefficient.campaign, result.coefficient.symbol)
        published_by.setdefault(key, {})[result.reference, result.reading] = result.shown or as_printed(
            result.published
        )
    rows = []
    quoted = {r.body for r in study.references if r.relation is Relation.QUOTED}
    for symbol in study.plan.wanted:
        for c in study.coefficients:
            if c.symbol != symbol or not columns or c.body not in quoted:
                continue
            published = published_by.get((c.campaign, c.symbol), {})
            rows.append(
                (
                    primed(symbol),
                    c.campaign or ABSENT,
                    *((NO_DATA, ABSENT) if c.status is Status.NO_TABLE else noun_tables.with_status(c)),
                    percent(c.parts.random, c.value),
                    percent(c.parts.model_form, c.value),
                    *(published.get(k, ABSENT) for k in columns),
                )
            )
    given = {r.name for r in study.references if r.relation is Relation.QUOTED}
    names = tuple(
        f"{name}, read with {reading}" if name in twice else f"{name}, as quoted" if name in given else name
        for name, reading in columns
    )
    headers = ("", "campaign", "ours", "U95", "random", "form", *names)
    notes = [_published_in(r, quoted) for r in study.references if r.relation is not Relation.RE_ANALYSIS]
    if study.plan.tows and any(NO_DATA in row for row in rows):
        notes.insert(0, f"{NO_DATA}: no run of these campaigns varies the motion; our CFD is under Own CFD.")
    return Table("Our coefficients beside published ones", headers, tuple(rows), tuple(notes), frozenset({0, 1}))


def _published_in(r: Reference, ours: Collection[str]) -> str:
    """What a published column is, where it is printed and which body it is about."""
    inferred = [remark(f) for f in r.assumed]
    if r.relation is Relation.QUOTED:
        digits = "The first page has the digits of the test report itself."
        return " ".join(
            filter(None, (f"{r.name}, as quoted: {_printed_in(r)}. Body: {r.body}. {digits}", r.note, *inferred))
        )
    another = "by another method for the same body" if r.body in ours else "for another body"
    return " ".join(filter(None, (f"{r.name}: {another}, {r.body}. Source: {_printed_in(r)}.", r.note, *inferred)))


def _printed_in(r: Reference) -> str:
    """Where a reference is printed; of a work that is no key its text as well."""
    of = r.citation if work(r.citation) == r.citation else ""
    return ", ".join(filter(None, (of, r.place))) or r.citation


def campaigns(study: Study) -> Table:
    """What was tested or computed, a row a campaign, and the parameter files that use it; no rows for a single one."""
    towed_ones = {t.campaign for t in study.plan.tows}
    rows = []
    for name in dict.fromkeys(t.campaign for t in study.tables):
        mine = [t for t in study.tables if t.campaign == name]
        files = [
            p.name
            for p in study.parameter_files.values()
            if any(name in (c.campaign or "").split(", ") for c in p.coefficients)
        ]
        kinds = ", ".join(dict.fromkeys(t.source.kind for t in mine))
        bodies = ", ".join(dict.fromkeys(t.body for t in mine))
        varied = _varied(mine)
        speed = np.concatenate([np.atleast_1d(t.speed) for t in mine])
        known = [r for t in mine if (r := t.reynolds(t.scaling.length)) is not None]
        reynolds = _span(1e-6 * np.concatenate(known)) if known else ABSENT
        source = f"{kinds}, virtual tank" if name in towed_ones else kinds
        rows.append((name, bodies, source, varied, _span(speed), reynolds, ", ".join(files) or ABSENT))
    notes = []
    for body in dict.fromkeys(t.body for t in study.tables):
        configuration = study.body.configuration(body) if study.body else None
        if configuration is not None and configuration.title:
            notes.append(f"{body}: {configuration.title}")
    titled = {t.body for t in study.tables if study.body and study.body.configuration(t.body) is not None}
    notes += (
        [f"{t.body}: {t.name}" for t in study.plan.tows if t.added is None and t.body not in titled]
        if study.body
        else []
    )
    at = dict.fromkeys(f"{p.conditions.speed:.3g} m/s" for p in study.parameter_files.values())
    notes = [in_sentences("", notes)] if notes else []
    angles = [f"{c}: {ANGLE_NAMES[c]}" for c in ANGLE_NAMES if any(c in t.varies for t in study.tables)]
    notes += [f"{'; '.join(angles)}."] if angles else []
    computed = {t.campaign: work(t.source.citation) for t in study.tables if t.source.kind == "cfd"}
    notes += [
        f"{name} was not run in the virtual tank. Source: {text}"
        for name, text in computed.items()
        if towed_ones and name not in towed_ones
    ]
    notes += [f"Parameter files and manoeuvres are for {listed(list(at))}."] if at else []
    return table_of("comparisons.campaigns", rows if len(rows) > 1 else (), tuple(notes))


def _varied(tables: Sequence[ForceTable]) -> str:
    """Motions that runs vary, and those that only tables turned by symmetry do."""
    own, turned = (
        list(
            dict.fromkeys(
                m if m in t.controls else f"{m}'" for t in tables if bool(t.by_symmetry) is copied for m in t.varies
            )
        )
        for copied in (False, True)
    )
    more = [m for m in turned if m not in own]
    return ", ".join(own) + f" (by symmetry {', '.join(more)})" * bool(more)


def _span(values: Array) -> str:
    """A number of three digits, or the smallest and the largest."""
    low, high = (f"{float(x):.3g}" for x in (np.nanmin(values), np.nanmax(values)))
    return low if low == high else f"{low} .. {high}"


def by_campaign(study: Study) -> Table:
    """The wanted coefficients, one column a campaign: value and U95, or that there are no data; those of tows apart."""
    apart = {t.campaign for t in study.plan.tows if t.added is not None}
    campaigns = list(dict.fromkeys(f.campaign for f in study.fits if f.campaign not in apart))
    found = {(c.symbol, c.campaign): c for c in study.coefficients}
    rows = []
    for symbol in study.plan.wanted:
        cells = []
        for campaign in campaigns:
            c = found.get((symbol, campaign))
            if c is None or c.value is None:
                cells.append(NO_DATA if c is None or c.status is Status.NO_TABLE else noun_tables.without_value(c))
            else:
                without = f", {c.status.replace('_', ' ')}" if c.status in NAMED_STATUSES else ""
                cells.append(plus_minus(c.value, c.u95) + without)
        rows.append((primed(symbol), *cells))
    bodies = {f.campaign: f.body for f in study.fits}
    notes = tuple(f"{c}: {bodies[c]}" for c in campaigns)
    return Table("By campaign", ("", *campaigns), tuple(rows), notes, frozenset({0}))


def differences(study: Study) -> Table:
    """How far every published column lies from ours, in primed units and in multiples of our U95."""
    rows = tuple(
        (
            primed(c.coefficient.symbol),
            c.reference,
            c.reading,
            c.relation.value,
            coefficient(c.published),
            coefficient(abs(c.difference)),
            ABSENT if not c.coefficient.u95 else f"{abs(c.difference) / c.coefficient.u95:.2f}",
        )
        for c in study.comparisons
        if c.relation is not Relation.RE_ANALYSIS and c.difference is not None
    )
    notes = tuple(f"{r}: {r.meaning}." for r in (Relation.CROSS_BODY, Relation.QUOTED))
    return table_of("comparisons.differences", rows, notes)

"""Every table that is shown, built once for terminal, CSV and report."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.axes import point_in_words
from coeflab.core.finding import Severity
from coeflab.core.provenance import work
from coeflab.core.table import (
    ABSENT,
    Table,
    as_printed,
    coefficient,
    number,
    percent,
    plus_minus,
    probability,
    with_u95,
)
from coeflab.core.texts import remark, words
from coeflab.core.wording import in_sentences, listed
from coeflab.fits.rows.sweeps import arm_shift
from coeflab.law.coefficient import COVERS, Status
from coeflab.law.symbols import ANGLE_NAMES, primed
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables.sources import halves
from coeflab.study.towed import STATES
from coeflab.study.validation import WIDE
from coeflab.tables.assumptions import CODE, depends
from coeflab.vehicle.reference import Relation

if TYPE_CHECKING:
    from coeflab.core.finding import Finding
    from coeflab.core.table import (
        Check,
    )
    from coeflab.core.types import Array
    from coeflab.fits.results.fit_result import Sweep
    from coeflab.fits.results.straight_runs import StraightRuns
    from coeflab.fits.uncertainty.budget import Budget
    from coeflab.law.coefficient import Coefficient
    from coeflab.study.study import Study
    from coeflab.tables.force_table import Exclusion, ForceTable
    from coeflab.vehicle.reference import Comparison, Reference

NO_DATA, NO_VALUE = "no data", "no value"
NO_WORK = "none"  # as a citation
VERDICTS = {True: "pass", False: "fail", None: "no verdict"}
WEAK = f"our U95 and the source's uncertainty together exceed {100.0 * WIDE:.0f} % of the published value"


def coefficients(study: Study, campaign: str | None = None) -> Table:
    """Every coefficient with its uncertainty and how it was made.

    Parameters
    ----------
    study : Study
    campaign : str, optional
        Only the coefficients of one campaign.
    """
    chosen = [c for c in study.coefficients if campaign is None or c.campaign == campaign]
    result = noun_tables.coefficients(chosen, covers=covers(study, chosen))
    flags = [assumed_of(study, c) for c in chosen]
    rows = tuple((f"{row[0]}{FLAG}", *row[1:]) if found else row for row, found in zip(result.rows, flags, strict=True))
    phrases = tuple(
        f"{FLAG.strip()} {f.subject}: {words(f).statement}." for f in dict.fromkeys(f for some in flags for f in some)
    )
    return Table(result.title, result.headers, rows, (*phrases, *result.notes), result.left)


FLAG = " *"  # behind a coefficient that hangs on something which no source states


def assumed_of(study: Study, c: Coefficient) -> tuple[Finding, ...]:
    """What a coefficient of a study hangs on that no source states."""
    fits = [f for f in study.fits if f.campaign == c.campaign and c.value is not None]
    found = dict.fromkeys(one for f in fits for one in f.findings if one.code == CODE)
    return tuple(f for f in found if primed(c.symbol) in f["symbols"] and depends(f, c.symbol, c.table))


# What a table of coefficients does without where a line is too narrow, the first one first.
DROPPED = ("estimator", "campaign", "input", "n", "window", "random", "form")


def coefficients_in(study: Study, width: int = 80) -> Table:
    """`coefficients` for a line of that many letters: without columns of `DROPPED` as far as needed, and on one line what has no table.

    Parameters
    ----------
    study : Study
    width : int
        At least that of symbol, value and U95, which stay.
    """
    whole = coefficients(study)
    without = Status.NO_TABLE.replace("_", " ")
    rows = [row for row in whole.rows if row[1] != without] or list(whole.rows)
    campaigns = list(dict.fromkeys(row[whole.headers.index("campaign")] for row in rows))
    absent = list(dict.fromkeys(row[0] for row in whole.rows if row[1] == without)) * (len(rows) < len(whole.rows))
    chosen = list(range(len(whole.headers)))

    def needed() -> int:
        return sum(max(len(row[i]) for row in (whole.headers, *rows)) + 3 for i in chosen)

    gone = []
    for name in DROPPED if len(campaigns) < 2 else (*(n for n in DROPPED if n != "campaign"), "campaign"):
        if needed() <= width:
            break
        chosen.remove(whole.headers.index(name))
        gone.append(name)
    notes = [note for note in whole.notes if not (absent and note.startswith(without))]
    notes += [f"No table of the campaign varies the motion of {', '.join(absent)}."] if absent else []
    notes += [f"Not shown: {', '.join(gone)}; --wide shows all."] if gone else []
    of = f" of {campaigns[0]}" if len(campaigns) == 1 and "campaign" in gone and campaigns[0] != ABSENT else ""
    selected = tuple(tuple(row[i] for i in chosen) for row in rows)
    left = frozenset(chosen.index(i) for i in whole.left if i in chosen)
    title = whole.title.replace("Coefficients", f"Coefficients{of}", 1)
    return Table(title, tuple(whole.headers[i] for i in chosen), selected, tuple(notes), left)


def covers(study: Study, among: Collection[Coefficient] | None = None) -> str:
    """What U95 of slopes at the origin covers: the points and, as far as they entered, declared inputs, grid and other studies.

    Parameters
    ----------
    study : Study
    among : collection of Coefficient, optional
        Of these; by default of all. Others than slopes at the origin do not count.

    Returns
    -------
    str
        What entered only some of the slopes is followed by their symbols.
    """
    every, some = covered(study, among)
    return ", ".join((*every, *(f"{name} (only {'; '.join(places)})" for name, places in some.items())))


def covered(
    study: Study, among: Collection[Coefficient] | None = None
) -> tuple[tuple[str, ...], dict[str, tuple[str, ...]]]:
    """The same apart: what is in U95 of every slope, and what is in some, with their symbols by campaign."""
    slopes = [f.coefficients[s.symbol] for f in study.fits for s in f.sweeps if s.target == "x" and s.value is not None]
    wanted = {(c.campaign or "", c.symbol) for c in slopes if among is None or c in among}
    budgets = [b for b in study.budgets if (b.campaign, b.symbol) in wanted]
    entered: dict[str, list[Budget]] = {}
    for b in budgets:
        names = ["declared inputs"] * bool(b.inputs) + ["grid"] * (b.part("grid") is not None)
        for name in (*names, *(s.name for s in b.studies)):
            entered.setdefault(name, []).append(b)
    several = len({campaign for campaign, _ in wanted}) > 1
    every = tuple(name for name, those in entered.items() if len(those) == len(wanted))
    some = {name: _by_campaign(those, several=several) for name, those in entered.items() if name not in every}
    return (COVERS, *every), some


def _by_campaign(budgets: Sequence[Budget], *, several: bool) -> tuple[str, ...]:
    """Symbols of budgets, followed by their campaign where a study has several."""
    by: dict[str, dict[str, None]] = {}
    for b in budgets:
        by.setdefault(b.campaign if several else "", {})[primed(b.symbol)] = None
    return tuple(", ".join(symbols) + f" of {campaign}" * several for campaign, symbols in by.items())


def headline(study: Study, symbols: Sequence[str] = ()) -> str:
    """The slopes at the origin with U95 and what it covers, in one sentence; empty where there is none.

    Parameters
    ----------
    study : Study
    symbols : sequence of str
        Without prime; by default those that the plan wants, or all where it wants none that has a value.
    """
    found = [f.coefficients[s.symbol] for f in study.fits for s in f.sweeps if s.target == "x" and s.value is not None]
    found = [c for c in found if c.value is not None]
    chosen = [c for c in found if c.symbol in (symbols or study.plan.wanted)] or ([] if symbols else found)
    if not chosen:
        return ""
    by: dict[str, list[str]] = {}
    for c in chosen:
        by.setdefault(c.campaign or "", []).append(f"{primed(c.symbol)} = {plus_minus(c.value, c.u95)}")
    each = "; ".join(f"{campaign}: " * (len(by) > 1) + ", ".join(values) for campaign, values in by.items())
    return f"{each} (U95; covers {covers(study, chosen)})."


def resistances(study: Study) -> tuple[str, ...]:
    """X0' of straight runs with U95 and its trend with speed, a sentence a table."""
    return tuple(r.in_words for f in study.fits for r in f.straight)


def straight_runs(found: StraightRuns) -> Table:
    """Every straight run of a table: speed, Reynolds number, force and its prime."""
    reynolds = [ABSENT] * len(found.speed) if found.reynolds is None else [number(1e-6 * r, 4) for r in found.reynolds]
    rows = zip(found.labels, found.speed, reynolds, found.force, found.primes, strict=True)
    cells = tuple((label, number(u, 4), re, number(x, 4), coefficient(prime)) for label, u, re, x, prime in rows)
    heads = ("run", "U m/s", "Re in millions", "X N", "X / (1/2 rho U^2 L^2)")
    return Table(f"Straight runs of {found.table}", heads, cells, (), frozenset({0}))


def primed_about(study: Study) -> str:
    """By which length the coefficients are primed, and about which point."""
    by: dict[str, None] = {}
    for f in study.fits:
        c = f.coefficients
        if c.conditions is not None or not c.coefficients:
            continue
        point = point_in_words(c.reference_point, c.datum)
        by[f"{c.scaling.length_name} = {c.scaling.length:.5g} m, about {point}"] = None
    lines = [f"Primed by {'; by '.join(by)}."] if by else []
    return " ".join([*lines, *halves(study)])


def lost_by_move(study: Study) -> tuple[str, ...]:
    """Slopes that a campaign gives about another point than the study's, and what their move lacks; a sentence a campaign."""
    out = []
    for f in study.fits:
        lost = [s.symbol for s in f.sweeps if s.value is not None and f.coefficients[s.symbol].value is None]
        own = [t for t in study.tables if t.campaign == f.campaign]
        slopes = [s for s in lost if s[1:] in ("r", "q")]
        if not slopes or not own or not (shift := arm_shift(own)):
            continue
        turning = {s[1:] for s in slopes}
        needed = [*(("Yv", "Nv") if "r" in turning else ()), *(("Zw", "Mw") if "q" in turning else ())]
        at = own[0].reference_point + np.array([shift, 0.0, 0.0])
        stated = all(t.arm_point is not None for t in own if {"q", "r"} & set(t.varies))
        out.append(
            f"{listed([primed(s) for s in slopes])}: velocities of {f.campaign} are at {point_in_words(at, own[0].datum)}, {abs(shift):.3g} m "
            f"{'ahead' if shift > 0.0 else 'aft'} of the study's point: {'' if stated else 'state arm_point, or '}give the drift runs "
            f"beside it, for a move takes its {listed([primed(n) for n in needed])}."
        )
    return tuple(out)


def answers(study: Study) -> tuple[str, ...]:
    """Which rows are for a grid study only, whether a finer grid is needed, the rate of self-propulsion; a sentence each."""
    found = [
        c for c in study.checks if c.name in ("grids", "propeller") and c.severity in (Severity.NOTE, Severity.PASS)
    ]
    several = len({c.subject for c in found}) > 1
    return tuple(f"{f'{c.subject}: ' * several}{c.statistic}." for c in found)


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
    headers = ("", "campaign", "ours", "U95", "published", "|difference|", "combined", "verdict", "reference")
    notes = (
        f"{Relation.RE_ANALYSIS}: {Relation.RE_ANALYSIS.meaning}.",
        *([f"weak pass: {WEAK} (root sum of squares)."] if any(row[-2] == "weak pass" for row in rows) else []),
        "combined: our U95 and the uncertainty that the source states, shown beside it; the verdict does not use it.",
    )
    return Table(
        "Re-analyses: our fits against the authors' own evaluation",
        headers,
        tuple(rows),
        notes,
        frozenset({0, 1, 7, 8}),
    )


def side_by_side(study: Study) -> Table:
    """The wanted coefficients beside every published column, lengths named; no verdict here."""
    columns = list(
        dict.fromkeys((c.reference, c.reading) for c in study.comparisons if c.relation is not Relation.RE_ANALYSIS)
    )
    twice = {name for name, _ in columns if sum(n == name for n, _ in columns) > 1}
    beside: dict[tuple[str | None, str], dict[tuple[str, str], str]] = {}
    for result in study.comparisons:
        key = (result.coefficient.campaign, result.coefficient.symbol)
        beside.setdefault(key, {})[result.reference, result.reading] = result.shown or as_printed(result.published)
    rows = []
    quoted = {r.body for r in study.references if r.relation is Relation.QUOTED}
    for symbol in study.plan.wanted:
        for c in study.coefficients:
            if c.symbol != symbol or not columns or c.body not in quoted:
                continue
            published = beside.get((c.campaign, c.symbol), {})
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
    headers = ("campaign", "body", "source", "varied", "speed m/s", "Re in millions", "parameter file")
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
    title = "What was tested and computed"
    return Table(title, headers, tuple(rows) if len(rows) > 1 else (), tuple(notes), frozenset({0, 1, 2, 3, 6}))


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
                without = ", form rejected" if c.status is Status.FORM_REJECTED else ""
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
    headers = ("", "column", "read with", "relation", "published", "|difference|", "in U95")
    notes = tuple(f"{r}: {r.meaning}." for r in (Relation.CROSS_BODY, Relation.QUOTED))
    return Table("Distance of the published columns", headers, rows, notes, frozenset({0, 1, 2, 3}))


def _window(sweep: Sweep, value: float) -> str:
    if sweep.is_angle:
        return f"{math.degrees(math.asin(min(value, 1.0))):.1f} deg"
    if sweep.variable in ("dr", "ds", "db"):
        return f"{math.degrees(value):.1f} deg"
    return number(value, 3)


def _angle(sweep: Sweep) -> str:
    """The angle that a window is of; empty where the variable is that of a control or a rate."""
    return f"asin({sweep.variable}/U)" if sweep.is_angle else ""


def estimators(sweep: Sweep) -> Table:
    """Single forms in every window: what plain evaluations would have said."""
    rows = tuple(
        (
            e.family.name.format(x=f"{sweep.variable}'"), _window(sweep, e.window), str(len(e.rows)),
            *with_u95(e.value, e.half_hc2), with_u95(e.value, e.half_hc3)[1], number(e.freedom, 3),
            probability(e.lack_of_fit), number(e.aicc, 5),
        )
        for e in sweep.forms
    )  # fmt: skip
    notes = (
        "Each trusts its form; none is the recommended value. HC2 with Bell-McCaffrey degrees of freedom (dof), HC3 with "
        "n - p; lack of fit: probability by chance.",
        *([f"Window: largest {_angle(sweep)}."] if _angle(sweep) else []),
    )
    headers = ("form", "window", "n", "value", "95 % HC2", "95 % HC3", "dof", "lack of fit", "AICc")
    return Table(f"Other forms for {primed(sweep.symbol)}", headers, rows, notes, frozenset({0}))


def sensitivity(sweep: Sweep) -> Table:
    """The recommended value had the sweep ended sooner."""
    rows = tuple((_window(sweep, s.cap), *with_u95(s.value, s.u95), percent(s.u95, s.value)) for s in sweep.sensitivity)
    headers = ("largest setting", "value", "U95", "U95 %")
    title = f"{primed(sweep.symbol)} by largest setting" + (f", {_angle(sweep)}" if _angle(sweep) else "")
    return Table(title, headers, rows, (), frozenset({0}))


def left_out(sweep: Sweep) -> Table:
    """Points that the sweep does not use."""
    rows = tuple((p.label, signed(sweep, p.x), coefficient(p.y), p.reason) for p in sweep.left_out)
    headers = ("point", sweep.variable, f"{sweep.component}'", "reason")
    return Table(f"Points left out of {primed(sweep.symbol)}", headers, rows, (), frozenset({0, 3}))


def signed(sweep: Sweep, x: float) -> str:
    """A setting of a sweep as people write it, with its sign: degrees, or a rate."""
    return ("-" if x < 0 else "") + _window(sweep, abs(x))


def checks(found: Sequence[Check]) -> Table:
    """All findings, the grave ones first."""
    order = ["fail", "warn", "note", "pass"]
    rows = tuple(
        (c.severity.value, c.name.replace("_", " "), c.subject, c.statistic, c.rule, c.comment)
        for c in sorted(found, key=lambda c: order.index(c.severity))
    )
    headers = ("", "check", "subject", "found", "rule", "meaning")
    return Table("Checks", headers, rows, (), frozenset(range(6)))


def warnings(found: Sequence[Check]) -> Table:
    """Findings without rules, of their meaning the first sentence; one that several of a check share stands once."""
    whole = without(checks(found), "rule")
    rows: list[tuple[str, ...]] = []
    meant: set[tuple[str, str]] = set()
    for row in whole.rows:
        first = row[4].partition(". ")[0].removesuffix(".")
        rows.append((*row[:4], "as above" if (row[1], first) in meant else f"{first}." * bool(first)))
        meant.add((row[1], first))
    return replace(whole, title="Failures and warnings", rows=tuple(rows))


def provenance(study: Study) -> Table:
    """Every file that went in, by its sha256."""
    rows = tuple((f.name, f.sha256) for f in study.inputs)
    return Table("Inputs", ("file", "sha256"), rows, (), frozenset({0, 1}))


def works(study: Study) -> tuple[tuple[str, str], ...]:
    """Key and text of every work that was used, in the order of its first use."""
    keys = [t.source.citation for t in study.tables] + [k for f in study.fits for k in f.citations]
    keys += [r.citation for r in study.references] + ([study.body.source.citation] if study.body else [])
    keys += [k for found in study.hulls.values() for k in found.citations]
    keys += ["feldman1979"] if study.parameter_files else []
    keys += [k for result in study.exports for k in result.citations]
    keys += [k for result in study.manoeuvres for k in result.citations]
    keys += ["sname1950", "roddy1990"]  # axes, symbols and the sense of control angles, under Conventions
    return tuple((k, work(k)) for k in dict.fromkeys(keys) if k != NO_WORK)


def sources_of_numbers(study: Study) -> frozenset[str]:
    """Keys of the works whose numbers a study uses or is compared with."""
    keys = {t.source.citation for t in study.tables} | {r.citation for r in study.references} | {"sname1950"}
    return frozenset(keys | ({study.body.source.citation} if study.body else set()))


def _of(components: Sequence[str], table: ForceTable) -> str:
    whole = "" in components or (len(components) > 1 and set(components) >= set(table.forces))
    return "row" if whole else " ".join(components)


def unused_rows(table: ForceTable) -> list[str]:
    """Every row, or component of one, that no fit uses, by the reason."""
    by: dict[str, dict[int, list[str]]] = {}
    for e in table.exclusions:
        by.setdefault(e.reason, {}).setdefault(e.row, []).append(e.component)
    out = []
    for reason, rows in by.items():
        names = [
            table.labels[row] + (f" {of}" if (of := _of(list(dict.fromkeys(c)), table)) != "row" else "")
            for row, c in rows.items()
        ]
        out.append(f"{', '.join(names)}: {reason}")
    return out


NAMED = 12  # rows that a line names; of more the first


def unused(tables: Sequence[ForceTable]) -> str:
    """In one line the rows that no fit uses, or not whole, because their source or the state of their run says so; empty without such."""
    by: dict[str, list[str]] = {}
    parts = False
    files = [t.name.rpartition("/")[2] for t in tables]
    campaigns = [t.campaign for t in tables]
    short = {
        t.name: file if files.count(file) == 1 else t.campaign if campaigns.count(t.campaign) == 1 else t.name
        for t, file in zip(tables, files, strict=True)
    }
    for t in tables:
        rows: dict[int, list[Exclusion]] = {}
        for e in t.exclusions:
            if e.of_source:
                rows.setdefault(e.row, []).append(e)
        for row, found in rows.items():
            components = list(dict.fromkeys(e.component for e in found))
            of = "row" if set(components) >= set(t.forces) else _of(components, t)
            first = found[0]
            kind = first.status or ("marked uncertain in the file" if first.uncertain else first.reason)
            name = t.labels[row] + f" of {short[t.name]}" * (len(tables) > 1)
            parts |= of != "row"
            by.setdefault(kind, []).append(name if of == "row" else f"{name} {of}")
    phrases = [
        f"{', '.join(rows[:NAMED])}{f' and {len(rows) - NAMED} more' * (len(rows) > NAMED)}: {STATES.get(why, why).replace(': ', ', ')}"
        for why, rows in by.items()
    ]
    what = "Readings left out (point, components)" if parts else "Points left out"
    return in_sentences(f"{what}: ", phrases) if phrases else ""


def inspected(table: ForceTable, most: int = 0) -> Table:
    """What a force table holds, row by row, in SI and FRD; of more than ``most`` rows the first and last."""
    motions = [m for m in ("u", "v", "w", "p", "q", "r") if m == "u" or m in table.varies]
    headers = ["", *(f"{m} [{'m/s' if m in 'uvw' else 'rad/s'}]" for m in motions)]
    headers += [f"{c} [rad]" for c in table.controls]
    headers += [f"{c} [{'N*m' if c in 'KMN' else 'N'}]" for c in table.forces]
    rows = []
    left_out = range(most - most // 3, len(table) - most // 3) if 0 < most < len(table) else range(0)
    for i in (i for i in range(len(table)) if i not in left_out):
        cells = [table.labels[i], *(number(float(table.motion[m][i]), 5) for m in motions)]
        cells += [number(float(a[i]), 4) for a in table.controls.values()]
        for c, values in table.forces.items():
            text = number(float(values[i]), 5)
            cells.append(text if table.usable[c][i] else f"({text})")
        rows.append(tuple(cells))
    by_row: dict[tuple[int, int], dict[str, list[str]]] = {}
    for e in table.exclusions:
        by_row.setdefault((e.row, e.line), {}).setdefault(e.reason, []).append(e.component)
    excluded = []
    for (row, line), reasons in by_row.items():
        place = table.labels[row] + f" (line {line})" * (table.labels.count(table.labels[row]) > 1)
        phrases = "; ".join(f"{_of(components, table)}: excluded, {reason}" for reason, components in reasons.items())
        excluded.append(f"{place}, {phrases}")
    notes = [
        *excluded[: most or None],
        *([f"{len(excluded) - most} more are excluded"] if 0 < most < len(excluded) else []),
    ]
    if left_out:
        notes.insert(0, f"{len(left_out)} of {len(table)} rows are not shown; --rows 0 shows all")
    spare = (headers[1],) if len(motions) > 1 or table.controls else ()
    return Table(
        f"{table.name}: SI, FRD",
        tuple(headers),
        tuple(rows),
        (*(["(...) excluded from fits"] if excluded else ()), *notes),
        frozenset({0}),
        spare,
    )


def without(table: Table, *names: str) -> Table:
    """The table without some columns, and without the notes on them."""
    selected = [i for i, header in enumerate(table.headers) if header not in names]
    rows = tuple(tuple(row[i] for i in selected) for row in table.rows)
    notes = tuple(n for n in table.notes if not n.startswith(tuple(f"{name}:" for name in names)))
    left = frozenset(selected.index(i) for i in table.left if i in selected)
    return Table(table.title, tuple(table.headers[i] for i in selected), rows, notes, left)

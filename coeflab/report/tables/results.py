"""Every table that is shown, built once for terminal, CSV and report."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.axes import point_in_words
from coeflab.core.finding import Finding, Severity
from coeflab.core.provenance import work
from coeflab.core.table import ABSENT, Check, Table, coefficient, number
from coeflab.core.texts import words
from coeflab.core.wording import collected, listed
from coeflab.fits.rows.sweeps import arm_shift
from coeflab.law.coefficient import COVERS, Coefficient, Status
from coeflab.law.symbols import primed
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables.sources import halves
from coeflab.report.texts import table_of
from coeflab.study.checks import CHECKS
from coeflab.tables.assumptions import CODE, FLAG, depends

if TYPE_CHECKING:
    from coeflab.fits.results.straight_runs import StraightRuns
    from coeflab.study.study import Study

NO_DATA, NO_VALUE = "no data", "no value"
NO_WORK = "none"  # as a citation


def coefficients(study: Study, campaign: str | None = None) -> Table:
    """Every coefficient with its uncertainty and how it was made.

    Parameters
    ----------
    study : Study
    campaign : str, optional
        Only the coefficients of one campaign.
    """
    return _coefficients(study, [c for c in study.coefficients if campaign is None or c.campaign == campaign])


def _coefficients(study: Study, chosen: Sequence[Coefficient]) -> Table:
    result = noun_tables.coefficients(chosen, covers=covers(study, chosen))
    flags = [assumed_of(study, c) for c in chosen]
    rows = tuple((f"{row[0]}{FLAG}", *row[1:]) if found else row for row, found in zip(result.rows, flags, strict=True))
    phrases = tuple(
        f"{FLAG.strip()} {f.subject}: {words(f).statement}." for f in dict.fromkeys(f for some in flags for f in some)
    )
    return Table(result.title, result.headers, rows, (*phrases, *result.notes), result.left)


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
    tabled = [c for c in study.coefficients if c.status is not Status.NO_TABLE]
    absent = dict.fromkeys(primed(c.symbol) for c in study.coefficients if c.status is Status.NO_TABLE and tabled)
    whole = _coefficients(study, tabled or study.coefficients)
    campaigns = list(dict.fromkeys(row[whole.headers.index("campaign")] for row in whole.rows))
    chosen = list(range(len(whole.headers)))

    def needed() -> int:
        return sum(max(len(row[i]) for row in (whole.headers, *whole.rows)) + 3 for i in chosen)

    gone = []
    for name in DROPPED if len(campaigns) < 2 else (*(n for n in DROPPED if n != "campaign"), "campaign"):
        if needed() <= width:
            break
        chosen.remove(whole.headers.index(name))
        gone.append(name)
    notes = [*whole.notes]
    notes += [f"No table of the campaign varies the motion of {', '.join(absent)}."] if absent else []
    notes += [f"Not shown: {', '.join(gone)}; --wide shows all."] if gone else []
    of = f" of {campaigns[0]}" if len(campaigns) == 1 and "campaign" in gone and campaigns[0] != ABSENT else ""
    title = whole.title.replace("Coefficients", f"Coefficients{of}", 1)
    return replace(whole, title=title, notes=tuple(notes)).only(chosen)


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
    entered = collected(
        (name, b)
        for b in budgets
        for name, has in (
            ("declared inputs", b.inputs),
            *((n, b.part(n)) for n in ("grid", *(s.name for s in b.studies))),
        )
        if has
    )
    several = len({campaign for campaign, _ in wanted}) > 1
    every = tuple(name for name, those in entered.items() if len(those) == len(wanted))
    some = {}
    for name in (name for name in entered if name not in every):
        by = collected((b.campaign if several else "", primed(b.symbol)) for b in entered[name])
        some[name] = tuple(", ".join(dict.fromkeys(s)) + f" of {c}" * several for c, s in by.items())
    return (COVERS, *every), some


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
    by = collected((c.campaign or "", c.said) for c in chosen)
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
    return table_of("results.straight_runs", cells, table=found.table)


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


def undetermined_by_move(study: Study) -> tuple[str, ...]:
    """Slopes that a campaign gives about another point than the study's, and what their move lacks; a sentence a campaign."""
    out = []
    for f in study.fits:
        undetermined = [s.symbol for s in f.sweeps if s.value is not None and f.coefficients[s.symbol].value is None]
        own = [t for t in study.tables if t.campaign == f.campaign]
        slopes = [s for s in undetermined if s[1:] in ("r", "q")]
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
    found = [c for c in study.checks if c.severity in (Severity.NOTE, Severity.PASS) and c.name in CHECKS.names()]
    found = [c for c in found if CHECKS.load(c.name).answers]
    several = len({c.subject for c in found}) > 1
    return tuple(f"{f'{c.subject}: ' * several}{c.statistic}." for c in found)


def checks(found: Sequence[Check]) -> Table:
    """All findings, the grave ones first."""
    order = ["fail", "warn", "note", "pass"]
    rows = tuple(
        (c.severity.value, c.name.replace("_", " "), c.subject, c.statistic, c.rule, c.comment)
        for c in sorted(found, key=lambda c: order.index(c.severity))
    )
    return table_of("results.checks", rows)


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
    return table_of("results.provenance", rows)


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


def without(table: Table, *names: str) -> Table:
    """The table without some columns, and without the notes on them."""
    selected = table.only([i for i, header in enumerate(table.headers) if header not in names])
    notes = tuple(n for n in table.notes if not n.startswith(tuple(f"{name}:" for name in names)))
    return replace(selected, notes=notes, spare=())

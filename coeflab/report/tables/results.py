"""Every table that is shown, built once for terminal, CSV and report."""

from __future__ import annotations

import math

from coeflab.core.provenance import work
from coeflab.core.table import ABSENT, Table, coefficient, number, percent, probability
from coeflab.fits.results.fit_result import Sweep
from coeflab.fits.statistics.slopes import MEMBER, Estimate
from coeflab.law.symbols import primed
from coeflab.report.tables import nouns as noun_tables
from coeflab.study.study import Study
from coeflab.tables.force_table import ForceTable
from coeflab.vehicle.reference import Relation

VERDICTS = {True: "pass", False: "fail", None: "no verdict"}


def coefficients(study: Study, campaign: str | None = None) -> Table:
    """Every coefficient with its uncertainty and how it was made.

    Parameters
    ----------
    study : Study
    campaign : str, optional
        Only the coefficients of one campaign.
    """
    return noun_tables.coefficients([c for c in study.coefficients if campaign is None or c.campaign == campaign])


def verdicts(study: Study) -> Table:
    """Ours against the authors' own evaluation of the same data: the only comparison with a verdict."""
    rows = [
        (
            primed(c.coefficient.symbol),
            c.coefficient.campaign or ABSENT,
            coefficient(c.coefficient.value),
            coefficient(c.coefficient.u95),
            coefficient(c.published),
            coefficient(None if c.difference is None else abs(c.difference)),
            coefficient(c.combined),
            VERDICTS[c.passed],
            c.reference,
        )
        for c in study.comparisons
        if c.relation is Relation.RE_ANALYSIS
    ]
    headers = ("", "campaign", "coeflab", "U95", "published", "|difference|", "combined", "verdict", "reference")
    notes = (
        f"{Relation.RE_ANALYSIS}: {Relation.RE_ANALYSIS.meaning}.",
        "combined: our U95 and the uncertainty that the source states, shown beside it; the verdict does not use it.",
    )
    return Table("Re-analysis of published evaluations", headers, tuple(rows), notes, frozenset({0, 1, 7, 8}))


def side_by_side(study: Study) -> Table:
    """The wanted coefficients beside every published column, lengths named; no verdict here."""
    columns = list(
        dict.fromkeys((c.reference, c.reading) for c in study.comparisons if c.relation is not Relation.RE_ANALYSIS)
    )
    twice = {name for name, _ in columns if sum(n == name for n, _ in columns) > 1}
    beside: dict[tuple[str | None, str], dict[tuple[str, str], float]] = {}
    for made in study.comparisons:
        key = (made.coefficient.campaign, made.coefficient.symbol)
        beside.setdefault(key, {})[made.reference, made.reading] = made.published
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
                    coefficient(c.value) if c.value is not None else c.status.replace("_", " "),
                    noun_tables.REJECTED if c.status == noun_tables.REJECTED_STATUS else coefficient(c.u95),
                    percent(c.parts.random, c.value),
                    percent(c.parts.model_form, c.value),
                    *(coefficient(published.get(k)) if k in published else ABSENT for k in columns),
                )
            )
    names = tuple(f"{name}, read with {reading}" if name in twice else name for name, reading in columns)
    headers = ("", "campaign", "coeflab", "U95", "random", "form", *names)
    notes = tuple(
        f"{r.name}: {r.relation}, {r.place}. {r.body}. {r.note}".strip()
        for r in study.references
        if r.relation is not Relation.RE_ANALYSIS
    )
    return Table("Side by side with the published table", headers, tuple(rows), notes, frozenset({0, 1}))


def by_campaign(study: Study) -> Table:
    """The wanted coefficients, one column a campaign: value and U95, or that no table gives them."""
    campaigns = list(dict.fromkeys(f.campaign for f in study.fits))
    found = {(c.symbol, c.campaign): c for c in study.coefficients}
    rows = []
    for symbol in study.plan.wanted:
        cells = []
        for campaign in campaigns:
            c = found.get((symbol, campaign))
            if c is None or c.value is None:
                cells.append("no table" if c is None else c.status.replace("_", " "))
            else:
                without = f", {c.status.replace('_', ' ')}" if c.status == noun_tables.REJECTED_STATUS else ""
                cells.append(coefficient(c.value) + (without if c.u95 is None else f" +- {coefficient(c.u95)}"))
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


def _estimate(sweep: Sweep, e: Estimate, role: str) -> tuple[str, ...]:
    return (
        e.family.name.format(x=f"{sweep.variable}'"),
        _window(sweep, e.window),
        str(len(e.rows)),
        coefficient(e.value),
        coefficient(e.half_hc2),
        coefficient(e.half_hc3),
        number(e.freedom, 3),
        probability(e.lack_of_fit),
        number(e.aicc, 5),
        probability(e.next_term),
        role,
    )


ESTIMATES = (
    "form", "window", "n", "value", "95 % HC2", "95 % HC3", "dof", "lack of fit", "AICc", "next term", "role",
)  # fmt: skip


def members(sweep: Sweep) -> Table:
    """Each family's last window of the rule, what became of it, and its bootstrap intervals."""
    rows = []
    for e in sweep.recommendation.panel:
        if e.role in ("smaller window", "beyond the window"):
            continue
        b = sweep.bootstrap.get(e.family.name) if e.role == MEMBER else None
        pairs = f"{coefficient(b.pairs[0])} .. {coefficient(b.pairs[1])}" if b else ABSENT
        wild = f"{coefficient(b.wild[0])} .. {coefficient(b.wild[1])}" if b else ABSENT
        rows.append((*_estimate(sweep, e, e.role), pairs, wild))
    notes = (
        "HC2 with Bell-McCaffrey degrees of freedom (dof), HC3 with n - p; lack of fit, next term: probabilities by "
        "chance; pairs, wild: 95 % percentile intervals of the bootstrap.",
    )
    return Table(
        f"Members for {primed(sweep.symbol)}", (*ESTIMATES, "pairs", "wild"), tuple(rows), notes, frozenset({0, 10})
    )


def estimators(sweep: Sweep) -> Table:
    """Single estimators without nuisance terms in every window: what a plain evaluation would have said."""
    rows = tuple(_estimate(sweep, e, "")[:9] for e in sweep.plain)
    return Table(f"Single estimators for {primed(sweep.symbol)}", ESTIMATES[:9], rows, (), frozenset({0}))


def sensitivity(sweep: Sweep) -> Table:
    """How the recommendation moves with the largest window allowed."""
    rows = tuple(
        (_window(sweep, s.cap), coefficient(s.value), coefficient(s.u95), percent(s.u95, s.value))
        for s in sweep.sensitivity
    )
    headers = ("largest window", "value", "U95", "U95")
    return Table(f"{primed(sweep.symbol)} against the largest window", headers, rows, (), frozenset({0}))


def left_out(sweep: Sweep) -> Table:
    """Points that the sweep does not use."""
    rows = tuple((p.label, _signed(sweep, p.x), coefficient(p.y), p.reason) for p in sweep.left_out)
    headers = ("point", sweep.variable, f"{sweep.component}'", "reason")
    return Table(f"Points left out of {primed(sweep.symbol)}", headers, rows, (), frozenset({0, 3}))


def _signed(sweep: Sweep, x: float) -> str:
    return ("-" if x < 0 else "") + _window(sweep, abs(x))


def checks(study: Study) -> Table:
    """All findings, the grave ones first."""
    order = ["fail", "warn", "note", "pass"]
    rows = tuple(
        (c.severity.value, c.name.replace("_", " "), c.subject, c.statistic, c.rule, c.comment)
        for c in sorted(study.checks, key=lambda c: order.index(c.severity))
    )
    headers = ("", "check", "subject", "found", "rule", "meaning")
    return Table("Checks", headers, rows, (), frozenset(range(6)))


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
    keys += [k for made in study.exports for k in made.citations]
    keys += [k for made in study.manoeuvres for k in made.citations]
    keys += ["sname1950", "roddy1990"]  # axes, symbols and the sense of control angles, under Conventions
    return tuple((k, work(k)) for k in dict.fromkeys(keys))


def inspected(table: ForceTable) -> Table:
    """What a force table holds, row by row, in SI and FRD."""
    motions = [m for m in ("u", "v", "w", "p", "q", "r") if m == "u" or m in table.varies]
    headers = ["", *(f"{m} [{'m/s' if m in 'uvw' else 'rad/s'}]" for m in motions)]
    headers += [f"{c} [rad]" for c in table.controls]
    headers += [f"{c} [{'N*m' if c in 'KMN' else 'N'}]" for c in table.forces]
    rows = []
    for i in range(len(table)):
        cells = [table.labels[i], *(number(float(table.motion[m][i]), 5) for m in motions)]
        cells += [number(float(a[i]), 4) for a in table.controls.values()]
        for c, values in table.forces.items():
            text = number(float(values[i]), 5)
            cells.append(text if table.usable[c][i] else f"({text})")
        rows.append(tuple(cells))
    notes = tuple(f"line {e.line}, {e.component or 'row'}: excluded, {e.reason}" for e in table.exclusions)
    return Table(
        f"{table.name}: SI, FRD", tuple(headers), tuple(rows), ("(...) excluded from fits", *notes), frozenset({0})
    )

"""What stands below the rows of a first page: whose fits and whose values they are, what U95 leaves out, what is independent."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.axes import point_in_words
from coeflab.core.provenance import work
from coeflab.core.types import dataclass
from coeflab.core.wording import collected, in_sentences, listed
from coeflab.fits.glide_polar import munk_in_words
from coeflab.fits.uncertainty.budget import RIG
from coeflab.law.coefficient import CoefficientSet
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import primed
from coeflab.report.document import AnswerRow
from coeflab.report.tables.budgets import SET_IN_A_COMPUTATION
from coeflab.report.tables.results import undetermined_by_move
from coeflab.report.tables.sources import halves
from coeflab.study.study import Study
from coeflab.study.validation import by_measured_number, validations
from coeflab.tables.assumptions import FLAG
from coeflab.vehicle.published_values import Reference, Relation

MOST_LETTERS, MOST_NAMED = 240, 4
NO_DATA = "no data"


@dataclass(frozen=True, slots=True, eq=False)
class PublishedColumns:
    """The published columns of one body.

    Attributes
    ----------
    body : str
        Whose coefficients are the answer.
    columns : tuple of Reference
        The experiment first.
    among : CoefficientSet or None
        The first of that body, whose length and reference point hold where a row has none.
    """

    body: str
    columns: tuple[Reference, ...]
    among: CoefficientSet | None


def notes(study: Study, publications: PublishedColumns, rows: Sequence[AnswerRow]) -> tuple[str, ...]:
    """Sentences of three lines at most.

    Parameters
    ----------
    study : Study
    publications : Beside
    rows : sequence of AnswerRow
    """
    towed_rows = {t.campaign for t in study.plan.tows if t.campaign}
    sources = [s for s in dict.fromkeys(r.source for r in rows if r.source) if s not in towed_rows]
    out = []
    if sources:
        scaling = publications.among.scaling if publications.among else None
        by = f" Primes use {scaling.length_name} = {scaling.length:.5g} m" if scaling else ""
        if publications.among:
            about = f"{point_in_words(publications.among.reference_point, publications.among.datum)}"
            by += f"{'; moments are' if by else ' Moments are'} about {about}"
        out.append(f"Ours: coeflab's fits to {listed(_with_symbols(sources, rows))}.{by}{'.' * bool(by)}")
        if any(r.symbol == "Mw" and r.value is not None for r in rows):
            out += filter(None, dict.fromkeys(munk_in_words(f) for f in study.fits if f.campaign in sources))
    if keys := list(dict.fromkeys(k for r in rows for k in r.assumed)):
        out.append(f"{FLAG.strip()} assumed, not stated by the source: {listed(keys)} (see Checks).")
    out += [*halves(study), *undetermined_by_move(study)]
    own = [r for r in rows if r.source in towed_rows]
    if own:
        body = next((t.body for t in study.tables if t.campaign == own[0].source), "")
        of = f", of body {body}" if body and body != publications.body else ""
        out.append(f"{', '.join(primed(r.symbol) for r in own)}: our CFD {own[0].source}{of}; no verdict.")
    if any(r.agrees is not None for r in rows):
        out.append(_the_authors(study, publications, rows))
    out += filter(None, (_independent(study), _not_in_u95(study, rows)))
    others = [r for r in publications.columns if r.relation is Relation.CROSS_BODY]
    for body in dict.fromkeys(r.body for r in others):
        names = listed([r.name for r in others if r.body == body])
        inferred = ", inferred" if any("body" in r.inferred for r in others if r.body == body) else ""
        of = f"of another body ({body}{inferred})" if body != publications.body else "by another method"
        are, get = ("is", "gets") if sum(r.body == body for r in others) == 1 else ("are", "get")
        out.append(f"{names} {are} {of} and {get} no verdict.")
    for r in others:
        if r.other_scaling is not None:
            out.append(f"{r.name}: {_readings(r.scaling, r.other_scaling)}.")
    return tuple(n if len(n) <= MOST_LETTERS else f"{n[:MOST_LETTERS]} ..." for n in out)


def _the_authors(study: Study, publications: PublishedColumns, rows: Sequence[AnswerRow]) -> str:
    """What the compared column is, and by which tests of their own its authors have what no table here gives."""
    column = publications.columns[0]
    reports = [r for r in study.references if r.relation is Relation.RE_ANALYSIS and r.body == publications.body]
    towed_rows = {t.campaign for t in study.plan.tows if t.campaign}
    methods: dict[str, list[str]] = {}
    for row in rows:
        printed = row.published[0] if row.published else None
        stated = column.printed(row.symbol)
        if (row.status != NO_DATA and row.source not in towed_rows) or printed is None or stated is None:
            continue
        digit = 10.0 ** -len(stated.printed.partition(".")[2])
        method = next(
            (
                kind.method for r in reports for kind in r.literature for v in kind.values
                if v.symbol == row.symbol and v.value is not None and abs(v.value - printed) <= digit
            ),
            "",
        )  # fmt: skip
        if method:
            methods.setdefault(method, []).append(primed(row.symbol))
    each = "".join(f"; {', '.join(s)} by {m}" for m, s in methods.items())
    names = [r.name for r in reports]
    heads = {n.rpartition(" ")[0] for n in names}
    same = heads.pop() if len(heads) == 1 and len(names) > 1 else ""
    whose = _several(same, [n.rpartition(" ")[2] for n in names]) if same else listed(names)
    if whose == column.name:  # named as the column is: what it is stands in its citation
        whose = "; ".join(dict.fromkeys(", ".join(filter(None, (work(r.citation), r.place))) for r in reports))
    elif reports:
        parts = zip(*(r.place.split(", ") for r in reports), strict=False)
        shared = ", ".join(same[0] for same in parts if len(set(same)) == 1)
        whose += f" ({shared})" * bool(shared)
    whose = (whose or "the authors' values, same points").removesuffix(".")
    return f"{column.name}: {whose}{each}."


NOUNS = ("configuration", "condition", "model", "series", "table", "test")


def _several(head: str, last: Sequence[str]) -> str:
    """Names with the same beginning: ``Roddy, configurations 1 and 2``."""
    first, _, noun = head.rpartition(" ")
    if not first or noun not in NOUNS:
        return listed([f"{head} {n}" for n in last])
    return f"{first}, {noun if noun.endswith('s') else f'{noun}s'} {listed(last)}"


def _not_in_u95(study: Study, rows: Sequence[AnswerRow]) -> str:
    """What no U95 of the rows holds, the first of it by name, and what the source states; empty where every one holds all."""
    mine = {(r.source, r.symbol) for r in rows if r.u95 is not None}
    budgets = [b for b in study.budgets if (b.campaign, b.symbol.removesuffix("'")) in mine]
    lacking: dict[str, set[str]] = {}
    for b in budgets:
        for name in (n for n in b.unassessed if n not in (SET_IN_A_COMPUTATION if b.kind == "cfd" else ())):
            lacking.setdefault(name.removeprefix("error of "), set()).add(b.symbol.removesuffix("'"))
    whole = {b.symbol.removesuffix("'") for b in budgets}
    names = sorted(lacking, key=lambda n: lacking[n] != whole)
    stated = _as_stated(study, rows)
    if not names:
        return f"U95 is without rig and balance; {stated}." if stated else ""
    more = " and others (see Coefficients)" if len(names) > MOST_NAMED else ""
    by = collected(
        (() if lacking[n] == whole else tuple(primed(r.symbol) for r in rows if r.symbol in lacking[n]), n)
        for n in (names[: MOST_NAMED - 1] if more else names)
    )
    shown = [*by.pop((), []), *(f"{listed(those)} ({listed(of)})" for of, those in by.items())]
    words = f"; {stated}" if stated else ""
    which = f"{', '.join(shown)}{more}" if more else f"{listed(shown)} (see Coefficients)"
    return f"Not in U95: errors of {which}{words}."


def _as_stated(study: Study, rows: Sequence[AnswerRow]) -> str:
    """What sources of tests state of their uncertainty, where U95 leaves rig and balance out; empty where nothing."""
    mine = {(r.source, r.symbol) for r in rows if r.u95 is not None}
    without = {
        b.campaign for b in study.budgets if RIG in b.unassessed and (b.campaign, b.symbol.removesuffix("'")) in mine
    }
    words = dict.fromkeys(
        t.source.stated_uncertainty for t in study.tables if t.campaign in without and t.source.stated_uncertainty
    )
    return "; ".join(f"the test report states for its own: {text.removesuffix('.')}" for text in words)


def _independent(study: Study) -> str:
    """How many computed coefficients agree with those measured on the same body; empty where none is compared."""
    every = validations(study, study.budgets)
    numbers, found_without = by_measured_number(every), [v for v in every if v.within is None]
    if not numbers:
        return ""
    found = [v for one in numbers for v in one]
    bodies = listed(
        [b.removeprefix(f"{study.plan.name}_").replace("_", " ") for b in dict.fromkeys(v.body for v in found)]
    )
    outside = list(dict.fromkeys(primed(v.symbol) for v in found if not v.within))
    shares = collected((primed(v.symbol), v.share) for v in found if v.weak)
    weak = [f"{s} (U_V is {_span(each)} of it)" for s, each in shares.items()]
    wanted_first = sorted(found_without, key=lambda v: v.symbol.removesuffix("'") not in study.plan.wanted)
    uncounted = [primed(v.symbol) for v in wanted_first if v.beyond]
    words = f" Weak: {', '.join(weak)}." * bool(weak) + f" Beyond U_V: {', '.join(outside)}." * bool(outside)
    words += (
        in_sentences(" No verdict, but beyond U_V: ", list(dict.fromkeys(uncounted)), " (see Verdict).", join=listed)
        if uncounted
        else ""
    )
    inside = sum(all(v.within for v in one) for one in numbers)
    return f"Independent evidence, {bodies}: CFD predicts {inside} of {len(numbers)} judged coefficients within U_V.{words}"


def _span(shares: Sequence[str]) -> str:
    """The smallest and the largest of several per cents."""
    low, *_, high = sorted((*shares, *shares), key=lambda s: float(s.removesuffix(" %")))
    return high if low == high else f"{low.removesuffix(' %')} to {high}"


def _readings(first: Scaling, other: Scaling) -> str:
    """The length that a column is read with, and what the other would make of it."""
    force, moment = (f"{100.0 * (other.ratio(symbol, first) - 1.0):+.1f} %" for symbol in ("Yv", "Nr"))
    return f"{first.length_name} assumed, not stated (if {other.length_name}: Yv' {force}, Nr' {moment})"


def _with_symbols(sources: Sequence[str], rows: Sequence[AnswerRow]) -> list[str]:
    """Campaigns, each with the coefficients that it gives where there are several."""
    if len(sources) < 2:
        return list(sources)
    return [f"{s} ({', '.join(primed(r.symbol) for r in rows if r.source == s)})" for s in sources]

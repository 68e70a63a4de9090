"""The first page of a study or a publication: what came out, in one sentence, six rows, two pictures and chips.

Everything that shows it takes it from here: terminal, notebook, HTML, PDF, and the summary, a report of that page alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Table, as_printed, in_digits_of
from coeflab.core.wording import listed, spelled_out
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult, Sweep
from coeflab.fits.results.straight_runs import SYMBOL
from coeflab.law.coefficient import NAMED_STATUSES, Coefficient, CoefficientSet, Status
from coeflab.law.symbols import derivative, primed
from coeflab.report.acceptance import Acceptance, by_basis, held
from coeflab.report.answer_table import LONGEST, MOST_COLUMNS, MOST_MODELS, MOST_ROWS
from coeflab.report.document import Answer, AnswerRow, Chip, Document, Figure
from coeflab.report.figures.first_page import axes_figure, forest_figure, renamed, shares_figure, slope_figure
from coeflab.report.figures.model import model_figures
from coeflab.report.figures.svg_file import size_of
from coeflab.report.first_page_notes import MOST_NAMED, NO_DATA, PublishedColumns, notes
from coeflab.report.notation import keeping, users_texts
from coeflab.report.reproduction import digest_of
from coeflab.report.sections.campaign import anchor, moved_from
from coeflab.report.sections.estimates import answer_of_shape
from coeflab.report.sections.stability import from_literature, no_index
from coeflab.report.tables.models import quality
from coeflab.report.tables.own_cfd import NO_RESULT
from coeflab.report.tables.results import assumed_of
from coeflab.report.texts import text_of
from coeflab.study.lines import MEANING as MEANING_OF_LINE
from coeflab.study.lines import NAME, line
from coeflab.study.study import Study
from coeflab.study.towed import Towed, towed
from coeflab.vehicle.published_values import Comparison, Reference, Relation
from coeflab.vehicle.stability import FAST, INDICES, Derived, Verdict, missing_for_stability, stability, verdict

ROLL = "K"  # moments of which no hull has a sign: a headline says what is open of one that is asked for, or alone
PLACES = 4  # of a line, which has no U95 to say how many count
LARGEST, TALL = 100_000, 440.0  # letters of a drawing that a first page may hold; points, with the axes below it


def answer(found: Study | Acceptance, *, drawn: bool = True) -> Answer:
    """What a reader wants first.

    Parameters
    ----------
    found : Study or Acceptance
    drawn : bool
        With its figures; a terminal shows none. A tall one leaves no room for the axes.

    Returns
    -------
    Answer
        Of a study its wanted coefficients beside the published columns of their body: from its re-analysed tables, else from
        an own tow of that body. A difference has a verdict only where the authors' own evaluation of the same data is known.
    """
    if isinstance(found, Study) and found.shape is not None:
        return answer_of_shape(found, drawn=drawn)
    result = _of_study(found) if isinstance(found, Study) else _of_publication(found)
    return _drawn(found, result) if drawn else result


def _of_study(study: Study) -> Answer:
    publications = _columns(study)
    rows = tuple(_row(study, publications, symbol) for symbol in _wanted(study, publications.body))
    compared = publications.columns[0].name if publications.columns else ""
    names = tuple(r.name for r in publications.columns)
    if all(r.value is None for r in rows) and any(f.models for f in study.fits):
        others = tuple(_row(study, publications, symbol) for symbol in _others(study, publications.body))
        if not others:
            return _of_models(study)
        rows = others
    words, chips, below = _sentence(study, publications, rows), _chips(study), notes(study, publications, rows)
    lines = [_line(study, r) for r in rows] if study.plan.tows and names else []
    if any(x is not None for x in lines):
        names, below = (*names, NAME), (*below, MEANING_OF_LINE)
        rows = tuple(
            replace(
                r, published=(*r.published, x),
                printed=(*(r.printed or map(as_printed, r.published)), "" if x is None else f"{x:.{PLACES}f}"),
            )
            for r, x in zip(rows, lines, strict=True)
        )  # fmt: skip
    return Answer(words, names, compared, rows, chips, notes=below)


def _line(study: Study, row: AnswerRow) -> float | None:
    """What the estimator of the steady-CFD study gives of the points behind a value."""
    tables = tuple(t for t in study.tables if t.campaign == row.source)
    among = _set(study, row.source)
    return line(tables, row.symbol, among.scaling.length) if tables and among is not None else None


def _columns(study: Study) -> PublishedColumns:
    """The body that the answer is about, and what is published of it: quoted, re-analysed, then other bodies."""
    quoted = [r for r in study.references if r.relation is Relation.QUOTED]
    campaigns = {f.campaign: f.body for f in study.fits}
    ours = [r for r in study.references if r.relation is Relation.RE_ANALYSIS and set(r.campaigns) & set(campaigns)]
    bodies = [c.body for c in study.coefficients if c.symbol in study.plan.wanted and c.value is not None]
    body = next((b for b in (*(r.body for r in quoted), *bodies) if b), next(iter(campaigns.values()), ""))
    of_body = [r for r in quoted if r.body == body]
    first = [r for r in ours if any(campaigns.get(c) == body for c in r.campaigns)]
    judged = {c.coefficient.symbol for c in study.comparisons if c.passed is not None} & set(_wanted(study, body))
    if judged and all(any(r.printed(symbol) is not None for r in of_body) for symbol in judged):
        first = []  # the quoted columns print what the re-analyses are judged by
    others = [r for r in study.references if r.relation is Relation.CROSS_BODY]
    fit = next((f for f in study.fits if f.body == body), None)
    return PublishedColumns(body, tuple([*first, *of_body, *others][:MOST_COLUMNS]), fit.coefficients if fit else None)


def _wanted(study: Study, body: str) -> tuple[str, ...]:
    """What the plan wants; of a plan that does not say, the slopes that it gives, six at most."""
    if study.plan.wanted:
        return study.plan.wanted
    slopes = [
        s.symbol for f in study.fits for s in f.sweeps if s.target == "x" and s.value is not None and f.body == body
    ]
    ahead = [SYMBOL for f in study.fits if f.straight and f.body == body]
    return tuple(dict.fromkeys([*slopes, *ahead]))[:MOST_ROWS]


def _others(study: Study, body: str) -> tuple[str, ...]:
    """Coefficients that the fits give where they give none of those wanted, such as X0' alone."""
    found = (c.symbol for c in study.coefficients if c.body == body and c.value is not None and c.origin == "fit")
    return tuple(dict.fromkeys(found))[:MOST_ROWS]


def _row(study: Study, publications: PublishedColumns, symbol: str) -> AnswerRow:
    found = [c for c in study.coefficients if c.symbol == symbol and c.body == publications.body]
    judged = {(x.coefficient.symbol, x.coefficient.campaign): x for x in study.comparisons if x.passed is not None}
    known = sorted((c for c in found if c.value is not None), key=lambda c: (c.symbol, c.campaign) not in judged)
    among = _set(study, known[0].campaign if known else None) or publications.among
    pairs = [_published(study, r, publications.body, symbol, among) for r in publications.columns]
    published, printed = tuple(value for value, _ in pairs), tuple(text for _, text in pairs)
    if not known:
        return replace(_towed_row(study, publications, symbol, published, found), printed=printed)
    c = known[0]
    rejected = c.status is Status.FORM_REJECTED
    row = AnswerRow(
        symbol, c.value, None if rejected else c.u95, c.status.replace("_", " ") if c.status in NAMED_STATUSES else "" if c.u95 else "no U95",
        c.campaign or "", published, anchor=_place(study, c), printed=printed,
        assumed=tuple(dict.fromkeys(str(f["key"]) for f in assumed_of(study, c))),
    )  # fmt: skip
    mine = judged.get((symbol, c.campaign))
    return _judged(row, mine if mine is not None and mine.coefficient.value == c.value else None)


def _place(study: Study, c: Coefficient) -> str:
    """Of the section that derives a coefficient, as a whole report names it."""
    places: set[str] = set()
    own = [anchor(f"campaign {f.campaign}", places) for f in study.fits]
    swept = [
        any(k is c for k in f.coefficients.coefficients) and any(s.symbol == c.symbol for s in f.sweeps)
        for f in study.fits
    ]
    mine = (place for place, is_ours in zip(own, swept, strict=True) if is_ours)
    return next((anchor(f"{place} {c.symbol}", places) for place in mine), "coefficients")


def _set(study: Study, campaign: str | None) -> CoefficientSet | None:
    return next((f.coefficients for f in study.fits if f.campaign == campaign), None)


def _judged(row: AnswerRow, verdict: Comparison | None) -> AnswerRow:
    """With its difference to the first column and what a re-analysis concludes from it."""
    first = row.published[0] if row.published else None
    difference = row.value - first if row.value is not None and first is not None else None
    return replace(row, difference=difference, agrees=verdict.passed if verdict and difference is not None else None)


def _towed_row(
    study: Study,
    publications: PublishedColumns,
    symbol: str,
    published: tuple[float | None, ...],
    found: Sequence[Coefficient],
) -> AnswerRow:
    """From an own tow that the plan sets beside these columns; else why there is no value."""
    for tow in _tows(study, publications):
        own = next((r for r in tow.rows if r.symbol == symbol and r.value is not None), None)
        if own is not None and not own.is_result:
            return AnswerRow(symbol, None, None, NO_RESULT, tow.tow.campaign, published)
        if own is not None:
            row = AnswerRow(symbol, own.value, own.u95, "" if own.u95 else "no U95", tow.tow.campaign, published)
            return _judged(row, None)
    status = next((c.status for c in found if c.status is not Status.NO_TABLE), None)
    if other := next((b for b, symbols in study.by_body.items() if b != publications.body and symbol in symbols), ""):
        return AnswerRow(symbol, None, None, f"fitted for body {other}", published=published)
    return AnswerRow(symbol, None, None, NO_DATA if status is None else status.replace("_", " "), published=published)


def _tows(study: Study, publications: PublishedColumns) -> tuple[Towed, ...]:
    """Own tows of the body, or those that the plan sets beside the first column."""
    names = {r.name for r in publications.columns[:1]}
    return (
        tuple(t for t in towed(study) if t.body == publications.body or names & set(t.tow.columns))
        if study.plan.tows
        else ()
    )


def _published(
    study: Study, reference: Reference, body: str, symbol: str, among: CoefficientSet | None
) -> tuple[float | None, str]:
    """A printed value by our length, as it is read first, and as text; of a quoted column in the digits of the report that it rounds or cuts."""
    if among is None or not _about_ours(reference, among):
        return None, ""
    read = reference.readings(symbol, among.scaling)
    printed = reference.printed(symbol)
    if not read or printed is None:
        return None, ""
    value = read[0][1]
    text = in_digits_of(value, printed.printed)
    if reference.relation is Relation.QUOTED:
        reports = [
            r
            for r in study.references
            if r.relation is Relation.RE_ANALYSIS and r.body == body and _about_ours(r, among)
        ]
        places = len(printed.printed.partition(".")[2])
        for r in reports:
            stated = r.printed_by_any_method(symbol)
            if stated is None or stated.value is None:
                continue
            v = stated.value * r.scaling.ratio(symbol, among.scaling)
            if abs(v - value) < 10.0**-places:  # the paper on SUBOFF quotes 0.005251 as 0.0052
                return v, in_digits_of(v, stated.printed)
    return value, text


def _about_ours(reference: Reference, among: CoefficientSet) -> bool:
    """Whether it is about our reference point, or about none that it names."""
    theirs = reference.reference_point
    return theirs is None or bool(np.allclose(theirs, among.reference_point, atol=1e-6))


def _short(title: str) -> str:
    """The beginning of a title, up to its colon."""
    head = title.partition(":")[0].strip()
    if len(head) > LONGEST // 3:
        head = head.partition(" (")[0]
    return head if len(head) <= LONGEST // 3 else head[: LONGEST // 3].rsplit(" ", 1)[0].rstrip(",") + " ..."


def _sentence(study: Study, publications: PublishedColumns, rows: tuple[AnswerRow, ...]) -> str:
    name = _short(study.plan.title or study.plan.name)
    judged = [r for r in rows if r.agrees is not None]
    valued = [r for r in rows if r.value is not None]
    kind = "static derivatives" if all(_is_static(r.symbol) for r in judged) else "derivatives"
    kind = kind if len(judged) != 1 else kind[:-1]
    several = len({f.body for f in study.fits}) > 1
    absent = _absent(rows, f" for {publications.body.replace('_', ' ')}" if several and publications.body else "")
    if judged:
        apart = [primed(r.symbol) for r in judged if not r.agrees]
        column = publications.columns[0].name
        if apart:
            some = f"{spelled_out(len(apart))} of {spelled_out(len(judged))} {kind}"
            first = (
                f"{name}: our fits to the data of {column} differ from its {listed(apart)} by more than U95 ({some})"
            )
        else:
            found = listed([primed(r.symbol) for r in judged])
            found = f"its {found}" if len(judged) <= MOST_NAMED else f"all {spelled_out(len(judged))} {kind}"
            first = f"{name}: our fits to the data of {column} reproduce {found} within U95"
    elif not valued:
        first = f"{name}: no wanted coefficient could be determined"
    else:
        failing = {(c.campaign, c.symbol) for c in study.checks if c.severity is Severity.FAIL}
        every = valued
        valued = [r for r in valued if failing.isdisjoint([(r.source, ""), (r.source, r.symbol)])]
        bounded = sum(r.u95 is not None for r in valued)
        of = (
            {1: "the", 2: "both"}.get(len(rows), f"all {spelled_out(len(rows))}")
            if len(valued) == len(rows)
            else f"{spelled_out(len(valued)) if valued else 'none'} of {spelled_out(len(rows))}"
        )
        fails = f"{spelled_out(len(every) - len(valued))} from tables that fail a check"
        s = "s" * (len(rows) > 1)
        wanted = "wanted " * (not study.plan.wanted or any(r.symbol in study.plan.wanted for r in rows))
        first = f"{name}: {of} {wanted}coefficient{s} found"
        first += f", {'each' if bounded == len(valued) else spelled_out(bounded)} with U95" * bool(valued)
        first += _open([r for r in valued if r.symbol in study.plan.wanted or r.symbol[0] != ROLL] or valued)
        first += f", {fails}" * (len(valued) < len(every))
        compared = ((FITS.load(r.fit).printed_inside, r) for r in study.fits if r.fit in FITS.names())
        inside, printed = map(sum, zip((0, 0), *(count(r) for count, r in compared if count is not None), strict=True))
        words = f"{inside} of {printed} printed coefficients inside their fitted U95" if printed else ""
        among = publications.among
        there = [r.name for r in publications.columns if among is not None and not _about_ours(r, among)]
        elsewhere = f"{listed(there)}: compared about another point" if there else ""
        absent = "; ".join(t for t in (elsewhere, absent or words) if t) or "no published evaluation of these data"
    if judged and all(r.status == NO_RESULT for r in rows if r.value is None):
        absent = ""  # their rows say it
    whole = f"{first}; {absent}." if absent else f"{first}."
    return whole if len(whole) <= LONGEST else f"{first[: LONGEST - 1]}."


def _open(valued: Sequence[AnswerRow]) -> str:
    """Which values have an interval that contains zero: the data leave their sign open."""
    names = [primed(r.symbol) for r in valued if r.u95 is not None and abs(r.value or 0.0) <= r.u95]
    if not names:
        return ""
    return (
        f", sign open of {listed(names)}"
        if len(names) <= MOST_ROWS // 2
        else f", sign open of {spelled_out(len(names))}"
    )


def _is_static(symbol: str) -> bool:
    return set(derivative(symbol).factors) <= {"v", "w"}


def _absent(rows: tuple[AnswerRow, ...], for_body: str) -> str:
    """Which rows have no value, and why where one reason serves all; of which body where the study has several."""
    without = [r for r in rows if r.value is None]
    if not without:
        return ""
    if all(r.status == NO_DATA for r in without) and all(
        set(derivative(r.symbol).factors) & {"p", "q", "r"} for r in without
    ):
        return f"no rotating-arm data{for_body}"
    return "; ".join(
        f"{listed([primed(r.symbol) for r in without if r.status == status])}: {status}"
        for status in dict.fromkeys(r.status for r in without)
    )


def _chips(study: Study) -> tuple[Chip, ...]:
    return (*_stability(study), *(c for c in (_warnings(study), _exports(study)) if c is not None))


def _stability(study: Study) -> tuple[Chip, ...]:
    """Of the first parameter file that has an index, a chip a plane."""
    every = [index for p in study.parameter_files.values() for index in stability(p)]
    if not every:
        files = tuple(study.parameter_files.values())
        words = no_index(min((missing_for_stability(p) for p in files), key=len)) if files else "no parameter file"
        return (Chip("Stability", words, Severity.NOTE, "stability" if files else ""),)
    return tuple(_of_plane(study, index) for index in every if index.subject == every[0].subject)


def _of_plane(study: Study, d: Derived) -> Chip:
    says = verdict(d)
    grave = (
        Severity.PASS
        if says is Verdict.STABLE and d.result is not None
        else Severity.WARN
        if says is Verdict.UNSTABLE
        else Severity.NOTE
    )
    value = f"{d.value:.2f}, no U95" if d.result is None else d.in_words
    plane, fast = ("horizontal", "") if d.name == "G_h" else ("vertical", f" {FAST}")
    file = next(p for p in study.parameter_files.values() if p.name == d.subject)
    stated = from_literature(file, d.name)
    published = f" ({', '.join(stated)} published)" if 0 < len(stated) < len(INDICES[d.name]) - 1 else ""
    several = len(study.parameter_files) > 1
    name = f"{_of_study_named(study, d.subject)}, {plane}{fast}" if several else f"Stability, {plane} plane{fast}"
    return Chip(name, f"{says}, {d.name} = {value}{published}", grave, "stability")


def _of_study_named(study: Study, name: str) -> str:
    """A parameter file as people say it, without the name of the study that it begins with."""
    words = name.removeprefix(f"{study.plan.name}_").replace("_", " ")
    return f"{words[:1].upper()}{words[1:]}"


def _warnings(study: Study) -> Chip:
    failed, warned = (sum(c.severity is s for c in study.checks) for s in (Severity.FAIL, Severity.WARN))
    text = f"{warned} of {len(study.checks)} checks" if study.checks else "no checks"
    if failed:
        return Chip("Warnings", f"{failed} failed, {warned} warned", Severity.FAIL, "checks")
    return Chip("Warnings", text, Severity.WARN if warned else Severity.PASS, "checks")


def _exports(study: Study) -> Chip:
    result, refused = len(study.exports), len(study.refused)
    if not result and not refused:
        return Chip("Exports to simulators", "none planned", Severity.NOTE)
    loss = sum(not e.lossless for e in study.exports)
    text = f"{result} made, {f'{loss} with losses' if loss else 'all complete'}" + (
        f", {refused} refused" if refused else ""
    )
    return Chip(
        "Exports to simulators", text, Severity.FAIL if refused else Severity.NOTE if loss else Severity.PASS, "exports"
    )


def _drawn(found: Study | Acceptance, result: Answer) -> Answer:
    """With its figures; of models, and of a publication, two that show what came out."""
    if isinstance(found, Acceptance):
        left = next((renamed(d, "answer-figure") for _, d in found.figures if len(d.svg) < LARGEST), None)
        right = shares_figure(found) if found.numbers else None
    else:
        left = _slope(found, result)
        right = forest_figure(result.rows, result.columns, result.compared) or forest_figure(
            result.rows, result.columns, ""
        )
        models = [m for f in found.fits for m in f.models]
        if models and (left is None or right is None):
            first, second = (*model_figures(models[0], "answer-model"), None, None)[:2]
            left, right = left or first, right or (second if left is None else first)
    is_tall = left is not None and size_of(left.svg)[1] > TALL
    return replace(result, slope=left, forest=right, axes=None if is_tall else axes_figure())


def _slope(study: Study, result: Answer) -> Figure | None:
    """Of the first row that comes from a sweep about the study's point: points of another point do not end at its value."""
    for r in result.rows:
        f = next((f for f in study.fits if f.campaign == r.source and _has_slope(f, r.symbol)), None)
        at = None if f is None else f.sweep(r.symbol)
        if f is not None and at is not None and r.value is not None and not moved_from(f, at):
            return slope_figure(at, r, result.compared, r.published[0] if r.published else None)
    return None


def _has_slope(fit: FitResult, symbol: str) -> bool:
    return any(s.symbol == symbol and s.target == "x" and s.value is not None and _spread(s) for s in fit.sweeps)


def _spread(sweep: Sweep) -> bool:
    return bool(np.any(sweep.x != 0.0)) and len(sweep.curve) == 3


def _of_models(study: Study) -> Answer:
    """Of a study whose fits give no wanted coefficient but laws and tables of forces."""
    models = tuple(m for f in study.fits for m in f.models)
    name = _short(study.plan.title or study.plan.name)
    n = spelled_out(len(models))
    sentence = f"{name}: {n} fitted {'model' if len(models) == 1 else 'models'}, no coefficient with a SNAME symbol."
    return Answer(sentence, chips=_chips(study), table=_narrow(quality(models), ("", "form", "n", "R2")))


def _of_publication(found: Acceptance) -> Answer:
    good, count, _, valid = _held(found)
    some = f"{count - good} of {count} numbers outside the tolerance"
    words = f"all {count} numbers within the tolerance" if good == count else some
    others = [b for b, (_, n) in held(found).items() if n and not b.validates]
    none = f"none of them is validation: {listed(others)} only"
    by = ", or ".join(b for b, (_, n) in held(found).items() if n and b.validates)
    words += (
        f"; {f'all {count}' if valid == count else f'{valid} of the {count}'} are validation: {by}"
        if valid
        else f"; {none}"
    )
    return Answer(f"{_short(found.title)}: {words}.", chips=_published_chips(found), table=by_basis(found))


def _held(found: Acceptance) -> tuple[int, int, int, int]:
    """How many numbers hold, how many there are; the same of those that validate."""
    numbers = held(found)
    good, count = (sum(pair[k] for pair in numbers.values()) for k in (0, 1))
    holding, valid = (sum(pair[k] for b, pair in numbers.items() if b.validates) for k in (0, 1))
    return good, count, holding, valid


def _narrow(whole: Table, names: Sequence[str]) -> Table:
    """Some columns and the first rows of a table; no notes of its own."""
    more = (f"{len(whole.rows) - MOST_MODELS} more in the report.",) if len(whole.rows) > MOST_MODELS else ()
    selected = whole.only([whole.headers.index(n) for n in names])
    return replace(selected, rows=selected.rows[:MOST_MODELS], notes=more, spare=())


def _published_chips(found: Acceptance) -> tuple[Chip, ...]:
    good, count, holding, valid = _held(found)
    worst = Severity.PASS if good == count else Severity.FAIL
    validated = Severity.NOTE if not valid else Severity.PASS if holding == valid else Severity.FAIL
    errata = len(found.errata)
    return (
        Chip("Numbers", f"{good} of {count} pass", worst, "compared"),
        Chip("Validation", f"{holding} of {valid} pass" if valid else "none", validated, "verdict"),
        Chip("Errata", f"{errata} in the publication", Severity.NOTE if errata else Severity.PASS, "errata" if errata else ""),
        Chip("Parameter files", f"{len(found.parameter_files)} made", Severity.NOTE, "parameter-files" if found.file_notes else ""),
    )  # fmt: skip


def study_summary(study: Study) -> Document:
    """One page on a study."""
    verbatim = users_texts(study)
    with keeping(verbatim):
        result = answer(study)
    return Document(
        study.plan.title or study.plan.name, text_of("first_page.subtitle"), (), study.plan.name, digest_of(study.inputs), verbatim=verbatim,
        answer=_unlinked(result),
    )  # fmt: skip


def acceptance_summary(found: Acceptance, whole: Document) -> Document:
    """One page on a publication reproduced, of whose whole report it takes name and inputs."""
    return replace(
        whole,
        subtitle=text_of("first_page.subtitle"),
        sections=(),
        works=(),
        answer=_unlinked(whole.answer or answer(found)),
    )


def _unlinked(result: Answer) -> Answer:
    """Without links to sections, of which a summary has none."""
    rows = tuple(replace(r, anchor="") for r in result.rows)
    return replace(result, rows=rows, chips=tuple(replace(c, anchor="") for c in result.chips))

"""What a report says about a study, in order; formats render it."""

from __future__ import annotations

import re
import shlex
from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial

from coeflab.core.finding import Severity
from coeflab.core.table import Table
from coeflab.core.version import VERSION
from coeflab.core.wording import THREE_LINES, Verbatim, in_sentences, listed
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.formats import loss_tables
from coeflab.report.bench import bench_of
from coeflab.report.document import Document, Section, Topic, every
from coeflab.report.figures.svg import settings
from coeflab.report.first_page import answer
from coeflab.report.notation import keeping, users_texts
from coeflab.report.reproduction import digest_of, reproduction, shipped_name
from coeflab.report.sections.added_mass import added_mass_sections
from coeflab.report.sections.body import body_sections
from coeflab.report.sections.budgets import budget_sections, tow_sections
from coeflab.report.sections.campaign import anchor, campaign_section, filled, says_nothing
from coeflab.report.sections.coefficients import coefficients_section
from coeflab.report.sections.conventions import conventions_section
from coeflab.report.sections.data_quality import quality_sections
from coeflab.report.sections.estimates import estimates_sections
from coeflab.report.sections.exports import export_sections
from coeflab.report.sections.manoeuvres import manoeuvre_sections
from coeflab.report.sections.review import review_sections
from coeflab.report.sections.stability import stability_sections
from coeflab.report.sections.verdict import SEVERAL, verdict
from coeflab.report.tables import budgets as budget_tables
from coeflab.report.tables import comparisons
from coeflab.report.tables import models as model_tables
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables import results as tables
from coeflab.report.tables import sources as source_tables
from coeflab.report.texts import text_of
from coeflab.report.workers import begun
from coeflab.study.study import Study
from coeflab.study.validation import validations
from coeflab.vehicle.force_law import points_of
from coeflab.vehicle.law_at_points import LawAtPoints

NAMED_BODIES = 2  # in the line under the title, which is one line on a wide screen
SETTINGS: dict[tuple[str, object], str] = {
    ("at_rest", "law"): "the force law contains the fitted Z0 and M0",
    ("at_rest", "apart"): "the force law does not contain the fitted Z0 and M0",
}
FEW = 8
MANY = 20  # input files, whose list is in the appendix alone


def document(study: Study, *, full: bool = True, review: bool = False) -> Document:
    """The report of a study: the core, and after it the appendix.

    Parameters
    ----------
    study : Study
    full : bool
        With the appendix, whose figures take most of the time.
    review : bool
        Without the appendix, but with what a reviewer asks for: from files to points, all checks, every derivative's curve.
    """
    verbatim = users_texts(study)
    with keeping(verbatim):
        result = _document(study, full and not review)
        if review:
            core_result = core(result)
            result = replace(core_result, sections=(*core_result.sections, *review_sections(study)))
        elif not full:
            result = core(result, tables.sources_of_numbers(study))
        return replace(result, verbatim=verbatim, bench=bench_of(study))


def core(document: Document, sources: Collection[str] | None = None) -> Document:
    """A report without what belongs to the appendix, and of the works those named, else all; no paragraph, note or caption is longer than three lines."""
    sections = tuple(
        _short_reproduction(s, document.digest) if s.anchor == "reproduce" else s
        for s in _without_appendix(document.sections)
    )
    known = {s.anchor for s in every(sections)}
    answer = document.answer
    if answer is not None:
        rows = tuple(replace(r, anchor=_known_anchor(r.anchor, known)) for r in answer.rows)
        answer = replace(
            answer, rows=rows, chips=tuple(replace(c, anchor=_known_anchor(c.anchor, known)) for c in answer.chips)
        )
    return replace(
        document,
        sections=sections,
        answer=answer,
        works=tuple(w for w in document.works if sources is None or w[0] in sources),
    )


# Ends of sentences, not of abbreviations; an initial such as that of R. F. Roddy ends none.
_SENTENCES = re.compile(r"(?<=[.!?])(?<!\b[A-Zp]\.)(?<!\bpp\.)(?<!\bFig\.)(?<!\be\.g\.)(?<!\bi\.e\.) (?=\S)")


def three_lines(texts: Sequence[str]) -> tuple[str, ...]:
    """Texts of at most three lines: a longer one is parted between sentences; a sentence and what a user wrote stay whole."""
    out: list[str] = []
    for text in texts:
        if isinstance(text, Verbatim) or len(text) <= THREE_LINES:
            out.append(text)
            continue
        piece = ""
        for part in _SENTENCES.split(text):
            if piece and len(piece) + 1 + len(part) > THREE_LINES:
                out.append(piece)
                piece = part
            else:
                piece = f"{piece} {part}".strip()
        out.append(piece)
    return tuple(out)


def first_lines(text: str) -> str:
    """The first sentences of a caption, three lines at most; the whole report has the rest."""
    return three_lines((text,))[0]


def _setting(name: str, value: object) -> str:
    """A setting of a fit, and what it means where its name does not say that."""
    meaning = SETTINGS.get((name, value), "")
    return f"{name} = {value} ({meaning})" if meaning else f"{name} = {value}"


def _known_anchor(anchor: str, known: set[str]) -> str:
    return anchor if anchor in known or not anchor else "coefficients" if "coefficients" in known else ""


def _short_reproduction(reproduce: Section, digest: str) -> Section:
    """How to reproduce, in three sentences; the whole report says the rest."""
    if not reproduce.code:
        return reproduce
    text = (
        text_of("content.made_by", version=VERSION),
        "Equal inputs, sources and libraries give this report byte for byte."
        + (f" Digest of all input files: {digest}." if digest else ""),
        *reproduce.paragraphs[-1:],
    )
    return replace(reproduce, paragraphs=three_lines(text))


def _without_appendix(sections: Sequence[Section]) -> tuple[Section, ...]:
    return tuple(
        replace(
            s,
            paragraphs=three_lines(s.paragraphs),
            topics=tuple(replace(t, texts=three_lines(t.texts)) for t in s.topics),
            tables=tuple(replace(t, notes=three_lines(t.notes)) for t in s.tables),
            figures=tuple(replace(f, caption=first_lines(f.caption)) for f in s.figures),
            subsections=_without_appendix(s.subsections),
        )
        for s in sections
        if not s.appendix
    )


def _document(study: Study, full: bool) -> Document:
    places: set[str] = set()
    own = [anchor(f"campaign {fit.campaign}", places) for fit in study.fits] if full and study.shape is None else []
    alone = [partial(_campaign_alone, study, fit, place, places) for fit, place in zip(study.fits, own, strict=False)]
    sizes = [len(f.sweeps) for f in study.fits]
    with settings(), begun(alone if sum(sizes) > FEW else (), sizes) as drawn:
        answered = answer(study)
        moving = [*stability_sections(study), *manoeuvre_sections(study)]
        conventions = conventions_section(study, drawn=answered.axes is None)
        appendix = _appendix(study) if full else ()
        campaigns = tuple(s for s in drawn() or [job() for job in alone] if not says_nothing(s))
    sections = (
        verdict(study),
        *_comparison(study),
        *tow_sections(study),
        *(estimates_sections(study) or (_with_campaigns(study, coefficients_section(study)),)),
        *_models(study),
        *_laws(study),
        *moving,
        *export_sections(study),
        _checks(study),
        conventions,
        _provenance(study),
        reproduction(study),
        *appendix,
        *_campaigns(campaigns),
    )
    if not full and (study.shape is None or study.plan.file is not None):
        sections = (
            replace(sections[0], topics=(*sections[0].topics, Topic("Appendix", (appendix_in_a_line(study),)))),
            *sections[1:],
        )
    bodies = list(dict.fromkeys(f.body.replace("_", " ") for f in study.fits))
    names = ", ".join(bodies) if len(bodies) <= NAMED_BODIES else f"{len(bodies)} bodies"
    return Document(
        study.plan.title or study.plan.name, f"Coefficients of {names}", sections, study.plan.name, digest_of(study.inputs),
        tables.works(study), answer=answered,
    )  # fmt: skip


def _appendix(study: Study) -> tuple[Section, ...]:
    found = (*budget_sections(study), *body_sections(study), *added_mass_sections(study), *quality_sections(study))
    return tuple(replace(s, appendix=True) for s in found)


def _campaigns(found: tuple[Section, ...]) -> tuple[Section, ...]:
    if not found:
        return ()
    text = ("Every coefficient and every fitted model with its points, its curves and what was tried.",)
    return (Section("campaigns", "Campaigns", text, subsections=found, appendix=True),)


def appendix_in_a_line(study: Study) -> str:
    """What the whole report holds beside the core, in one line."""
    shipped = shipped_name(study.plan)
    name = shipped or (study.plan.file.name if study.plan.file else "PLAN")
    where = "" if shipped or study.plan.file is None else f"In the folder of {name}, "
    held = [
        (len(study.budgets), "uncertainty budget"),
        (len(study.hulls), "added-mass matrix", "added-mass matrices"),
        (0 if study.shape else len(study.fits), "fit with every point and curve", "fits with every point and curve"),
        (len(study.checks), "check"),
        (
            sum(result.loss is not None for result in study.exports),
            "loss report of an export",
            "loss reports of exports",
        ),
    ]
    each = [f"{n} {names[0] if n == 1 else (*names, f'{names[0]}s')[1]}" for n, *names in held if n]
    listing = f"{', '.join(each)}, the quality of the data" if each else "the quality of the data"
    return f"{where}`coeflab report {shlex.quote(name)} --full` adds the appendix: {listing}."


def _campaign_alone(study: Study, fit: FitResult, place: str, places: set[str]) -> Section:
    return campaign_section(study, fit, place, set(places))


def _models(study: Study) -> tuple[Section, ...]:
    models = tuple(m for f in study.fits for m in f.models)
    if not models:
        return ()
    text = (text_of("content.models"),)
    each = tuple(noun_tables.terms(m) for m in models)
    return (
        Section(
            "models",
            "Fitted models",
            text,
            filled(*model_tables.qualities(models), model_tables.campaigns(study.fits), *each),
        ),
    )


def _laws(study: Study) -> tuple[Section, ...]:
    found = {name: points_of(p) for name, p in study.parameter_files.items()}
    each = {name: loss_tables.at_points(laws, f"Force law of {name}") for name, laws in found.items() if laws}
    if not each:
        return ()
    text: tuple[str, ...] = (
        text_of("content.laws"),
        *(_law_in_words(name, found[name], table) for name, table in each.items()),
    )
    in_files = {c.campaign for p in study.parameter_files.values() for c in p.coefficients}
    if none := [c for c in dict.fromkeys(f.campaign for f in study.fits) if not in_files & {c, *c.split(", ")}]:
        text += (_not_in_a_file(none),)
    whole = Section(
        "all-laws", "Force laws at their points", (loss_tables.IN_PERCENT,), tuple(each.values()), appendix=True
    )
    return (Section("law-at-points", "Force law at its points", text, subsections=(whole,)),)


def _law_in_words(name: str, found: Sequence[LawAtPoints], table: Table) -> str:
    """How the law of a file agrees with its points: how many components of tables hold, and the largest difference in its range."""
    judged = [f for f in found if not f.small and len(f.beyond) < f.n_points]
    if not judged:
        return f"{name}: too small to judge."
    worst = max(judged, key=lambda f: f.share)
    holding = sum(not f.missed for f in judged)
    apart, allowed = (
        loss_tables.percent(x) for x in (worst.share, worst.allowed / worst.largest if worst.largest else 0.0)
    )
    words = f"{name}: {holding} of {len(judged)} components of tables hold; the largest difference is {apart} ({worst.component} of {worst.table}, allowed {allowed})."
    return " ".join((words, *(n for n in table.notes if n != loss_tables.IN_PERCENT)))


def _not_in_a_file(campaigns: Sequence[str]) -> str:
    """Which campaigns are not compared with a law."""
    if len(campaigns) > SEVERAL:
        return f"{len(campaigns)} campaigns are not compared, because they have no parameter file (What was tested and computed)."
    have = "it has" if len(campaigns) == 1 else "they have"
    return f"Not compared, because {have} no parameter file: {listed(campaigns)}."


def _comparison(study: Study) -> tuple[Section, ...]:
    if not study.comparisons:
        return ()
    text = ("Published values are rescaled to our length before they are compared.",)
    lengths = []
    for r in study.references:
        if r.other_scaling is not None:
            lengths.append(
                text_of("content.two_lengths", name=r.name, scaling=r.scaling, other_scaling=r.other_scaling)
            )
    shown = filled(
        comparisons.campaigns(study),
        budget_tables.predictions(validations(study, study.budgets)),
        tables.without(comparisons.verdicts(study), "combined"),
    )
    apart = filled(tables.without(comparisons.side_by_side(study), "random", "form"), comparisons.differences(study))
    more = (
        (Section("distances", "Published columns and distances", tuple(lengths), tables=apart, appendix=True),)
        if apart
        else ()
    )
    return (Section("comparison", "Comparison with published values", text, shown, subsections=more),)


def _with_campaigns(study: Study, coefficients: Section) -> Section:
    """The section on coefficients; it begins with the campaigns where no comparison does."""
    first = () if study.comparisons else filled(comparisons.campaigns(study))
    return replace(coefficients, tables=(*first, *coefficients.tables))


def _checks(study: Study) -> Section:
    """Failures and warnings, a row each; the others counted, and in the appendix."""
    if not study.checks:
        return Section("checks", "Checks", ("No checks were made.",))
    grave = [c for c in study.checks if c.severity in (Severity.FAIL, Severity.WARN)]
    found = ", ".join(f"{sum(c.severity is s for c in study.checks)} {s}" for s in reversed(Severity))
    whole = Section("all-checks", "All checks", tables=filled(tables.checks(study.checks)), appendix=True)
    shown = filled(tables.warnings(grave))
    return Section("checks", "Checks", (f"{found}. Warnings do not make the study fail.",), shown, subsections=(whole,))


def _provenance(study: Study) -> Section:
    """What went in: a short list of files here, a long one in the appendix."""
    inputs = filled(tables.provenance(study), source_tables.inputs_table(study))
    words = text_of("acceptance.by_sha256")
    if many := (files := len(study.inputs)) > MANY:
        words = f"{files} input files; --full lists their sha256."
    text = (words, *dict.fromkeys(_settings(f) for f in study.fits if f.settings))
    whole = (Section("inputs", "All inputs", tables=inputs, appendix=True),) if many else ()
    return Section("provenance", "Provenance", text, () if many else inputs, subsections=whole)


def _settings(fit: FitResult) -> str:
    """What a fit is, and its settings; estimates are no plugin of their own."""
    summary = FITS.load(fit.fit).summary if fit.fit in FITS.names() else ""
    each = [_setting(k, v) for k, v in sorted(fit.settings.items())]
    settings = in_sentences(f"Setting{'s' * (len(each) > 1)} of {fit.fit}: ", each, join=", ".join)
    return f"{f'Fitting method {fit.fit}: {summary}. ' * bool(summary)}{settings}"

"""A report on one page: the verdict, the wanted coefficients, two figures, stability."""

from __future__ import annotations

from dataclasses import replace

from coeflab.core.table import ABSENT, Table, number, plus_minus
from coeflab.fits.results.fit_result import Sweep
from coeflab.law.coefficient import COVERS
from coeflab.report import content
from coeflab.report.acceptance import Acceptance
from coeflab.report.answer import answer
from coeflab.report.document import Document, Figure, Section, digest_of
from coeflab.report.figures.estimator import estimator_figure
from coeflab.report.figures.model import model_figures
from coeflab.report.figures.sweep import sweep_figure
from coeflab.report.notation import keeping, users_texts
from coeflab.report.sections import acceptance as acceptance_document
from coeflab.report.sections.parameter_file import in_words
from coeflab.report.tables import results as tables
from coeflab.report.tables.models import quality
from coeflab.study.study import Study
from coeflab.vehicle.derived import INDICES, Derived, centre_of_pressure, sense, stability

MOST_ROWS, MOST_PARAGRAPHS, MOST_NOTES, LONGEST_NOTE, LONGEST_CAPTION = 12, 3, 4, 120, 200


def study_summary(study: Study) -> Document:
    """One page on a study."""
    verbatim = users_texts(study)
    with keeping(verbatim):
        return replace(_study_summary(study), verbatim=verbatim)


def _study_summary(study: Study) -> Document:
    sections = (
        _first(content.verdict(study), in_words(study, with_values=False)),
        *_coefficients(study),
        *_main(study),
        *_stability(study),
    )
    return Document(
        study.plan.title or study.plan.name, "Summary on one page; the whole report holds budgets, checks and sources",
        sections, study.plan.name, digest_of(study.inputs), answer=answer(study),
    )  # fmt: skip


def acceptance_summary(found: Acceptance, whole: Document) -> Document:
    """One page on a publication reproduced.

    Parameters
    ----------
    found : Acceptance
    whole : Document
        Its whole report.
    """
    first = acceptance_document.verdict(found)
    figures = (*acceptance_document.figures(found)[:1], *first.figures)
    sections = (replace(first, paragraphs=first.paragraphs[: MOST_PARAGRAPHS - 1], figures=()), *_drawn(figures))
    return replace(
        whole, subtitle="Summary on one page; the whole report holds every number", sections=sections, works=()
    )


def _first(verdict: Section, stability: list[str]) -> Section:
    """The first paragraphs and the last, and what is unstable, in the place of one."""
    said = verdict.paragraphs[1:]  # the first holds the values of the table below
    kept = (*said[: MOST_PARAGRAPHS - 1 - bool(stability)], *stability, said[-1]) if said else verdict.paragraphs
    return replace(verdict, paragraphs=tuple(dict.fromkeys(kept)))


def _coefficients(study: Study) -> tuple[Section, ...]:
    wanted = _with_centres(tables.by_campaign(study), study)
    if not wanted.rows:
        models = tuple(m for f in study.fits for m in f.models)
        wanted = quality(models) if models else tables.coefficients(study)
    if not wanted.rows:
        return ()
    return (Section("coefficients", "Coefficients with U95", (f"U95 covers {COVERS}.",), tables=(_cut(wanted),)),)


def _with_centres(table: Table, study: Study) -> Table:
    """Below the coefficients where the force of drift acts, forward of the reference point over L."""
    found = [d for f in study.fits for d in centre_of_pressure(f.coefficients, f.campaign)]
    rows = []
    for name in dict.fromkeys(d.name for d in found):
        cells = {d.subject: _with_half(d) for d in found if d.name == name}
        rows.append((f"x/L = {name}", *(cells.get(campaign, ABSENT) for campaign in table.headers[1:])))
    return replace(table, rows=(*table.rows, *rows)) if table.rows else table


def _with_half(d: Derived) -> str:
    return plus_minus(d.value, d.result.linear) if d.result else number(d.value)


def _cut(table: Table) -> Table:
    """The first rows, and how many more there are; no long notes."""
    left = len(table.rows) - MOST_ROWS
    notes = [n for n in table.notes if len(n) < LONGEST_NOTE][:MOST_NOTES]
    more = [f"{left} more in the whole report"] if left > 0 else []
    return replace(table, rows=table.rows[:MOST_ROWS], notes=("; ".join(notes + more),) if notes or more else ())


def _main(study: Study) -> tuple[Section, ...]:
    """The curve of the first wanted coefficient that has a value, with all its estimators; else the first model."""
    sweeps = [s for f in study.fits for s in f.sweeps if len(s.x) and s.value is not None]
    order = {symbol: i for i, symbol in enumerate(study.plan.wanted)}
    if sweeps:
        main: Sweep = min(sweeps, key=lambda s: order.get(s.symbol, len(order)))
        judged = tuple(c for c in study.comparisons if c.passed is not None)
        held = tuple(
            c for c in judged if (c.coefficient.symbol, c.coefficient.campaign) == (main.symbol, main.campaign)
        )
        return _drawn((sweep_figure(main, "main"), estimator_figure(main, held, "estimators")))
    models = [m for f in study.fits for m in f.models]
    return _drawn(model_figures(models[0], "main")[:2]) if models else ()


def _drawn(figures: tuple[Figure, ...]) -> tuple[Section, ...]:
    """Two at most, beside each other."""
    title = "Main figure" if len(figures) == 1 else "Main figures"
    return (Section("figure", title, figures=tuple(map(_short, figures))),) if figures else ()


def _short(figure: Figure) -> Figure:
    """No more than the first sentences of its caption."""
    caption = figure.caption
    if len(caption) > LONGEST_CAPTION:
        end = caption.rfind(". ", 0, LONGEST_CAPTION)
        caption = caption[: end + 1] if end > 0 else ""
    return replace(figure, caption=caption)


def _stability(study: Study) -> tuple[Section, ...]:
    """A row for every parameter file with an index."""
    rows = []
    for name, parameters in study.parameter_files.items():
        given = {d.name: d for d in stability(parameters)}
        if given:
            pairs = ((_with_half(given[i]), sense(given[i])) if i in given else (ABSENT, ABSENT) for i in INDICES)
            rows.append((name, *(cell for pair in pairs for cell in pair)))
    if not rows:
        return ()
    headers = ("parameter file", "G_h", "horizontal", "G_v", "vertical")
    table = Table("Stability of straight motion with controls fixed", headers, tuple(rows), (), frozenset({0, 2, 4}))
    return (Section("stability", "Stability", tables=(_cut(table),)),)

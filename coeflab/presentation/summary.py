"""A report on one page: the verdict, the wanted coefficients, the main figure, stability."""

from __future__ import annotations

from dataclasses import replace

from coeflab.model.acceptance import Acceptance
from coeflab.model.derived import centre_of_pressure, stability
from coeflab.model.fit_result import Sweep
from coeflab.model.study import Study
from coeflab.model.table import Table
from coeflab.presentation import acceptance_document, budget_tables, content, tables
from coeflab.presentation.document import Document, Figure, Section
from coeflab.presentation.figures import sweep_figure
from coeflab.presentation.model_figure import model_figures
from coeflab.presentation.model_tables import quality

MOST_ROWS, MOST_PARAGRAPHS, MOST_NOTES, LONGEST_NOTE = 12, 3, 4, 120


def study_summary(study: Study) -> Document:
    """One page on a study."""
    sections = (
        _first(content.verdict(study)),
        *_coefficients(study),
        *_main(study),
        *_stability(study),
    )
    return Document(
        study.plan.title or study.plan.name, "Summary on one page; the whole report holds budgets, checks and sources",
        sections, study.plan.name, content.digest_of(study.inputs),
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
    figures = tuple(_short(f) for f in acceptance_document.figures(found)[:1])
    sections = (replace(first, paragraphs=first.paragraphs[:MOST_PARAGRAPHS]), *_drawn(figures))
    return replace(
        whole, subtitle="Summary on one page; the whole report holds every number", sections=sections, works=()
    )


def _first(verdict: Section) -> Section:
    return replace(verdict, paragraphs=(*verdict.paragraphs[:MOST_PARAGRAPHS], verdict.paragraphs[-1]))


def _coefficients(study: Study) -> tuple[Section, ...]:
    wanted = tables.by_campaign(study)
    if not wanted.rows:
        models = tuple(m for f in study.fits for m in f.models)
        wanted = quality(models) if models else tables.coefficients(study)
    if not wanted.rows:
        return ()
    return (Section("coefficients", "Coefficients with U95", tables=(_cut(wanted),)),)


def _cut(table: Table) -> Table:
    """The first rows, and how many more there are; no long notes."""
    left = len(table.rows) - MOST_ROWS
    notes = [n for n in table.notes if len(n) < LONGEST_NOTE][:MOST_NOTES]
    more = [f"{left} more in the whole report"] if left > 0 else []
    return replace(table, rows=table.rows[:MOST_ROWS], notes=("; ".join(notes + more),) if notes or more else ())


def _main(study: Study) -> tuple[Section, ...]:
    """The curve of the first wanted coefficient that has a value, else of the first sweep, else of the first model."""
    sweeps = [s for f in study.fits for s in f.sweeps if len(s.x) and s.recommendation.value is not None]
    order = {symbol: i for i, symbol in enumerate(study.plan.wanted)}
    if sweeps:
        main: Sweep = min(sweeps, key=lambda s: order.get(s.symbol, len(order)))
        return _drawn((_short(sweep_figure(main, "main")),))
    models = [m for f in study.fits for m in f.models]
    return _drawn(tuple(_short(f) for f in model_figures(models[0], "main")[:1])) if models else ()


def _drawn(figures: tuple[Figure, ...]) -> tuple[Section, ...]:
    return (Section("figure", "Main figure", figures=figures),) if figures else ()


def _short(figure: Figure) -> Figure:
    """No more than the first sentences of its caption; the page has one figure."""
    return replace(figure, anchor="main", caption=figure.caption[:400])


def _stability(study: Study) -> tuple[Section, ...]:
    derived = [d for f in study.fits for d in centre_of_pressure(f.coefficients, f.campaign)]
    derived += [d for p in study.parameter_files.values() for d in stability(p)]
    table = budget_tables.derived(derived)
    if not table.rows:
        return ()
    kept = [i for i, h in enumerate(table.headers) if i == 0 or h in ("subject", "value", "95 % Monte Carlo")]
    narrow = Table(
        "Centre of pressure over L and stability indices",
        tuple(table.headers[i].removesuffix(" Monte Carlo") for i in kept),
        tuple(tuple(row[i] for i in kept) for row in table.rows),
        (),
        frozenset({0, 1}),
    )
    return (Section("stability", "Stability", tables=(_cut(narrow),)),)

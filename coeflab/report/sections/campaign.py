"""One section a campaign, one part of it a coefficient."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from coeflab.core.axes import point_in_words
from coeflab.core.provenance import work
from coeflab.core.table import Table, percent, plus_minus, with_u95
from coeflab.core.wording import listed
from coeflab.fits.results.fit_result import FitResult, Sweep
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.results.lack_of_fit import residuals_in_words
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import primed
from coeflab.report.document import Figure, Section
from coeflab.report.figures.estimator import estimator_figure
from coeflab.report.figures.incidence import ACROSS, incidence_figure
from coeflab.report.figures.model import distinct, model_figures, over_what
from coeflab.report.figures.sweep import sweep_figure
from coeflab.report.figures.variables import moving, response_name
from coeflab.report.sections.coefficients import in_one_line
from coeflab.report.sections.oscillations import oscillation_sections
from coeflab.report.tables import models as joint_tables
from coeflab.report.tables import models as model_tables
from coeflab.report.tables import results as tables
from coeflab.report.tables import sources as source_tables
from coeflab.report.tables import sweeps as sweep_tables
from coeflab.report.texts import text_of
from coeflab.study.study import Study
from coeflab.study.symmetry import zeros
from coeflab.tables.force_table import ForceTable
from coeflab.vehicle.published_values import Relation

LONGEST = 80


def filled(*several: Table) -> tuple[Table, ...]:
    """The tables that have rows."""
    return tuple(t for t in several if t.rows)


def anchor(text: str, taken: set[str]) -> str:
    """An identifier for a link, unique among those taken."""
    base = re.sub(r"[^a-z0-9]+", "-", text.lower())[:LONGEST].strip("-") or "part"
    name, n = base, 2
    while name in taken:
        name, n = f"{base}-{n}", n + 1
    taken.add(name)
    return name


def campaign_section(study: Study, fit: FitResult, place: str, taken: set[str]) -> Section:
    """A campaign by one fit: its data, its coefficients, its sweeps.

    Parameters
    ----------
    study : Study
    fit : FitResult
    place : str
        Its anchor.
    taken : set of str
        Anchors that its parts must not have.
    """
    mine = [t for t in study.tables if t.campaign in fit.campaigns]
    title = mine[0].title if len(fit.campaigns) == 1 and mine else f"Jointly: {fit.campaign}"
    if sum(f.campaign == fit.campaign for f in study.fits) > 1:
        title = f"{title} ({fit.fit})"
    again = _first_of(study, fit) is not fit
    text = [text_of("campaign.as_before")] if again else [*(line for t in mine for line in _about(t)), *_obtained(mine)]
    zero = zeros(study, fit.campaign, fit.coefficients.coefficients)
    alone = [s for s in fit.sweeps if s.symbol not in {c.symbol for c in zero} and not s.by_symmetry]
    own = next((t for t in study.plan.tows if t.campaign == fit.campaign), None)
    if own is not None:  # a tow beside the campaigns of a study has a handful of runs: its own report draws them
        alone = [s for s in alone if s.symbol in study.plan.wanted and own.added is None]
    text += [line for line in (in_one_line(zero), _in_the_table(fit, alone, zero)) if line]
    text += [r.in_words for r in fit.straight]
    if "swept about" in fit.settings:
        text.append(text_of("campaign.swept_about", settings=fit.settings["swept about"]))
    return Section(
        place,
        title,
        tuple(text),
        filled(
            *(() if again else (source_tables.declared(mine), tables.coefficients(study, fit.campaign))),
            joint_tables.campaigns((fit,)),
            *map(tables.straight_runs, fit.straight),
        ),
        tuple(
            incidence_figure(t, rate, study.body, anchor(f"{place} {t.name} {rate}", taken))
            for t in mine
            for rate in ACROSS
            if rate in t.varies and not _shown_before(study, fit)
        ),
        subsections=(
            *(_sweep_section(study, fit, s, anchor(f"{place} {s.symbol}", taken)) for s in alone),
            *(_model_section(m, anchor(f"{place} {m.response}", taken)) for m in distinct(fit.models)),
            *oscillation_sections(study, fit, lambda name: anchor(f"{place} {name}", taken)),
        ),
    )


def says_nothing(section: Section) -> bool:
    """Whether a later fit of a campaign brings nothing to its section but the pointer to the first one."""
    return section.paragraphs == (text_of("campaign.as_before"),) and not (
        section.tables or section.figures or section.subsections
    )


def _in_the_table(fit: FitResult, alone: list[Sweep], zero: Sequence[Coefficient]) -> str:
    """Slopes without a section: turned by symmetry, or of an own tow and not among those that the plan wants."""
    words = {s.symbol for s in alone} | {c.symbol for c in zero}
    left = [primed(s.symbol) for s in fit.sweeps if s.symbol not in words]
    return (
        f"In the table only, by symmetry from other points, not among those wanted, or of an own tow: {listed(left)}."
        if left
        else ""
    )


def _first_of(study: Study, fit: FitResult) -> FitResult:
    """The first fit of the same campaign, whose section describes the data and has the table of all coefficients."""
    return next(f for f in study.fits if f.campaign == fit.campaign)


def _shown_before(study: Study, fit: FitResult) -> bool:
    """Whether the section of another fit already draws the tables of this one."""
    return next(f for f in study.fits if set(fit.campaigns) & set(f.campaigns)) is not fit


def _model_section(model: FittedModel, place: str) -> Section:
    name = f"{response_name(model)} over {over_what(model)}" if moving(model) else response_name(model)
    shown = filled(model_tables.influence(model), model_tables.correlations(model))
    return Section(place, name, residuals_in_words(model), shown, model_figures(model, place))


def _about(table: ForceTable) -> list[str]:
    usable = sum(int(mask.sum()) for mask in table.usable.values())
    cells = sum(mask.size for mask in table.usable.values())
    source = table.source
    text = [
        text_of(
            "campaign.about",
            name=table.name,
            body=table.body.replace("_", " "),
            table=len(table),
            usable=usable,
            cells=cells,
            run_at=table.run_at.capitalize(),
            citation=work(source.citation),
        )
        + (f" {source.place}." if source.place else "")
    ]
    if table.notes:
        text.append(f"Done on reading: {'; '.join(table.notes)}.")
    return text


def _obtained(several: Sequence[ForceTable]) -> Iterator[str]:
    """How tables were obtained and what their sources state of their uncertainty, once where they share it."""
    yield from dict.fromkeys(t.source.how_obtained for t in several if t.source.how_obtained)
    for stated in dict.fromkeys(t.source.stated_uncertainty for t in several if t.source.stated_uncertainty):
        yield f"Uncertainty as the source states it: {stated}."


def _sweep_section(study: Study, fit: FitResult, sweep: Sweep, place: str) -> Section:
    c = fit.coefficients[sweep.symbol]
    name = primed(sweep.symbol)
    there = moved_from(fit, sweep)
    about = f" about {point_in_words(fit.coefficients.reference_point, fit.coefficients.datum)}" if there else ""
    if c.value is None:
        text = [f"{name} has no value. {c.estimator} {c.status.advice}"]
    else:
        text = [
            f"{name}{about} = {plus_minus(c.value, c.u95)} (U95, {percent(c.u95, c.value)}; covers {tables.covers(study, [c])}): random part "
            f"{percent(c.parts.random, c.value)}, form {percent(c.parts.model_form, c.value)}. {c.status.advice}".strip()
        ]
    if there:
        text.append(
            f"{name} about {there} = {plus_minus(sweep.value or 0.0, sweep.u95)}: the value of this sweep, before it is moved to "
            "the study's point. All that follows here, figures and tables, is about that point."
        )
    if sweep.one_sided:
        text.append("All points lie on one side of zero: even and odd parts cannot be told apart.")
    text += _caveats(sweep)
    published = tuple(
        k
        for k in study.comparisons
        if k.relation is Relation.RE_ANALYSIS
        and k.coefficient.campaign == sweep.campaign
        and k.coefficient.symbol == sweep.symbol
    )
    figures: list[Figure] = []
    if len(sweep.x):
        figures.append(sweep_figure(sweep, f"{place}-data"))
    if sweep.forms:
        figures.append(estimator_figure(sweep, published, f"{place}-estimators"))
    shown = filled(sweep_tables.sensitivity(sweep), sweep_tables.left_out(sweep), sweep_tables.estimators(sweep))
    return Section(place, name, tuple(text), shown, tuple(figures))


def moved_from(fit: FitResult, sweep: Sweep) -> str:
    """The point of a sweep whose value another point changes, in words; empty where its value is that of the coefficient."""
    c = fit.coefficients[sweep.symbol]
    same = sweep.value is None or (c.value is not None and bool(np.isclose(c.value, sweep.value, rtol=1e-9, atol=0.0)))
    return "" if same else fit.settings.get("swept about", "the point at which its runs do not drift")


def _caveats(sweep: Sweep) -> list[str]:
    out = []
    if len(sweep.wrong):
        out.append(
            text_of(
                "campaign.wrong",
                names=", ".join(sweep.labels[i] for i in sweep.wrong),
                symbol=primed(sweep.symbol),
                with_all=with_u95(sweep.with_all, sweep.u95)[0],
            )
        )
    shorter = [s for s in sweep.sensitivity if s.value is not None]
    if shorter and sweep.value is not None:
        low, high = (with_u95(f(s.value for s in shorter if s.value is not None), sweep.u95)[0] for f in (min, max))
        moved = f"stays at {low}" if low == high else f"lies between {low} and {high}"
        out.append(f"Had the sweep ended sooner, as in the table by largest setting, the value {moved}.")
    return out

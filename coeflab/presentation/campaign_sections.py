"""One section a campaign, one part of it a coefficient."""

from __future__ import annotations

import re

from coeflab.core.citations import work
from coeflab.core.symbols import primed
from coeflab.model.fit_result import FitResult, Sweep
from coeflab.model.fitted_model import FittedModel
from coeflab.model.force_table import ForceTable
from coeflab.model.misfit import residuals_in_words
from coeflab.model.reference import Relation
from coeflab.model.study import Study
from coeflab.model.table import Table, coefficient, percent
from coeflab.presentation import joint_tables, model_tables, tables
from coeflab.presentation.document import Figure, Section
from coeflab.presentation.estimator_figure import estimator_figure
from coeflab.presentation.figures import sweep_figure
from coeflab.presentation.model_figure import distinct, model_figures, over_what
from coeflab.presentation.variables import moving, response_name

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
    text = [line for t in mine for line in _about(t)]
    if "swept about" in fit.settings:
        text.append(
            f"Figures and estimators are about {fit.settings['swept about']}: the coefficients in the tables are about "
            "the study's reference point."
        )
    return Section(
        place,
        title,
        tuple(text),
        filled(tables.coefficients(study, fit.campaign), joint_tables.campaigns((fit,))),
        subsections=(
            *(_sweep_section(study, fit, s, anchor(f"{place} {s.symbol}", taken)) for s in fit.sweeps),
            *(_model_section(m, anchor(f"{place} {m.response}", taken)) for m in distinct(fit.models)),
        ),
    )


def _model_section(model: FittedModel, place: str) -> Section:
    name = f"{response_name(model)} over {over_what(model)}" if moving(model) else response_name(model)
    shown = filled(model_tables.influence(model), model_tables.correlations(model))
    return Section(place, name, residuals_in_words(model), shown, model_figures(model, place))


def _about(table: ForceTable) -> list[str]:
    usable = sum(int(mask.sum()) for mask in table.usable.values())
    cells = sum(mask.size for mask in table.usable.values())
    source = table.source
    text = [
        f"{table.name}: {table.body.replace('_', ' ')}, {len(table)} rows; {usable} of {cells} force cells are usable. "
        f"Speed {table.conditions.speed:.5g} m/s, density {table.conditions.density:.5g} kg/m3. "
        f"Source: {work(source.citation)}" + (f" {source.place}." if source.place else "")
    ]
    if source.how_obtained:
        text.append(source.how_obtained)
    if source.stated_uncertainty:
        text.append(f"Uncertainty as the source states it: {source.stated_uncertainty}.")
    if table.notes:
        text.append(f"Done on reading: {'; '.join(table.notes)}.")
    return text


def _sweep_section(study: Study, fit: FitResult, sweep: Sweep, place: str) -> Section:
    c = fit.coefficients[sweep.symbol]
    name = primed(sweep.symbol)
    if c.value is None:
        text = [f"{name} has no value. {c.status.advice}"]
    elif c.u95 is None:
        text = [f"{name} = {coefficient(c.value)}, no U95. {c.status.advice}"]
    else:
        text = [
            f"{name} = {coefficient(c.value)} ± {coefficient(c.u95)} (U95, {percent(c.u95, c.value)}): random part "
            f"{percent(c.parts.random, c.value)}, model-form part {percent(c.parts.model_form, c.value)}."
        ]
    if sweep.one_sided:
        text.append(
            "All points lie on one side of zero, so terms of the other parity cannot be told apart and are left out."
        )
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
    if sweep.plain or sweep.recommendation.panel:
        figures.append(estimator_figure(sweep, published, f"{place}-estimators"))
    shown = filled(tables.members(sweep), tables.sensitivity(sweep), tables.left_out(sweep), tables.estimators(sweep))
    return Section(place, name, tuple(text), shown, tuple(figures))


def _caveats(sweep: Sweep) -> list[str]:
    out = []
    capped = [s.value for s in sweep.sensitivity if s.value is not None]
    if capped and sweep.recommendation.value is not None:
        low, high = coefficient(min(capped)), coefficient(max(capped))
        moved = f"stays at {low}" if low == high else f"lies between {low} and {high}"
        out.append(f"When no window may exceed the limits in the table of largest windows, the value {moved}.")
    if sweep.left_out:
        reasons: dict[str, list[str]] = {}
        for p in sweep.left_out:
            reasons.setdefault(p.reason, []).append(p.label)
        each = "; ".join(f"{', '.join(labels)} ({why})" for why, labels in reasons.items())
        out.append(f"Left out: {each}.")
    return out

"""Nouns as cards: a heading, a picture, a table; what a notebook shows of them.

A card carries its own style, needs nothing from anywhere and takes its ink from the page, light or dark. Equal nouns give
equal bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.errors import CoeflabError
from coeflab.core.finding import Severity
from coeflab.core.several import Several, labels
from coeflab.core.table import ABSENT, Check, Table, number, percent
from coeflab.core.types import Array
from coeflab.core.wording import counted, listed
from coeflab.law.coefficient import Coefficient, CoefficientSet
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.report.card_parts import (
    MOST_NOTES,
    MOST_PICTURES,
    OURS,
    Part,
    absent_part,
    card,
    coefficient_grid,
    grid_part,
    heading_part,
    notes_part,
    parts_in_a_row,
    picture_part,
    table_part,
)
from coeflab.report.markup import cell_html, html
from coeflab.report.tables import nouns as tables

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.fits.uncertainty.budget import Budget
    from coeflab.law.added_mass import AddedMass
    from coeflab.motion.manoeuvre import Simulation
    from coeflab.motion.trajectory import Trajectory
    from coeflab.report.acceptance import Acceptance
    from coeflab.report.document import Answer, Figure
    from coeflab.study.study import Study
    from coeflab.tables.force_table import ForceTable
    from coeflab.vehicle.parameter_file import ParameterFile

OF_SEVERITY = {Severity.PASS: "#1f9370", Severity.NOTE: "#8a97a5", Severity.WARN: "#c98a1b", Severity.FAIL: "#d6453a"}
DRAWN = "noun"


@card
def answer_card(found: Answer) -> tuple[Part, ...]:
    """The sentence, the rows beside published columns, the pictures, the chips."""
    return (heading_part(found.sentence), _answer(found))


def _answer(found: Answer) -> Part:
    """Pictures, then the rows of `answer_table`, chips and notes."""
    from coeflab.report.answer_table import answer_table

    table = answer_table(found)
    if found.table is not None:
        rows = table_part(table)
    else:
        cells = [
            [absent_part(c) if i == 1 and r.value is None else cell_html(c) for i, c in enumerate(row)]
            for r, row in zip(found.rows, table.rows, strict=True)
        ]
        rows = grid_part(table.headers, cells, table.left) + notes_part(table.notes[:MOST_NOTES])
    chips = "".join(
        f'<li style="--of: {OF_SEVERITY[c.severity]}"><b>{html(c.name)}</b> {html(c.text)}</li>' for c in found.chips
    )
    below = f'<ul class="chips">{chips}</ul>' if chips else ""
    return parts_in_a_row(*map(picture_part, (found.slope, found.forest)), f"<div>{rows}{below}</div>")


@card
def study_card(found: Study) -> tuple[Part, ...]:
    """Its answer, and what else it holds."""
    from coeflab.report.first_page import answer as answer_of

    first = answer_of(found)
    about = (
        f"Study {found.plan.name}: {counted(len(found.tables), 'table')}, {counted(len(found.fits), 'fit')}, "
        f"{counted(len(found.coefficients), 'coefficient')}, {counted(len(found.checks), 'finding')}. "
        f"Parameter files: {', '.join(found.parameter_files) or 'none'}."
    )
    return (heading_part(first.sentence, about), _answer(first))


@card
def acceptance_card(found: Acceptance) -> tuple[Part, ...]:
    """A publication reproduced: its answer."""
    from coeflab.report.first_page import answer as answer_of

    first = answer_of(found)
    return (heading_part(first.sentence, f"Publication reproduced: {found.name}"), _answer(first))


@card
def one_coefficient_card(c: Coefficient) -> tuple[Part, ...]:
    """Its value with the interval, what makes U95 up, and how it was made."""
    parts = {"noise": c.parts.random, "form": c.parts.model_form, "inputs": c.parts.input}
    result = [f"{name} {percent(size, c.value)}" for name, size in parts.items() if size is not None]
    about = [f"{c.n_points} points over {tables.window_text(c)}" if c.window else "", c.estimator, c.body]
    of = f"U95 holds {listed(result)} of the value." if result else ""
    return (
        parts_in_a_row(coefficient_grid((c,))),
        notes_part([t for t in ("; ".join(a for a in about if a), of, c.status.advice) if t]),
    )


@card
def coefficients_card(found: CoefficientSet) -> tuple[Part, ...]:
    """Every coefficient with its interval."""
    at = ", ".join(f"{x:.4g}" for x in found.reference_point)
    if found.conditions is None:
        by = f"primed by {found.scaling.length_name} {found.scaling.length:.5g} m"
    else:
        by = f"SI at {found.conditions.speed:.4g} m/s and {found.conditions.density:.5g} kg/m^3"
    about = f"{by}; about ({at}) m from: {found.datum}"
    return (
        heading_part(f"{found.body}: {len(found.coefficients)} coefficients", about),
        parts_in_a_row(coefficient_grid(found.coefficients)),
    )


@card
def fit_card(result: FitResult) -> tuple[Part, ...]:
    """The curve of the first slope, or the first model, and the coefficients."""
    from coeflab.report.figures.model import model_figures
    from coeflab.report.figures.sweep import sweep_figure

    drawn = next((s for s in result.sweeps if s.value is not None and s.parity == "odd" and len(s.x)), None)
    figure = sweep_figure(drawn, DRAWN) if drawn is not None else None
    if figure is None and result.models:
        figure = next(iter(model_figures(result.models[0], DRAWN)), None)
    found = result.coefficients.coefficients
    grid = coefficient_grid(found) if found else table_part(tables.terms(result.models[0])) if result.models else ""
    more = f"{len(result.models)} fitted models" if len(result.models) > 1 else ""
    heading = f"{result.fit} of {result.campaign}"
    return (heading_part(heading, f"{result.body}; primed by {result.coefficients.scaling.length_name}", more),
            parts_in_a_row(picture_part(figure), grid))  # fmt: skip


@card
def model_card(found: FittedModel) -> tuple[Part, ...]:
    """Its first figure and its terms."""
    from coeflab.report.figures.model import model_figures

    drawn = next(iter(model_figures(found, DRAWN)), None)
    return (parts_in_a_row(picture_part(drawn), f"<div>{table_part(tables.terms(found))}</div>"),)


@card
def budget_card(found: Budget) -> tuple[Part, ...]:
    """The parts of a U95 as bars and in a table."""
    from coeflab.report.figures.tornado import tornado_figure
    from coeflab.report.tables.budgets import budget as of_budget

    figure = replace(tornado_figure(found, DRAWN), caption="") if found.parts else None
    return (parts_in_a_row(picture_part(figure), f"<div>{table_part(of_budget(found))}</div>"),)


@card
def finding_card(found: Check) -> tuple[Part, ...]:
    """What a check found, what it was held against, and what it means."""
    return (
        heading_part(f"{found.severity.capitalize()}: {found.subject}", found.name.replace("_", " ")),
        notes_part([t for t in (found.statistic, f"Rule: {found.rule}" if found.rule else "", found.comment) if t]),
    )


@card
def several_card(found: Several[Any]) -> tuple[Part, ...]:
    """Nouns of one kind in a table, a row each; the first of those that have a picture with it."""
    kinds = {type(noun).__name__ for noun in found}
    result = _TOGETHER.get(next(iter(kinds)), _lines) if len(kinds) == 1 else _lines
    return result(found)


def _lines(found: Sequence[Any]) -> tuple[Part, ...]:
    """Of other nouns what each says in a line."""
    rows = tuple((next(iter(labels(noun)), ABSENT), str(noun)) for noun in found)
    return (table_part(Table(f"{len(found)} together", ("", "what it holds"), rows, (), frozenset({0, 1}))),)


def _coefficients(found: Sequence[Coefficient]) -> tuple[Part, ...]:
    valued = sum(c.value is not None for c in found)
    return (coefficient_grid(found, f"{counted(len(found), 'coefficient')}, {valued} with a value"),)


def _tables(found: Sequence[ForceTable]) -> tuple[Part, ...]:
    from coeflab.report.figures.nouns import table_figure

    rows = tuple(
        (t.name, f"{len(t)}", " ".join(t.forces), " ".join(t.varies) or ABSENT, t.body, t.source.citation)
        for t in found
    )
    shown = Table(counted(len(found), "table"), ("", "rows", "components", "over", "body", "source"), rows, (),
                  frozenset({0, 2, 3, 4, 5}))  # fmt: skip
    return (parts_in_a_row(*_pictures(table_figure, found), f"<div>{table_part(shown)}</div>"),)


def _held(file: ParameterFile) -> list[str]:
    """What of a vehicle a file has beside its law."""
    parts = {"mass": file.mass, "added mass": file.added_mass, "hydrostatics": file.hydrostatics}
    return [name for name, value in parts.items() if value]


def _files(found: Sequence[ParameterFile]) -> tuple[Part, ...]:
    from coeflab.report.figures.nouns import law_figure

    rows = []
    for p in found:
        valued = sum(c.value is not None for c in p.coefficients)
        rows.append((p.name, p.body, f"{valued} of {len(p.coefficients)}", f"{len(p.models)}",
                     ", ".join(_held(p)) or ABSENT))  # fmt: skip
    headers = ("", "body", "coefficients with a value", "fitted tables", "with")
    shown = Table(counted(len(found), "parameter file"), headers, tuple(rows), (), frozenset({0, 1, 4}))
    return (parts_in_a_row(*_pictures(law_figure, found), f"<div>{table_part(shown)}</div>"),)


def _pictures(draw: Callable[[Any, str], Figure | None], found: Sequence[Any]) -> list[Part]:
    """Of the first nouns, each with an anchor and the name of its own."""
    drawn = [(noun.name, draw(noun, f"{DRAWN}-{i}")) for i, noun in enumerate(found[:MOST_PICTURES])]
    return [picture_part(replace(figure, caption=name)) for name, figure in drawn if figure is not None]


def _findings(found: Sequence[Check]) -> tuple[Part, ...]:
    from coeflab.report.tables.results import checks

    return (table_part(replace(checks(found), title=counted(len(found), "finding"))),)


def _budgets(found: Sequence[Budget]) -> tuple[Part, ...]:
    from coeflab.report.tables.budgets import overview

    return (table_part(overview(found)),)


_TOGETHER: dict[str, Callable[[Any], tuple[Part, ...]]] = {
    "Coefficient": _coefficients, "ForceTable": _tables, "ParameterFile": _files, "Check": _findings, "Budget": _budgets,
}  # fmt: skip


@card
def force_table_card(found: ForceTable) -> tuple[Part, ...]:
    """Points over the motion that varies, and what every column spans."""
    from coeflab.report.figures.nouns import table_figure

    length, rows = found.scaling.length, []
    for name in found.varies:
        x, isangle = found.primed_motion(name, length), name in found.controls
        x = np.degrees(x) if isangle else x
        rows.append((name if isangle else f"{name}'", "deg" if isangle else "1", *_span(x), ABSENT))
    for name, force in found.forces.items():
        unused = int(np.sum(~found.usable[name] & np.isfinite(force)))
        rows.append((name, "N" if name in "XYZ" else "N m", *_span(force), f"{unused}" if unused else ABSENT))
    table = Table("", ("", "unit", "least", "largest", "cells not used"), tuple(rows), found.notes, frozenset({0, 1}))
    at = ", ".join(f"{x:.4g}" for x in found.reference_point)
    about = f"{found.body}; {found.run_at}; {found.scaling.length_name} {length:.5g} m; moments about ({at}) m from: {found.datum}"
    return (heading_part(f"{found.name}: {len(found)} rows", found.title, about, f"Source: {found.source.citation}"),
            parts_in_a_row(picture_part(table_figure(found, DRAWN)), f"<div>{table_part(table)}</div>"))  # fmt: skip


def _span(values: Array) -> tuple[str, str]:
    finite = values[np.isfinite(values)]
    return (number(float(finite.min())), number(float(finite.max()))) if len(finite) else (ABSENT, ABSENT)


@card
def body_card(found: Body) -> tuple[Part, ...]:
    """Outlines from the side and from above, and particulars."""
    from coeflab.report.figures.hull_outline import hull_figure
    from coeflab.report.tables.added_mass import particulars

    figure = None
    if found.shape is not None:
        try:
            figure = hull_figure(found, DRAWN)
        except CoeflabError:  # a shape without a closed surface has no outline
            figure = None
    lengths = ", ".join(f"{name.replace('_', ' ')} {value:.5g} m" for name, value in found.lengths.items())
    shape = "" if found.shape is not None else "Particulars only: its file states no shape."
    return (heading_part(f"{found.name}: {found.title}", lengths, shape),
            parts_in_a_row(picture_part(figure), f"<div>{table_part(replace(particulars(found), title=''))}</div>"))  # fmt: skip


@card
def added_mass_card(found: AddedMass) -> tuple[Part, ...]:
    """The matrix, every entry shaded by its share of the roots of its diagonals."""
    at = ", ".join(f"{x:.4g}" for x in found.reference_point)
    about = f"M_A about ({at}) m from: {found.datum}; kg, kg m, kg m^2; {found.verdict}"
    size = np.sqrt(np.abs(np.diag(found.matrix)))
    share = np.abs(found.matrix) / np.maximum(np.outer(size, size), 1e-300)
    cut = tables.ROUNDING * float(np.max(np.abs(found.matrix), initial=0.0))
    rows = []
    for i, name in enumerate(COMPONENTS):
        cells = [
            f'<div style="background: color-mix(in srgb, {OURS} {100.0 * min(share[i, j], 1.0) * 0.55:.0f}%, transparent); '
            f'padding: 0.1rem 0.3rem">{cell_html(number(float(v)))}</div>'
            if abs(v) > cut else "0"
            for j, v in enumerate(found.matrix[i])
        ]  # fmt: skip
        rows.append([name, *cells])
    grid = grid_part(("", *(f"{m}dot" for m in MOTIONS)), rows)
    rough = ("Only a rough guide for this body.",) if found.rough else ()
    return (heading_part(f"Added mass of {found.body or 'a body'} by {found.method}", about), parts_in_a_row(f"<div>{grid}</div>"),
            notes_part((*rough, *found.statements[:MOST_NOTES])))  # fmt: skip


@card
def parameters_card(found: ParameterFile) -> tuple[Part, ...]:
    """The force law with its points, and the coefficients."""
    from coeflab.report.figures.nouns import law_figure

    at = f"{found.conditions.speed:.5g} m/s and {found.conditions.density:.5g} kg/m^3"
    valued = sum(c.value is not None for c in found.coefficients)
    heading = f"{found.name}: " + ", ".join(
        [f"{valued} of {len(found.coefficients)} coefficients have a value"] * bool(found.coefficients)
        + [counted(len(found.models), "fitted table")] * bool(found.models)
    )
    about = f"{found.body}; primed by {found.scaling.length_name} {found.scaling.length:.5g} m; SI at {at}"
    held = _held(found)
    held += [counted(len(found.thrusters), "thruster")] if found.thrusters else []
    ordered = sorted(found.coefficients, key=lambda c: c.value is None)
    return (heading_part(heading, about, f"With {listed(held)}." if held else ""),
            parts_in_a_row(picture_part(law_figure(found, DRAWN)), f"<div>{coefficient_grid(ordered) if ordered else ''}{_models(found)}</div>"),
            notes_part(found.remarks[:MOST_NOTES]))  # fmt: skip


def _models(found: ParameterFile) -> Part:
    """The fitted tables of a file, a row each."""
    rows = [
        (m.response, m.unit, ", ".join(m.names), m.form, f"{len(m.terms)}", f"{m.n_points}", m.campaign)
        for m in found.models
    ]
    headers = ("response", "unit", "over", "form", "terms", "points", "from")
    return table_part(Table("", headers, tuple(rows), (), frozenset({0, 1, 2, 3, 6}))) if rows else ""


@card
def motion_card(found: Trajectory) -> tuple[Part, ...]:
    """The track, and beginning, end and range of every quantity."""
    from coeflab.report.figures.motion import track_figures

    table = tables.motion(found)
    return (
        heading_part(table.title),
        parts_in_a_row(
            picture_part(track_figures(found, DRAWN, 0.0)[0]), f"<div>{table_part(replace(table, title=''))}</div>"
        ),
    )


@card
def simulation_card(found: Simulation) -> tuple[Part, ...]:
    """The track with the body drawn on it, and the figures of the manoeuvre."""
    from coeflab.report.figures.motion import track_figures
    from coeflab.report.tables.motion import figure_table

    table = figure_table(found.figures, "", found.vehicle.length)
    why = found.undetermined or found.trajectory.why
    drawn = None if found.undetermined else track_figures(found.trajectory, DRAWN, found.vehicle.length)[0]
    return (
        heading_part(f"{found.manoeuvre.name} of {found.vehicle.name}", why),
        parts_in_a_row(picture_part(drawn), f"<div>{table_part(table)}</div>"),
    )


@card
def figure_card(found: Figure) -> tuple[Part, ...]:
    """The drawing with its caption."""
    return (picture_part(found),)

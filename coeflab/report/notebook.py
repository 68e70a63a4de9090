"""Nouns as cards: a heading, a picture, a table; what a notebook shows of them.

A card carries its own style, needs nothing from anywhere and takes its ink from the page, light or dark. Equal nouns give
equal bytes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, wraps
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.errors import CoeflabError
from coeflab.core.finding import Severity
from coeflab.core.several import labels
from coeflab.core.table import ABSENT, Table, number, percent
from coeflab.core.text.bounded import own_text
from coeflab.core.types import Array
from coeflab.core.wording import counted, listed
from coeflab.law.coefficient import Coefficient, CoefficientSet
from coeflab.law.symbols import COMPONENTS, MOTIONS, primed
from coeflab.report.markup import cell_html, html, unit_html
from coeflab.report.notation import keeping, users_texts
from coeflab.report.tables import nouns as tables

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.core.several import Several
    from coeflab.core.table import Check
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
OURS, AGAINST = "#2f86c5", "#d2691e"
DRAWN = "noun"
LONG, MOST_ROWS, MOST_NOTES, MOST_PICTURES = 34, 24, 4, 2
WIDE, TALL = 100.0, 14.0
ACROSS = 1.12  # pixels a point of a drawing at the most
DRAFT = "coeflab-draft"  # stands for the digest of the card, which ids begin with

Part = str
Maker = Callable[[Any], tuple[Part, ...]]


def _card(make: Maker) -> Callable[[Any], str]:
    """Parts of a noun as one card; what users wrote is set as they wrote it, ids are the card's own."""

    @wraps(make)
    def wrapped(noun: Any) -> str:
        with keeping(users_texts(noun)):
            content = "".join(make(noun))
        own = f"c{hashlib.sha256(content.encode()).hexdigest()[:10]}"
        return f'<div class="coeflab"><style>{_style()}</style>{content.replace(DRAFT, own)}</div>'

    return wrapped


@cache
def _style() -> str:
    symbols = own_text(files("coeflab.report.formats") / "_html" / "symbols.css")
    style = own_text(files("coeflab.report") / "notebook.css")
    return f"\n{style}.coeflab {{\n{symbols}}}\n"


def _heading(title: str, *about: str) -> Part:
    lines = "".join(f'<p class="about">{html(a)}</p>' for a in about if a)
    return f'<p class="said">{html(title)}</p>{lines}'


def _parts(*several: Part) -> Part:
    return f'<div class="parts">{"".join(several)}</div>'


def _picture(figure: Figure | None) -> Part:
    if figure is None:
        return ""
    from coeflab.report.figures.first_page import renamed
    from coeflab.report.figures.svg_file import size_of

    caption = f"<figcaption>{html(figure.caption)}</figcaption>" if figure.caption else ""
    widest = ACROSS * size_of(figure.svg)[0]
    return (
        f'<figure style="max-width: {widest:.0f}px">{renamed(figure, f"{DRAFT}-{figure.anchor}").svg}{caption}</figure>'
    )


def _grid(
    headers: Sequence[str], rows: Sequence[Sequence[Part]], left: frozenset[int] = frozenset({0}), title: str = ""
) -> Part:
    """A table of cells that are HTML already."""
    caption = f"<caption>{html(title)}</caption>" if title else ""

    def row(tag: str, cells: Sequence[Part]) -> str:
        classed = (f'<{tag} class="left">' if i in left else f"<{tag}>" for i in range(len(cells)))
        return f"<tr>{''.join(f'{open_}{cell}</{tag}>' for open_, cell in zip(classed, cells, strict=True))}</tr>"

    body = "".join(row("td", r) for r in rows)
    head = row("th", [html(h) for h in headers])
    return f'<div class="wide"><table>{caption}<thead>{head}</thead><tbody>{body}</tbody></table></div>'


def _shown(table: Table) -> Part:
    """A table of texts, cut, with its notes."""
    rows = [
        [unit_html(cell) if head == "unit" else _cell(cell) for head, cell in zip(table.headers, row)]
        for row in table.rows[:MOST_ROWS]
    ]
    more = len(table.rows) - MOST_ROWS
    notes = (*((f"{more} more rows.",) if more > 0 else ()), *table.notes[:MOST_NOTES])
    return _grid(table.headers, rows, table.left, table.title) + _notes(notes)


def _cell(text: str) -> Part:
    return f'<span class="long">{cell_html(text)}</span>' if len(text) > LONG else cell_html(text)


def _notes(notes: Sequence[str]) -> Part:
    return "".join(f'<p class="note">{html(n)}</p>' for n in notes)


def _absent(status: str) -> Part:
    return f'<span class="absent">{escape(status)}</span>'


def _bar(low: float, high: float, mark: float, ticks: Sequence[float], span: tuple[float, float], title: str) -> Part:
    """A bar with a mark over a scale, what lies beyond it cut off at an open end."""
    scale = WIDE / (span[1] - span[0])
    at = [(min(max(v, span[0]), span[1]) - span[0]) * scale for v in (low, high, mark)]
    lines = "".join(
        f'<path d="M{(t - span[0]) * scale:.1f} 0V{TALL:g}" stroke="currentColor" stroke-opacity="0.35"/>'
        for t in ticks
    )
    width = max(at[1] - at[0], 1.0)
    ends = [x for x, v in ((2.0, low), (WIDE - 2.0, high)) if (v < span[0] if x < WIDE / 2.0 else v > span[1])]
    open_ = "".join(f'<circle cx="{x:g}" cy="{TALL / 2:g}" r="2" fill="{AGAINST}"/>' for x in ends)
    return (
        f'<svg viewBox="0 0 {WIDE:g} {TALL:g}" role="img" aria-label="{escape(title)}"><title>{escape(title)}</title>{lines}'
        f'<rect x="{at[0]:.1f}" y="4" width="{width:.1f}" height="6" fill="{OURS}" fill-opacity="0.55"/>'
        f'<path d="M{at[2]:.1f} 2V12" stroke="{OURS}" stroke-width="2"/>{open_}</svg>'
    )


def _interval(value: float | None, u95: float | None) -> Part:
    """Value and U95 over the value: the left line is zero, the mark the value; a band across the line leaves the sign open."""
    if not value or u95 is None or not np.isfinite(u95):
        return ""
    share = abs(u95 / value)
    sign = "the sign is open" if share >= 1.0 else "the sign is settled"
    return _bar(
        1.0 - share, 1.0 + share, 1.0, (0.0,), (-0.5, 2.5), f"U95 is {percent(u95, value)} of the value: {sign}"
    )


def _coefficient_row(c: Coefficient) -> list[Part]:
    value, u95 = tables.with_status(c)
    if c.value is None:
        return [cell_html(_name(c)), _absent(value), "", "", "", _cell(c.campaign or c.citation or ABSENT)]
    share = percent(c.u95, c.value)
    come = c.campaign or c.citation or ABSENT
    return [cell_html(_name(c)), cell_html(value), cell_html(u95), share, _interval(c.value, c.u95), _cell(come)]


def _name(c: Coefficient) -> str:
    return primed(c.symbol.removesuffix("'")) if c.unit == "1" else c.symbol


def _coefficient_grid(several: Sequence[Coefficient], title: str = "") -> Part:
    headers = ("", "value", "U95", "of value", "0 | value", "from")
    shown = several[:MOST_ROWS]
    more = len(several) - len(shown)
    notes = (f"{more} more.",) if more else ()
    return _grid(headers, [_coefficient_row(c) for c in shown], frozenset({0, 5}), title) + _notes(notes)


@_card
def answer(found: Answer) -> tuple[Part, ...]:
    """The sentence, the rows beside published columns, the pictures, the chips."""
    return (_heading(found.sentence), _answer(found))


def _answer(found: Answer) -> Part:
    """Pictures, then the rows of `answer_table`, chips and notes."""
    from coeflab.report.answer_table import answer_table

    table = answer_table(found)
    if found.table is not None:
        rows = _shown(table)
    else:
        cells = [
            [_absent(c) if i == 1 and r.value is None else cell_html(c) for i, c in enumerate(row)]
            for r, row in zip(found.rows, table.rows, strict=True)
        ]
        rows = _grid(table.headers, cells, table.left) + _notes(table.notes[:MOST_NOTES])
    chips = "".join(
        f'<li style="--of: {OF_SEVERITY[c.severity]}"><b>{html(c.name)}</b> {html(c.text)}</li>' for c in found.chips
    )
    below = f'<ul class="chips">{chips}</ul>' if chips else ""
    return _parts(*map(_picture, (found.slope, found.forest)), f"<div>{rows}{below}</div>")


@_card
def study(found: Study) -> tuple[Part, ...]:
    """Its answer, and what else it holds."""
    from coeflab.report.first_page import answer as answer_of

    first = answer_of(found)
    about = (
        f"Study {found.plan.name}: {counted(len(found.tables), 'table')}, {counted(len(found.fits), 'fit')}, "
        f"{counted(len(found.coefficients), 'coefficient')}, {counted(len(found.checks), 'finding')}. "
        f"Parameter files: {', '.join(found.parameter_files) or 'none'}."
    )
    return (_heading(first.sentence, about), _answer(first))


@_card
def acceptance(found: Acceptance) -> tuple[Part, ...]:
    """A publication reproduced: its answer."""
    from coeflab.report.first_page import answer as answer_of

    first = answer_of(found)
    return (_heading(first.sentence, f"Publication reproduced: {found.name}"), _answer(first))


@_card
def one_coefficient(c: Coefficient) -> tuple[Part, ...]:
    """Its value with the interval, what makes U95 up, and how it was made."""
    parts = {"noise": c.parts.random, "form": c.parts.model_form, "inputs": c.parts.input}
    result = [f"{name} {percent(size, c.value)}" for name, size in parts.items() if size is not None]
    about = [f"{c.n_points} points over {tables.window_text(c)}" if c.window else "", c.estimator, c.body]
    of = f"U95 holds {listed(result)} of the value." if result else ""
    return (
        _parts(_coefficient_grid((c,))),
        _notes([t for t in ("; ".join(a for a in about if a), of, c.status.advice) if t]),
    )


@_card
def coefficients(found: CoefficientSet) -> tuple[Part, ...]:
    """Every coefficient with its interval."""
    at = ", ".join(f"{x:.4g}" for x in found.reference_point)
    if found.conditions is None:
        by = f"primed by {found.scaling.length_name} {found.scaling.length:.5g} m"
    else:
        by = f"SI at {found.conditions.speed:.4g} m/s and {found.conditions.density:.5g} kg/m^3"
    about = f"{by}; about ({at}) m from: {found.datum}"
    return (
        _heading(f"{found.body}: {len(found.coefficients)} coefficients", about),
        _parts(_coefficient_grid(found.coefficients)),
    )


@_card
def fit(result: FitResult) -> tuple[Part, ...]:
    """The curve of the first slope, or the first model, and the coefficients."""
    from coeflab.report.figures.model import model_figures
    from coeflab.report.figures.sweep import sweep_figure

    drawn = next((s for s in result.sweeps if s.value is not None and s.parity == "odd" and len(s.x)), None)
    figure = sweep_figure(drawn, DRAWN) if drawn is not None else None
    if figure is None and result.models:
        figure = next(iter(model_figures(result.models[0], DRAWN)), None)
    found = result.coefficients.coefficients
    grid = _coefficient_grid(found) if found else _shown(tables.terms(result.models[0])) if result.models else ""
    more = f"{len(result.models)} fitted models" if len(result.models) > 1 else ""
    heading = f"{result.fit} of {result.campaign}"
    return (_heading(heading, f"{result.body}; primed by {result.coefficients.scaling.length_name}", more),
            _parts(_picture(figure), grid))  # fmt: skip


@_card
def model(found: FittedModel) -> tuple[Part, ...]:
    """Its first figure and its terms."""
    from coeflab.report.figures.model import model_figures

    drawn = next(iter(model_figures(found, DRAWN)), None)
    return (_parts(_picture(drawn), f"<div>{_shown(tables.terms(found))}</div>"),)


@_card
def budget(found: Budget) -> tuple[Part, ...]:
    """The parts of a U95 as bars and in a table."""
    from coeflab.report.figures.tornado import tornado_figure
    from coeflab.report.tables.budgets import budget as of_budget

    figure = replace(tornado_figure(found, DRAWN), caption="") if found.parts else None
    return (_parts(_picture(figure), f"<div>{_shown(of_budget(found))}</div>"),)


@_card
def finding(found: Check) -> tuple[Part, ...]:
    """What a check found, what it was held against, and what it means."""
    return (
        _heading(f"{found.severity.capitalize()}: {found.subject}", found.name.replace("_", " ")),
        _notes([t for t in (found.statistic, f"Rule: {found.rule}" if found.rule else "", found.comment) if t]),
    )


@_card
def several(found: Several[Any]) -> tuple[Part, ...]:
    """Nouns of one kind in a table, a row each; the first of those that have a picture with it."""
    kinds = {type(noun).__name__ for noun in found}
    result = _TOGETHER.get(next(iter(kinds)), _lines) if len(kinds) == 1 else _lines
    return result(found)


def _lines(found: Sequence[Any]) -> tuple[Part, ...]:
    """Of other nouns what each says in a line."""
    rows = tuple((next(iter(labels(noun)), ABSENT), str(noun)) for noun in found)
    return (_shown(Table(f"{len(found)} together", ("", "what it holds"), rows, (), frozenset({0, 1}))),)


def _coefficients(found: Sequence[Coefficient]) -> tuple[Part, ...]:
    valued = sum(c.value is not None for c in found)
    return (_coefficient_grid(found, f"{counted(len(found), 'coefficient')}, {valued} with a value"),)


def _tables(found: Sequence[ForceTable]) -> tuple[Part, ...]:
    from coeflab.report.figures.nouns import table_figure

    rows = tuple(
        (t.name, f"{len(t)}", " ".join(t.forces), " ".join(t.varies) or ABSENT, t.body, t.source.citation)
        for t in found
    )
    shown = Table(counted(len(found), "table"), ("", "rows", "components", "over", "body", "source"), rows, (),
                  frozenset({0, 2, 3, 4, 5}))  # fmt: skip
    return (_parts(*_pictures(table_figure, found), f"<div>{_shown(shown)}</div>"),)


def _files(found: Sequence[ParameterFile]) -> tuple[Part, ...]:
    from coeflab.report.figures.nouns import law_figure

    rows = []
    for p in found:
        valued = sum(c.value is not None for c in p.coefficients)
        held = ("mass", p.mass), ("added mass", p.added_mass), ("hydrostatics", p.hydrostatics)
        rows.append((p.name, p.body, f"{valued} of {len(p.coefficients)}", f"{len(p.models)}",
                     ", ".join(name for name, value in held if value) or ABSENT))  # fmt: skip
    headers = ("", "body", "coefficients with a value", "fitted tables", "with")
    shown = Table(counted(len(found), "parameter file"), headers, tuple(rows), (), frozenset({0, 1, 4}))
    return (_parts(*_pictures(law_figure, found), f"<div>{_shown(shown)}</div>"),)


def _pictures(draw: Callable[[Any, str], Figure | None], found: Sequence[Any]) -> list[Part]:
    """Of the first nouns, each with an anchor and the name of its own."""
    drawn = [(noun.name, draw(noun, f"{DRAWN}-{i}")) for i, noun in enumerate(found[:MOST_PICTURES])]
    return [_picture(replace(figure, caption=name)) for name, figure in drawn if figure is not None]


def _findings(found: Sequence[Check]) -> tuple[Part, ...]:
    from coeflab.report.tables.results import checks

    return (_shown(replace(checks(found), title=counted(len(found), "finding"))),)


def _budgets(found: Sequence[Budget]) -> tuple[Part, ...]:
    from coeflab.report.tables.budgets import overview

    return (_shown(overview(found)),)


_TOGETHER: dict[str, Callable[[Any], tuple[Part, ...]]] = {
    "Coefficient": _coefficients, "ForceTable": _tables, "ParameterFile": _files, "Check": _findings, "Budget": _budgets,
}  # fmt: skip


@_card
def force_table(found: ForceTable) -> tuple[Part, ...]:
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
    return (_heading(f"{found.name}: {len(found)} rows", found.title, about, f"Source: {found.source.citation}"),
            _parts(_picture(table_figure(found, DRAWN)), f"<div>{_shown(table)}</div>"))  # fmt: skip


def _span(values: Array) -> tuple[str, str]:
    finite = values[np.isfinite(values)]
    return (number(float(finite.min())), number(float(finite.max()))) if len(finite) else (ABSENT, ABSENT)


@_card
def body(found: Body) -> tuple[Part, ...]:
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
    return (_heading(f"{found.name}: {found.title}", lengths, shape),
            _parts(_picture(figure), f"<div>{_shown(replace(particulars(found), title=''))}</div>"))  # fmt: skip


@_card
def added_mass(found: AddedMass) -> tuple[Part, ...]:
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
    grid = _grid(("", *(f"{m}dot" for m in MOTIONS)), rows)
    rough = ("Only a rough guide for this body.",) if found.rough else ()
    return (_heading(f"Added mass of {found.body or 'a body'} by {found.method}", about), _parts(f"<div>{grid}</div>"),
            _notes((*rough, *found.statements[:MOST_NOTES])))  # fmt: skip


@_card
def parameters(found: ParameterFile) -> tuple[Part, ...]:
    """The force law with its points, and the coefficients."""
    from coeflab.report.figures.nouns import law_figure

    at = f"{found.conditions.speed:.5g} m/s and {found.conditions.density:.5g} kg/m^3"
    valued = sum(c.value is not None for c in found.coefficients)
    heading = f"{found.name}: " + ", ".join(
        [f"{valued} of {len(found.coefficients)} coefficients have a value"] * bool(found.coefficients)
        + [counted(len(found.models), "fitted table")] * bool(found.models)
    )
    about = f"{found.body}; primed by {found.scaling.length_name} {found.scaling.length:.5g} m; SI at {at}"
    held = [
        n
        for n, v in (("mass", found.mass), ("added mass", found.added_mass), ("hydrostatics", found.hydrostatics))
        if v
    ]
    held += [counted(len(found.thrusters), "thruster")] if found.thrusters else []
    ordered = sorted(found.coefficients, key=lambda c: c.value is None)
    return (_heading(heading, about, f"With {listed(held)}." if held else ""),
            _parts(_picture(law_figure(found, DRAWN)), f"<div>{_coefficient_grid(ordered) if ordered else ''}{_models(found)}</div>"),
            _notes(found.remarks[:MOST_NOTES]))  # fmt: skip


def _models(found: ParameterFile) -> Part:
    """The fitted tables of a file, a row each."""
    rows = [
        (m.response, m.unit, ", ".join(m.names), m.form, f"{len(m.terms)}", f"{m.n_points}", m.campaign)
        for m in found.models
    ]
    headers = ("response", "unit", "over", "form", "terms", "points", "from")
    return _shown(Table("", headers, tuple(rows), (), frozenset({0, 1, 2, 3, 6}))) if rows else ""


@_card
def motion(found: Trajectory) -> tuple[Part, ...]:
    """The track, and beginning, end and range of every quantity."""
    from coeflab.report.figures.motion import track_figures

    table = tables.motion(found)
    return (
        _heading(table.title),
        _parts(_picture(track_figures(found, DRAWN, 0.0)[0]), f"<div>{_shown(replace(table, title=''))}</div>"),
    )


@_card
def simulation(found: Simulation) -> tuple[Part, ...]:
    """The track with the body drawn on it, and the figures of the manoeuvre."""
    from coeflab.report.figures.motion import track_figures
    from coeflab.report.tables.motion import figure_table

    table = figure_table(found.figures, "", found.vehicle.length)
    why = found.undetermined or found.trajectory.why
    drawn = None if found.undetermined else track_figures(found.trajectory, DRAWN, found.vehicle.length)[0]
    return (
        _heading(f"{found.manoeuvre.name} of {found.vehicle.name}", why),
        _parts(_picture(drawn), f"<div>{_shown(table)}</div>"),
    )


@_card
def figure(found: Figure) -> tuple[Part, ...]:
    """The drawing with its caption."""
    return (_picture(found),)

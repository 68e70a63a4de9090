"""A publication reproduced, as a report: verdict, figures, every number and what it is held against, errata.

Every number of a publication as one mark: its difference over what is allowed, one strip a table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D

from coeflab.core.provenance import InputFile, work
from coeflab.core.types import Array
from coeflab.report import acceptance as acceptance_tables
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable, overview, share
from coeflab.report.document import Document, Figure, Panel, Section
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, COLUMNS, LEGEND_ROW, RIGHT, WIDTH, drawing, height_of, legend, ticks
from coeflab.report.figures.series import numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.first_page import answer
from coeflab.report.reproduction import digest_of, published_reproduction
from coeflab.report.sections.conventions import published_conventions
from coeflab.report.texts import table_of, text_of

ACROSS = "difference / tolerance  [-]"
EDGE, BEYOND = 1.28, 1.18
HEAD, LEAST, ROW, MOST, LONGEST = 15.0, 13.0, 2.7, 80.0, 60
INDENT = 16.0
HOLLOW: dict[str, Any] = {"markerfacecolor": "none", "markeredgewidth": 0.9}
FILLED: dict[str, Any] = {"markeredgewidth": 0.0}
MARKS: dict[Basis, dict[str, Any]] = {
    Basis.VALIDATION: {"marker": "^", "markersize": 4.4, "markeredgecolor": COLOURS["d"], "markerfacecolor": COLOURS["d"], **FILLED},
    Basis.VERIFICATION: {"marker": "D", "markersize": 3.8, "markeredgecolor": COLOURS["b"], "markerfacecolor": COLOURS["b"], **FILLED},
    Basis.CALIBRATION: {"marker": "s", "markersize": 3.8, "markeredgecolor": COLOURS["c"], **HOLLOW},
    Basis.CONSISTENCY: {"marker": "o", "markersize": 4.0, "markeredgecolor": COLOURS["a"], "markerfacecolor": COLOURS["a"], **FILLED},
}  # fmt: skip
OUTSIDE: dict[str, Any] = {"marker": "x", "markersize": 5.0, "markeredgecolor": COLOURS["ink"], "markeredgewidth": 1.3}


def allowance_figure(found: Acceptance, anchor: str) -> Figure:
    """All comparisons, those that repeat others too.

    Parameters
    ----------
    found : Acceptance
    anchor : str
    """
    rows = [r for t in found.tables for r in t.rows]
    held = sum(r.holds for r in rows)
    title = f"{held} of {len(rows)} comparisons within the tolerance"
    heights = [min(max(LEAST, ROW * len(t.rows)), MOST) for t in found.tables]
    body = sum(heights) + HEAD * len(heights)
    description = (
        "One strip a table, one mark a number at its difference over the tolerance: "
        + "; ".join(f"{t.title}: {t.within}" for t in found.tables)
        + "."
    )
    with settings():
        handles = _legend(rows)
        figure = drawing(BOTTOM + body + 10.0 + LEGEND_ROW * max(2, -(-len(handles) // COLUMNS)))
        top, panels = BOTTOM + body, []
        for t, height in zip(found.tables, heights, strict=True):
            _heading(figure, top, t)
            panels.append(_strip(figure, top - HEAD - height, height, t))
            top -= HEAD + height
        _scale(figure)
        legend(figure, handles, BOTTOM + body)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, text_of("acceptance.caption"), description, tuple(panels))


def _heading(figure: Drawing, top: float, t: ComparedTable) -> None:
    name = t.title if len(t.title) <= LONGEST else t.title[:LONGEST].rsplit(" ", 1)[0].rstrip(",") + " …"
    level = (top - HEAD + 4.0) / height_of(figure)
    figure.text(INDENT / WIDTH, level, name, va="baseline", fontsize=8.25)
    figure.text((WIDTH - RIGHT) / WIDTH, level, t.within, va="baseline", ha="right", color=COLOURS["muted"])


def _axes(figure: Drawing, bottom: float, height: float, up: tuple[float, float]) -> Axes:
    whole = height_of(figure)
    axes = figure.add_axes((INDENT / WIDTH, bottom / whole, (WIDTH - INDENT - RIGHT) / WIDTH, height / whole))
    axes.set_axis_off()
    axes.set_xlim(-EDGE, EDGE)
    axes.set_ylim(*up)
    return axes


def _strip(figure: Drawing, bottom: float, height: float, t: ComparedTable) -> Panel:
    """One table: its first row on top."""
    count = len(t.rows)
    axes = _axes(figure, bottom, height, (count + 0.8, 0.2))
    axes.axvspan(-1.0, 1.0, color=COLOURS["band"], alpha=0.22, linewidth=0, zorder=0)
    for x, width in ((-1.0, 0.9), (0.0, 0.6), (1.0, 0.9)):
        axes.axvline(x, color=COLOURS["muted"], linewidth=width, zorder=0.5)
    # Two decimals: further ones differ from one linear algebra to the next, and a page must not.
    at = np.array([round(share(r), 2) + 0.0 for r in t.rows])
    order = np.arange(1.0, count + 1.0)
    series = []
    for basis, look in MARKS.items():
        mine = np.array([r.basis is basis and r.holds for r in t.rows])
        series.append(_drawn(axes, _key(basis), basis, at, order, mine, look, t.rows))
    series.append(_drawn(axes, "outside", "outside", at, order, ~np.array([r.holds for r in t.rows]), OUTSIDE, t.rows))
    return numbers(axes, series, ACROSS, "row of the table")


def _key(basis: Basis) -> str:
    """The basis as a mark of the drawing, which is one word."""
    return basis.name.lower()


def _drawn(
    axes: Axes, key: str, name: str, x: Array, y: Array, mine: Any, look: dict[str, Any], rows: Sequence[Compared]
) -> Any:
    """The marks of one kind, beyond the frame at its edge; values are told of those inside, where they are what is seen."""
    if np.any(mine):
        seen = np.where(np.isnan(x), BEYOND, np.clip(x, -BEYOND, BEYOND))
        tagged(axes.plot(seen[mine], y[mine], linestyle="none", clip_on=False, zorder=3, **look), key)
    words = mine & (np.abs(x) <= BEYOND)
    return points(key, name, x[words], y[words], [_summary(r) for r, yes in zip(rows, words, strict=True) if yes])


def _summary(r: Compared) -> str:
    unit = "" if r.unit == "1" else f" {r.unit}"
    found = "no number" if r.found is None else f"{r.found:.6g}{unit}"
    against = f"{'at most ' if r.at_most else ''}{r.against:.6g}{unit}"
    return f"{r.case}, {r.quantity}: reference {against} ({r.basis}), found {found}"


def _scale(figure: Drawing) -> None:
    whole, wide = height_of(figure), WIDTH - INDENT - RIGHT
    for x in ticks((-1.0, 1.0), 4):
        place = (INDENT + wide * (x + EDGE) / (2.0 * EDGE)) / WIDTH
        text = f"{x + 0.0:g}".replace("-", "−")
        figure.text(place, (BOTTOM - 13.5) / whole, text, ha="center", va="baseline")
    figure.text((INDENT + wide / 2.0) / WIDTH, (BOTTOM - 27.5) / whole, ACROSS, ha="center", va="baseline")


def _legend(rows: Sequence[Compared]) -> list[Any]:
    kinds = [b for b in MARKS if any(r.basis is b and r.holds for r in rows)]
    handles = [tagged(Line2D([], [], linestyle="none", label=b, **MARKS[b]), _key(b)) for b in kinds]
    if not all(r.holds for r in rows):
        handles.append(tagged(Line2D([], [], linestyle="none", label="outside", **OUTSIDE), "outside"))
    return handles


def document(found: Acceptance, inputs: tuple[InputFile, ...] = ()) -> Document:
    """The report of a publication.

    Parameters
    ----------
    found : Acceptance
    inputs : tuple of InputFile, optional
        The files that it was computed from.
    """
    tables = tuple(
        Section(f"table-{t.key.replace('_', '-')}", t.title, tables=(shown,))
        for t, shown in zip(found.tables, acceptance_tables.tables(found), strict=True)
    )
    sections = (
        verdict(found),
        *_section("figures", "Figures", figures=figures(found)),
        Section("compared", "Every number and its reference", (text_of("acceptance.differences"),), subsections=tables),
        *_section("statements", "What to know", found.statements),
        *_section("parameter-files", "Parameter files", found.file_notes),
        *_errata(found),
        published_conventions(found.conventions),
        *_provenance(inputs),
        published_reproduction(found.name, inputs),
    )
    works = tuple((k, work(k)) for k in found.citations)
    return Document(
        found.title,
        text_of("acceptance.subtitle"),
        sections,
        found.name,
        digest_of(inputs),
        works,
        answer=answer(found),
    )


def verdict(found: Acceptance) -> Section:
    """How many numbers hold, and which do not."""
    rows = [*found.numbers, *found.repeated]
    text = [*headline(found)]
    for t in found.tables:
        failed = [f"{r.quantity} of {r.case}" for r in t.rows if not r.holds]
        if failed:
            text.append(f"Outside, {t.title}: {', '.join(failed)}.")
    text += [f"{b.capitalize()}: {text_of(f'acceptance.{b}')}." for b in Basis if found.counts[b]]
    drawn = (allowance_figure(found, "allowances"),) if rows else ()
    return Section("verdict", "Verdict", tuple(text), (overview(found),), drawn)


def headline(found: Acceptance) -> tuple[str, ...]:
    """How many numbers hold by basis, each once, and how many of them validate anything."""
    again = found.repeated
    first, *others = acceptance_tables.headline(acceptance_tables.held(found))
    if again:
        first += f" {len(again)} more comparisons repeat these numbers in another way and do not count; {sum(r.holds for r in again)} of them lie within."
    return first, *others


def figures(found: Acceptance) -> tuple[Figure, ...]:
    """Its drawings."""
    return tuple(replace(drawn, scene=None) for _, drawn in found.figures)


def _section(
    anchor: str, title: str, text: tuple[str, ...] = (), figures: tuple[Figure, ...] = ()
) -> tuple[Section, ...]:
    return (Section(anchor, title, text, figures=figures),) if text or figures else ()


def _errata(found: Acceptance) -> tuple[Section, ...]:
    if not found.errata:
        return ()
    return (Section("errata", "Errata of the publication", tables=(acceptance_tables.errata(found),)),)


def _provenance(inputs: tuple[InputFile, ...]) -> tuple[Section, ...]:
    if not inputs:
        return ()
    rows = tuple((f.name, f.sha256) for f in inputs)
    table = table_of("acceptance.provenance", rows)
    return (Section("provenance", "Provenance", (text_of("acceptance.by_sha256"),), (table,)),)

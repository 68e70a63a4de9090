"""Parts of a card as HTML: heading, picture, table, bar, rows of coefficients; the card around them has its own style and ids."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from functools import cache, wraps
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.table import ABSENT, Table, percent
from coeflab.core.text.bounded import own_text
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import primed
from coeflab.report.markup import cell_html, html, unit_html
from coeflab.report.notation import keeping, users_texts
from coeflab.report.tables import nouns as tables

if TYPE_CHECKING:
    from coeflab.report.document import Figure


OURS, AGAINST = "#2f86c5", "#d2691e"
LONG, MOST_ROWS, MOST_NOTES, MOST_PICTURES = 34, 24, 4, 2
WIDE, TALL = 100.0, 14.0
ACROSS = 1.12  # pixels a point of a drawing at the most
DRAFT = "coeflab-draft"  # stands for the digest of the card, which ids begin with
Part = str
Maker = Callable[[Any], tuple[Part, ...]]


def card(make: Maker) -> Callable[[Any], str]:
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


def heading_part(title: str, *about: str) -> Part:
    """A title with lines about it."""
    lines = "".join(f'<p class="about">{html(a)}</p>' for a in about if a)
    return f'<p class="said">{html(title)}</p>{lines}'


def parts_in_a_row(*several: Part) -> Part:
    """Parts beside each other where there is room."""
    return f'<div class="parts">{"".join(several)}</div>'


def picture_part(figure: Figure | None) -> Part:
    """A drawing with its caption; nothing of None."""
    if figure is None:
        return ""
    from coeflab.report.figures.first_page import renamed
    from coeflab.report.figures.svg_file import size_of

    caption = f"<figcaption>{html(figure.caption)}</figcaption>" if figure.caption else ""
    widest = ACROSS * size_of(figure.svg)[0]
    return (
        f'<figure style="max-width: {widest:.0f}px">{renamed(figure, f"{DRAFT}-{figure.anchor}").svg}{caption}</figure>'
    )


def grid_part(
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


def table_part(table: Table) -> Part:
    """A table of texts, cut, with its notes."""
    rows = [
        [unit_html(cell) if head == "unit" else cell_part(cell) for head, cell in zip(table.headers, row)]
        for row in table.rows[:MOST_ROWS]
    ]
    more = len(table.rows) - MOST_ROWS
    notes = (*((f"{more} more rows.",) if more > 0 else ()), *table.notes[:MOST_NOTES])
    return grid_part(table.headers, rows, table.left, table.title) + notes_part(notes)


def cell_part(text: str) -> Part:
    """A text with its symbols, small where it is long."""
    return f'<span class="long">{cell_html(text)}</span>' if len(text) > LONG else cell_html(text)


def notes_part(notes: Sequence[str]) -> Part:
    """Notes, a line each."""
    return "".join(f'<p class="note">{html(n)}</p>' for n in notes)


def absent_part(status: str) -> Part:
    """What stands in the place of a value."""
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
        return [cell_html(_name(c)), absent_part(value), "", "", "", cell_part(c.campaign or c.citation or ABSENT)]
    share = percent(c.u95, c.value)
    come = c.campaign or c.citation or ABSENT
    return [cell_html(_name(c)), cell_html(value), cell_html(u95), share, _interval(c.value, c.u95), cell_part(come)]


def _name(c: Coefficient) -> str:
    return primed(c.symbol.removesuffix("'")) if c.unit == "1" else c.symbol


def coefficient_grid(several: Sequence[Coefficient], title: str = "") -> Part:
    """Coefficients, a row each, with their intervals as bars."""
    headers = ("", "value", "U95", "of value", "0 | value", "from")
    shown = several[:MOST_ROWS]
    more = len(several) - len(shown)
    notes = (f"{more} more.",) if more else ()
    return grid_part(headers, [_coefficient_row(c) for c in shown], frozenset({0, 5}), title) + notes_part(notes)

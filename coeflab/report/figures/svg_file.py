"""Figures as one SVG file that needs no page: white ground, colours in place of the page's variables, titles above."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from coeflab.report.document import Figure as Drawing

COLUMNS, GAP, TITLE = 2, 24.0, 18.0
LONGEST = 62


def plain(svg: str) -> str:
    """A drawing with the colours that its variables stand for."""
    return re.sub(r"var\(--fig-\w+, (#[0-9a-f]{6})\)", r"\1", svg)


def size_of(svg: str) -> tuple[float, float]:
    """Width and height of a drawing, points."""
    found = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', svg)
    if found is None:
        raise ValueError("a drawing without viewBox")
    return float(found[1]), float(found[2])


def sheet(rows: Sequence[Sequence[Drawing]], statement: str = "") -> bytes:
    """Rows of figures, one below the other; equal figures give equal bytes.

    Parameters
    ----------
    rows : sequence of sequence of Figure
        One figure at least. Rows of one figure each are put in two columns.
    statement : str
        What holds for all figures; the file's description.
    """
    if all(len(row) == 1 for row in rows):
        single = [row[0] for row in rows]
        rows = [single[i : i + COLUMNS] for i in range(0, len(single), COLUMNS)]
    wide = max(size_of(f.svg)[0] for row in rows for f in row)
    parts, top = [], GAP
    for row in rows:
        for i, figure in enumerate(row):
            x = GAP + i * (wide + GAP)
            parts += [_title(figure, x, top + 10.0, wide), _placed(figure, x, top + TITLE)]
        top += TITLE + max(size_of(f.svg)[1] for f in row) + GAP
    across = GAP + max(map(len, rows)) * (wide + GAP)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {across:g} {top:g}" width="{across:g}pt" '
        f'height="{top:g}pt" style="background:#fff">\n'
    )
    if statement:
        head += f"<desc>{escape(statement)}</desc>\n"
    return (head + "".join(parts) + "</svg>\n").encode()


def _title(figure: Drawing, x: float, y: float, wide: float) -> str:
    fit = f' textLength="{wide:g}" lengthAdjust="spacingAndGlyphs"' if len(figure.title) > LONGEST else ""
    return (
        f'<text x="{x:g}" y="{y:g}" font-family="Helvetica, Arial, sans-serif" font-size="9.5" font-weight="bold"{fit}>'
        f"{escape(figure.title)}</text>\n"
    )


def _placed(figure: Drawing, x: float, y: float) -> str:
    wide, tall = size_of(figure.svg)
    place = f'<svg x="{x:g}" y="{y:g}" width="{wide:g}" height="{tall:g}" '
    return plain(figure.svg).replace("<svg ", place, 1)

"""Texts with their symbols and exponents as HTML, as parts of an SVG text, and as plain letters.

What HTML shows is also what it says: the text of its elements is that which was written (``Yvdot'``, ``U^2``), so that
it is found, heard and copied; only minus signs, Greek letters, powers of ten and the names of fitted models
(``C_D_alpha^2``) are the proper characters.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from html import escape

from coeflab.report.notation import (
    DOT,
    HIGH,
    LEVEL,
    Factor,
    Kept,
    Raised,
    Run,
    Symbol,
    cell_runs,
    kept,
    runs,
    unit_runs,
)
from coeflab.report.printable import runs_to_the_left, visible

PRIME = "\u2032"
REMEMBERED = 1 << 14
SMALL = 0.72
LOWER, HIGHER = 0.22, -0.34
Part = tuple[str, bool, float]


def html(text: str) -> str:
    """A sentence or a heading as HTML; every character of a user's is a text."""
    return _html(text, kept())


@lru_cache(REMEMBERED)
def _html(text: str, kept: Kept | None) -> str:
    return _page(text, runs(text, kept))


def cell_html(text: str) -> str:
    """A table's cell as HTML."""
    return _cell_html(text, kept())


@lru_cache(REMEMBERED)
def _cell_html(text: str, kept: Kept | None) -> str:
    return _page(text, cell_runs(text, kept))


def unit_html(text: str) -> str:
    """A cell that holds a unit, as HTML."""
    return _page(text, unit_runs(text))


def label(text: str) -> str:
    """A text in letters alone, for places that know no other: ``v'^3`` is v′³."""
    return _label(text, kept())


@lru_cache(REMEMBERED)
def _label(text: str, kept: Kept | None) -> str:
    return visible("".join(_letters(piece) for piece in cell_runs(text, kept)))


def unit_label(text: str) -> str:
    """A unit in letters alone."""
    return visible("".join(_letters(piece) for piece in unit_runs(text)))


def drawn(text: str) -> str:
    """The inside of an SVG ``<text>`` element."""
    return _drawn(text, kept())


@lru_cache(REMEMBERED)
def _drawn(text: str, kept: Kept | None) -> str:
    out, before = [], 0.0
    for letters, slanted, level in _joined(part for piece in cell_runs(text, kept) for part in _parts(piece)):
        size = SMALL if level else 1.0
        look = ' font-style="italic"' * slanted + f' font-size="{SMALL}em"' * bool(level)
        if level != before:
            look += f' dy="{round((level - before) / size, 3):g}em"'
        before = level
        shown = escape(visible(letters), quote=False)
        out.append(f"<tspan{look}>{shown}</tspan>" if look else shown)
    return "".join(out)


def _page(text: str, pieces: Sequence[Run]) -> str:
    made = "".join(_element(piece) for piece in pieces).replace("</i><i>", "")
    return f"<bdi>{made}</bdi>" if runs_to_the_left(text) else made


def _element(piece: Run) -> str:
    if isinstance(piece, str):
        return escape(visible(piece))
    if isinstance(piece, Raised):
        return f"<sup><b>^</b>{piece.text}</sup>"
    under = piece.index + "".join(_below(f) for f in piece.factors)
    link = "<b>_</b>" if "_" in piece.text else ""
    out = f"<i>{piece.letter}</i>"
    if under:
        out += f"<sub>{link}{under}</sub>"
    return out + "<u><b>'</b></u>" * piece.primed


def _below(factor: Factor) -> str:
    out = f'<i class="dot">{factor.letter}<b>dot</b></i>' if factor.dotted else f"<i>{factor.letter}</i>"
    if factor.index:
        out += f"<sub>{factor.index}</sub>"
    return f"|{out}|" if factor.absolute else out


def _letters(piece: Run) -> str:
    if isinstance(piece, str):
        return piece
    if isinstance(piece, Raised):
        return piece.text.translate(_RAISED) if set(piece.text) <= set(LEVEL) else f"^{piece.text}"
    link = "_" if "_" in piece.text and piece.index and piece.letter.isascii() else ""
    return piece.letter + link + piece.index + "".join(_factor(f) for f in piece.factors) + PRIME * piece.primed


_RAISED = str.maketrans(LEVEL, HIGH)


def _factor(factor: Factor) -> str:
    out = factor.letter + DOT * factor.dotted + factor.index
    return f"|{out}|" if factor.absolute else out


def _parts(piece: Run) -> Iterator[Part]:
    """Letters, whether they are slanted, and how far below the line they stand, in their line's size."""
    if isinstance(piece, Symbol):
        yield piece.letter, True, 0.0
        if piece.index:
            yield piece.index, False, LOWER
        for factor in piece.factors:
            yield from ((ch, ch != "|", LOWER) for ch in _factor(factor))
        if piece.primed:
            yield PRIME, False, 0.0
    elif isinstance(piece, Raised) and not set(piece.text) <= set(LEVEL):
        yield piece.text, False, HIGHER
    else:
        yield _letters(piece), False, 0.0


def _joined(parts: Iterable[Part]) -> list[Part]:
    out: list[Part] = []
    for letters, slanted, level in parts:
        if out and out[-1][1:] == (slanted, level):
            out[-1] = (out[-1][0] + letters, slanted, level)
        else:
            out.append((letters, slanted, level))
    return out

"""Texts with their symbols and exponents as HTML, as parts of an SVG text, and as plain letters.

What HTML shows is also what it says: the text of its elements is that which was written (``Yvdot'``, ``U^2``), so that
it is found, heard and copied; only minus signs, Greek letters, powers of ten and the names of fitted models
(``C_D_alpha^2``) are the proper characters.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from html import escape

from coeflab.report.notation import (
    DOT,
    HIGH,
    LEVEL,
    TOKENS,
    Command,
    Factor,
    Raised,
    Run,
    Symbol,
    VerbatimTexts,
    cell_runs,
    joined,
    masked,
    runs,
    symbol_pieces,
    unit_runs,
    verbatim,
)
from coeflab.report.printable import runs_to_the_left, visible

PRIME = "\u2032"
REMEMBERED = 1 << 14
SMALL = 0.72
LOWER, HIGHER = 0.22, -0.34
Part = tuple[str, bool, float]


def html(text: str) -> str:
    """A sentence or a heading as HTML; every character of a user's is a text."""
    return _html(text, verbatim())


@lru_cache(REMEMBERED)
def _html(text: str, verbatim: VerbatimTexts | None) -> str:
    return _page(text, runs(text, verbatim))


def html_with(text: str, marks: Callable[[str], Iterable[tuple[int, int, str, str]]]) -> str:
    """A sentence as HTML with elements round some of its words.

    Parameters
    ----------
    text : str
    marks : callable
        Gets the text with a neutral letter for every one of a user's, and gives in order, without overlap: beginning, end,
        and what stands before and after as HTML. A mark that would cut a symbol in two is left out.
    """
    covered = masked(text, verbatim())
    tokens = [] if "$" in covered or "\\" in covered else list(TOKENS.finditer(covered))
    out, at = [], 0
    for start, end, before, after in marks(covered):
        if any(t.start() < edge < t.end() for t in tokens for edge in (start, end)):
            continue
        out += [_between(text, tokens, at, start), before, _between(text, tokens, start, end), after]
        at = end
    return _directed(text, "".join([*out, _between(text, tokens, at, len(text))]))


def _between(text: str, tokens: Sequence[re.Match[str]], start: int, end: int) -> str:
    """A part of a sentence as HTML, by the symbols of the whole."""
    pieces: list[Run] = []
    at = start
    for found in tokens:
        if start <= found.start() and found.end() <= end:
            pieces += [text[at : found.start()], *symbol_pieces(found)]
            at = found.end()
    return "".join(_element(piece) for piece in joined([*pieces, text[at:end]])).replace("</i><i>", "")


def cell_html(text: str) -> str:
    """A table's cell as HTML."""
    return _cell_html(text, verbatim())


@lru_cache(REMEMBERED)
def _cell_html(text: str, verbatim: VerbatimTexts | None) -> str:
    return _page(text, cell_runs(text, verbatim))


def unit_html(text: str) -> str:
    """A cell that holds a unit, as HTML."""
    return _page(text, unit_runs(text))


def label(text: str) -> str:
    """A text in letters alone, for places that know no other: ``v'^3`` is v′³."""
    return _label(text, verbatim())


@lru_cache(REMEMBERED)
def _label(text: str, verbatim: VerbatimTexts | None) -> str:
    return visible("".join(_letters(piece) for piece in cell_runs(text, verbatim)))


def unit_label(text: str) -> str:
    """A unit in letters alone."""
    return visible("".join(_letters(piece) for piece in unit_runs(text)))


def drawn(text: str) -> str:
    """The inside of an SVG ``<text>`` element."""
    return _drawn(text, verbatim())


@lru_cache(REMEMBERED)
def _drawn(text: str, verbatim: VerbatimTexts | None) -> str:
    out, before = [], 0.0
    for letters, slanted, level in _joined_lettering(
        part for piece in cell_runs(text, verbatim) for part in _parts(piece)
    ):
        size = SMALL if level else 1.0
        look = ' font-style="italic"' * slanted + f' font-size="{SMALL}em"' * bool(level)
        if level != before:
            look += f' dy="{round((level - before) / size, 3):g}em"'
        before = level
        shown = escape(visible(letters), quote=False)
        out.append(f"<tspan{look}>{shown}</tspan>" if look else shown)
    return "".join(out)


def _page(text: str, pieces: Sequence[Run]) -> str:
    return _directed(text, "".join(_element(piece) for piece in pieces).replace("</i><i>", ""))


def _directed(text: str, wrapped: str) -> str:
    return f"<bdi>{wrapped}</bdi>" if runs_to_the_left(text) else wrapped


def _element(piece: Run) -> str:
    if isinstance(piece, str):
        return escape(visible(piece))
    if isinstance(piece, Raised):
        return f"<sup><b>^</b>{piece.text}</sup>"
    if isinstance(piece, Command):
        return f"<code>{escape(visible(piece.text))}</code>"
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
    if isinstance(piece, Command):
        return piece.text
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


def _joined_lettering(parts: Iterable[Part]) -> list[Part]:
    out: list[Part] = []
    for letters, slanted, level in parts:
        if out and out[-1][1:] == (slanted, level):
            out[-1] = (out[-1][0] + letters, slanted, level)
        else:
            out.append((letters, slanted, level))
    return out

"""One PDF: numbered tables and figures, symbols set as mathematics, bookmarks, vector drawings; nothing outside is used."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from importlib.resources import files
from string import ascii_lowercase
from typing import Any, Literal

from coeflab.core.errors import OutputError
from coeflab.core.table import ABSENT, Table, percent, plus_minus, says_one
from coeflab.core.text.bounded import own_bytes
from coeflab.core.version import VERSION
from coeflab.report.document import Answer, AnswerRow, Document, Figure, Section
from coeflab.report.figures.svg_file import plain, size_of
from coeflab.report.notation import Command, Raised, Run, cell_runs, keeping, runs, unit_runs, verbatim
from coeflab.report.printable import BREAK, CLOCK, WORD, breakable, glyphs, shortened

summary = "one PDF to print and to keep: typeset tables, mathematics and vector figures"
suffix = ".pdf"
citations: tuple[str, ...] = ()

TEMPLATE = ("data", "symbols", "page", "figures", "tables", "first_page", "report")
LONGEST_TITLE, LONGEST_HEAD, LONGEST_COLUMN, LONGEST_CAPTION = 300, 64, 160, 800
WHOLE, WORDY = 20, re.compile(r"[a-df-z,]")
LONG, DEEP = 18, 3
NO_DATA, ESTIMATOR = "no data", "estimator"
FEW, ON_A_PAGE, CHAPTER = 14, 3000, 4
FINER = 4
FILE = re.compile(r"/?(?:[\w-]+[./])+[A-Za-z]\w{0,7}[,;:.]?")
_UNIT = r"(?:kg|km|mm|cm|kn|ft|lb|Hz|rad|m|s|N|W)"
MEASURED = re.compile(rf"(?<!\S)((?:[<>≤≥±] )?[(]?[−+]?\d[\d.,]* (?:%|{_UNIT}(?:[/·* ]{_UNIT})*)(?![\w/]))")
PLACES = re.compile(r"(?<=[/_])(?=.)|(?<=\.)(?=[A-Za-z]\w*\.)")


def render(document: Document) -> Mapping[str, bytes]:
    """The report as a file.

    Parameters
    ----------
    document : Document

    Returns
    -------
    mapping of file name to bytes
        ``report.pdf``; equal documents give equal bytes.

    Raises
    ------
    OutputError
        The typesetter refuses the document.
    """
    return {"report.pdf": typeset(content(document))}


def typeset(content: Mapping[str, Any]) -> bytes:
    """A PDF from the content that the template reads as data; nothing in it is ever taken for markup."""
    return _compiled(content, "pdf", None)[0]


def page_pictures(document: Document, ppi: float) -> tuple[bytes, ...]:
    """The pages of the PDF as PNG pictures, ``ppi`` pixels an inch."""
    return tuple(map(_averaged, _compiled(content(document), "png", ppi * FINER)))


def _averaged(page: bytes) -> bytes:
    """A picture in which each pixel is the mean of those it stands for: the typesetter leaves out rows of a drawing."""
    import numpy as np
    from matplotlib.image import imread, imsave

    fine = imread(io.BytesIO(page))[..., :3]
    rows, columns = (n // FINER for n in fine.shape[:2])
    mean = fine[: rows * FINER, : columns * FINER].reshape(rows, FINER, columns, FINER, 3).mean((1, 3))
    result = io.BytesIO()
    imsave(result, np.rint(255.0 * mean).astype(np.uint8), format="png", metadata={"Software": "coeflab"})
    return result.getvalue()


def _compiled(content: Mapping[str, Any], form: Literal["pdf", "png"], ppi: float | None) -> tuple[bytes, ...]:
    import typst
    from matplotlib import get_data_path

    folder = files("coeflab.report.formats") / "_pdf"
    template = b"\n".join(own_bytes(folder / f"{name}.typ") for name in TEMPLATE)
    try:
        result, warnings = typst.compile_with_warnings(
            template,
            format=form,
            ppi=ppi,
            sys_inputs={"report": json.dumps(content, ensure_ascii=False)},
            font_paths=typst.Fonts(include_system_fonts=False, font_paths=[f"{get_data_path()}/fonts/ttf"]),
            ignore_system_fonts=True,
            timestamp=CLOCK,
        )
    except typst.TypstError as why:
        raise OutputError(f"the PDF could not be typeset: {why}") from None
    if warnings:
        raise OutputError(f"the PDF could not be typeset: {warnings[0].message}")
    return tuple(map(bytes, result)) if isinstance(result, list) else (bytes(result),)


def content(document: Document) -> dict[str, Any]:
    """A document as plain data: texts in pieces, drawings with their colours, columns with their longest cells."""
    with keeping(document.verbatim):
        return _content(document)


def _content(document: Document) -> dict[str, Any]:
    return {
        "title": _text(shortened(document.title, LONGEST_TITLE)),
        "name": glyphs(shortened(document.title, LONGEST_TITLE)),
        "subtitle": _text(shortened(document.subtitle, LONGEST_TITLE)),
        "head": glyphs(shortened(document.name or document.title, LONGEST_HEAD)),
        "digest": document.digest,
        "author": f"coeflab {VERSION}",
        "answer": None if document.answer is None else _answer(document.answer),
        "whole": document.answer is None or any(s.appendix for s in document.sections),
        "parts": _numbered([part for s in document.sections for part in _parts(s, 1)]),
        "works": [_folding(glyphs(text)) for _, text in document.works],
    }


def _numbered(parts: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The parts, the first of the appendix marked."""
    first = next((p for p in parts if p["level"] == 1 and p["appendix"]), None)
    return [{**p, "opens": p is first} for p in parts]


def _answer(answer: Answer) -> dict[str, Any]:
    """The first page: a sentence, a row a coefficient, figures, chips, notes."""
    drawn = {name: getattr(answer, name) for name in ("slope", "forest", "axes")}
    return {
        "sentence": _text(answer.sentence),
        "compared": _text(answer.compared),
        "columns": [_text(shortened(c, LONGEST_COLUMN)) for c in answer.columns],
        "rows": [_answer_row(r, len(answer.columns)) for r in answer.rows],
        "chips": [{"name": glyphs(c.name), "text": _text(c.text), "severity": c.severity.value} for c in answer.chips],
        "notes": [_text(n) for n in answer.notes],
        "table": None if answer.table is None else _table(answer.table, 1),
        **{name: None if figure is None else _figure(figure) for name, figure in drawn.items()},
    }


def _answer_row(row: AnswerRow, columns: int) -> dict[str, Any]:
    """Its cells as texts; the share of U95 that the difference is, which the bar shows, or None."""
    ours = (
        row.status if row.value is None else f"{plus_minus(row.value, row.u95)} {row.status * bool(row.u95)}".rstrip()
    )
    published = [*row.shown, *[None] * columns][:columns]
    within = percent(row.u95, row.value) if row.value is not None and row.u95 is not None else ""
    return {
        "symbol": _text(row.name),
        "ours": _text(ours or NO_DATA),
        "open": row.value is None,
        "within": _text(within or (row.status if row.value is not None else "")),
        "source": _text(row.source),
        "published": [None if value is None else _text(value) for value in published],
        "difference": None
        if row.difference is None
        else _text(f"{row.difference:+.1e}" if row.u95 is None else _signed(row)),
        "share": row.share,
        "ratio": None if row.share is None else _text(f"{row.share:+.2f}"),
        "agrees": row.agrees,
    }


def _signed(row: AnswerRow) -> str:
    """The difference with the last place of U95."""
    first = plus_minus(row.difference, row.u95).partition(" ")[0]
    return first if first.startswith("-") else f"+{first}"


def _parts(section: Section, level: int, later: bool = True) -> Iterator[dict[str, Any]]:
    """A section and its subsections, in the order of reading; ``later``: others of its level stand before it."""
    yield {
        "level": level,
        "appendix": section.appendix,
        "anchor": section.anchor,
        "fresh": level > 1 and later and len(section.subsections) >= CHAPTER,
        "title": _text(shortened(section.title, LONGEST_TITLE)),
        "paragraphs": [_text(p) for p in section.paragraphs],
        "topics": [{"name": _text(t.name), "texts": [_text(p) for p in t.texts]} for t in section.topics],
        "code": [_folding(glyphs(line)) for line in section.code],
        "figures": [_figure(f) for f in section.figures],
        "plates": section.plates,
        "tables": [_table(t, level) for t in section.tables],
    }
    for i, part in enumerate(section.subsections):
        yield from _parts(part, level + 1, i > 0)


def _figure(figure: Figure) -> dict[str, Any]:
    wide, tall = size_of(figure.svg)
    drawing = plain(figure.svg).replace('font-family="Helvetica, Arial, sans-serif"', 'font-family="DejaVu Sans"')
    return {
        "svg": drawing,
        "wide": wide,
        "tall": tall,
        "title": _text(shortened(figure.title, LONGEST_TITLE)),
        "caption": _text(shortened(figure.caption, LONGEST_CAPTION)),
        "description": glyphs(f"{shortened(figure.title, LONGEST_TITLE)}. {figure.description}"),
    }


def _table(table: Table, level: int) -> dict[str, Any]:
    """The table; of a long one deep inside, which HTML folds, its title and what it counts."""
    title = _text(shortened(table.title, LONGEST_TITLE))
    if level >= DEEP and len(table.rows) > LONG:
        return {"elsewhere": True, "title": title, "count": len(table.rows)}
    table = _with_room(_lettered(table))
    columns = range(len(table.headers))
    units = {i for i in columns if table.headers[i] == "unit"}
    folds = [any(len(row[i]) > WHOLE and WORDY.search(row[i]) for row in table.rows) for i in columns]
    rows = [[_cell(text, i in units, folds[i]) for i, text in enumerate(row)] for row in table.rows]
    return {
        "elsewhere": False,
        "together": len(table.rows) <= FEW and _letters(table) < ON_A_PAGE,
        "title": title,
        "headers": [_text(shortened(h, LONGEST_COLUMN)) for h in table.headers],
        "rows": rows,
        "whole": all(len(cell) < ON_A_PAGE // 4 for row in table.rows for cell in row),
        "left": [i in table.left for i in columns],
        "folds": folds,
        "longest": [_longest([row[i] for row in rows]) for i in columns],
        "words": [_word(table, i) for i in columns],
        "verdicts": [[text in ("fail", "warn") for text in row] for row in table.rows],
        "notes": [_text(n) for n in table.notes],
    }


def _lettered(table: Table) -> Table:
    """With letters in the place of estimators that rows share, explained below; without the column where one serves all."""
    if ESTIMATOR not in table.headers:
        return table
    i = table.headers.index(ESTIMATOR)
    texts = [text for text in dict.fromkeys(row[i] for row in table.rows) if text != ABSENT]
    if not 0 < len(texts) < min(len(table.rows), len(ascii_lowercase)):
        return table
    names = dict(zip(texts, ascii_lowercase, strict=False))
    several = len(texts) > 1
    lettered = replace(
        table, rows=tuple((*row[:i], names.get(row[i], row[i]), *row[i + 1 :]) for row in table.rows),
        notes=(*table.notes, *(f"{ESTIMATOR} {names[t] if several else 'of all'}: {t}." for t in texts)),
    )  # fmt: skip
    return lettered if several else lettered.only([k for k in range(len(table.headers)) if k != i])


def _with_room(table: Table) -> Table:
    """Without columns that say one thing in every row, where another has to fold; a note says it once."""
    complete = [i for i in range(len(table.headers)) if i == 0 or not says_one(table, i)]
    if len(complete) == len(table.headers) or not any(len(c) > WHOLE for row in table.rows for c in row):
        return table
    once = [i for i in range(len(table.headers)) if i not in complete]
    more = (f"{table.headers[i]}, in every row: {table.rows[0][i] or 'none'}." for i in once)
    return replace(table.only(complete), notes=(*table.notes, *more))


def _letters(table: Table) -> int:
    return sum(map(len, table.notes)) + sum(len(cell) for row in table.rows for cell in row)


def _longest(cells: list[list[Any]]) -> list[list[Any]]:
    """The four longest cells of a column as they are set: what its width is measured by."""

    def length(cell: list[Any]) -> int:
        return sum(
            len(p) if isinstance(p, str) else length(p["whole"]) if "whole" in p else len(p.get("up") or p["text"])
            for p in cell
        )

    return sorted(cells, key=length, reverse=True)[:4]


def _word(table: Table, column: int) -> str:
    """The longest word of a column, its header among them: the least width that it can have."""
    texts = [table.headers[column], *(row[column] for row in table.rows)]
    words = (w for text in texts for w in _folding(glyphs(text)).replace("\u200b", " ").split())
    return max(words, key=len, default="")


def _cell(text: str, unit: bool, folds: bool) -> list[Any]:
    pieces = [_piece(p) for p in (unit_runs(text) if unit else cell_runs(text, verbatim()))]
    return _with_units(pieces) if folds else [p.replace(" ", "\u00a0") if isinstance(p, str) else p for p in pieces]


def _text(text: str) -> list[Any]:
    return _with_units([_piece(p) for p in runs(text, verbatim())])


def _with_units(pieces: list[Any]) -> list[Any]:
    """The pieces, those of a number and a unit that could part at its slash or its space in one that stays on a line."""
    out: list[Any] = []
    for piece in pieces:
        last = out[-1] if out else None
        if isinstance(piece, dict) and "up" in piece and isinstance(last, dict) and "whole" in last:
            last["whole"].append(piece)
        elif isinstance(piece, str):
            parts = MEASURED.split(piece)
            out += [{"whole": [part]} if i % 2 else part for i, part in enumerate(parts) if part]
        else:
            out.append(piece)
    return out


def _folding(text: str) -> str:
    """Like `breakable`; a name of a file breaks after its separators only, as long as their parts are short."""
    return "".join(_folded(w) for w in re.split(r"(\s+)", text)) if len(text) > WORD else text


def _folded(word: str) -> str:
    parts = PLACES.split(word)
    return BREAK.join(parts) if FILE.fullmatch(word) and max(map(len, parts)) <= WORD < len(word) else breakable(word)


def _piece(piece: Run) -> Any:
    if isinstance(piece, str):
        return _folding(glyphs(piece))
    if isinstance(piece, Raised):
        return {"up": piece.text}
    if isinstance(piece, Command):
        return {"command": True, "text": piece.text}
    return {
        "letter": piece.letter,
        "text": piece.text,
        "index": piece.index,
        "primed": piece.primed,
        "factors": [
            {"letter": f.letter, "index": f.index, "dotted": f.dotted, "absolute": f.absolute} for f in piece.factors
        ],
    }

"""The answer of a study or a publication as a table for a terminal."""

from __future__ import annotations

from dataclasses import replace

from coeflab.core.table import ABSENT, Table, with_u95
from coeflab.report.acceptance import MEANING
from coeflab.report.document import Answer, AnswerRow
from coeflab.report.figures.first_page import share_text

LONGEST, MOST_ROWS, MOST_COLUMNS = 160, 6, 3
WIDTH, MOST_MODELS = 46, 12  # of a table that stands in the place of rows
BAR, SHORT_BAR = 6, 2  # letters of a difference that is as large as U95; where there are many columns
HALF_WIDTH = "U95: half-width of the 95 % interval."


def answer_table(found: Answer) -> Table:
    """The rows as texts, 79 columns wide at most with three short published names.

    Parameters
    ----------
    found : Answer

    Returns
    -------
    Table
        Symbol; ours with U95, also in per cent; each published column in the digits of its source; the difference to the
        compared column over U95 as a number and a bar of `BAR` letters, `SHORT_BAR` beside many columns, for one U95, ``!`` where the verdict is that it lies beyond. Of a publication, and of
        models, the table that stands in the place of rows.
    """
    if found.table is not None:
        return _on_a_terminal(found.table, found.notes)
    short = [n.rsplit(" ", 1)[0] if n.rpartition(" ")[2].isdigit() else n for n in found.columns]
    short = [n.replace("published ", "publ. ") for n in short]
    names = short if len(set(short)) == len(short) else list(found.columns)
    is_judged = any(r.share is not None for r in found.rows)
    many = len(found.columns) > MOST_COLUMNS
    rows = tuple(
        (r.name, *_cells(r, many), *((_bar(r, SHORT_BAR if many else BAR),) if is_judged else ())) for r in found.rows
    )
    headers = ("", "ours +- U95", *names, *(("diff./U95",) if is_judged else ()))
    left = {0, *((len(headers) - 1,) if is_judged else ())}
    defined = (HALF_WIDTH,) if any(r.u95 for r in found.rows) else ()
    return Table("Answer", headers, rows, (*defined, *found.notes), frozenset(left))


def _on_a_terminal(table: Table, notes: tuple[str, ...]) -> Table:
    """Long cells are cut; what the numbers of a publication are compared with stands below."""
    if MEANING not in table.headers:
        rows = tuple(tuple(map(_cut, row)) for row in table.rows)
        return replace(table, rows=rows, notes=(*table.notes, *notes))
    i = table.headers.index(MEANING)
    meant = tuple(f"{row[0]}: {row[i]}" for row in table.rows)
    others = table.only([k for k in range(len(table.headers)) if k != i])
    return replace(others, notes=(*meant, *table.notes, *notes))


def _cut(text: str) -> str:
    return text if len(text) <= WIDTH else f"{text[:WIDTH].rsplit(' ', 1)[0]} ..."


def _cells(r: AnswerRow, many: bool = False) -> tuple[str, ...]:
    """Ours, where there is room for it with U95 in per cent, and the published values with the digits of their sources."""
    value, u95 = with_u95(r.value, r.u95)
    share = "" if many else f" ({share_text(abs(r.u95 / r.value)) if r.value else 'zero'})" if r.u95 else ""
    ours = f"{value} +- {u95}{share} {r.status}".strip() if r.u95 else f"{value} {r.status}".strip()
    return (r.status if r.value is None else ours, *(text or ABSENT for text in r.shown))


def _bar(r: AnswerRow, letters: int) -> str:
    if r.share is None:
        return "-"
    whole = min(round(letters * abs(r.share)), letters)
    return f"{r.share:+.2f} {'#' * whole}{'!' if r.agrees is False else ''}".strip()

"""Rows of CSV as text: the one writer of every CSV file, so that no text of a source becomes a formula of a spreadsheet.

A text that a spreadsheet would calculate, such as ``=1+1``, ``@SUM(A1)`` or ``-beta``, gets an apostrophe before it; numbers stay as they are.
`plain` takes it off again: what coeflab writes and reads is the same text.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?(?:inf|nan)", re.ASCII | re.IGNORECASE)
_FORMULA = re.compile(r"'*\s*[=+\-@\t\r].", re.DOTALL)
_ESCAPED = re.compile(r"''*\s*[=+\-@\t\r].", re.DOTALL)


def escaped(cell: object) -> object:
    """A cell that no spreadsheet takes for a formula.

    Parameters
    ----------
    cell : object
        A text that begins with ``= + - @``, a tab or a return, and is no number, gets an apostrophe; so does one that has it already.

    Examples
    --------
    >>> [escaped(c) for c in ("=1+1", "-0.5", "-beta", "'=x", "-", 2.0)]
    ["'=1+1", '-0.5', "'-beta", "''=x", '-', 2.0]
    """
    if not isinstance(cell, str) or not _FORMULA.match(cell) or _NUMBER.fullmatch(cell.strip()):
        return cell
    return f"'{cell}"


def plain(cell: str) -> str:
    """A cell as it was before `escaped`.

    Examples
    --------
    >>> [plain(c) for c in ("'=1+1", "-0.5", "''=x", "'quoted'")]
    ['=1+1', '-0.5', "'=x", "'quoted'"]
    """
    return cell[1:] if _ESCAPED.match(cell) else cell


def csv_text(rows: Iterable[Iterable[object]], comments: Iterable[str] = ()) -> str:
    """Rows as CSV, comma, line feed, every text `escaped`; comments first, each behind ``# ``.

    Examples
    --------
    >>> print(csv_text([("run", "Y [N]"), ("=A1", -1.5)], ["made by hand"]), end="")
    # made by hand
    run,Y [N]
    '=A1,-1.5
    """
    out = io.StringIO()
    out.writelines(f"# {text}\n" for text in comments)
    csv.writer(out, lineterminator="\n").writerows([escaped(cell) for cell in row] for row in rows)
    return out.getvalue()

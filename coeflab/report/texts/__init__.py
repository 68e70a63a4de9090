"""The words of reports: one TOML file a subject, one table a code, found by ``subject.what``.

A table to be shown has ``title``, ``headers`` and may have ``left`` (columns flush left; the first by default), ``spare`` and ``notes``.
Else a code is a text, or a list of texts. Facts stand in braces, with a format of Python where one is needed.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import Any

from coeflab.core.table import Table
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import own_toml


@cache
def templates(subject: str) -> dict[str, Any]:
    """Everything that is worded of a subject, by code without the subject."""
    return own_toml(own_text(files(__name__) / f"{subject}.toml"))


def _of(code: str) -> Any:
    subject, _, what = code.partition(".")
    return templates(subject)[what]


def text_of(code: str, **facts: Any) -> str:
    """A sentence, a caption or a paragraph."""
    return str(_of(code)).format(**facts)


def texts_of(code: str, **facts: Any) -> tuple[str, ...]:
    """Several of them."""
    return tuple(one.format(**facts) for one in _of(code))


def table_of(code: str, rows: Iterable[tuple[str, ...]], notes: Iterable[str] = (), **facts: Any) -> Table:
    """A table to be shown.

    Parameters
    ----------
    code : str
    rows : iterable of tuple of str
    notes : iterable of str
        After those of the template.
    **facts
        What stands in braces.
    """
    t = _of(code)
    first = (note.format(**facts) for note in t.get("notes", ()))
    return Table(
        t["title"].format(**facts), tuple(t["headers"]), tuple(rows), (*first, *notes),
        frozenset(t.get("left", (0,))), tuple(t.get("spare", ())),
    )  # fmt: skip

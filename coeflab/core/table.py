"""A table to be shown: one per result feeds terminal, CSV and HTML alike.

What a check found.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from html import escape
from importlib import import_module
from math import isnan

from coeflab.core.types import brief


@brief
@dataclass(frozen=True, slots=True)
class Table:
    """Text cells with a caption.

    Attributes
    ----------
    title : str
    headers : tuple of str
    rows : tuple of tuple of str
    notes : tuple of str
    left : frozenset of int
        Columns that are set flush left; the others are numbers.
    """

    title: str
    headers: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()
    left: frozenset[int] = frozenset({0})

    def _repr_html_(self) -> str:
        """The table for notebooks; every text escaped."""
        sides = ["left" if i in self.left else "right" for i in range(len(self.headers))]
        heads, *rows = (
            "".join(f'<{tag} style="text-align: {side}">{escape(cell)}</{tag}>' for side, cell in zip(sides, row))
            for tag, row in (("th", self.headers), *(("td", r) for r in self.rows))
        )
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        notes = "".join(f'<p style="font-size: 85%">{escape(note)}</p>' for note in self.notes)
        caption = f'<caption style="text-align: left; font-weight: bold">{escape(self.title)}</caption>'
        return f"<table>{caption}<thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>{notes}"


ABSENT = "-"


def number(value: float | None, digits: int = 4) -> str:
    """A number to ``digits`` significant digits, or a dash."""
    if value is None or isnan(value):
        return ABSENT
    if value in (float("inf"), float("-inf")):
        return "inf" if value > 0 else "-inf"
    text = f"{value:.{digits}g}"
    if "e" in text:
        return text
    places = len(text.partition(".")[2])
    shown = len(text.lstrip("-").lstrip("0.").replace(".", ""))
    return f"{value:.{places + max(0, digits - shown)}f}" if value else "0"


def coefficient(value: float | None) -> str:
    """A primed coefficient as the field prints it: six decimals, three digits when it is tiny."""
    if value is None or isnan(value):
        return ABSENT
    return f"{value:.2e}" if 0 < abs(value) < 5e-5 else f"{value:.6f}"


def percent(part: float | None, of: float | None) -> str:
    """A half-width in per cent of its value."""
    if part is None or not of or isnan(part):
        return ABSENT
    return f"{100.0 * abs(part / of):.1f} %"


def probability(value: float) -> str:
    """A probability; a dash where it could not be computed."""
    return ABSENT if isnan(value) else "<0.001" if value < 1e-3 else f"{value:.3f}"


class Severity(StrEnum):
    """How much a finding matters; only `FAIL` makes the exit code 1."""

    PASS = "pass"
    NOTE = "note"
    WARN = "warn"
    FAIL = "fail"


@brief
@dataclass(frozen=True, slots=True)
class Check:
    """One finding.

    Attributes
    ----------
    name : str
        Plugin that made it.
    subject : str
        Campaign or parameter file, and symbol.
    severity : Severity
    statistic : str
        What was computed, with its number.
    rule : str
        What it was held against.
    comment : str
        What it means and what to do.
    """

    name: str
    subject: str
    severity: Severity
    statistic: str
    rule: str
    comment: str


def html_by(renderer: str, noun: object) -> str:
    """HTML of a noun for notebooks, by the function of that name in ``coeflab.report.tables.nouns``.

    The report is imported on first use and by name: nouns stand below it.
    """
    tables = getattr(import_module("coeflab.report.tables.nouns"), renderer)(noun)
    return "".join(t._repr_html_() for t in ((tables,) if isinstance(tables, Table) else tables))

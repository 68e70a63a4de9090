"""A table to be shown: one per result feeds terminal, CSV and HTML alike.

What a check found.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from html import escape
from importlib import import_module
from math import isfinite, isnan

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
LARGEST_SHARE = 1000.0  # per cent; beyond, the value is nothing beside its uncertainty
TINY, HUGE, LONGEST = 5e-5, 1e6, 12  # of numbers with a fixed point, and their decimals


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


def with_u95(value: float | None, u95: float | None) -> tuple[str, str]:
    """A value and its 95 % half-width for people: U95 with two significant digits, the value to the same last place.

    JCGM 100:2008, 7.2.6. Both have one power of ten where both are tiny or one is huge. Without a usable U95 the value
    stands as `coefficient` has it.
    """
    if value is None or u95 is None or not isfinite(value) or not isfinite(u95) or u95 <= 0.0:
        return coefficient(value), coefficient(u95)
    last = int(f"{u95:.1e}".partition("e")[2]) - 1
    size = max(abs(value), u95)
    if TINY <= size < HUGE:
        if last < -LONGEST:
            return coefficient(value), f"{u95:.1e}"
        first, second = (f"{round(v, -last) + 0.0:.{max(-last, 0)}f}" for v in (value, u95))
        return first, second
    power = int(f"{round(size, -last):e}".partition("e")[2])
    places = max(power - last, 0)
    first, second = (f"{round(v / 10.0**power, places) + 0.0:.{places}f}e{power:+03d}" for v in (value, u95))
    return first, second


def plus_minus(value: float | None, u95: float | None, sign: str = "+-") -> str:
    """``value +- U95`` with the digits of `with_u95`; the value alone without a usable U95.

    Parameters
    ----------
    value, u95 : float or None
    sign : str
        The renderers of texts know ``+-``; where nothing is rendered it is the sign itself.
    """
    first, second = with_u95(value, u95)
    return f"{first} {sign} {second}" if u95 is not None and isfinite(u95) else first


def percent(part: float | None, of: float | None) -> str:
    """A half-width in per cent of its value."""
    if part is None or not of or isnan(part):
        return ABSENT
    share = 100.0 * abs(part / of)
    return f"{share:.1f} %" if share <= LARGEST_SHARE else f"> {LARGEST_SHARE:.0f} %"


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
    """HTML of a noun for notebooks, by the function of that name in ``coeflab.report.notebook``.

    The report is imported on first use and by name: nouns stand below it.
    """
    return str(getattr(import_module("coeflab.report.notebook"), renderer)(noun))

"""A table to be shown: one per result feeds terminal, CSV and HTML alike.

What a check found.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from html import escape
from math import isfinite, isnan
from textwrap import wrap
from typing import Any, NamedTuple

from coeflab.core.cards import html_by
from coeflab.core.errors import PluginError
from coeflab.core.finding import Finding, Severity
from coeflab.core.keywords import all_spoken, spoken
from coeflab.core.missed import suggesting
from coeflab.core.texts import Wording, remark, words
from coeflab.core.types import brief, in_angles
from coeflab.core.wording import Verbatim


@brief
@dataclass(frozen=True, slots=True)
class Table:
    """Text cells with a caption.

    Attributes
    ----------
    title : str
    headers : tuple of str
    rows : tuple of tuple of str
        A zero has no sign: what rounding makes of a small negative number is 0.
    notes : tuple of str
    left : frozenset of int
        Columns that are set flush left; the others are numbers.
    spare : tuple of str
        Headers of columns that a narrow line does without, the first to go first.
    """

    title: str
    headers: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()
    left: frozenset[int] = frozenset({0})
    spare: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if any("-0" in cell for row in self.rows for cell in row):
            object.__setattr__(self, "rows", tuple(tuple(map(_unsigned, row)) for row in self.rows))

    def __str__(self) -> str:
        return "\n".join(line.text for line in set_lines(self.spoken(), 80))

    def spoken(self) -> Table:
        """The table in the words of whoever reads it: options in a shell, else keywords."""
        rows = tuple(tuple(spoken(cell) if "--" in cell else cell for cell in row) for row in self.rows)
        return replace(self, rows=rows, notes=all_spoken(self.notes))

    def only(self, columns: Sequence[int]) -> Table:
        """Some of its columns."""
        rows = tuple(tuple(row[i] for i in columns) for row in self.rows)
        left = frozenset(k for k, i in enumerate(columns) if i in self.left)
        return replace(self, headers=tuple(self.headers[i] for i in columns), rows=rows, left=left)

    def _repr_html_(self) -> str:
        """The table for notebooks; every text escaped."""
        return self.spoken()._html()

    def _html(self) -> str:
        sides = ["left" if i in self.left else "right" for i in range(len(self.headers))]
        heads, *rows = (
            "".join(f'<{tag} style="text-align: {side}">{escape(cell)}</{tag}>' for side, cell in zip(sides, row))
            for tag, row in (("th", self.headers), *(("td", r) for r in self.rows))
        )
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        notes = "".join(f'<p style="font-size: 85%">{escape(note)}</p>' for note in self.notes)
        caption = f'<caption style="text-align: left; font-weight: bold">{escape(self.title)}</caption>'
        return f"<table>{caption}<thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>{notes}"


def _unsigned(cell: str) -> str:
    """A cell whose zeros have no sign, which rounding gives them; a user's own text stays."""
    return cell if isinstance(cell, Verbatim) or "-0" not in cell else _NEGATIVE_ZERO.sub(r"\1", cell)


class Line(NamedTuple):
    """A line of a table that is set: what it is (title, head, row or note) and its cells, padded."""

    kind: str
    cells: tuple[str, ...]

    @property
    def text(self) -> str:
        """The line as it is printed."""
        return (MARGIN * (self.kind in ("head", "row")) + GAP.join(self.cells)).rstrip()


MARGIN = GAP = "  "
COMFORT, SPARED = 20, 32  # letters below which text is not folded while a column can go; such a column goes before that
LONGEST_WORD = 36  # in a cell; what is longer is broken
_NEGATIVE_ZERO = re.compile(r"(?<![\w.\-/])-(0(?:\.0*)?(?:e[+-]?\d+)?)(?![\w.\-/])")
_TOGETHER = re.compile(r"(?<=\d) (?=(?:%|deg|rad|mm?|kn?|kg|s|N)\b|%)|(?<=\+-) | (?=\+- )")


def folded(text: str, width: int, first: str = "", then: str = "", whole: bool = True) -> list[str]:
    """A text as lines of at most ``width`` letters, never between a number and its unit.

    Parameters
    ----------
    text : str
    width : int
    first, then : str
        What the first line and the others begin with.
    whole : bool
        A word longer than a line, such as a path, stays whole.
    """
    selected = _TOGETHER.sub("\u00a0", text)
    lines = wrap(
        selected,
        width,
        initial_indent=first,
        subsequent_indent=then,
        break_long_words=not whole,
        break_on_hyphens=False,
    )
    return [line.replace("\u00a0", " ") for line in lines] or [first]


def set_lines(table: Table, width: int) -> tuple[Line, ...]:
    """A table as lines of at most ``width`` letters.

    First a column goes below that says the same in every row, then text is folded, then columns of `Table.spare` go, one by
    one and named below; then text is folded down to its words, and what is still too wide goes on below, behind its first
    column, and the texts after it where that one does not tell the rows apart. Numbers are never folded.

    Parameters
    ----------
    table : Table
    width : int
        A word that is longer than a line has its line.
    """
    chosen = list(range(len(table.headers)))
    below: list[str] = []
    for i in list(chosen):
        if _room(table, chosen, SPARED) > width and says_one(table, i):
            chosen.remove(i)
            phrases = table.rows[0][i]
            below += [f"All rows: {table.headers[i]} {phrases}"] if phrases not in ("", ABSENT) else []
    gone = []
    for name in table.spare:
        if _room(table, chosen, COMFORT) <= width:
            break
        gone += [name for i in chosen if table.headers[i] == name]
        chosen = [i for i in chosen if table.headers[i] != name]
    groups = [chosen] if _room(table, chosen, 1) <= width else _groups(table, chosen, width)
    out = [Line("title", (text,)) for text in folded(table.title, width)]
    for k, group in enumerate(groups):
        if k:
            out.append(Line("title", (f"{MARGIN}{MORE}:",)))
        out += _block(table, group, width)
    below += [f"Not shown: {', '.join(gone)}; --wide shows all."] if gone else []
    for note in (*table.notes, *below):
        out += [Line("note", (text,)) for text in folded(note, width, MARGIN, 2 * MARGIN)]
    return tuple(out)


MORE = "more"


def says_one(table: Table, i: int) -> bool:
    """Whether a column of text says the same in each of several rows."""
    return bool(
        i in table.left and table.headers[i] and len(table.rows) > 1 and len({row[i] for row in table.rows}) == 1
    )


def _column(table: Table, i: int) -> list[str]:
    return [table.headers[i], *(row[i] for row in table.rows)]


def _least(table: Table, i: int, comfort: int) -> int:
    """Letters that a column needs at least: its longest number, or the longest word of text."""
    cells = _column(table, i)
    text = cells if i in table.left else cells[:1]
    numbers = [] if i in table.left else [len(cell) for cell in cells[1:]]
    words = max((len(word) for cell in text for word in cell.split()), default=1)
    at_ease = min(max(map(len, cells)), SPARED if table.headers[i] in table.spare and comfort > 1 else comfort)
    return max(at_ease if i in table.left else 0, min(words, LONGEST_WORD), *numbers, 1)


def _room(table: Table, chosen: list[int], comfort: int) -> int:
    return sum(_least(table, i, comfort) + len(GAP) for i in chosen)


def _groups(table: Table, chosen: list[int], width: int) -> list[list[int]]:
    """Columns that fit beside each other, each group behind the columns that name its rows."""
    names, others = chosen[:1], chosen[1:]
    while (
        len(others) > 1
        and others[0] in table.left
        and len({tuple(r[i] for i in names) for r in table.rows}) < len(table.rows)
    ):
        if 2 * _room(table, [*names, others[0]], 1) > width:
            break
        names.append(others.pop(0))
    out = [list(names)]
    for i in others:
        if len(out[-1]) > len(names) and _room(table, [*out[-1], i], 1) > width:
            out.append(list(names))
        out[-1].append(i)
    return out


def _block(table: Table, chosen: list[int], width: int) -> list[Line]:
    """Header and rows of columns that fit, text folded as far as needed, the widest column first."""
    widths = {i: max(1, *map(len, _column(table, i))) for i in chosen}
    least = {i: _least(table, i, 1) for i in chosen}
    while sum(widths.values()) + len(GAP) * len(chosen) > width:
        reducible = [i for i in chosen[1:] if widths[i] > least[i]] or [i for i in chosen[:1] if widths[i] > least[i]]
        if not reducible:
            break
        widths[max(reducible, key=lambda i: widths[i])] -= 1
    out = []
    for k, row in enumerate((table.headers, *table.rows)):
        cells = [[row[i]] if len(row[i]) <= widths[i] else folded(row[i], widths[i], whole=False) for i in chosen]
        deepest = max(map(len, cells))
        for n in range(deepest):
            # A header stands on its numbers, a folded text begins with them.
            above = [deepest - len(cell) if k == 0 else 0 for cell in cells]
            texts = [cell[n - a] if 0 <= n - a < len(cell) else "" for cell, a in zip(cells, above, strict=True)]
            sides = zip(chosen, texts, strict=True)
            padded = (t.ljust(widths[i]) if i in table.left else t.rjust(widths[i]) for i, t in sides)
            out.append(Line("row" if k else "head", tuple(padded)))
    return out


ABSENT = "-"
LEAST_SHARE = 0.1  # per cent; the last digit that is printed
LARGEST_SHARE = 100.0  # per cent; beyond, the value is nothing beside its uncertainty
LARGE = f"> {LARGEST_SHARE:.0f} %"
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


def as_printed(value: float | None) -> str:
    """A published coefficient: as `coefficient`, without zeros behind its fourth decimal, which no source prints."""
    shown = coefficient(value)
    return shown if "e" in shown or shown == ABSENT else shown[:-2] + shown[-2:].rstrip("0")


def in_digits_of(value: float, printed: str) -> str:
    """A published value, also one brought to another length, with as many significant digits as its source prints."""
    mantissa = printed.strip().lower().partition("e")[0]
    return number(value, max(len(mantissa.lstrip("+-0.").replace(".", "")), 1)) if value else printed.strip()


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
    return f"{first} {sign} {second}" if u95 is not None and isfinite(u95) and u95 > 0.0 else first


def percent(part: float | None, of: float | None) -> str:
    """A half-width in per cent of its value."""
    if part is None or not of or isnan(part):
        return ABSENT
    share = 100.0 * abs(part / of)
    if 0.0 < share < LEAST_SHARE / 2.0:
        return f"< {LEAST_SHARE:g} %"
    return f"{share:.1f} %" if share <= LARGEST_SHARE else LARGE


def probability(value: float) -> str:
    """A probability; a dash where it could not be computed."""
    return ABSENT if isnan(value) else "<0.001" if value < 1e-3 else f"{value:.3f}"


@suggesting
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
    campaign, table : str
        Whose rows it is on; empty where it is on no rows, the table where it is on the whole campaign.
    finding : Finding or None
        The same as data, where its words are of a template.
    symbol : str
        Where it is on one coefficient of the campaign alone.
    """

    name: str
    subject: str
    severity: Severity
    statistic: str
    rule: str
    comment: str
    campaign: str = ""
    table: str = ""
    finding: Finding | None = None
    symbol: str = ""

    @classmethod
    def of(cls, code: str, subject: str, severity: Severity, **facts: Any) -> Check:
        """A check by the code of its words, which begins with its name.

        Parameters
        ----------
        code : str
            As `Finding.of` takes it.
        subject : str
        severity : Severity
        **facts
            As `Finding.of` takes them.
        """
        return as_check(code.partition(".")[0], Finding.of(code, subject, severity, **facts))

    def __repr__(self) -> str:
        return in_angles(self, f"{self.severity}, {self.name}: {self.subject}: {self.statistic}")

    def __str__(self) -> str:
        return f"{self.severity}, {self.subject}: {self.statistic}{f' {self.comment}' if self.comment else ''}"

    def spoken(self) -> Check:
        """The finding in the words of whoever reads it: options in a shell, else keywords."""
        statistic, rule, comment = all_spoken((self.statistic, self.rule, self.comment))
        return replace(self, statistic=statistic, rule=rule, comment=comment)

    def _repr_html_(self) -> str:
        """What was found and what it means, for notebooks."""
        return html_by("finding", self)


def as_check(name: str, found: Finding) -> Check:
    """A finding as a row of the table of checks, its words from the templates.

    Parameters
    ----------
    name : str
        Plugin that made it.
    found : Finding
    """
    try:
        text = words(found)
    except PluginError:  # of a file by somebody else's plugin
        text = Wording(remark(found), "", "")
    return Check(name, found.subject, found.severity, text.statement, text.rule, text.advice, finding=found)

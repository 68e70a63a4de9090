"""How other people write tables: numbers in their marks, words for no number, names with units, the rows above the data."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from coeflab.core.errors import shown
from coeflab.core.text.bounded import stream_of
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import parse_header
from coeflab.law.symbols import COMPONENTS, CONTROL_COLUMNS, CONTROLS, MOTIONS
from coeflab.tables.column_map import WIND, share
from coeflab.tables.columns import DIGIT
from coeflab.tables.raw_table import RawColumn
from coeflab.tables.vocabulary import folded, vocabulary

SNIFFED = 1 << 16
MOSTLY = 0.6  # of a row of units
LONGEST_LEGEND = 4000  # letters
BLANKS = "\u00a0\u2007\u2009\u202f"  # no-break, figure, thin and narrow no-break space: marks between thousands
_MINUS = dict.fromkeys(map(ord, "\u2010\u2011\u2012\u2013\u2014\u2212\ufe63\uff0d"), "-")
_SWAPPED = str.maketrans(",.", ".,")
_DASHES = frozenset({"", "-", "--", "---"})
ERRORS = frozenset({"#div/0!", "#value!", "#ref!", "#name?", "#num!", "#null!", "#n/a", "#na", "#getting_data"})
_NO_NUMBER = ERRORS | {
    "nan", "+nan", "-nan", "nan(ind)", "-nan(ind)", "1.#qnan", "-1.#ind", "1.#ind", "na", "n.a.", "n/a", "null", "none", "nil",
    "inf", "+inf", "-inf", "infinity", "+infinity", "-infinity", "1.#inf", "-1.#inf",
}  # fmt: skip
MARK_NAMES = {".": "point", ",": "comma", " ": "blank", "'": "apostrophe", "": "none"}


@dataclass(frozen=True)
class Marks:
    """The mark before the decimals and the mark between the thousands.

    Attributes
    ----------
    decimal : {".", ","}
    thousands : {"", " ", ".", ",", "'"}
        A blank stands for every kind of blank.
    """

    decimal: str = "."
    thousands: str = ""

    @cached_property
    def _form(self) -> re.Pattern[str]:
        point = re.escape(self.decimal)
        grouped = ""
        if self.thousands:
            mark = {" ": f"[ {BLANKS}]", "'": "['’]"}.get(self.thousands, re.escape(self.thousands))
            grouped = rf"|[-+]?[1-9][0-9]{{0,2}}(?:{mark}[0-9]{{3}})+(?:{point}[0-9]*)?"
        return re.compile(rf"[-+]?(?:[0-9]+(?:{point}[0-9]*)?|{point}[0-9]+)(?:[eEdD][-+]?[0-9]+)?{grouped}")

    @cached_property
    def _translation(self) -> dict[int, str | None]:
        """Letters of a number as Python reads it: no marks between thousands, a point, e."""
        away = f"{self.thousands}{BLANKS} '’" if self.thousands else ""
        return {**dict.fromkeys(map(ord, away)), ord(self.decimal): ".", ord("d"): "e", ord("D"): "e"}

    def numbers(self, cells: Sequence[str]) -> Array | None:
        """Many cells at once, equal to `number` of each; None where one of them is anything but a finite number."""
        if not all(map(self._form.fullmatch, cells)):
            return None
        values = np.array(list(map(float, "\n".join(cells).translate(self._translation).split("\n"))))
        return values if np.isfinite(values).all() else None

    def number(self, cell: str) -> float | None:
        """The number of a stripped cell: NaN where it says that there is none, None where it is text."""
        if not cell.isascii():
            cell = cell.translate(_MINUS)
        if self._form.fullmatch(cell):
            value = float(cell.translate(self._translation))
            return value if math.isfinite(value) else math.nan
        return math.nan if cell.lower() in _NO_NUMBER or cell in _DASHES or cell.startswith("Err:") else None


def one_reading(text: str, marks: Marks) -> float | None:
    """The one reading of a number in a text; None where it has two, 1,025 with a decimal comma and with thousands."""
    plain = text.strip().rstrip(",.")
    for decimal in (marks.decimal, *({".", ","} - {marks.decimal})):
        value = Marks(decimal).number(plain)
        if value is not None:
            certain = decimal == marks.decimal or not re.fullmatch(r"[-+]?[1-9]\d{0,2}[.,]\d{3}", plain)
            return value if certain else None
    return None


def numeric(cells: Sequence[str], marks: Marks) -> int:
    """How many cells are numbers, or say in letters that they are none."""
    return sum(c not in _DASHES and marks.number(c) is not None for c in cells)


_ATOM = (
    r"(?:[kMm]?N(?:mm|m)?|lbf?|kgf|gf|[mck]?m|in|[Ff]t|[Ii]nch(?:es)?|(?:[Mm]illi)?[Mm]et(?:er|re)s?|ms|s|sec|min|h|[Dd]eg\.?|[Dd]egrees?|[Gg]rad|[Gg]rd|rad|radians?|°|kn|kts?|knots?|n(?:oe|œ)uds?|[Kk]noten|nudos|nodi|mph|mps|kph|rpm|rps|"
    r"rev|[kM]?Hz|1|[km]?g|t|slug|[kM]?Pa|m?bar|psi|m?V|m?A|k?W|K|(?:°|[Dd]egr?\.?[ _]?)C|%|‰)"
)
_POWER = r"(?:(?:\^|\*\*)?\(?-?[1-4]\)?|[²³⁻¹⁴]+)?"
_UNIT = re.compile(rf"{_ATOM}{_POWER}(?:\s*[*/·.\- ]\s*\(?{_ATOM}{_POWER}\)?)*")
_LETTER = re.compile(r"[^\W\d]|[°%‰]")
_BRACKETS = re.compile(r"(?P<name>.*?\S)\s*\[(?P<unit>[^\[\]]*)\]")
_PARENTHESES = re.compile(r"(?P<name>.*?\S)\s*\((?P<unit>[^()]*(?:\([^()]*\)[^()]*)*)\)")
_BEHIND = re.compile(r"(?P<name>.*?[^\s,/])(?:\s*,\s*|\s+/\s+)(?P<unit>\S.*)")
# The last letter of these is no unit: coefficients, standard errors and rudders are written so too.
_NO_UNIT_BEHIND = re.compile(r"(?i)(c|se|k|d|delta|sd|std|err|sigma|max|min)_.{1,2}")
# Units of several words behind a name, as r_rad_s, U_m_per_s, rho_kg_m3 and Mz_N_m: no name ends so by chance.
_WORDS_BEHIND = re.compile(
    r"(?P<name>.*[^_\s])_(?:(?P<over>rad(?:ians?)?|deg(?:rees?)?|rev|m|cm|mm|ft|in|km|kg|g|lbf?|slug|t)_(?:per_)?"
    r"(?P<under>s(?:ec(?:ond)?)?|min|h|m\^?3|cm\^?3|l|ft\^?3)(?P<square>2|\^2)?|(?P<force>[kM]?N|lbf)_(?P<arm>mm|cm|m|ft|in)|(?P<one>deg(?:rees?)?|rad|[kM]?Nm|mps))"
)
_SEPARATORS = " _-:/"
_INDICES = frozenset("ijn:")
# Units in small letters behind a name in small letters, as programs write them: lift_n, speed_ms.
_SMALL = {
    "n": ("N", frozenset({"X", "Y", "Z", *WIND})),
    "nm": ("N*m", frozenset("KMN")),
    "ms": ("m/s", frozenset("Uuvw")),
}


_NO_UNIT = frozenset({"", "-", "–", "—", "/"})
_BETWEEN_UNITS = re.compile(r"\s*[×•∙⋅‐‑_]\s*|\s+x\s+")  # as N×m, N_m and N x m in brackets


def is_unit(text: str) -> bool:
    """Whether a text is a unit as tables write it, without brackets; of numbers 1 alone is one, not 1.1 nor 12."""
    if text in _NO_UNIT - {""} or text == "1":
        return True
    return len(text) <= 24 and _UNIT.fullmatch(text) is not None and _LETTER.search(text) is not None


def name_and_unit(text: str) -> tuple[str, str]:
    """Split ``Fy [N]``, ``Fy (N)``, ``Fy, N`` and ``Fy / N``; the unit is empty where none stands."""
    clean = " ".join(text.split())
    if m := _BRACKETS.fullmatch(clean):
        if m["unit"].strip() in _INDICES:  # beta[i] of a program
            return m["name"].rstrip(_SEPARATORS), ""
        return m["name"].rstrip(_SEPARATORS) or m["name"], m["unit"].strip()
    if (m := _PARENTHESES.fullmatch(clean)) and is_unit(_BETWEEN_UNITS.sub("·", m["unit"].strip()) or "-"):
        return m["name"].rstrip(_SEPARATORS) or m["name"], m["unit"].strip()
    if (m := _BEHIND.fullmatch(clean)) and is_unit(m["unit"]) and m["unit"] not in ("-", "1"):
        return m["name"], m["unit"]
    return clean, ""


def unit_in_words(text: str) -> tuple[str, str]:
    """Split ``r_rad_s`` and ``U_m_per_s`` into name and unit, ``rad/s``; the unit is empty where no such one stands."""
    m = _WORDS_BEHIND.fullmatch(text)
    if m is not None and m["one"]:
        return m["name"], "m/s" if m["one"] == "mps" else m["one"]
    if m is None or _NO_UNIT_BEHIND.fullmatch(f"{m['name']}_N"):
        return text, ""
    if m["force"]:
        return m["name"], f"{m['force']}*{m['arm']}"
    under = f"{m['under']}^2" if m["square"] else m["under"]
    return m["name"], f"{m['over']}/{under}"


def names_and_units(texts: Sequence[str]) -> list[tuple[str, str]]:
    """Split ``Fy_N`` where at least half of the names, and two of them, end so and one of these ends is no single letter.

    A unit of several words, as in ``r_rad_s``, is one wherever it stands.
    """
    words = [_in_small_letters(t) or unit_in_words(t) for t in texts]
    return [w if w[1] else p for w, p in zip(words, _by_last_word(texts, words), strict=True)]


def _in_small_letters(text: str) -> tuple[str, str] | None:
    """Name and unit of ``lift_n``, where the name is of what has that unit."""
    name, _, end = text.strip().rpartition("_")
    unit, meanings = _SMALL.get(end, ("", frozenset()))
    words, bare = vocabulary(), folded(name)
    return (name, unit) if {words.columns.get(bare, ""), words.flow.get(bare, "")} & meanings else None


def _by_last_word(texts: Sequence[str], words: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    parts = [w if w[1] else t.rpartition("_")[::2] for t, w in zip(texts, words, strict=True)]
    ends = [
        bool(n) and bool(w[1] or (is_unit(u) and u != "-" and not _NO_UNIT_BEHIND.fullmatch(t)))
        for t, (n, u), w in zip(texts, parts, words, strict=True)
    ]
    sure = any(e and len(u) > 1 for e, (_, u) in zip(ends, parts))
    if not sure or sum(ends) < 2 or 2 * sum(ends) < len(texts):
        return [(t, "") for t in texts]
    return [p if e else (t, "") for t, p, e in zip(texts, parts, ends)]


_NUMBER = re.compile(r"[-+]?\d[\d.,]*(?:[eE][-+]?\d+)?")


def _bare(cell: str) -> str:
    return cell[1:-1].strip() if cell[:1] + cell[-1:] in ("[]", "()", "<>") else cell


def _unit_of(cell: str) -> str:
    """The unit of a cell of a row of units: a slash says that there is none, a number that it is something else."""
    bare, _, other = _bare(cell).partition(" / ")
    bare = bare if other in ("", bare) else f"{bare} / {other}"
    return "-" if bare == "/" else bare if bare == "1" or share(bare) is not None or not _NUMBER.fullmatch(bare) else ""


def numbered(rows: Sequence[Sequence[str]], marks: Marks) -> frozenset[int]:
    """The columns of equally long rows in which more cells are numbers than text."""
    out = set()
    for k, column in enumerate(zip(*rows)):
        filled = [c for c in column if c not in _DASHES]
        if 2 * numeric(filled, marks) > len(filled):
            out.add(k)
    return frozenset(out)


def is_unit_row(cells: Sequence[str], numbers: Set[int], names: Sequence[str] = ()) -> bool:
    """Whether a row between names and data holds units: the letters of a run (A, K, m, s) and the number 1 are units too.

    Every cell is a unit, a share such as 1e-3, or blank. Beyond that one cell has to be what no row of data has: a unit in
    letters or % over a column of numbers, a bracket, or a share such as 1e-3 beside a dash; or all are dashes. A number under a
    name that has its unit is one of the data.

    Parameters
    ----------
    cells : sequence of str
    numbers : set of int
        Columns that hold numbers below, see `numbered`.
    names : sequence of str
        Over them, where they are known.
    """
    bare = [_bare(c) for c in cells]
    if any((c == "1" or share(c) is not None) and c != "%" and name_and_unit(n)[1] for c, n in zip(cells, names)):
        return False
    units = [not c or is_unit(c) or share(c) is not None for c in bare]
    if not any(cells):
        return False
    if not all(
        units
    ):  # units that nobody knows between those of columns of numbers, as H:M:S; places of taps as 100.00
        within = [k for k in numbers if k < len(bare)]
        known = [bare[k] for k in within if bare[k] not in (*_NO_UNIT, "1") and is_unit(bare[k])]
        worded = [k for k, c in enumerate(bare) if units[k] or not _NUMBER.fullmatch(c)]
        some = [k for k in within if k in worded]
        return len({*known}) > 1 and all(sum(units[k] for k in ks) >= MOSTLY * len(ks) for ks in (worded, some))
    over = [bare[k] for k in numbers if k < len(bare)]
    if any(c and c != b for c, b in zip(cells, bare)) or any(
        c != "1" and c not in _NO_UNIT and is_unit(c) for c in over
    ):
        return True
    shares = any(share(c) is not None for c in over)
    dashes = any(c in _NO_UNIT for c in over if c)
    return dashes and (shares or all(c in _NO_UNIT for c in bare))


def is_name_row(cells: Sequence[str], marks: Marks, numbers: Set[int] = frozenset()) -> bool:
    """Whether at least half of the cells hold a text, and three texts at least stand beside each number; Na and nan are texts.

    Cells behind the last column of ``numbers``, where these are known, count only as far as one holds a text.
    """
    filled = [c for c in cells if c and c not in _DASHES]
    below = sum(math.isfinite(x) for c in filled if (x := marks.number(c)) is not None)
    reach = max([k for k, c in enumerate(cells) if c] + list(numbers or [len(cells) - 1]), default=-1) + 1
    return 2 * sum(map(bool, cells)) >= reach and 4 * below <= len(filled)


@dataclass(frozen=True, slots=True)
class Head:
    """Names and units of the columns, and where they stand.

    Attributes
    ----------
    names, units : tuple of str
    line, unit_line : int
        0 where there is none.
    written : tuple of tuple of str
        The rows of the head as written, to know them again.
    units_stand : str
        Where the units stand, as people read it.
    remarks : tuple of str
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    line: int = 0
    unit_line: int = 0
    written: tuple[tuple[str, ...], ...] = ()
    units_stand: str = "none"
    remarks: tuple[str, ...] = ()


Row = tuple[int, list[str]]


def read_head(
    above: Sequence[Row], width: int, marks: Marks, numbers: Set[int], named: int = 0, united: int = 0
) -> Head:
    """The names over a table's columns.

    Parameters
    ----------
    above : sequence of (line, cells)
        Rows over the data, the nearest last, each as wide as the table.
    width : int
    marks : Marks
    numbers : set of int
        Columns that hold numbers, see `numbered`.
    named, united : int
        Lines that a person says hold the names and the units; 0 to find them, -1 where there are none.
    """
    rows = list(above)
    remarks = []
    while not (named or united) and _is_under_names(rows, marks, numbers) and _is_empty(rows[-1][1], numbers):
        remarks.append(f"line {rows[-1][0]}: left out, no number in it ({shown(' '.join(filter(None, rows[-1][1])))})")
        rows.pop()
    units: Row | None = next((r for r in rows if r[0] == united), None)
    under = united == 0 and _is_under_names(rows, marks, numbers) and named != rows[-1][0]
    if under and is_unit_row(rows[-1][1], numbers, rows[-2][1]):
        units = rows[-1]
        if any(marks.number(c) is not None and c not in _DASHES for c in units[1]):
            remarks.append(
                f"line {units[0]}: {shown(' '.join(filter(None, units[1])))} are taken for the units of the columns"
            )
    rows = [r for r in rows if r is not units]
    names: Row | None = next((r for r in rows if r[0] == named), None)
    if named == 0 and rows and is_name_row(rows[-1][1], marks, numbers):
        names = rows[-1]
    if names is None:
        own = tuple(map(_unit_of, units[1])) if units else ("",) * width
        plain = tuple(f"column {k + 1}" for k in range(width))
        return Head(plain, own, unit_line=units[0] if units else 0, remarks=tuple(remarks))
    group = next((r for r in reversed(rows) if r[0] < names[0]), None)
    return _head(names, units, group, remarks)


def head_in_order(names: str, width: int, path: Path) -> Head:
    """The head that a person says: names of the first columns between commas; a dash names none."""
    cells = [" ".join(c.split()) for c in names.split(",")]
    if len(cells) > width:
        raise input_error("tables.too_many_names", path, many=len(cells), width=width)
    return _head((0, ["" if c in _DASHES else c for c in cells] + [""] * (width - len(cells))), None, None, ())


WORDS = 5  # of a name at most
_EXPLAINS = re.compile(r"(?:^|[,;#%!]\s*)(?P<short>\w{1,8})\s+(?:-|=)\s+(?P<text>[^,;=]*[^\W\d][^,;=]*)")


def explained(head: Head, lines: Sequence[str]) -> Head:
    """The head with what a legend above it says of short names: ``P3: drift`` in degrees where a line has ``P3 - drift [degree]``.

    Parameters
    ----------
    head : Head
    lines : sequence of str
        Over the rows of numbers.
    """
    if not head.line or any(head.units):
        return head
    words: dict[str, tuple[str, str]] = {}
    for n, line in enumerate(lines, start=1):
        if n != head.line and len(line) < LONGEST_LEGEND:
            words |= {m["short"]: name_and_unit(m["text"].strip()) for m in _EXPLAINS.finditer(line)}
    if not any(name in words for name in head.names):
        return head
    names = tuple(f"{name}: {words[name][0]}" if name in words else name for name in head.names)
    units = tuple(words[name][1] if name in words else "" for name in head.names)
    return replace(head, names=names, units=units, units_stand="in a legend above the names")


def _is_under_names(rows: Sequence[Row], marks: Marks, numbers: Set[int]) -> bool:
    return len(rows) > 1 and is_name_row(rows[-2][1], marks, numbers)


def _is_empty(cells: Sequence[str], numbers: Set[int]) -> bool:
    """Whether a row over the data is one of them without any number: nothing in all columns of numbers, and no units."""
    return bool(numbers) and all(cells[k] in _DASHES for k in numbers) and not is_unit_row(cells, numbers)


def _head(names: Row, units: Row | None, group: Row | None, before: Sequence[str]) -> Head:
    texts = [" ".join(t.split()) for t in names[1]]
    over = [name_and_unit(" ".join(t.split())) for t in group[1]] if group else []
    if (
        group
        and len({n for n, _ in over} - {""}) == len(texts) > 1
        and not any(
            ":" in g or "=" in g or len(g.split()) > WORDS for g in group[1]
        )  # words over the table, split at its delimiter
        and not any(_NUMBER.fullmatch(g) or (is_unit(t) and t[1:]) for g, t in zip(group[1], texts))
    ):
        before = [*before, f"lines {group[0]} and {names[0]}: both name the columns"]
        texts = [f"{n}: {t}".removesuffix(": ") + f" [{u}]" * bool(u) for (n, u), t in zip(over, texts)]
    stand = "none"
    if units:
        split = [(t, _unit_of(u)) if _bare(u) else unit_in_words(t) for t, u in zip(texts, units[1])]
        stand = f"row under the names (line {units[0]})"
    else:
        split = [name_and_unit(t) for t in texts]
        if any(u for _, u in split):
            split = [(n, u) if u else unit_in_words(n) for n, u in split]
            stand = "in the header"
        else:
            split = names_and_units([n for n, _ in split])
            stand = "after an underscore" if any(u for _, u in split) else stand
    found, remarks = _distinct([n or f"column {k}" for k, (n, _) in enumerate(split, start=1)], names[0], group)
    remarks = [*before, *remarks]
    written = tuple(tuple(r[1]) for r in (names, units) if r)
    return Head(
        tuple(found), tuple(u for _, u in split), names[0], units[0] if units else 0, written, stand, tuple(remarks)
    )


def _distinct(names: list[str], line: int, group: Row | None) -> tuple[list[str], list[str]]:
    """Names that differ, the later ones numbered, and what stands over them: how far a group reaches no file says."""
    seen: Counter[str] = Counter()
    out = []
    for name in names:
        seen[name] += 1
        out.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    again = [n for n, many in seen.items() if many > 1]
    if not again:
        return out, []
    words = f"line {line}: {', '.join(map(shown, again[:8]))} head several columns; the later ones are numbered"
    over = [f"{shown(' '.join(g.split()))} over {shown(n)}" for g, n in zip(group[1], out) if g] if group else []
    return out, [words, f"line {group[0]}: {', '.join(over[:12])}"] if group and over else [words]


@dataclass(slots=True)
class Cells:
    """What was met in a column on the way: words for no number, text, and where first.

    Attributes
    ----------
    absent : dict of str to list of int
        How often each word for no number stands there, and its first line.
    text : list
        How many cells are text, the first of them and its line.
    """

    absent: dict[str, list[int]] = field(default_factory=dict)
    text: list[int | str] = field(default_factory=list)

    def values(self, cells: Sequence[str], lines: Sequence[int], marks: Marks, plain: bool = False) -> Array:
        """Numbers of stripped cells, one by one; what is none is noted.

        Parameters
        ----------
        cells : sequence of str
        lines : sequence of int
        marks : Marks
        plain : bool
            No cell has an underscore, or a letter beyond ASCII: what Python takes for a number is one.
        """
        out = np.empty(len(cells))
        point, mark = marks.decimal == ".", marks.thousands or "\n"
        for i, cell in enumerate(cells):
            value: float | None = math.nan
            if plain and mark not in cell:
                try:
                    value = float(cell if point else cell.translate(_SWAPPED))
                except ValueError:
                    value = math.nan
            if value is None or not math.isfinite(value):
                value = marks.number(cell)
                if value is None:
                    self.text = [int(self.text[0]) + 1, *self.text[1:]] if self.text else [1, cell, lines[i]]
                    value = math.nan
                elif math.isnan(value):
                    self.no_number(cell, lines[i])
            out[i] = value
        return out

    def no_number(self, cell: str, line: int) -> None:
        """Note a cell that says that there is no number."""
        word = cell if len(cell) < 20 and not any(c in "123456789" for c in cell) else "beyond all numbers"
        self.absent.setdefault(word, [0, line])[0] += 1

    def remarks(self, name: str, rows: int) -> list[str]:
        """What a person should know of the column."""
        out = []
        if self.text and int(self.text[0]) < rows / 2:
            out.append(
                f"column {shown(name)}: {_counted(int(self.text[0]))} text, first {shown(self.text[1])} in line {self.text[2]}"
            )
        elif not self.text and (absent := {w: n for w, n in self.absent.items() if n[0] < rows or w}):
            words = ", ".join(
                f"{shown(w) if w else 'blank'} {n[0]} times" if n[0] > 1 else shown(w) if w else "blank"
                for w, n in absent.items()
            )
            total, first = sum(n[0] for n in absent.values()), min(n[1] for n in absent.values())
            out.append(f"column {shown(name)}: {_counted(total)} without a number ({words}), first in line {first}")
        return out


def _counted(many: int) -> str:
    return f"{many} cell{'s are' if many > 1 else ' is'}"


def raw_columns(
    head: Head, values: Iterable[Array], texts: Mapping[int, Sequence[str]], met: Sequence[Cells]
) -> tuple[tuple[RawColumn, ...], list[str]]:
    """The columns of a raw table and what is remarkable of them; columns without name and content are left out."""
    columns, remarks = [], list(head.remarks)
    for k, (name, unit, column) in enumerate(zip(head.names, head.units, values)):
        if name == f"column {k + 1}" and k not in texts and np.all(np.isnan(column)) and set(met[k].absent) <= {""}:
            continue
        columns.append(RawColumn(name, unit, column, tuple(texts.get(k, ()))))
        remarks += met[k].remarks(name, len(column))
    return tuple(columns), remarks


_HOUSE = frozenset({*COMPONENTS, *WIND, *MOTIONS, *CONTROLS, *CONTROL_COLUMNS, "alpha", "beta", "U"})
_OPENFOAM = re.compile(
    r"^\s*#\s*Time\b.*(?:total_[xyz]|pressure_[xyz]|forces?\(|moments?\(|\(|\bC[mdls]\b)|^FoamFile\b"
)
_OF_FORCES = re.compile(
    r"^\s*#\s*(?:Force|Moment|Forces|Force coefficients|Moment coefficients|CofR|liftDir|dragDir|magUInf)\b"
)
_OF_TIME = re.compile(r"^\s*#\s*Time\b")  # without it such a line may stand in any table: "# CofR (2 0 0)"


def is_of_openfoam(lines: Sequence[str]) -> bool:
    """Whether the first lines are those of forces or a dictionary of OpenFOAM, whose importer takes the folder of a case."""
    first = [line[:2000] for line in lines[:60]]
    titled = any(map(_OF_FORCES.search, first)) and any(map(_OF_TIME.search, first))
    return titled or any(map(_OPENFOAM.search, first))


def is_house_table(path: Path) -> bool:
    """Whether a file is a comma CSV whose names of columns are ours, each with its unit in brackets; never raises."""
    try:
        with stream_of(path) as stream:
            sample = stream.read(SNIFFED)
        text = sample[: sample.rfind(b"\n") + 1 if len(sample) == SNIFFED else None].decode("utf-8-sig")
    except (OSError, UnicodeDecodeError):
        return False
    head = next((line for line in text.split("\n") if line.strip() and not line.lstrip().startswith("#")), "")
    headers = [parse_header(cell.strip().strip('"')) for cell in head.split(",")]
    united = [
        h.name.removeprefix("se_").removeprefix(DIGIT).removesuffix("'") in _HOUSE
        for h in headers
        if h.unit is not None
    ]
    return "\0" not in text and "\r" not in head.rstrip("\r") and bool(united) and all(united)

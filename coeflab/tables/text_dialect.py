"""How a file of delimited text is written, by its first 64 KiB: delimiter, marks, encoding, head; or one clear error."""

from __future__ import annotations

import codecs
import csv
import math
import re
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path
from statistics import median

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import CSV_LINE, TABLE_COLUMNS
from coeflab.core.options import bounded, one_of, text
from coeflab.core.text.bounded import stream_of
from coeflab.core.texts import input_error
from coeflab.tables.dialect import (
    BLANKS,
    ERRORS,
    MARK_NAMES,
    SNIFFED,
    Head,
    Marks,
    Row,
    explained,
    head_in_order,
    is_name_row,
    is_unit_row,
    numbered,
    numeric,
    read_head,
)
from coeflab.tables.raw_table import Stated
from coeflab.tables.words.above import words_above

DELIMITERS = {"tab": "\t", "semicolon": ";", "pipe": "|", "comma": ",", "blanks": " ", "none": ""}
MARKS = {"blank": " ", "point": ".", "comma": ",", "apostrophe": "'", "none": ""}
COMMENTS = ("#", "%", "//", "!")
_ENCODINGS = (
    "utf-8", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1", "cp437", "mac-roman", "shift_jis", "euc_kr", "gb18030",
)  # fmt: skip
SEEN, FEWEST_NAMED = 12, 3  # rows that tell a head from the first of them; names over columns of numbers
POLAR = "Calculated polar for"  # over a polar of XFOIL and XFLR5, whose first column is alpha in degrees
FEWEST_SHORT = 2  # rows: one alone was cut
RULE = re.compile(r"[-=+|:_ \t]*(?:---|===|___|:-+:?|-+:)[-=+|:_ \t]*")
_ERRORS = tuple(ERRORS)
_SPACES = re.compile(r"[ \t]+")


@dataclass(frozen=True, slots=True)
class Options:
    """What a person may say of a file instead of having it found out.

    Attributes
    ----------
    delimiter : str
        Between the columns; empty to find it out, none for a single column.
    decimal : str
        Mark before the decimals; empty to find it out.
    thousands : str
        Mark between thousands; empty to find it out.
    header : int
        Line of the column names; 0 to find it, -1 where there is none.
    units : int
        Line of the units; 0 to find it, -1 where there is none.
    encoding : str
        Empty to find it out: a byte-order mark, else UTF-8, else cp1252.
    comment : str
        What begins a comment line; empty for each of # % // !.
    columns : str
        Names of all, in order and between commas, such as alpha [deg], CL, -, Cm; empty to find them.
    """

    delimiter: str = one_of("", "", *DELIMITERS)
    decimal: str = one_of("", "", "point", "comma")
    thousands: str = one_of("", "", *MARKS)
    header: int = bounded(0, -1, 1_000_000)
    units: int = bounded(0, -1, 1_000_000)
    encoding: str = one_of("", "", *_ENCODINGS)
    comment: str = one_of("", "", *COMMENTS, "none")
    columns: str = text("")


class AmbiguousError(InputError):
    """A table whose numbers can be read in two ways."""


@dataclass(frozen=True, slots=True)
class TextDialect:
    """How a file is written, as far as its beginning says."""

    encoding: str
    delimiter: str
    marks: Marks
    comments: tuple[str, ...]
    head: Head
    start: int
    width: int
    numbers: tuple[int, ...]  # columns that hold numbers
    words: frozenset[int]  # columns that hold text
    decimals: int  # digits behind the mark in the last column, -1 where they differ
    summary: Mapping[str, str]
    remarks: tuple[str, ...] = ()
    stated: Mapping[str, Stated] = field(default_factory=dict)
    above: tuple[str, ...] = ()  # lines over the head
    ragged: bool = False  # rows end before their last names


def _comments(options: Options) -> tuple[str, ...]:
    return {"": COMMENTS, "none": ()}.get(options.comment, (options.comment,))


def is_comment(line: str, comments: tuple[str, ...]) -> bool:
    """Whether a line without leading blanks is a comment; ``#N/A`` begins none."""
    return bool(comments) and line.startswith(comments) and not line.lower().startswith(_ERRORS)


def split_line(line: str, delimiter: str) -> list[str]:
    """Stripped cells of a line."""
    if not delimiter:
        return [line.strip().strip('"')]
    if '"' in line:
        spaced = _SPACES.sub(" ", line.strip()) if delimiter == " " else line
        try:
            return [c.strip() for c in next(csv.reader([spaced], delimiter=delimiter, skipinitialspace=True))]
        except csv.Error:
            pass
    if delimiter == " ":
        return _SPACES.split(line.strip(" \t\n"))
    return [c.strip() for c in line.split(delimiter)]


def unread(path: Path, why: OSError) -> InputError:
    """The error of a file that the machine does not hand out."""
    return InputError(str(why.strerror or why), "a readable file", file=path)


def first_bytes(path: Path) -> tuple[bytes, bool]:
    """The first bytes of a file, and whether they are all of it."""
    try:
        if not path.is_file():
            raise InputError("a folder" if path.is_dir() else "no such file", "a table", file=path)
        with stream_of(path) as stream:
            content = stream.read(SNIFFED + 1)
    except OSError as why:
        raise unread(path, why) from None
    return content[:SNIFFED], len(content) <= SNIFFED


def encoding_of(sample: bytes, options: Options, path: Path) -> str:
    """The encoding by mark, by zeros of UTF-16, by being UTF-8, else cp1252."""
    if options.encoding:
        return "utf-8-sig" if options.encoding == "utf-8" else options.encoding
    for mark, name in (
        (codecs.BOM_UTF8, "utf-8-sig"),
        (codecs.BOM_UTF16_LE, "utf-16"),
        (codecs.BOM_UTF16_BE, "utf-16"),
    ):
        if sample.startswith(mark):
            return name
    if b"\0" in sample:
        even, odd = sample[::2].count(0), sample[1::2].count(0)
        if min(even, odd) <= 0.02 * len(sample) and max(even, odd) > 0.4 * len(sample):
            return "utf-16-be" if even > odd else "utf-16-le"
        raise InputError("binary content (a NUL byte)", "a table of text", file=path)
    try:
        codecs.getincrementaldecoder("utf-8")().decode(sample)
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"


def _line_ends(text: str) -> str:
    crlf = text.count("\r\n")
    found = {"CRLF": crlf, "LF": text.count("\n") - crlf, "CR": text.count("\r") - crlf}
    return " and ".join(n for n, many in found.items() if many) or "none"


def first_lines(sample: bytes, whole: bool, encoding: str, path: Path) -> tuple[list[str], str]:
    """Lines of the sample, the last one left out where it may be cut, and what ends them."""
    try:
        text = codecs.getincrementaldecoder(encoding)().decode(sample, whole)
    except UnicodeDecodeError as why:
        raise undecoded(why, encoding, path) from None
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if not whole or not lines[-1]:
        lines.pop()
    if any("\0" in line for line in lines):
        raise InputError("binary content (a NUL)", "a table of text", file=path)
    if not lines and not whole:
        raise InputError(f"a line longer than {CSV_LINE} bytes", "a table", file=path, line=1)
    return lines, _line_ends(text)


def undecoded(why: UnicodeDecodeError, encoding: str, path: Path) -> InputError:
    """The error of a file that is not in its encoding."""
    byte = why.object[why.start : why.start + 1].hex()
    return input_error("tables.byte_of_another_encoding", path, byte=byte, encoding=encoding)


Rows = list[Row]
Found = tuple[str, Rows, tuple[int, int, int, float]]


def _longest(rows: Rows, marks: Marks) -> tuple[int, int, int, float]:
    """First and past-last index of the longest run of equally wide rows with numbers, their width and share of numbers."""
    best = (0, 0, 0, 0.0)
    counts = [numeric(c, marks) for _, c in rows]
    i = 0
    for (width, data), run in groupby(zip(rows, counts), key=lambda rc: (len(rc[0][1]), rc[1] > 0)):
        found = list(run)
        cells = sum(sum(map(bool, c)) for (_, c), _ in found)
        share = sum(n for _, n in found) / max(cells, 1)
        if data and len(found) * share > (best[1] - best[0]) * best[3]:
            best = (i, i + len(found), width, share)
        i += len(found)
    return best


def padded(cells: list[str], width: int) -> list[str]:
    """A row that ends before the last of its names, filled up with blanks where at least half of it is there."""
    return cells + [""] * (width - len(cells)) if width <= 2 * len(cells) else cells


def _ragged(rows: Rows, marks: Marks) -> Rows | None:
    """The rows under names filled up; None where a long run of whole ones begins there, or fewer than two are short."""
    out, width, short, named = list[Row](), 0, 0, False
    for n, cells in rows:
        if numeric(cells, marks):
            named, short = False, short + (len(cells) < width <= 2 * len(cells))
        elif len(cells) >= FEWEST_NAMED and is_name_row(cells, marks):
            width, named = max(len(cells), width if named else 0), True
        out.append((n, padded(cells, width)))
    first = _longest(rows, marks)[0]
    whole = first and len(rows[first][1]) == len(rows[first - 1][1]) and not numeric(rows[first - 1][1], marks)
    return out if short >= FEWEST_SHORT and not whole else None


def _hypotheses(text: str, options: Options) -> list[Marks]:
    """Marks that may be meant, the simplest first."""
    blank = any(b in text for b in (*BLANKS, " "))
    out = []
    for thousands in ("", ",", ".", " ", "'"):
        there = {"": True, " ": blank, "'": "'" in text or "’" in text}.get(thousands, thousands in text)
        out += [
            Marks(d, thousands)
            for d in ".,"
            if d != thousands and there and (d == "." or "," in text or thousands == "." or options.decimal)
        ]
    if options.decimal:
        out = [m for m in out if m.decimal == MARKS[options.decimal]]
    if options.thousands:
        decimals = [MARKS[options.decimal]] if options.decimal else [".", ","]
        out = [Marks(d, MARKS[options.thousands]) for d in decimals if d != MARKS[options.thousands]]
    return out


def _delimiter(rows_read: list[tuple[int, str]], options: Options, path: Path) -> Found:
    """The delimiter, the rows that it makes and their longest run."""
    text = "\n".join(line for _, line in rows_read)
    hypotheses = _hypotheses(text, options) or [Marks()]
    wanted = [DELIMITERS[options.delimiter]] if options.delimiter else DELIMITERS.values()
    found = []
    for delimiter in wanted:
        if delimiter and (delimiter not in text and not (delimiter == " " and "\t" in text)) and not options.delimiter:
            continue
        rows = [(n, split_line(line, delimiter)) for n, line in rows_read]
        if delimiter.strip(" ") and (ragged := _ragged(rows, hypotheses[0])):
            rows = ragged
        run = max((_longest(rows, m) for m in hypotheses), key=lambda r: (r[1] - r[0]) * r[3])
        if run[1] and (run[2] > 1 or not delimiter or options.delimiter):
            found.append((delimiter, rows, run, (run[1] - run[0]) * run[3]))
    if not found:
        raise input_error("tables.no_row_of_numbers", path)
    most = max(f[3] for f in found)
    delimiter, rows, run, _ = next(f for f in found if f[3] >= 0.8 * most)
    first, last, width, share = run
    if _is_head([c for _, c in rows[first:last][:SEEN]], hypotheses):
        run = (first + 1, last, width, share)
    return delimiter, rows, run


def _is_head(rows: Sequence[list[str]], hypotheses: Sequence[Marks]) -> bool:
    """Whether the first of some rows names columns of numbers, though a few of its cells are numbers themselves."""
    if len(rows) < 3:
        return False
    below = [
        k for k in range(len(rows[0])) if all(any(m.number(c[k]) is not None for m in hypotheses) for c in rows[1:])
    ]
    named = [k for k in below if rows[0][k] and all(m.number(rows[0][k]) is None for m in hypotheses)]
    return len(named) >= FEWEST_NAMED and is_name_row(rows[0], hypotheses[0])


def _readings(marks: Marks) -> str:
    words = f"decimal {MARK_NAMES[marks.decimal]}"
    return f"{words} and {MARK_NAMES[marks.thousands]} between thousands" if marks.thousands else words


def _which(one: Marks, other: Marks) -> str:
    """The options that decide between two readings."""
    words = [
        f"decimal = {MARK_NAMES[m.decimal]}"
        if one.decimal != other.decimal
        else f"thousands = {MARK_NAMES[m.thousands]}"
        for m in (one, other)
    ]
    return f"Say the option {words[0]} or {words[1]}."


def _marks(rows: Rows, delimiter: str, options: Options, path: Path) -> Marks:
    """Decimal and thousands mark by all numbers of the sample.

    Raises
    ------
    AmbiguousError
        Two readings take as many cells as numbers, and give other values.
    """
    cells = [(n, c) for n, row in rows for c in row if c]
    hypotheses = _hypotheses("\n".join(c for _, c in cells), options) or [Marks()]
    values = [[m.number(c) for _, c in cells] for m in hypotheses]
    taken = [sum(v is not None for v in vs) for vs in values]
    best = taken.index(max(taken))
    if hypotheses[best] == Marks() and delimiter != ";" and not options.thousands:
        return hypotheses[best]
    for m, vs in ((m, vs) for m, vs, many in zip(hypotheses, values, taken) if many == taken[best]):
        for (line, cell), a, b in zip(cells, values[best], vs):
            if a is not None and b is not None and a != b and not (math.isnan(a) and math.isnan(b)):
                raise AmbiguousError(
                    f"numbers such as {shown(cell)}: {a!r} with a {_readings(hypotheses[best])}, {b!r} with a {_readings(m)}",
                    "numbers with one reading", file=path, line=line, advice=_which(hypotheses[best], m),
                )  # fmt: skip
    return hypotheses[best]


def _fitted(line: str, delimiter: str, width: int, filled: int) -> list[str] | None:
    """The cells of a line of the head, as many as the table has columns; None where it cannot be split so."""
    for other in dict.fromkeys((delimiter, "\t", ";", ",", "|")):
        cells = split_line(line, other)
        while len(cells) > width and not cells[-1]:
            cells.pop()
        if filled <= len(cells) < width and other == delimiter:
            cells += [""] * (width - len(cells))
        if len(cells) == width:
            return cells
    if delimiter == " ":
        wide = [c.strip() for c in re.split(r"\t+|\s{2,}", line.strip())]
        joined = _SPACES.split(re.sub(r"\s+([\[(][^\])]*[\])])", "\u0000\\1", line.strip()))
        for cells in (wide, [c.replace("\u0000", " ") for c in joined]):
            if len(cells) == width:
                return cells
    return None


def _over_rule(line: str, rule: str, width: int) -> list[str] | None:
    """The names over a rule of strokes, one a column: each stands over its own; None where the rule has none of them, or not as many."""
    middles = [sum(m.span()) / 2 for m in re.finditer(r"[-=_]+", rule)]
    if len(middles) != width or width < FEWEST_NAMED:
        return None
    names = [""] * width
    for word in re.finditer(r"\S+", line):
        k = min(range(width), key=lambda i: abs(middles[i] - sum(word.span()) / 2))
        names[k] = f"{names[k]} {word[0]}".strip()
    return names if all(names) else None


def _over_cells(line: str, row: str, width: int) -> list[str] | None:
    """The names over fixed columns, each within its own; blank where a column has none; None where one is wider or most lack."""
    cells = [m.span() for m in re.finditer(r"\S+", row)]
    names = [""] * width
    for word in re.finditer(r"\S+", line):
        own = [k for k, (begin, end) in enumerate(cells) if begin - 2 <= word.start() and word.end() <= end + 1]
        if len(cells) != width or len(own) != 1 or names[own[0]]:
            return None
        names[own[0]] = word[0]
    return names if sum(map(bool, names)) > max(width / 2, FEWEST_NAMED - 1) else None


def _head(
    lines: list[str], start: int, dialect: tuple[str, Marks, int, int], numbers: Set[int], options: Options, path: Path
) -> tuple[Head, list[str]]:
    """The names over the line ``start`` (counted from 1)."""
    delimiter, marks, width, filled = dialect
    if options.columns:
        return head_in_order(options.columns, width, path), []
    comments = _comments(options)
    above: list[Row] = []
    remarks: list[str] = []
    ruled = ""
    for n in range(start - 1, 0, -1):
        line = lines[n - 1].strip(" \n") if delimiter == "\t" else lines[n - 1].strip()
        remark = is_comment(line.lstrip(), comments)
        bare = line.lstrip().lstrip("".join(comments)).strip() if remark else line
        if not bare or RULE.fullmatch(bare):
            ruled = lines[n - 1] if bare else ruled
            continue
        cells = _fitted(bare, delimiter, width, filled)
        if cells is None and not above:
            cells = _over_rule(lines[n - 1], ruled, width)
            if cells is None and delimiter == " " and not remark:
                cells = _over_cells(lines[n - 1], lines[start - 1], width)
        if cells is None and not above and delimiter != " " and any(POLAR in text for text in lines[: n - 1]):
            named = split_line(bare, delimiter)  # XFLR5 writes columns behind the last name
            cells = named + [""] * (width - len(named)) if 2 * len(named) > width > len(named) else None
        asked = n in (options.header, options.units)
        found, lacks = split_line(bare, delimiter), cells is None and not remark
        if lacks and not asked and numeric(found, marks) == len(found):
            remarks.append(f"line {n}: left out, {len(found)} of {width} cells")
            continue
        split = delimiter == " " or delimiter in bare
        if (cells is None and asked) or (lacks and not above and options.header == 0 and split):
            many = len(found)
            raise input_error("tables.names_over_wider_rows", path, n, many=many, ending="s" * (many != 1), width=width)
        if lacks and not above and max(options.header, options.units) <= 0:
            break
        if cells is not None and (asked or not remark or not above or len(above) == 1):
            above.insert(0, (n, cells))
        if len(above) == 4 and options.header <= 0 and options.units <= 0:
            break
    for n, what in ((options.header, "header"), (options.units, "units")):
        if n > 0 and n not in [a[0] for a in above]:
            raise input_error("tables.no_names_in_line", path, column=what, n=n, start=start)
    head = explained(read_head(above, width, marks, numbers, options.header, options.units), lines[: start - 1])
    if head.line and is_comment(lines[head.line - 1].lstrip(), comments):
        remarks.append(f"line {head.line}: the last comment over the data is taken for the names of the columns")
    return head, remarks


def sniff(path: Path, options: Options) -> TextDialect:
    """How a file is written.

    Raises
    ------
    InputError
        Binary, empty, no rows of numbers, names that do not fit, or numbers that can be read in two ways.
    """
    sample, whole = first_bytes(path)
    encoding = encoding_of(sample, options, path)
    lines, ends = first_lines(sample, whole, encoding, path)
    comments = _comments(options)
    first = max(options.header, options.units, 0)
    selected = [
        (n, line) for n, line in enumerate(lines, start=1)
        if line.strip() and n > first and not is_comment(line.lstrip(), comments) and not RULE.fullmatch(line)
    ]  # fmt: skip
    if not selected:
        found = f"nothing under line {first}" if first > 0 else "an empty file, or one of comments only"
        raise InputError(found, "a table", file=path)
    delimiter, rows, run = _delimiter(selected, options, path)
    delimiter, rows, run = _single_column(lines, selected, (delimiter, rows, run), options, path)
    width = run[2]
    if width > TABLE_COLUMNS:
        raise InputError(f"{width} columns", f"at most {TABLE_COLUMNS}", file=path, line=rows[run[0]][0])
    marks = _marks(rows[run[0] : run[1]], delimiter, options, path)
    counts = [numeric(c, marks) if len(c) == width else 0 for _, c in rows]
    usual = median(counts[run[0] : run[1]]) / 2
    fits = [n > 0 and n >= usual for n in counts]
    begin = next(i for i in range(run[1]) if i == run[0] or (fits[i] and all(fits[i : i + 2])))
    numbers_below = numbered([c for _, c in rows[begin + 1 : run[1]] or rows[begin : run[1]]], marks)
    places = [(begin, run[0])]
    if options.units == 0 and begin + 1 < run[1] and is_unit_row(rows[begin][1], numbers_below):
        places.insert(0, (begin + 1, begin + 1))  # 1e-3 and the like over the data, read as numbers
    for first, top in places:
        body = [c for _, c in rows[top : run[1]]]
        filled = max(k + 1 for c in body for k, cell in enumerate(c) if numeric([cell], marks))
        head, remarks = _head(lines, rows[first][0], (delimiter, marks, width, filled), numbers_below, options, path)
        if head.unit_line == rows[begin][0]:
            break
    begin = first
    _two_blanks(delimiter, marks, selected, rows[begin : run[1]], path)
    numbers = tuple(k for k in range(width) if any(numeric([c[k]], marks) for c in body))
    words = frozenset(k for c in body for k in range(width) if marks.number(c[k]) is None)
    ends_of = {len(c[-1].partition(marks.decimal)[2]) for c in body[:-1]} if len(body) > 3 else {-1}
    used = sorted({p for line in lines for p in comments if is_comment(line.lstrip(), (p,))})
    marked = encoding.endswith("-sig") and sample.startswith(codecs.BOM_UTF8)
    phrases = {
        "delimiter": next(name for name, d in DELIMITERS.items() if d == delimiter),
        "decimal mark": MARK_NAMES[marks.decimal],
        "thousands mark": MARK_NAMES[marks.thousands],
        "header": f"line {head.line}" if head.line else "none",
        "units": head.units_stand,
        "comments": " ".join(used) or "none",
        "encoding": encoding.removesuffix("-sig") + " with byte-order mark" * (marked or encoding == "utf-16"),
        "line ends": ends,
    }
    over = list(_above(lines[: rows[begin][0] - 1], head, delimiter, comments))
    return TextDialect(
        encoding, delimiter, marks, comments, head, rows[begin][0], width, numbers, words, ends_of.pop() if len(ends_of) == 1 else -1,
        phrases, tuple(remarks), words_above(over, marks),
        tuple(" ".join(filter(None, cells)) for _, cells in over),
        any(len(split_line(lines[n - 1], delimiter)) < len(c) for n, c in rows[begin : run[1]] if delimiter),
    )  # fmt: skip


def _above(lines: list[str], head: Head, delimiter: str, comments: tuple[str, ...]) -> Iterator[Row]:
    """Lines over a table that are none of its head, as sentences or as cells."""
    for n, line in enumerate(lines, start=1):
        bare = line.strip().lstrip("".join(comments)).strip()
        if bare and n not in (head.line, head.unit_line):
            yield n, [bare] if {"=", ":"} & set(bare) else split_line(bare, delimiter)


def _single_column(
    lines: list[str], rows_read: list[tuple[int, str]], found: Found, options: Options, path: Path
) -> Found:
    """Tell two columns of whole numbers from one column with decimal commas."""
    delimiter, rows, run = found
    body = [line for n, line in rows_read if rows[run[0]][0] <= n <= rows[run[1] - 1][0]]
    two = delimiter == "," and run[2] == 2 and not options.delimiter
    if not two or not all(re.fullmatch(r"\s*[-+]?\d+,\d+\s*", b) for b in body):
        return found
    above = [line for line in lines[: rows[run[0]][0] - 1] if line.strip()]
    named = above[-1] if above else ""
    if "," in named or (options.decimal == "point" and named):
        return found
    if named and options.header >= 0:
        single = [(n, split_line(line, "")) for n, line in rows_read]
        return "", single, _longest(single, Marks(","))
    line = rows[run[0]][0]
    raise AmbiguousError(
        f"{shown(body[0].strip())}, which is two numbers between commas, or one with a decimal comma", "rows with one reading",
        file=path, line=line, advice="Say the option delimiter = comma, or delimiter = none and decimal = comma.",
    )  # fmt: skip


def _two_blanks(delimiter: str, marks: Marks, rows_read: list[tuple[int, str]], rows: Rows, path: Path) -> None:
    """Refuse tabs and blanks of which either may be the delimiter: "1 200<tab>5"."""
    if delimiter != "\t" or marks.thousands != " ":
        return
    lines = dict(rows_read)
    split = [(n, split_line(lines[n], " ")) for n, _ in rows]
    widths = {len(c) for _, c in split}
    plain = Marks(marks.decimal)
    if len(widths) == 1 and len(split[0][1]) != len(rows[0][1]) and all(numeric(c, plain) == len(c) for _, c in split):
        raise AmbiguousError(
            f"{shown(lines[rows[0][0]].strip())}, with tabs and blanks between columns or blanks between thousands",
            "rows with one reading", file=path, line=rows[0][0], advice="Say the option delimiter = blanks, or thousands = blank.",
        )  # fmt: skip

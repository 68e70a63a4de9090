"""Tables of any delimited text: what cannot be told from the file is asked for, and every row left out is named."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import CSV_LINE, TABLE_CELLS, TABLE_CUT_LINES, TABLE_TEXTS
from coeflab.core.options import parse_options
from coeflab.core.text.bounded import text_stream_of
from coeflab.core.text.series import matrix_of
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.tables import text_dialect
from coeflab.tables.blocks import Title, with_blocks
from coeflab.tables.column_names import named_as
from coeflab.tables.dialect import Cells, Marks, is_house_table, is_of_openfoam, raw_columns
from coeflab.tables.monitor_files import head, kind_of
from coeflab.tables.raw_table import RawTable

summary = "any delimited text: delimiter, decimal mark, units and encoding detected and reported"
citations = ()
reads = "tables of delimited text"

_BLOCK = 1 << 20  # letters
_COMMENT_BEGINS = frozenset(c[0] for c in text_dialect.COMMENTS)
_PLAIN = re.compile(r"[-+]?[0-9][-+.,0-9eE]*")
_RULED = frozenset("-=+|:_")
_NESTED = frozenset("{[")  # what a table does not begin with
_PIECE = 32  # lines: where a block has a cell without number, most of its pieces have none


def _blocks(path: Path, dialect: text_dialect.TextDialect) -> Iterator[tuple[int, list[str], bool]]:
    """Lines from the first row on, many at a time: number of the first, lines, whether the last has an end."""
    rest, line = "", 1
    with text_stream_of(path, dialect.encoding) as stream:
        while text := stream.read(_BLOCK):
            *lines, rest = (rest + text).split("\n")
            if len(rest) > CSV_LINE:
                raise InputError(f"a line longer than {CSV_LINE} letters", "a table", file=path, line=line + len(lines))
            skip = min(max(dialect.start - line, 0), len(lines))
            if lines[skip:]:
                yield line + skip, lines[skip:], True
            line += len(lines)
        if rest and line >= dialect.start:
            yield line, [rest], False


@dataclass(slots=True)
class _Body:
    """The rows as they are read."""

    path: Path
    dialect: text_dialect.TextDialect
    keep: frozenset[int]
    columns: list[list[Array]]
    met: list[Cells]
    texts: dict[int, list[str]]
    lines: list[NDArray[np.int64]] = field(default_factory=list)
    rows: int = 0
    cut: list[tuple[int, str]] = field(default_factory=list)
    again: list[int] = field(default_factory=list)
    short: list[int] = field(default_factory=list)
    known: dict[str, str] = field(default_factory=dict)
    titles: list[tuple[int, str]] = field(default_factory=list)

    def add(self, line: int, lines: list[str], ended: bool) -> None:
        """Take some lines: at once where all are rows of plain numbers, else one by one."""
        block = self._at_once(lines) if ended and not self.keep else None
        if block is not None:
            self._grow(np.arange(line, line + len(lines)))
            for column, values in zip(self.columns, block.T):
                column.append(np.ascontiguousarray(values))
            return
        if ended and not self.keep and not self.dialect.marks.thousands and len(lines) > _PIECE:
            first, firsts = len(self.lines), [len(column) for column in self.columns]
            for i in range(0, len(lines), _PIECE):
                self.add(line + i, lines[i : i + _PIECE], ended)
            self.lines[first:] = [np.concatenate(self.lines[first:])]
            for start, column in zip(firsts, self.columns):
                column[start:] = [np.concatenate(column[start:])] if column[start:] else []
            return
        numbers: list[int] = []
        rows: list[list[str]] = []
        for n, text in enumerate(lines, start=line):
            if (row := self._cells(n, text, ended)) is not None:
                numbers.append(n)
                rows.append(row)
        self._grow(np.array(numbers, dtype=np.int64))
        plain = all(map(str.isascii, lines)) and not any("_" in text for text in lines)
        for k, cells in enumerate(zip(*rows)):
            self.columns[k].append(self._values(k, cells, numbers, plain))
            if k in self.keep:
                self.texts.setdefault(k, []).extend(self.known.setdefault(c, c) for c in cells)

    def whole_columns(self) -> Iterator[Array]:
        """The columns one after the other, their pieces given back to the memory."""
        for pieces in self.columns:
            whole = np.concatenate(pieces)
            pieces.clear()
            yield whole

    def _grow(self, lines: NDArray[np.int64]) -> None:
        self.rows += len(lines)
        self.lines.append(lines)
        most = min(
            TABLE_CELLS // self.dialect.width, TABLE_TEXTS // max(len(self.keep), 1) if self.keep else TABLE_CELLS
        )
        if self.rows > most:
            raise input_error("tables.too_many_rows", self.path, int(lines[-1]), most=most)

    def _at_once(self, lines: list[str]) -> Array | None:
        """All rows by numpy, or None where a line is anything but a row of plain numbers."""
        d = self.dialect
        if d.marks.thousands or '"' in lines[0]:
            return None
        if d.marks.decimal == ",":
            if any("." in line for line in lines):
                return None
            lines = [line.replace(",", ".") for line in lines]
        try:
            block = matrix_of(lines, d.delimiter.strip(" ")) if any(lines) else None
        except ValueError:
            return None
        right = block is not None and block.shape == (len(lines), d.width) and bool(np.isfinite(block).all())
        return block if right else None

    def _cells(self, n: int, text: str, ended: bool) -> list[str] | None:
        """The cells of one line, None where it is no row."""
        d = self.dialect
        if ended and d.numbers and text.lstrip()[:1] not in _COMMENT_BEGINS:
            cells = text_dialect.split_line(text, d.delimiter)
            if len(cells) == d.width and _PLAIN.fullmatch(cells[d.numbers[0]]):
                return cells
        stripped = text.strip()
        ruled = stripped[:1] in _RULED and text_dialect.RULE.fullmatch(stripped)
        if not stripped or ruled or text_dialect.is_comment(stripped, d.comments):
            return None
        cells = text_dialect.split_line(text, d.delimiter)
        while len(cells) > d.width and not cells[-1]:
            cells.pop()
        if tuple(cells) in d.head.written:
            self.again.append(n)
            return None
        if ended and self.is_title(cells):
            self.titles.append((n, " ".join(filter(None, cells))))
            return None
        if d.ragged and ended and len(cells) < d.width:
            cells = text_dialect.padded(cells, d.width)
            self.short += [n] * (len(cells) == d.width)
        if len(cells) != d.width:
            self._leave_out(n, f"{len(cells)} of {d.width} cells", ended)
            return None
        if not ended and (any(d.marks.number(cells[k]) is None for k in d.numbers) or self._is_short(cells[-1])):
            self._leave_out(n, "the last number is not whole", ended)
            return None
        if len(d.numbers) > 1 and not self._any_number(cells):
            raise input_error("tables.words_among_rows", self.path, n, stripped=shown(stripped))
        return cells

    def is_title(self, cells: list[str]) -> bool:
        """Whether a line between rows is the title of those below: one cell of words, in a table of several columns."""
        filled = [c for c in cells if c]
        worded = len(filled) == 1 and sum(map(str.isalpha, filled[0])) > 2
        return self.dialect.width > 1 and worded and self.dialect.marks.number(filled[0]) is None

    def _any_number(self, cells: list[str]) -> bool:
        """Whether a cell of the columns with numbers is none of letters only."""
        wanted = [cells[k] for k in self.dialect.numbers]
        return any(c[-1:].isdigit() for c in wanted) or any(self.dialect.marks.number(c) is not None for c in wanted)

    def _is_short(self, cell: str) -> bool:
        mark = self.dialect.marks.decimal
        return 0 < self.dialect.decimals > len(cell.partition(mark)[2])

    def _leave_out(self, n: int, why: str, ended: bool) -> None:
        self.cut.append((n, why if ended else f"{why}, and the line has no end: the file is cut there"))
        if len(self.cut) > TABLE_CUT_LINES and len(self.cut) > 0.01 * self.rows + TABLE_CUT_LINES:
            first, words = self.cut[0]
            raise input_error(
                "tables.lines_of_other_width", self.path, first, words=words, count=len(self.cut) - 1, width=self.dialect.width,
            )  # fmt: skip

    def _values(self, k: int, cells: Sequence[str], lines: list[int], plain: bool) -> Array:
        """A column's numbers; the quick way gives what `Marks.number` gives, or nothing."""
        marks = self.dialect.marks
        if plain and marks == Marks():
            with suppress(ValueError):
                values = np.array(list(map(float, cells)))
                if np.isfinite(values).all():
                    return values
        elif (found := marks.numbers(cells)) is not None:
            return found
        return self.met[k].values(cells, lines, marks, plain)


def _read(path: Path, dialect: text_dialect.TextDialect, keep: frozenset[int]) -> _Body:
    empty = [Cells() for _ in range(dialect.width)]
    body = _Body(path, dialect, keep, [[] for _ in empty], empty, {})
    for line, lines, ended in _blocks(path, dialect):
        body.add(line, lines, ended)
    if not body.rows:
        raise input_error("tables.no_whole_rows", path, dialect.start)
    return body


def _remarks(body: _Body) -> list[str]:
    out = [f"line {n}: left out, {why}" for n, why in body.cut[:10]]
    out += [f"line {n}: words among the rows ({shown(text)})" for n, text in body.titles[:10]]
    if len(body.cut) > 10:
        out.append(f"{len(body.cut) - 10} more lines left out for the same reason")
    for lines, words in (
        (body.again, "the header is repeated in line {}; left out"),
        (body.short, "line {}: no cells under the last names, taken as blank"),
    ):
        if lines:
            more = f" and {len(lines) - 5} more" * (len(lines) > 5)
            out.append(words.format(listed([str(n) for n in lines[:5]]) + more))
    return out


def recognises(path: Path) -> bool:
    """Whether the file is a table of text that no other importer knows, by its first 64 KiB."""
    if is_house_table(path):
        return False
    try:
        sample, whole = text_dialect.first_bytes(path)
        encoding = text_dialect.encoding_of(sample, text_dialect.Options(), path)
        lines, _ = text_dialect.first_lines(sample, whole, encoding, path)
        if is_of_openfoam(lines) or kind_of(head(path)) or "".join(lines).lstrip()[:1] in _NESTED:
            return False
        dialect = text_dialect.sniff(path, text_dialect.Options())
    except text_dialect.AmbiguousError:
        return True
    except InputError:
        return False
    least = len({*dialect.numbers} | dialect.words) / 2 + (0.1 if dialect.delimiter == " " else 0.0)
    return dialect.width > 1 and len(dialect.numbers) >= least


def raw(path: Path, options: Mapping[str, Any]) -> RawTable:
    """The table of a file as it stands there.

    Parameters
    ----------
    path : Path
    options : mapping
        See `Options`.

    Raises
    ------
    InputError
        No table, rows of other lengths, numbers that can be read in two ways, or too many cells.
    """
    given = parse_options(text_dialect.Options, options, "table")
    dialect = text_dialect.sniff(path, given)
    try:
        body = _read(path, dialect, dialect.words)
        textual = frozenset(k for k, met in enumerate(body.met) if met.text)
        if textual - dialect.words:
            body = _read(path, dialect, textual)
    except UnicodeDecodeError as why:
        if dialect.encoding == "utf-8" and not given.encoding:
            return raw(path, {**options, "encoding": "cp1252"})
        raise text_dialect.undecoded(why, dialect.encoding, path) from None
    except OSError as why:
        raise text_dialect.unread(path, why) from None
    texts = {k: t for k, t in body.texts.items() if k in textual}
    columns, remarks = raw_columns(dialect.head, body.whole_columns(), texts, body.met)
    if any(text_dialect.POLAR in text for text in dialect.above):
        columns = tuple(replace(c, unit="deg") if not c.unit and named_as(c.name) == "alpha" else c for c in columns)
    lines = np.concatenate(body.lines)
    titles = [Title(0, 0, text) for text in dialect.above]
    titles += [Title(int(np.searchsorted(lines, n)), n, text) for n, text in body.titles]
    table = RawTable(
        path, columns, dialect.head.line, lines, files=(path,), dialect=dialect.summary, stated=dialect.stated,
        remarks=(*dialect.remarks, *_remarks(body), *remarks),
    )  # fmt: skip
    return with_blocks(table, titles, dialect.marks)

"""Delimited text with a unit in every header: cells by line and column, or one clear error."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.limits import CSV_BLANK_LINES, CSV_CELLS, CSV_LINE, LARGEST_NUMBER
from coeflab.core.text.bounded import stream_of
from coeflab.core.text.csv_rows import plain
from coeflab.core.units import Header, factor, parse_header

_NUMBER = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_UTF16 = (b"\xff\xfe", b"\xfe\xff")


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """The raw cells of a table.

    Attributes
    ----------
    file : Path
    headers : tuple of Header
    first_line : int
        Line number of the first row of data.
    rows : tuple of tuple of str
        One cell per header.
    lines : tuple of int
        Of every row, where they do not follow each other.
    """

    file: Path
    headers: tuple[Header, ...]
    first_line: int
    rows: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...] = ()

    def __len__(self) -> int:
        return len(self.rows)

    def line(self, row: int) -> int:
        """Line number of a row."""
        return self.lines[row] if self.lines else self.first_line + row

    def position(self, name: str) -> int:
        """Position of a column by its name without unit."""
        return [h.name for h in self.headers].index(name)

    def texts(self, name: str) -> list[str]:
        """A column as text."""
        position = self.position(name)
        return [row[position] for row in self.rows]

    def numbers(self, name: str) -> NDArray[np.float64]:
        """A column as numbers; NaN marks a blank cell.

        Raises
        ------
        InputError
            Text, NaN or infinity in a cell, with its line.
        """
        values = np.full(len(self), np.nan)
        for row, cell in enumerate(self.texts(name)):
            if not cell:
                continue
            number = float(cell) if _NUMBER.fullmatch(cell) else np.nan
            if not np.isfinite(number):
                raise InputError(
                    shown(cell),
                    "a finite number",
                    file=self.file,
                    line=self.line(row),
                    column=self.headers[self.position(name)].text,
                    advice=_advice(cell),
                )
            values[row] = number
        return values

    def si(self, header: Header, dimension: str, example: str) -> NDArray[np.float64]:
        """A column with its unit in the header, in SI; NaN marks a blank cell.

        Parameters
        ----------
        header : Header
        dimension : str
            A key of `coeflab.core.units.SI`.
        example : str
            A header that would do, for one without unit.

        Raises
        ------
        UnitsError
            No unit, or one of another dimension.
        InputError
            As `numbers`, or a number beyond all sizes.
        """
        unit = require_unit(header, self.file, self.first_line - 1, example)
        try:
            scale = factor(unit, dimension)
        except UnitsError as why:
            raise why.at(self.file, self.first_line - 1, header.text) from None
        with np.errstate(over="ignore"):
            values = self.numbers(header.name) * scale
        if (wild := np.flatnonzero(np.abs(values) > LARGEST_NUMBER)).size:
            row = int(wild[0])
            raise InputError(
                shown(self.texts(header.name)[row]), f"a number of at most {LARGEST_NUMBER:g} in SI units", file=self.file,
                line=self.line(row), column=header.text,
            )  # fmt: skip
        return np.asarray(values)


def _advice(cell: str) -> str:
    if cell.endswith("?") or cell.lower() in ("nan", "-", "n/a", "na"):
        return 'Leave the cell blank and name the column under "uncertain".'
    return "Write a point for the decimals." if re.fullmatch(r"[-+]?[0-9]+,[0-9]+", cell) else ""


def _lines(path: Path) -> Iterator[str]:
    """Decoded lines, one at a time, so that a huge file of something else fails early."""
    try:
        if path.is_dir():
            raise InputError("a folder", "a CSV file", file=path)
        if not path.is_file():
            raise InputError("no such file", "a CSV file", file=path)
        with stream_of(path) as stream:
            for number, raw in enumerate(iter(lambda: stream.readline(CSV_LINE), b""), start=1):
                yield _decoded(raw, path, number)
    except OSError as why:
        raise InputError(str(why.strerror or why), "a readable file", file=path) from None


def _decoded(raw: bytes, path: Path, number: int) -> str:
    advice = "Save the file as UTF-8."
    if number == 1 and raw.startswith(_UTF16):
        raise InputError("UTF-16 text", "UTF-8 text", file=path, line=number, advice=advice)
    if b"\0" in raw:
        raise InputError("binary content (a NUL byte)", "a CSV file", file=path, line=number)
    try:
        line = raw.decode("utf-8-sig" if number == 1 else "utf-8")
    except UnicodeDecodeError as why:
        # A line cut at its longest may end inside a character.
        if len(raw) < CSV_LINE or why.start < len(raw) - 3:
            raise InputError(
                f"the byte 0x{raw[why.start]:02x}", "UTF-8 text", file=path, line=number, advice=advice
            ) from None
        line = ""
    if "\r" in line.rstrip("\r\n") or line.endswith("\r"):
        raise InputError(
            "a carriage return as the end of a line", "line ends LF or CRLF", file=path, line=number,
            advice="Save the file with Unix or Windows line ends.",
        )  # fmt: skip
    if len(raw) >= CSV_LINE:
        raise InputError(f"a line longer than {CSV_LINE} bytes", "a CSV table", file=path, line=number)
    return line


def _headers(path: Path, line: str, number: int) -> tuple[Header, ...]:
    for name, separator in (("semicolons", ";"), ("tabs", "\t")):
        if separator in line and "," not in line:
            raise InputError(
                f"{name} between columns", "commas", file=path, line=number,
                advice="Save the table as comma-separated CSV with a point for the decimals.",
            )  # fmt: skip
    try:
        names = next(csv.reader([line], strict=True))
    except csv.Error as why:
        raise InputError(f"a header that cannot be read ({why})", "a CSV header", file=path, line=number) from None
    headers = tuple(parse_header(plain(n)) for n in names)
    seen: set[str] = set()
    for i, header in enumerate(headers, start=1):
        if not header.name or not header.text.isprintable():
            found = f"{shown(header.text)} as header of column {i}"
            raise InputError(found, 'column names such as "Y [N]"', file=path, line=number)
        if header.name in seen:
            raise InputError(
                f"the column {shown(header.name)} twice",
                "every column once",
                file=path,
                line=number,
                column=header.text,
            )
        seen.add(header.name)
    return headers


def read_cells(path: Path) -> Cells:
    """Read a CSV table as text; lines before the header that start with # are comments.

    Raises
    ------
    InputError
        Empty, binary, not UTF-8, duplicated columns, rows of other lengths than the header, or no rows at all.
    """
    lines = _lines(path)
    numbered = enumerate(lines, start=1)
    first = next((n for n in numbered if n[1].strip() and not n[1].lstrip().startswith("#")), None)
    if first is None:
        raise InputError("an empty file, or one of comments only", "a header line with units", file=path)
    number, head = first
    headers = _headers(path, head, number)
    rows = _rows(lines, path, number, len(headers))
    while rows and not any(rows[-1]):
        rows.pop()
    for i, row in enumerate(rows):
        if not row:
            raise InputError(
                "an empty line", f"{len(headers)} cells", file=path, line=number + 1 + i, advice="Remove it."
            )
    if not rows:
        raise InputError("a header and no rows", "rows of numbers", file=path, line=number + 1)
    return Cells(path, headers, number + 1, tuple(rows))


def _rows(lines: Iterator[str], path: Path, header_line: int, width: int) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    reader = csv.reader(lines, strict=True)
    blank = 0
    while True:
        line = header_line + len(rows) + 1
        try:
            row = next(reader)
        except StopIteration:
            return rows
        except csv.Error as why:
            raise InputError(
                f"a row that cannot be read ({why})", f"{width} cells", file=path, line=line,
                advice="Look for a quotation mark that is not closed.",
            ) from None  # fmt: skip
        if reader.line_num != len(rows) + 1:
            raise InputError("a line break inside quotation marks", "one row a line", file=path, line=line)
        if row and len(row) != width:
            advice = "The row has semicolons; write commas." if any(";" in cell for cell in row) else ""
            raise InputError(
                f"{len(row)} cell{'s' * (len(row) != 1)}", f"{width} as in the header", file=path, line=line,
                advice=advice,
            )  # fmt: skip
        if len(rows) * width >= CSV_CELLS:
            raise InputError(
                f"more than {CSV_CELLS} cells", "a table of steady forces, one row a setting", file=path, line=line,
                advice="Average time series first.",
            )  # fmt: skip
        blank = 0 if row else blank + 1
        if blank > CSV_BLANK_LINES:
            raise InputError(f"{blank} empty lines", "rows of numbers", file=path, line=line, advice="Remove them.")
        rows.append(tuple(plain(cell.strip()) for cell in row))


def require_unit(header: Header, path: Path, line: int, example: str) -> str:
    """The unit of a header.

    Parameters
    ----------
    header : Header
    path, line : Path, int
        Where it stands.
    example : str
        A unit that would do.

    Raises
    ------
    UnitsError
        No unit was written.
    """
    if header.unit is None:
        raise UnitsError(
            "a header without unit",
            f'a unit in brackets, such as "{example}"',
            file=path,
            line=line,
            column=header.text,
        )
    return header.unit

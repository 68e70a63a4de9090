"""Delimited text with a unit in every header: cells by line and column, or one clear error."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.units import Header, parse_header

if TYPE_CHECKING:
    import pandas as pd

LONGEST_HEADER = 1 << 16


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """The raw cells of a table.

    Attributes
    ----------
    file : Path
    headers : tuple of Header
    first_line : int
        Line number of the first row of data.
    frame : DataFrame of str
        One column per header, by position.
    """

    file: Path
    headers: tuple[Header, ...]
    first_line: int
    frame: pd.DataFrame

    def __len__(self) -> int:
        return len(self.frame)

    def line(self, row: int) -> int:
        """Line number of a row."""
        return self.first_line + row

    def position(self, name: str) -> int:
        """Position of a column by its name without unit."""
        return [h.name for h in self.headers].index(name)

    def texts(self, name: str) -> list[str]:
        """A column as text."""
        return [str(t).strip() for t in self.frame.iloc[:, self.position(name)]]

    def numbers(self, name: str) -> NDArray[np.float64]:
        """A column as numbers; NaN marks a blank cell.

        Raises
        ------
        InputError
            Text, NaN or infinity in a cell, with its line.
        """
        import pandas as pd

        position = self.position(name)
        text = self.frame.iloc[:, position].str.strip()
        blank = text.eq("").to_numpy(dtype=bool)
        values = np.array(pd.to_numeric(text.where(text != "", "0"), errors="coerce"), dtype=float)
        bad = np.flatnonzero(~blank & ~np.isfinite(values))
        if bad.size:
            row = int(bad[0])
            cell = str(text.iloc[row])
            doubtful = cell.endswith("?")
            raise InputError(
                shown(cell),
                "a finite number",
                file=self.file,
                line=self.line(row),
                column=self.headers[position].text,
                advice='Leave the cell blank and name the column under "uncertain".'
                if doubtful or cell.lower() in ("nan", "-", "n/a")
                else "",
            )
        values[blank] = np.nan
        return values


def _head(path: Path) -> tuple[str, int]:
    """The header line and its line number; comment lines before it start with #."""
    try:
        if path.is_dir():
            raise InputError("a folder", "a CSV file", file=path)
        if not path.exists():
            raise InputError("no such file", "a CSV file", file=path)
        with path.open("rb") as stream:
            for number in range(1, 1001):
                raw = stream.readline(LONGEST_HEADER)
                if not raw:
                    raise InputError("an empty file", "a header line with units", file=path)
                if len(raw) >= LONGEST_HEADER or b"\0" in raw:
                    raise InputError("binary content or an endless line", "a CSV header", file=path, line=number)
                try:
                    line = raw.decode("utf-8-sig")
                except UnicodeDecodeError as why:
                    raise InputError(
                        f"the byte 0x{raw[why.start]:02x}",
                        "UTF-8 text",
                        file=path,
                        line=number,
                        advice="Save the file as UTF-8.",
                    ) from None
                if line.strip() and not line.lstrip().startswith("#"):
                    return line, number
    except OSError as why:
        raise InputError(str(why.strerror or why), "a readable file", file=path) from None
    raise InputError("1000 lines of comments", "a header line with units", file=path)


def _headers(path: Path, line: str, number: int) -> tuple[Header, ...]:
    if ";" in line and "," not in line:
        raise InputError("semicolons between columns", "commas", file=path, line=number)
    try:
        names = next(csv.reader(io.StringIO(line), strict=True))
    except (csv.Error, StopIteration) as why:
        raise InputError(f"a header that cannot be read ({why})", "a CSV header", file=path, line=number) from None
    headers = tuple(parse_header(n) for n in names)
    seen: set[str] = set()
    for header in headers:
        if not header.name or not header.text.isprintable():
            raise InputError(shown(header.text), 'column names such as "Y [N]"', file=path, line=number)
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
    """Read a CSV table as text.

    Raises
    ------
    InputError
        Empty, binary, not UTF-8, duplicated columns, rows of other lengths than the header, or no rows at all.
    """
    head, number = _head(path)
    headers = _headers(path, head, number)
    import pandas as pd

    try:
        frame = pd.read_csv(
            path,
            header=None,
            skiprows=number,
            names=list(range(len(headers))),
            index_col=False,
            dtype=str,
            keep_default_na=False,
            skip_blank_lines=False,
            encoding="utf-8-sig" if number == 1 else "utf-8",
            on_bad_lines="error",
        )
    except pd.errors.EmptyDataError:
        raise InputError("a header and no rows", "rows of numbers", file=path, line=number + 1) from None
    except pd.errors.ParserError as why:
        raise _ragged(path, number, len(headers), str(why)) from None
    except UnicodeDecodeError as why:
        raise InputError(f"bytes that are no UTF-8 ({why.reason})", "UTF-8 text", file=path) from None
    while len(frame) and not "".join(map(str, frame.iloc[-1].fillna(""))).strip():
        frame = frame.iloc[:-1]
    if not len(frame):
        raise InputError("a header and no rows", "rows of numbers", file=path, line=number + 1)
    short = np.flatnonzero(frame.isna().to_numpy().any(axis=1))
    if short.size:
        row = int(short[0])
        have = int(frame.iloc[row].notna().sum())
        raise InputError(f"{have} cells", f"{len(headers)} as in the header", file=path, line=number + 1 + row)
    return Cells(path, headers, number + 1, frame)


def _ragged(path: Path, header_line: int, width: int, message: str) -> InputError:
    """Find the first row with too many cells, for an error with its line."""
    with path.open(encoding="utf-8", errors="replace", newline="") as stream:
        for number, row in enumerate(csv.reader(stream), start=1):
            if number > header_line and len(row) > width:
                return InputError(f"{len(row)} cells", f"{width} as in the header", file=path, line=number)
    return InputError(f"rows that cannot be read ({message})", f"{width} cells in every row", file=path)


def require_unit(header: Header, path: Path, line: int, example: str) -> str:
    """The unit of a header.

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

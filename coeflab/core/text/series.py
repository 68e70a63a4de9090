"""Histories as solvers write them: comment lines, then rows of numbers parted by blanks or brackets, streamed."""

from __future__ import annotations

import gzip
import io
import re
import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import CSV_LINE, HISTORY_ROWS
from coeflab.core.text.bounded import stream_of
from coeflab.core.types import Array

_BLOCK = 4 << 20
_COMMENTS = 200
_BLANKS = bytes.maketrans(b"()\t\r,", b"     ")
_NOT_A_NUMBER = re.compile(r"[-+]?(?:nan|1\.#(?:IND|QNAN|SNAN)\w*)", re.IGNORECASE)


@dataclass(frozen=True, slots=True, eq=False)
class Series:
    """Columns of one history.

    Attributes
    ----------
    columns : tuple of (n,) arrays
    remarks : tuple of str
        What was left out, with the line.
    cut : str
        Shows that the last line is not whole; empty otherwise.
    wild : tuple of int, or None
        Row and line of the first value that is not finite.
    """

    columns: tuple[Array, ...]
    remarks: tuple[str, ...]
    cut: str
    wild: tuple[int, int] | None


@contextmanager
def opened(file: Path) -> Iterator[IO[bytes]]:
    """The bytes of a file, plain or compressed by gzip.

    Raises
    ------
    InputError
        Not to be opened or read.
    """
    try:
        if not file.is_file():
            raise InputError("no file", "a history", file=file)
        if file.suffix == ".gz":
            with gzip.open(file, "rb") as unpacked:
                yield unpacked  # type: ignore[misc]
        else:
            with stream_of(file) as stream:
                yield stream
    except (OSError, EOFError, zlib.error) as why:
        raise InputError(str(getattr(why, "strerror", None) or why), "a readable file", file=file) from None


def read_comments(file: Path) -> tuple[str, ...]:
    """The lines at the head that start with #, without it.

    Raises
    ------
    InputError
        Not to be read, or one is too long.
    """
    comments: list[str] = []
    with opened(file) as stream:
        while len(comments) < _COMMENTS:
            line = stream.readline(CSV_LINE)
            if not line.startswith(b"#"):
                break
            if len(line) >= CSV_LINE:
                raise InputError(f"a line longer than {CSV_LINE} bytes", "a history", file=file, line=len(comments) + 1)
            comments.append(line[1:].decode("utf-8", "replace").strip())
    return tuple(comments)


def read_series(file: Path, width: int, sums: Sequence[Sequence[int]]) -> Series:
    """Read the rows.

    A last line without its line end is left out, whatever it holds: its last number may be cut.

    Parameters
    ----------
    file : Path
    width : int
        Numbers in a row.
    sums : sequence of sequences of int
        What a column of the result is: the sum of these numbers of the row.

    Raises
    ------
    InputError
        A row that is no row of numbers, with its line; more rows than memory holds.
    """
    columns: list[Array] = [np.empty(0) for _ in sums]
    rows, line, cut = 0, 1, ""
    remarks: list[str] = []
    wild = None
    with opened(file) as stream:
        size = file.stat().st_size
        for block, is_last in _blocks(stream, file):
            text, tail = block, b""
            if is_last:
                text, newline, tail = block.rpartition(b"\n")
                text += newline
            count = text.count(b"\n")
            matrix, lines = _numbers(text, width, file, line)
            end = rows + len(matrix)
            for i, which in enumerate(sums):
                if end > len(columns[i]):
                    # As many rows as the file will have, by its size: what is not written takes no memory.
                    longer = np.empty(end if is_last else max(3 * end // 2, int(1.05 * end * size / stream.tell())))
                    longer[:rows] = columns[i][:rows]
                    columns[i] = longer
                columns[i][rows:end] = matrix[:, which[0]] if len(which) == 1 else matrix[:, list(which)].sum(axis=1)
            if wild is None and not np.all(np.isfinite(matrix)):
                first = int(np.flatnonzero(~np.isfinite(matrix).all(axis=1))[0])
                wild = (rows + first, line + first if lines is None else lines[first])
            rows = end
            line += count
            if rows > HISTORY_ROWS:
                raise InputError(f"more than {HISTORY_ROWS:,} rows", "a shorter history", file=file, line=line)
            if tail.strip(b"\0 \r\t"):
                cells = tail.translate(_BLANKS).split()
                whole = len(cells) == width and tail.count(b"(") == tail.count(b")")
                remarks.append(f"line {line} has no end and is left out")
                cut = "" if whole else f"line {line} ends after {len(cells)} of {width} numbers"
            elif tail:
                remarks.append(f"line {line} holds no text")
                cut = f"line {line} was never written"
    return Series(tuple(c[:rows] for c in columns), tuple(remarks), cut, wild)


def _blocks(stream: IO[bytes], file: Path) -> Iterator[tuple[bytes, bool]]:
    """Whole lines, some megabytes at a time, and whether they are the last."""
    while True:
        block = stream.read(_BLOCK)
        rest = stream.readline(CSV_LINE) if len(block) == _BLOCK else b""
        if len(rest) >= CSV_LINE:
            raise InputError(f"a line longer than {CSV_LINE} bytes", "rows of numbers", file=file)
        is_last = len(block) < _BLOCK or not rest
        yield block + rest, is_last
        if is_last:
            return


def matrix_of(lines: Sequence[str], delimiter: str) -> Array:
    """Rows of plain numbers.

    Raises
    ------
    ValueError
        Some line is none, or of another width.
    """
    return np.loadtxt(lines, delimiter=delimiter or None, comments=None, ndmin=2)


def _numbers(text: bytes, width: int, file: Path, line: int) -> tuple[Array, list[int] | None]:
    """Rows of a block; their lines where not every line is a row."""
    if b"#" not in text and b"\n\n" not in text and b"\0" not in text:
        try:
            read: Any = io.StringIO(text.translate(_BLANKS).decode("ascii"))
            matrix = np.loadtxt(read, ndmin=2, comments=None) if text.strip() else np.empty((0, width))
            if matrix.shape == (text.count(b"\n"), width):
                return matrix, None
        except ValueError:  # some line is no row of numbers: the slow way finds it
            pass
    out, lines = [], []
    for number, raw in enumerate(text.split(b"\n")[:-1], start=line):
        cells = raw.translate(_BLANKS).decode("utf-8", "replace").split()
        if not cells or cells[0].startswith("#"):
            continue
        out.append([_number(c, file, number) for c in cells])
        lines.append(number)
        if len(cells) != width:
            found, expected = f"{len(cells)} numbers", f"{width}, as the header says"
            raise InputError(found, expected, file=file, line=number)
    return np.array(out).reshape(-1, width), lines


def _number(cell: str, file: Path, line: int) -> float:
    if _NOT_A_NUMBER.fullmatch(cell):
        return np.nan
    try:
        return float(cell.replace("1.#INF", "inf").replace("_", "?"))
    except ValueError:
        raise InputError(shown(cell), "a number", file=file, line=line) from None

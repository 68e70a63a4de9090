"""Monitors of solvers: numbers in columns, one line an iteration, in whatever state a run left them.

What the importers of single runs share: rows read block by block, restarts put in order, files of one run joined, and how
the run ended.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import CSV_LINE, MONITOR_COLUMNS, MONITOR_NUMBERS
from coeflab.core.text.bounded import stream_of
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.tables.monitor_files import HEAD, decoded, header_cells, lines_of
from coeflab.tables.raw_table import Ended, RawColumn, RawTable, Stated

BLOCK = 1 << 22
_NUMBER = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?(?:nan(?:\([a-z]*\))?|inf(?:inity)?|1\.#(?:qnan|snan|ind|inf)0*)", re.I)
_MOST_BROKEN, _BROKEN_SHARE = 10, 0.01


@dataclass(frozen=True, slots=True)
class Layout:
    """Where the rows of a monitor begin and what separates their cells.

    Attributes
    ----------
    names : tuple of str
        Of the columns, as written.
    line : int
        Of the names.
    first, offset : int
        Line and byte of the first row.
    delimiter : str
        ``,``, ``;``, a tab, or a blank for any run of blanks.
    headings : frozenset of str
        Lines that a restart may write again.
    """

    names: tuple[str, ...]
    line: int
    first: int
    offset: int
    delimiter: str
    headings: frozenset[str]


@dataclass(slots=True, eq=False)
class Monitor:
    """The rows of a monitor, on their way into a table, which takes the columns over one by one.

    Attributes
    ----------
    path : Path
    names : tuple of str
    columns : list of (n,) array
        Blank cells are NaN; NaN and infinity as written are infinite.
    lines : (n,) integer array
    header_line : int
    remarks : tuple of str
    crashed : str
        What shows that writing stopped halfway; empty where nothing does.
    """

    path: Path
    names: tuple[str, ...]
    columns: list[Array]
    lines: NDArray[np.int64]
    header_line: int
    remarks: tuple[str, ...] = ()
    crashed: str = ""

    def __len__(self) -> int:
        return len(self.lines)

    def at(self, row: int) -> str:
        """File and line of a row."""
        return f"{self.path.name}:{self.lines[row]}"


def laid_out(raw: bytes, path: Path, lines: int, names: Sequence[str], delimiter: str, names_line: int) -> Layout:
    """The layout of a file whose header has so many lines.

    Raises
    ------
    InputError
        The header does not end within 64 KiB, or has names of too many columns.
    """
    ends = [m.end() for m, _ in zip(re.finditer(rb"\r\n|\n|\r", raw), range(lines), strict=False)]
    if len(ends) < lines and len(raw) >= HEAD:
        raise InputError(f"a header longer than {HEAD} bytes", "a monitor of a solver", file=path, line=1)
    if len(names) > MONITOR_COLUMNS:
        found = f"{len(names)} columns"
        raise InputError(found, f"a monitor of at most {MONITOR_COLUMNS}", file=path, line=names_line)
    text = decoded(raw)[0]
    headings = frozenset(_squeezed(line) for line in lines_of(text)[:lines] if line.strip())
    offset = ends[lines - 1] if len(ends) >= lines else len(raw)
    return Layout(tuple(names), names_line, lines + 1, offset, delimiter, headings)


def _squeezed(line: str) -> str:
    return " ".join(line.split())


class _Rows:
    """Collects rows of a monitor, block by block, in columns that are made about as long as the file lets expect."""

    def __init__(self, path: Path, layout: Layout) -> None:
        self.path, self.layout = path, layout
        self.width = len(layout.names)
        self.columns: list[Array] = [np.empty(0)] * self.width
        self.lines = np.empty(0, dtype=np.int64)
        self.bytes = 0
        self.count, self.line = 0, layout.first
        self.broken: list[tuple[int, str]] = []
        self.repeated: list[int] = []
        self.marks: set[str] = set()

    def add(self, block: bytes) -> None:
        """Rows of a block of whole lines."""
        if b"\r" in block:
            block = block.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        self.bytes += len(block)
        at, values = self._at_once(block) or self._by_line(block)
        self.line += block.count(b"\n")
        self.keep(at, values)
        if len(self.broken) > _MOST_BROKEN + _BROKEN_SHARE * self.count:
            line, found = self.broken[0]
            raise input_error(
                "tables.broken_lines", self.path, line, found=found, width=self.width, count=len(self.broken)
            )

    def keep(self, at: NDArray[np.int64], values: Array) -> None:
        """Rows by their lines."""
        self.count += len(at)
        if self.count * self.width > MONITOR_NUMBERS:
            raise input_error("tables.too_many_numbers", self.path, int(at[-1]), monitor_numbers=MONITOR_NUMBERS)
        if self.count > len(self.lines):
            self._lengthen()
        rows = slice(self.count - len(at), self.count)
        self.lines[rows] = at
        for j, column in enumerate(self.columns):
            column[rows] = values[:, j]

    def _lengthen(self) -> None:
        """Longer columns, one after the other: a list of their pieces would take their memory twice in the end."""
        whole = max(self.path.stat().st_size - self.layout.offset, 1)
        length = max(self.count, int(1.02 * self.count * whole / max(self.bytes, 1)), len(self.lines) * 5 // 4)
        length = min(length, MONITOR_NUMBERS // self.width + 1)
        for j, column in enumerate(self.columns):
            self.columns[j] = np.empty(length)
            self.columns[j][: len(column)] = column
        lines, self.lines = self.lines, np.empty(length, dtype=np.int64)
        self.lines[: len(lines)] = lines

    def _at_once(self, block: bytes) -> tuple[NDArray[np.int64], Array] | None:
        """All rows of a block where every line has the right number of numbers; else None."""
        delimiter = self.layout.delimiter.encode()
        if b'"' in block or (delimiter in b";\t" and b"," in block):
            return None
        chars = np.frombuffer(block, dtype=np.uint8)
        ends = np.flatnonzero(chars == 10)
        blank = chars <= 32
        if delimiter != b" ":
            between = chars == delimiter[0]
            commas = np.diff(np.cumsum(between, dtype=np.int32)[ends], prepend=0)
            blank |= between
        begins = ~blank
        begins[1:] &= blank[:-1]
        cells = np.diff(np.cumsum(begins, dtype=np.int32)[ends], prepend=0)
        full = cells == self.width
        right = full | (cells == 0)
        if delimiter != b" ":
            right &= commas == np.where(full, self.width - 1, 0)
        if not right.all():
            return None
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)
            try:
                numbers = np.fromstring(block.replace(delimiter, b" "), sep=" ")
            except (DeprecationWarning, ValueError):
                return None
        if numbers.size != self.width * int(full.sum()):
            return None
        numbers[np.isnan(numbers)] = np.inf
        if delimiter != b"," and b"." in block:
            self.marks.add(".")
        return self.line + np.flatnonzero(full), numbers.reshape(-1, self.width)

    def _by_line(self, block: bytes) -> tuple[NDArray[np.int64], Array]:
        at, rows = [], []
        for number, raw in enumerate(block.split(b"\n")[:-1], start=self.line):
            row = self.row(raw, number)
            if row is not None:
                at.append(number)
                rows.append(row)
        return np.array(at, dtype=np.int64), np.array(rows, dtype=float).reshape(-1, self.width)

    def row(self, raw: bytes, number: int) -> list[float] | None:
        """Numbers of one line; None for a blank one, a heading or a broken line, which are noted."""
        if len(raw) > CSV_LINE:
            self.broken.append((number, f"a line longer than {CSV_LINE} bytes"))
            return None
        line = raw.decode("utf-8", "replace")
        if not line.strip():
            return None
        if (squeezed := _squeezed(line)) in self.layout.headings or squeezed.startswith("ZONE "):
            if squeezed == self._names_line:
                self.repeated.append(number)
            return None
        cells = self._split(line)
        if line.lstrip().startswith(('"', '("')) and not any(_NUMBER.fullmatch(c) for c in cells):
            raise input_error("tables.another_header", self.path, number, squeezed=shown(squeezed))
        if len(cells) != self.width:
            self.broken.append((number, f"{len(cells)} cell{'s' * (len(cells) != 1)}"))
            return None
        numbers = [self._number(cell) for cell in cells]
        for cell, value in zip(cells, numbers, strict=True):
            if value is None:
                self.broken.append((number, shown(cell)))
                return None
        return numbers  # type: ignore[return-value]

    @property
    def _names_line(self) -> str:
        return max(self.layout.headings, key=len, default="")

    def _split(self, line: str) -> list[str]:
        if self.layout.delimiter == " ":
            return line.split()
        if '"' in line:
            return header_cells(line, self.layout.delimiter)
        return [cell.strip() for cell in line.split(self.layout.delimiter)]

    def _number(self, cell: str) -> float | None:
        """Blank is NaN, NaN and infinity as written are infinite, other text is None."""
        if not cell:
            return np.nan
        cell = cell.replace("\N{MINUS SIGN}", "-")
        if self.layout.delimiter in ";\t" and "," in cell and "." not in cell:
            self.marks.add(",")
            cell = cell.replace(",", ".", 1)
        elif "." in cell and self.layout.delimiter != ",":
            self.marks.add(".")
        if _NUMBER.fullmatch(cell):
            return float(cell)
        return np.inf if _NOT_FINITE.fullmatch(cell) else None


def _blocks(path: Path, offset: int) -> Iterator[tuple[bytes, bool]]:
    """Whole lines, some MiB at a time, then what follows the last line end, and whether it is that."""
    try:
        with stream_of(path) as stream:
            stream.seek(offset)
            rest = b""
            while read := stream.read(BLOCK):
                rest += read
                end = rest.rfind(b"\n") + 1
                if not end and b"\r" in rest[:-1]:
                    end = rest[:-1].rfind(b"\r") + 1
                if not end and len(rest) > BLOCK:
                    raise input_error("tables.no_line_end", path, block=BLOCK)
                if end:
                    yield rest[:end], False
                rest = rest[end:]
    except OSError as why:
        raise InputError(str(why.strerror or why), "a readable file", file=path) from None
    if rest.endswith(b"\r"):
        yield rest, False
    elif rest:
        yield rest, True


def read_monitor(path: Path, layout: Layout) -> Monitor:
    """Read the rows of a monitor.

    A last line that is cut is left out, and so is a complete one without a line end, whose last number may be. Lines that
    a crash left broken amid the file are left out too, and said, up to ten and one in a hundred.

    Raises
    ------
    InputError
        Too many broken lines, another header amid the rows, decimal points and commas, or too many numbers.
    """
    rows = _Rows(path, layout)
    tail = ""
    for block, is_rest in _blocks(path, layout.offset):
        if not is_rest:
            rows.add(block)
            continue
        row = rows.row(block, rows.line)
        if row is not None and not rows.count:
            rows.keep(np.array([rows.line]), np.array([row]))
        elif row is not None:
            tail = f"{path.name}:{rows.line}: no line end after the last line, which may be cut: left out"
    if rows.marks == {",", "."}:
        raise input_error("tables.two_decimal_marks", path, layout.first)
    last = int(rows.lines[rows.count - 1]) if rows.count else layout.first - 1
    cut = [f"{path.name}:{n}: the last line is broken ({found})" for n, found in rows.broken if n > last][:1]
    remarks = [
        f"{path.name}:{n}: {found} instead of {rows.width}: line left out" for n, found in rows.broken[:5] if n < last
    ]
    if len(rows.broken) > len(remarks) + len(cut):
        remarks.append(f"{path.name}: {len(rows.broken)} broken lines left out in all")
    remarks += [f"{path.name}:{n}: the header again, as a restart writes it" for n in rows.repeated[:5]]
    columns = [column[: rows.count] for column in rows.columns]
    lines = rows.lines[: rows.count]
    if tail:
        remarks.append(tail)
    return Monitor(path, layout.names, columns, lines, layout.line, tuple(remarks), cut[0] if cut else "")


# ---------------------------------------------------------------------------------------------------- runs


def taken(monitor: Monitor, rows: NDArray[np.bool_] | NDArray[np.int64]) -> Monitor:
    """A monitor of some of its rows; the given one loses its columns."""
    columns = []
    for j in range(len(monitor.columns)):
        values, monitor.columns[j] = monitor.columns[j], np.empty(0)
        columns.append(values[rows])
    return replace(monitor, columns=columns, lines=monitor.lines[rows])


def in_order(monitor: Monitor, index: int, inner: bool = False) -> Monitor:
    """Rows in rising order of one column: where it goes back or stands still, the later rows win.

    Parameters
    ----------
    monitor : Monitor
    index : int
        Position of the column.
    inner : bool
        Whether it stands still while inner iterations go on, which is nothing to remark.
    """
    if not len(monitor):
        return monitor
    steps = monitor.columns[index]
    readable = np.isfinite(steps)
    if not readable.all():
        row = int(np.flatnonzero(~readable)[0])
        remark = f"{monitor.at(row)}: {monitor.names[index]} is no number: {int((~readable).sum())} lines left out"
        return in_order(replace(taken(monitor, readable), remarks=(*monitor.remarks, remark)), index, inner)
    lowest_after = np.append(np.minimum.accumulate(steps[::-1])[::-1][1:], np.inf)
    selected = steps < lowest_after
    if selected.all():
        return monitor
    change = np.diff(steps)
    back = np.flatnonzero(change < 0.0 if inner else change <= 0.0) + 1
    remarks = monitor.remarks
    if back.size:
        words = [f"{monitor.at(i)}: {monitor.names[index]} {steps[i]:g} follows {steps[i - 1]:g}" for i in back[:3]]
        more = f" and at {len(back) - 3} more places" if len(back) > 3 else ""
        remarks = (
            *remarks,
            f"{'; '.join(words)}{more}: the later lines count, {int((~selected).sum())} earlier ones left out",
        )
    return replace(taken(monitor, selected), remarks=remarks)


def pieced(monitors: Sequence[Monitor], index: int) -> Monitor:
    """Files that continue each other as one monitor: where a later one begins, the earlier ones end.

    Raises
    ------
    InputError
        Files with other columns.
    """
    whole = monitors[0]
    for later in monitors[1:]:
        if later.names != whole.names:
            raise input_error(
                "tables.other_columns", later.path, later.header_line, names=shown(", ".join(later.names), 200), name=whole.path.name,
            )  # fmt: skip
        begins = later.columns[index][0] if len(later) else np.inf
        selected = whole.columns[index] < begins
        remarks = (*whole.remarks, *later.remarks)
        if not selected.all():
            left_out = f"{int((~selected).sum())} lines of {whole.path.name} from there on left out"
            remarks = (*remarks, f"{later.path.name} begins at {whole.names[index]} {begins:g}: {left_out}")
        columns = [np.concatenate([a[selected], b]) for a, b in zip(whole.columns, later.columns, strict=True)]
        lines = np.concatenate([whole.lines[selected], later.lines])
        whole = Monitor(later.path, whole.names, columns, lines, whole.header_line, remarks, later.crashed)
    return whole


def joined(monitors: Sequence[Monitor], index: str) -> Monitor:
    """Monitors of one run as one, at the steps that all of them have.

    Raises
    ------
    InputError
        No common step, or one name with different values in two files.
    """
    first = monitors[0]
    if len(monitors) == 1:
        return first
    common = first.columns[0]
    for other in monitors[1:]:
        common = np.intersect1d(common, other.columns[0], assume_unique=True)
    if not len(common) and all(len(m) for m in monitors):
        files = ", ".join(m.path.name for m in monitors)
        raise InputError(f"no {index} that {shown(files, 200)} share", "monitors of one run", file=first.path.parent)
    names, columns, remarks = [first.names[0]], [common], []
    for monitor in monitors:
        rows = np.isin(monitor.columns[0], common)
        if left := int((~rows).sum()):
            remarks.append(f"{monitor.path.name}: {left} lines at steps that the other files lack: left out")
        for name, values in zip(monitor.names[1:], monitor.columns[1:], strict=True):
            if name not in names:
                names.append(name)
                columns.append(values[rows])
            elif not np.array_equal(values[rows], columns[names.index(name)], equal_nan=True):
                raise input_error(
                    "tables.two_values_in_files", monitor.path, monitor.header_line, name, name=shown(name)
                )
    crashed = next((m.crashed for m in monitors if m.crashed), "")
    words = tuple(r for m in monitors for r in m.remarks)
    lines = first.lines[np.isin(first.columns[0], common)]
    return Monitor(first.path, tuple(names), columns, lines, first.header_line, (*words, *remarks), crashed)


def how_ended(monitor: Monitor, judged: Sequence[int]) -> tuple[Ended, str]:
    """How a run ended, and what shows it.

    Parameters
    ----------
    monitor : Monitor
    judged : sequence of int
        Positions of the columns whose NaN means divergence: forces, not residuals.
    """
    if not len(monitor):
        return Ended.EMPTY, monitor.crashed or f"{monitor.path.name}: no rows below the header"
    for j in judged:
        if np.isinf(monitor.columns[j][-1]):
            finite = np.flatnonzero(~np.isinf(monitor.columns[j]))
            row = int(finite[-1]) + 1 if finite.size else 0
            return Ended.DIVERGED, f"{monitor.at(row)}: {monitor.names[j]} is no number from there to the end"
    return (Ended.CRASHED, monitor.crashed) if monitor.crashed else (Ended.WHOLE, "")


def worst_end(ends: Iterable[tuple[Ended, str]]) -> tuple[Ended, str]:
    """How a run of several monitors ended: diverged before crashed."""
    return max(ends, key=lambda e: (e[0] is not Ended.WHOLE, e[0] is Ended.DIVERGED))


def raw_table(
    monitor: Monitor, path: Path, columns: Sequence[tuple[int, str, str, str]], files: Sequence[Path],
    dialect: dict[str, str], stated: dict[str, Stated] | None = None, remarks: Sequence[str] = (),
) -> RawTable:  # fmt: skip
    """The history of a run; the monitor loses the columns that go into it.

    Parameters
    ----------
    monitor : Monitor
    path : Path
        What a person named.
    columns : sequence of (int, str, str, str)
        Position, name without unit, unit and meaning.
    files : sequence of Path
    dialect : dict of str to str
    stated : dict of str to Stated, optional
    remarks : sequence of str
        Beside those of the monitor.
    """
    result = []
    for j, name, unit, means in columns:
        values, monitor.columns[j] = monitor.columns[j], np.empty(0)
        values[np.isinf(values)] = np.nan
        result.append(RawColumn(name, unit, values, means=means))
    return RawTable(
        path, tuple(result), monitor.header_line, monitor.lines, files=tuple(files), dialect=dialect,
        stated=stated or {}, remarks=(*monitor.remarks, *remarks),
    )  # fmt: skip

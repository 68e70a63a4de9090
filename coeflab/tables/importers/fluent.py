"""Report files (.out) and force reports of Ansys Fluent.

A report file states neither directions nor units: what its columns mean has to be said by a person. A force report states
the direction or the axis of every number, and the moment centre: forces of the fluid on the walls in the global axes of the
case (Fluent User's Guide, "Forces on Boundaries"). Its three-component table, or reports along positive axes, give X Y Z
and K M N in those axes; a report along a negative axis is turned, and said.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import JSON_BYTES
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.text.bounded import stream_of
from coeflab.core.texts import input_error
from coeflab.tables.half_bodies import planes_in_files
from coeflab.tables.monitor_files import decoded, files_of, first_filled, head, kind_of, lines_of, one_run, require
from coeflab.tables.monitors import (
    Monitor,
    how_ended,
    in_order,
    joined,
    laid_out,
    pieced,
    raw_table,
    read_monitor,
    worst_end,
)
from coeflab.tables.raw_table import Ended, RawColumn, RawTable, Run, Stated

summary = "report files (.out) and force reports of Ansys Fluent"
computed = True
reads = "report files (.out) or a force report of Fluent"
citations = ("Ansys Inc. (2024): Ansys Fluent User's Guide, Release 2024 R2: Report Files; Forces on Boundaries.",)

FORCE_TABLE = re.compile(
    r"^(?P<title>(?:Forces|Moments)\b.*)\n.*\n[ \t]*Zone[ \t]+Pressure[ \t]+Viscous[ \t]+Total\b", re.M
)
_FIRST, _NAMES = re.compile(r'"[^"]*"'), re.compile(r'\(?\s*"[^"]+"(?:\s+"[^"]*")+\s*\)?')
_INDEX = re.compile(r"iterations?|time[ -]step|flow[ -]time", re.I)
_QUOTED = re.compile(r'"([^"]*)"')
_PART = re.compile(r"(.+)_\d+_\d+")
_VECTOR = re.compile(r"\(([^()]*)\)")
_TITLE = re.compile(
    r"(?P<what>Forces|Moments)(?: - (?:Direction Vector \((?P<direction>[^()]*)\)"
    r"|Moment Center \((?P<centre>[^()]*)\)(?:\s+Moment Axis \((?P<axis>[^()]*)\))?))?"
)
_UNIT = re.compile(r"(?:Forces|Moments)\s*[\[(]([^\])]*)[\])]")
_UNITS = {"n": "N", "n-m": "N*m", "n m": "N*m", "nm": "N*m"}
_SHARES = ("pressure", "viscous", "total")
_AXES = {"Forces": "XYZ", "Moments": "KMN"}
_TIMES = ("flow-time", "Flow Time", "flow time")


def wrote(lines: Sequence[str]) -> bool:
    """Whether a title and names are quoted, or a table has Zone, Pressure, Viscous, Total below a title of Forces or Moments."""
    first = [line for _, line in first_filled(lines, 3)]
    if first and _FIRST.fullmatch(first[0]):
        named = next((line for line in reversed(first[1:]) if _NAMES.fullmatch(line)), "")
        if named and _INDEX.fullmatch(_QUOTED.findall(named)[0]):
            return True
    return FORCE_TABLE.search("\n".join(lines)) is not None


def recognises(path: Path) -> bool:
    """Whether a file is a report file or a force report of Fluent, or a folder holds those of one run only."""
    if path.is_dir():
        return bool(_monitors(path))
    return path.is_file() and kind_of(head(path)) == "fluent"


def run(path: Path, options: Mapping[str, Any] | None = None) -> Run:
    """Read the report files of a run, or its force report.

    Parameters
    ----------
    path : Path
        A report file, a force report, or the folder of the report files of one run. Files of restarts, such as
        ``drag-rfile_1_1.out`` beside ``drag-rfile.out``, continue each other.
    options : mapping, optional
        None are known.

    Returns
    -------
    Run
        Report files: columns by their names, without meaning. A force report: one row a report, its zones as patches.

    Raises
    ------
    InputError
        Another content, files of several runs in one folder, broken lines, or another header amid the rows.
    """
    parse_options(NoOptions, options or {}, "importers.fluent")
    if path.is_dir():
        parts = _monitors(path)
        if not parts:
            raise input_error("tables.no_report_files_of_one_run", path)
    else:
        parts = ((path,),)
        raw = head(path)
        if not raw.strip() and path.is_file():
            return Run.empty(path, f"{path.name}: empty")
        require(raw, path, "fluent", "a report file or a force report of Fluent")
        if _is_report(raw):
            return _force_report(path)
    monitors, ends = [], []
    files: list[Path] = []
    for of_one in parts:
        pieces = [in_order(_read(f), 0) for f in of_one]
        ends.append(how_ended(pieces[-1], range(len(pieces[-1].names))[1:]))
        monitors.append(pieced(pieces, 0))
        files += of_one
    ended, why = worst_end(ends)
    whole = joined(monitors, monitors[0].names[0])
    columns = [(j, name, *_meaning(name, j)) for j, name in enumerate(whole.names)]
    dialect = {"format": "Fluent report file", "delimiter": "blanks", "decimal mark": "point"}
    remarks = (f"{files[0].name}: report files state no directions and no units",)
    stated, texts = planes_in_files(path, _TEXTS, _SYMMETRY)
    table = raw_table(whole, path, columns, (*files, *texts), dialect, stated, remarks)
    return Run(path, path.stem, table, ended=ended, why=why)


# Transcripts, journals, summaries of the setup and cases written as text name the type of every zone.
_TEXTS = (".trn", ".jou", ".log", ".txt", ".cas", ".msh", ".sum", ".out", ".py", ".scm")
_SYMMETRY = re.compile(
    r"(?i)\bsymmetry faces,?\s+zone\s+(?P<name>\d+)|\((?:39|45) \(\d+ symmetry (?P<zone>[^\s()]+)"
    r"|\bzone-type\s+(?P<typed>\([^()]*\)|\S+)\s+[\"']?symmetry\b|^\s*(?P<listed>[\w.:-]+)\s+\d+\s+symmetry\s*$"
    r"|zone.type\b[^\n]*[\"']symmetry[\"']|\bBoundary Conditions\b[^\n]*\"symmetry\"|^\s*symmetry\s*\((?P<number>\d+)\)"
)


def _meaning(name: str, j: int) -> tuple[str, str]:
    if name in _TIMES:
        return "s", "time"
    return "", "iteration" if j == 0 else ""


def _is_report(raw: bytes) -> bool:
    return FORCE_TABLE.search("\n".join(lines_of(decoded(raw)[0]))) is not None


def _monitors(folder: Path) -> tuple[tuple[Path, ...], ...]:
    """Report files of a folder, those of one report in order; empty where two of them have the same names of columns."""
    by_base: dict[str, list[Path]] = {}
    seen: dict[tuple[str, ...], str] = {}
    for file in files_of(folder, "fluent"):
        raw = head(file)
        if _is_report(raw):
            continue
        base = m[1] if (m := _PART.fullmatch(file.stem)) else file.stem
        by_base.setdefault(base, []).append(file)
        if seen.setdefault(_names(raw)[0][1:], base) != base:
            return ()
    return tuple(one_run(files, _PART) for files in by_base.values())


def _names(raw: bytes) -> tuple[tuple[str, ...], int, int]:
    """Names of the columns, their line, and the number of lines of the header."""
    lines = first_filled(lines_of(decoded(raw)[0]), 3)
    n, line = lines[1]
    if len(lines) > 2 and lines[2][1].startswith("("):
        n, line = lines[2]
    return tuple(_QUOTED.findall(line)), n, n


def _read(path: Path) -> Monitor:
    raw = head(path)
    names, at, header = _names(raw)
    if len(names) < 2:
        raise input_error("tables.one_column", path, at)
    return read_monitor(path, laid_out(raw, path, header, names, " ", at))


# ---------------------------------------------------------------------------------------------------- force reports


@dataclass(frozen=True, slots=True)
class _Table:
    """One table of a force report: its title, and the numbers of every zone."""

    line: int
    what: str
    direction: tuple[float, ...] | None
    centre: tuple[float, ...] | None
    unit: str
    zones: Mapping[str, tuple[tuple[float, ...], ...]]

    @property
    def key(self) -> tuple[str, tuple[float, ...] | None]:
        return self.what, self.direction


def _numbers(text: str, path: Path, line: int) -> tuple[float, ...]:
    try:
        return tuple(float(cell) for cell in text.split())
    except ValueError:
        raise InputError(shown(text), "numbers", file=path, line=line) from None


def _tables(path: Path) -> tuple[list[_Table], str]:
    """Every table of a force report or of a transcript that holds some, and what shows that it was cut."""
    try:
        with stream_of(path) as stream:
            raw = stream.read(JSON_BYTES + 1)
    except OSError as why:
        raise InputError(str(why.strerror or why), "a readable file", file=path) from None
    if len(raw) > JSON_BYTES:
        raise InputError(f"more than {JSON_BYTES >> 20} MiB", "a force report", file=path)
    lines = lines_of(raw.decode("utf-8-sig", "replace"))
    out: list[_Table] = []
    for n, line in enumerate(lines):
        title = _TITLE.fullmatch(line.strip())
        if title is None or n + 2 >= len(lines) or lines[n + 2].split()[:4] != ["Zone", "Pressure", "Viscous", "Total"]:
            continue
        unit = _UNIT.search(lines[n + 1][:1000])
        given = title["axis"] if title["what"] == "Moments" else title["direction"]
        zones, closed = _zones(lines, n + 3, path, 1 if given else 3)
        if not closed:
            return out, f"{path.name}:{n + 1}: the table has no row Net"
        written = unit[1].strip() if unit else ""
        out.append(
            _Table(
                n + 1, title["what"], _numbers(given, path, n + 1) if given else None,
                _numbers(title["centre"], path, n + 1) if title["centre"] else None,
                _UNITS.get(written.lower(), written), zones,
            )
        )  # fmt: skip
    return out, ""


def _zones(
    lines: Sequence[str], start: int, path: Path, size: int
) -> tuple[dict[str, tuple[tuple[float, ...], ...]], bool]:
    """Pressure, viscous, total and their coefficients of every zone, each of so many numbers; whether Net ends them."""
    zones: dict[str, tuple[tuple[float, ...], ...]] = {}
    for n, line in enumerate(lines[start:], start=start + 1):
        cells = line.split()
        if not cells:
            return zones, False
        if set(line.strip()) <= {"-", " "}:
            continue
        name = cells[0]
        groups = _VECTOR.findall(line)
        rows = (
            [_numbers(g, path, n) for g in groups] if groups else [(v,) for v in _numbers(" ".join(cells[1:]), path, n)]
        )
        if len(rows) != 6 or any(len(r) != size for r in rows):
            if n == len(lines):
                return zones, False
            raise input_error(
                "tables.numbers_of_a_zone", path, n, count=len(rows), found="vectors" if groups else "numbers", name=shown(name),
                wanted="six vectors" if size == 3 else "six numbers",
            )  # fmt: skip
        zones[name] = tuple(rows)
        if name.lower() == "net":
            return zones, True
    return zones, False


def _force_report(path: Path) -> Run:
    """The reports of a file: every kind of table a set of columns, its repetitions the rows."""
    tables, cut = _tables(path)
    if not tables:
        return Run.empty(path, cut or f"{path.name}: empty")
    kinds: dict[tuple[str, tuple[float, ...] | None], list[_Table]] = {}
    for table in tables:
        kinds.setdefault(table.key, []).append(table)
    rows = min(len(found) for found in kinds.values())
    remarks = [
        f"{path.name}:{found[rows].line}: {len(found) - rows} reports without partner left out"
        for found in kinds.values() if len(found) > rows
    ]  # fmt: skip
    centres = {t.centre for found in kinds.values() for t in found[:rows] if t.centre is not None}
    if len(centres) > 1:
        raise input_error(
            "tables.several_moment_centres", path, next(t.line for t in tables if t.centre not in (None, tables[0].centre)),
            count=len(centres),
        )  # fmt: skip
    stated, texts = planes_in_files(path, _TEXTS, _SYMMETRY)
    if centres:
        line = next(t.line for t in tables if t.centre)
        stated["axes.reference_point"] = Stated(centres.pop(), f"{path.name}:{line}")
    whole = {what for what, direction in kinds if direction is None}
    per_zone: dict[str, list[RawColumn]] = {}
    for kind, found in kinds.items():
        means, sign = ("", 1.0) if kind[0] in whole else _axis(*kind)
        if sign < 0.0:
            remarks.append(f"{path.name}:{found[0].line}: {means} is minus the number along {_shown(kind[1])}")
        for zone in found[0].zones:
            if all(zone in t.zones for t in found[:rows]):
                per_zone.setdefault(zone, []).extend(_columns(kind, found[:rows], zone, means, sign))
    count = RawColumn("report", "", np.arange(1.0, rows + 1.0), means="iteration")
    lines = np.array([t.line for t in next(iter(kinds.values()))[:rows]])
    dialect = {"format": "Fluent force report", "delimiter": "blanks", "decimal mark": "point"}
    result = {
        zone: RawTable(path, (count, *columns), tables[0].line, lines, files=(path,), dialect=dialect)
        for zone, columns in per_zone.items()
    }
    net = next(zone for zone in result if zone.lower() == "net")
    history = replace(result.pop(net), stated=stated, remarks=tuple(remarks), files=(path, *texts))
    last = [c.values[-1] for c in history.columns]
    ended, why = (Ended.CRASHED, cut) if cut else (Ended.WHOLE, "")
    if not np.isfinite(last).all():
        ended, why = Ended.DIVERGED, f"{path.name}:{lines[-1]}: a force that is no number"
    return Run(path, path.stem, history, patches=result, ended=ended, why=why, is_final=True)


def _shown(direction: tuple[float, ...] | None) -> str:
    return f"({' '.join(f'{d:g}' for d in direction or ())})"


def _axis(what: str, direction: tuple[float, ...] | None) -> tuple[str, float]:
    """The component that a report along a unit vector of an axis gives, and its sign; empty for others."""
    if direction is None or len(direction) != 3 or sorted(abs(d) for d in direction) != [0.0, 0.0, 1.0]:
        return "", 1.0
    j = next(i for i, d in enumerate(direction) if d != 0.0)
    return _AXES[what][j], float(np.sign(direction[j]))


def _columns(
    kind: tuple[str, tuple[float, ...] | None], found: Sequence[_Table], zone: str, means: str, sign: float
) -> list[RawColumn]:  # fmt: skip
    """Columns of one zone of one kind of table."""
    what, direction = kind
    out = []
    for i, share in enumerate((*_SHARES, *(f"{s} coefficient" for s in _SHARES))):
        values = np.array([t.zones[zone][i] for t in found], dtype=float)
        unit = found[0].unit if i < 3 else "-"
        if values.shape[1] == 1:
            along = f"along {_shown(direction)}" if what == "Forces" else f"about {_shown(direction)}"
            name = f"{what} {along} {share}" if sign > 0.0 else f"{what} {along} {share}, turned"
            out.append(RawColumn(name, unit, sign * values[:, 0], means=means if share == "total" else ""))
            continue
        for j, axis in enumerate(_AXES[what]):
            own = axis if share == "total" else ""
            out.append(RawColumn(f"{what} {'xyz'[j]} {share}", unit, values[:, j], means=own))
    return out

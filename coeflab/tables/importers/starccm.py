"""Monitors and monitor plots of Simcenter STAR-CCM+ as CSV.

A monitor's name, such as "Drag Monitor", is its user's: what it means has to be said by a person. Forces are those of the
fluid on the surface along the report's direction (Simcenter STAR-CCM+ User Guide, "Force"), which the file does not state.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import shown
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.texts import input_error
from coeflab.tables.half_bodies import planes_in_files
from coeflab.tables.monitor_files import decoded, files_of, first_filled, head, header_cells, kind_of, lines_of, require
from coeflab.tables.monitors import Monitor, how_ended, in_order, joined, laid_out, raw_table, read_monitor, worst_end
from coeflab.tables.raw_table import Run

summary = "monitors and monitor plots of Simcenter STAR-CCM+ exported as CSV"
computed = True
reads = "monitor CSV of STAR-CCM+, one file or a folder of one run"
citations = ("Siemens Digital Industries Software (2023): Simcenter STAR-CCM+ User Guide: Force; Force Coefficient.",)

# A row a condition, of reports in the place of a history.
_CONDITION = re.compile(
    r"(?i)\b(?:run|case|design\s*#?|drift|beta|alpha|angle|yaw angle|incidence|speed)(?!.* Monitor\b)"
)
_MONITOR = re.compile(r".+ Monitor(?: \d+)?: .+|(Iteration|Time Step): \1|Physical Time: Physical Time \(.*\)")
_DELIMITERS = {",": "comma", ";": "semicolon", "\t": "tab"}
_UNIT = re.compile(r"(?P<name>.+?)\s*\((?P<unit>[^()]*)\)")
_STEPS = ("Iteration", "Time Step", "\u8fed\u4ee3")
_TIMES = ("Physical Time", "Time", "Solution Time", "\u65f6\u95f4", "\u7269\u7406\u65f6\u95f4")
_WITHOUT_UNIT = ("Force Coefficient", "Moment Coefficient")


# Macros that Java plays back and summary reports name the kind of every boundary.
_TEXTS = (".java", ".log", ".txt", ".html", ".htm", ".xml", ".out")
_SYMMETRY = re.compile(
    r"SymmetryBoundary\b|(?i:\btype\W{1,20}symmetry(?:\s+plane)?\b)|[:>|]\s*Symmetry(?: Plane)?\s*(?:[<|]|$)"
)
_BOUNDARY = re.compile(r"(?:getBoundary\(\"|(?i:\bboundary(?:\s+name)?\s*:\s*))([^\"\n<]+)")


def wrote(lines: Sequence[str]) -> bool:
    """Whether a column is ``NAME Monitor: WHAT (UNIT)``, ``Iteration: Iteration`` or ``Physical Time: Physical Time (s)``."""
    for _, line in first_filled(lines, 1):
        heads = [header_cells(line, d) for d in _DELIMITERS if d in line]
        return any(any(map(_MONITOR.fullmatch, h)) and not _CONDITION.search(h[0]) for h in heads)
    return False


def recognises(path: Path) -> bool:
    """Whether a file is a monitor of STAR-CCM+, or a folder holds those of one run and no other monitors."""
    if path.is_dir():
        return bool(_monitors(path))
    return path.is_file() and kind_of(head(path)) == "starccm"


def run(path: Path, options: Mapping[str, Any] | None = None) -> Run:
    """Read the monitors of a run.

    Parameters
    ----------
    path : Path
        One CSV file, or a folder of several that share their iterations or times.
    options : mapping, optional
        None are known.

    Returns
    -------
    Run
        Columns by the names and units of the file, without meaning but for iteration and time; no conditions.

    Raises
    ------
    InputError
        Another content, files of several runs in one folder, broken lines, or another header amid the rows.
    """
    parse_options(NoOptions, options or {}, "importers.starccm")
    files = _monitors(path) if path.is_dir() else (path,)
    if not files:
        raise input_error("tables.no_monitors_of_one_run", path)
    if not path.is_dir() and path.is_file() and not head(path).strip():
        return Run.empty(path, f"{path.name}: empty")
    read = [_read(f) for f in files]
    monitors = [in_order(m, 0) for m, _ in read]
    counted = {_label(m.names[0])[0] for m in monitors}
    if len(counted) > 1:
        names = ", ".join(sorted(counted))
        raise input_error("tables.monitors_over_several", path, names=shown(names))
    ends = [how_ended(m, range(len(m.names))[1:]) for m in monitors]
    ended, why = worst_end(ends)
    whole = joined(monitors, next(iter(counted)))
    columns = [(j, *_label(name), _means(name) if j == 0 else "") for j, name in enumerate(whole.names)]
    delimiter = read[0][1]
    dialect = {
        "format": "STAR-CCM+ monitor CSV",
        "delimiter": _DELIMITERS[delimiter],
        "decimal mark": "point" if delimiter == "," else "point or comma",
    }
    stated, texts = planes_in_files(path, _TEXTS, _SYMMETRY, _BOUNDARY)
    table = raw_table(whole, path, columns, (*files, *texts), dialect, stated)
    return Run(path, path.stem, table, ended=ended, why=why)


def _label(name: str) -> tuple[str, str]:
    """Name and unit: ``Drag Monitor: Drag Monitor (N)`` is Drag Monitor in N, a coefficient has the unit ``-``."""
    match = _UNIT.fullmatch(name)
    bare, unit = (match["name"], match["unit"].strip()) if match else (name, "")
    own, _, what = bare.partition(": ")
    if what in _WITHOUT_UNIT and not unit:
        unit = "-"
    return (own if what in (own, *_WITHOUT_UNIT) else bare), unit.replace("N-m", "N*m")


def _means(name: str) -> str:
    """Whether the first column counts iterations or times."""
    own, unit = _label(name)
    if own in _STEPS:
        return "iteration"
    return "time" if own in _TIMES or unit == "s" else ""


def _monitors(folder: Path) -> tuple[Path, ...]:
    """Monitors of a folder; none where two of them have a monitor of one name: those are several runs."""
    files = files_of(folder, "starccm")
    seen: set[str] = set()
    for file in files:
        names = set(_header(head(file))[0][1:])
        if seen & names:
            return ()
        seen |= names
    return files


def _header(raw: bytes) -> tuple[list[str], str, int]:
    """Names, delimiter and line of the header."""
    lines = lines_of(decoded(raw)[0])
    at = next((n for n, line in enumerate(lines, start=1) if line.strip()), 1)
    delimiter = max(_DELIMITERS, key=lambda d: len(header_cells(lines[at - 1], d)))
    return header_cells(lines[at - 1], delimiter), delimiter, at


def _read(path: Path) -> tuple[Monitor, str]:
    """One file: the column that counts first, once."""
    raw = head(path)
    require(raw, path, "starccm", 'a monitor of STAR-CCM+ ("Drag Monitor: Drag Monitor (N)")')
    names, delimiter, at = _header(raw)
    if len(names) < 2 or not _means(names[0]):
        raise input_error("tables.first_column_counts_nothing", path, at, names[0], names=shown(names[0]))
    monitor = read_monitor(path, laid_out(raw, path, at, names, delimiter, at))
    return _once(monitor), delimiter


def _once(monitor: Monitor) -> Monitor:
    """A monitor without columns that repeat an earlier one, and with a name of its own for every other."""
    names: list[str] = []
    columns: list[Any] = []
    remarks: Sequence[str] = monitor.remarks
    for j, name in enumerate(monitor.names):
        twins = [k for k in range(j) if monitor.names[k] == name]
        if any(np.array_equal(monitor.columns[j], monitor.columns[k], equal_nan=True) for k in twins):
            continue
        if twins:
            remarks = (*remarks, f"{monitor.path.name}:{monitor.header_line}: {name} twice, with different values")
        names.append(f"{name} ({len(twins) + 1})" if twins else name)
        columns.append(monitor.columns[j])
    return replace(monitor, names=tuple(names), columns=columns, remarks=tuple(remarks))

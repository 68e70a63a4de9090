"""Captive tests as the SIMMAN workshops ask for them: forces X Y N, position, velocities and accelerations in columns.

Format of Model Test Results and Coordinate Systems, instructions of SIMMAN 2014 (simman2014.dk): ASCII, SI, model scale, axes
of the ITTC (x forward, y to starboard, z down). Static tests have one row of means a condition, dynamic ones the time series
of one whole cycle. The instructions fix which columns there are, not how they are separated.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import factor
from coeflab.tables.dialect import is_house_table
from coeflab.tables.monitor_files import decoded, head, header_cells, lines_of
from coeflab.tables.monitors import Monitor, laid_out, read_monitor

TIME = ("Time", "time", "t")
DIMENSIONS = {
    **dict.fromkeys(TIME, "time"), **dict.fromkeys(("x", "y"), "length"), "psi": "angle",
    "X": "force", "Y": "force", "N": "moment", "u": "speed", "v": "speed", "r": "rate",
    "udot": "acceleration", "vdot": "acceleration", "rdot": "angular acceleration",
}  # fmt: skip
UNITS = {
    "time": "s", "length": "m", "angle": "rad", "force": "N", "moment": "N*m", "speed": "m/s", "rate": "rad/s",
    "acceleration": "m/s^2", "angular acceleration": "rad/s^2",
}  # fmt: skip
STATED = "SIMMAN 2014, Format of Model Test Results"
FIRST_LINES = 64  # in which the names of a captive test are looked for
SIMMAN = frozenset(("X", "Y", "N", "u", "v", "r", "udot", "vdot", "rdot"))
_CAPTIVE = re.compile(r"(?P<name>[A-Za-z]+(?:_?dot)?)\s*(?P<unit>\[[^\[\]]*\]|\([^()]*\))?")
_SQUARED = re.compile(r"s(?:2|\*\*2|\u00b2)$")
FEWEST, STILL = 8, 1e-9  # rows of a cycle; acceleration of a static test over its largest velocity


def line_of_names(lines: Sequence[str]) -> int:
    """The line, from 1, that names the columns of a captive test; 0 without one."""
    return next((i for i, line in enumerate(lines[:FIRST_LINES], start=1) if captive_names(line)[0]), 0)


def is_captive_test(path: Path) -> bool:
    """Whether a file has the columns of a captive test, and is no table of ours."""
    return line_of_names(lines_of(decoded(head(path))[0])) > 0 and not is_house_table(path)


def captive_names(line: str) -> tuple[tuple[str, ...], tuple[str, ...], str]:
    """Names, units and delimiter of a line that names the columns of a SIMMAN captive test; empty where it does not.

    Parameters
    ----------
    line : str
        A comment mark before the names is no part of them.
    """
    bare = line.strip().lstrip("#%!").strip()
    delimiter = next((d for d in "\t;," if d in bare), " ")
    # A blank separates columns only where none stands before a unit.
    cells = re.sub(r"\s+([\[(])", r"\1", bare).split() if delimiter == " " else header_cells(bare, delimiter)
    parts = [_CAPTIVE.fullmatch(cell) for cell in cells]
    names = tuple(m["name"].replace("_", "") if m else cell for m, cell in zip(parts, cells, strict=True))
    if not set(names) >= SIMMAN or len(set(names)) < len(names):
        return (), (), ""
    return names, tuple((m["unit"] or "").strip("[]()") if m else "" for m in parts), delimiter


def captive_test(path: Path) -> tuple[Monitor, tuple[str, ...], str]:
    """The columns of a captive test, as written.

    Returns
    -------
    monitor : Monitor
    units : tuple of str
        As the file writes them, else those of SI, which the instructions ask for.
    delimiter : str

    Raises
    ------
    InputError
        Another content, broken lines, a unit that does not fit its column.
    """
    raw = head(path)
    lines = lines_of(decoded(raw)[0])
    at = line_of_names(lines)
    if not at:
        found = "another content" if path.is_file() else "no such file"
        raise InputError(found, f"columns {' '.join(sorted(SIMMAN))}", file=path, line=1)
    names, units, delimiter = captive_names(lines[at - 1])
    below = captive_units(lines[at : at + 1], delimiter, len(names))
    monitor = read_monitor(path, laid_out(raw, path, at + bool(below), names, delimiter, at))
    written = below or units
    filled = []
    for name, word in zip(names, written, strict=True):
        dimension = DIMENSIONS.get(name, "")
        unit = _SQUARED.sub("s^2", word)
        if unit and dimension:
            try:
                factor(unit, dimension)
            except UnitsError as why:
                raise UnitsError(why.found, why.expected, file=path, line=at + bool(below), column=name) from None
        filled.append(unit or UNITS.get(dimension, ""))
    return monitor, tuple(filled), delimiter


def captive_units(lines: list[str], delimiter: str, width: int) -> tuple[str, ...]:
    """The row of units below the names; empty where there is none."""
    line = lines[0].strip().lstrip("#%!").strip() if lines else ""
    cells = [c.strip().strip("[]()") for c in (line.split() if delimiter == " " else line.split(delimiter))]
    if len(cells) != width or any(c[:1].isdigit() or c[:1] in "-+." for c in cells):
        return ()
    return tuple("" if c == "-" else c for c in cells)


def is_record(columns: dict[str, Array]) -> bool:
    """Whether the rows are the time series of an oscillating test: time rises, and something is accelerated."""
    time = next((columns[n] for n in TIME if n in columns), None)
    if time is None or len(time) < FEWEST or not np.all(np.diff(time) > 0.0):
        return False
    largest = max(float(np.abs(columns[n]).max()) for n in ("u", "v", "r"))
    return any(float(np.abs(columns[n]).max()) > STILL * largest for n in ("udot", "vdot", "rdot"))


def record(path: Path) -> tuple[Array, dict[str, Array]]:
    """Time and columns of an oscillating test, in SI.

    Raises
    ------
    InputError
        No time, or a cell that is no number.
    """
    monitor, units, _ = captive_test(path)
    out = {}
    for name, unit, values in zip(monitor.names, units, monitor.columns, strict=True):
        if name not in DIMENSIONS or name == "x":  # along the tank, not along the carriage
            continue
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            raise input_error("tables.cell_without_number", path, int(monitor.lines[bad[0]]), name)
        out[name] = values * factor(unit, DIMENSIONS[name])
    time = next((out.pop(n) for n in TIME if n in out), None)
    if time is None:
        raise InputError(shown(" ".join(monitor.names)), "a column Time", file=path, line=monitor.header_line)
    return time, out

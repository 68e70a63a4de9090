"""Final values of one run, a file a run: names with values, SU2's forces_breakdown.dat, wall forces in the output of CFX.

A table of names with values (STAR-CCM+ "Report Name, Value, Unit", post-processors) says no directions: a person says them. SU2
gives coefficients in the axes of the mesh, CFX forces and moments of the fluid in the global axes about their origin.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.limits import JSON_BYTES
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.text.bounded import whole_bytes
from coeflab.core.texts import input_error
from coeflab.tables.dialect import Marks, name_and_unit
from coeflab.tables.half_bodies import planes_in_files
from coeflab.tables.monitor_files import decoded, head, header_cells, lines_of
from coeflab.tables.raw_table import Ended, RawColumn, RawTable, Run, Stated

summary = "final values of one run: report name and value, SU2 forces_breakdown.dat, CFX wall forces"
reads = "files of final values, one a run (report name, value, unit; forces_breakdown.dat; .out of CFX)"
citations = ("Ansys Inc. (2024): Ansys CFX-Solver Manager User's Guide, Release 2024 R2: CFX-Solver Output File.",)
computed = True

_NAMES = ("report name", "report", "name", "quantity", "monitor", "result", "parameter")
_VALUES = ("value", "last value", "final value", "result value", "mean")
_UNITS = ("unit", "units")
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_BREAKDOWN = re.compile(r"(?m)^Forces breakdown:\s*$")
_TOTAL = re.compile(rf"^Total (?P<name>C[A-Za-z]+(?:/CD)?):\s*(?P<value>{_NUMBER})\b")
_AXES = {"CFx": "X", "CFy": "Y", "CFz": "Z", "CMx": "K", "CMy": "M", "CMz": "N"}
_FLOW = re.compile(rf"^Free-stream velocity: \((?P<flow>[^()]*)\) m/s\. Magnitude: (?P<speed>{_NUMBER}) m/s")
_ANGLES = re.compile(
    rf"Angle of attack \(AoA\): (?P<alpha>{_NUMBER}) deg(?:.*sideslip \(AoS\): (?P<beta>{_NUMBER}) deg)?"
)
_SIZES = {
    "coefficients.area": re.compile(rf"(?i)reference area[^\d\n]{{0,40}}(?P<value>{_NUMBER})\s*m"),
    "coefficients.length": re.compile(rf"(?i)reference length[^\d\n]{{0,40}}(?P<value>{_NUMBER})\s*m"),
}
_WALLS = re.compile(r"^\|\s*(?P<share>Pressure|Viscous) (?P<what>Force|Moment) On Walls\s*\|$")
_SUM = re.compile(rf"Totals?\s*:?\s+(?P<x>{_NUMBER})\s+(?P<y>{_NUMBER})\s+(?P<z>{_NUMBER})$")
_SYMMETRY = re.compile(r"(?i)^\s*Boundary Type\s*=\s*SYMMETRY\b")
_BOUNDARY = re.compile(r"(?i)^\s*BOUNDARY\s*:\s*(.+)")
_MARKS = Marks()


def recognises(path: Path) -> bool:
    """Whether a file holds final values of one run."""
    raw = head(path)
    if not raw or b"\0" in raw:
        return False
    text = decoded(raw)[0]
    return bool(_BREAKDOWN.search(text)) or _is_cfx(text) or _named_values(lines_of(text)) is not None


def run(path: Path, options: Mapping[str, Any] | None = None) -> Run:
    """The values of a file as a history of one row.

    Parameters
    ----------
    path : Path
    options : mapping, optional
        None are known.

    Raises
    ------
    InputError
        Another content, or a value that is no number.
    """
    parse_options(NoOptions, options or {}, "importers.reports")
    text = decoded(whole_bytes(path, JSON_BYTES))[0]
    lines = lines_of(text)
    stated: dict[str, Stated] = {}
    conditions: dict[str, Stated] = {}
    half: dict[str, Stated] = {}
    texts: list[Path] = []
    if _BREAKDOWN.search(text):
        kind, columns = "SU2 forces breakdown", list(_breakdown(lines))
        conditions, stated = _of_su2(lines, path)
        half, texts = planes_in_files(
            path, (".cfg", ".log"), re.compile(r"(?i)^\s*MARKER_SYM\w*\s*=\s*\(?\s*(?!NONE)(?P<name>\w+)")
        )
    elif _is_cfx(text[: 1 << 16]):
        kind, columns = "wall forces of CFX", list(_walls(lines))
        half, texts = planes_in_files(path, (".ccl", ".out"), _SYMMETRY, _BOUNDARY)
        stated = {
            "axes.reference_point": Stated((0.0, 0.0, 0.0), "the origin of the axes, as CFX has it", convention=True)
        }
    else:
        kind, columns = "names with values", _values(lines, path)
    stated |= half
    dialect = {"format": kind}
    if not columns:
        return Run.empty(path, f"{path.name}: no final value")
    broken = not all(math.isfinite(float(c.values[0])) for c in columns)
    table = RawTable(path, tuple(columns), files=(path, *texts), dialect=dialect, stated=stated)
    reason = f"{path.name}: a value that is no number" * broken
    return Run(
        path, path.stem, table, conditions, ended=Ended.DIVERGED if broken else Ended.WHOLE, why=reason, is_final=True
    )


def _column(name: str, unit: str, value: float, means: str = "") -> RawColumn:
    return RawColumn(name, unit, np.array([value]), means=means)


def _named_values(lines: Sequence[str]) -> tuple[int, str, list[int]] | None:
    """Line of the head of a table of names and values, its delimiter, and where name, value and unit stand; None without one."""
    filled = [(n, line) for n, line in enumerate(lines) if line.strip()][:1]
    for n, line in filled:
        for delimiter in (d for d in ",;\t" if d in line):
            cells = [c.casefold() for c in header_cells(line, delimiter)]
            places = [next((i for i, c in enumerate(cells) if c in words), -1) for words in (_NAMES, _VALUES, _UNITS)]
            if min(places[:2]) >= 0 and len(cells) <= 3:
                return n, delimiter, places
    return None


def _values(lines: Sequence[str], path: Path) -> list[RawColumn]:
    found = _named_values(lines)
    if found is None:
        raise input_error("tables.no_named_values", path, 1)
    at, delimiter, (name, value, unit) = found
    out: dict[str, RawColumn] = {}
    for n, line in enumerate(lines[at + 1 :], start=at + 2):
        cells = header_cells(line, delimiter)
        if not any(cells):
            continue
        number = _MARKS.number(cells[value]) if len(cells) > max(name, value) else None
        if number is None:
            raise InputError(f'"{line.strip()[:60]}"', "a name and a number", file=path, line=n)
        own, behind = name_and_unit(cells[name])
        if own in out:
            raise input_error("tables.name_twice", path, n, own=own)
        written = cells[unit] if 0 <= unit < len(cells) else behind
        out[own] = _column(own, written.replace("N-m", "N*m"), number)
    return list(out.values())


def _breakdown(lines: Sequence[str]) -> Iterator[RawColumn]:
    """Totals of all surfaces: those above the first surface."""
    for line in lines:
        if line.startswith("Surface name"):
            return
        if m := _TOTAL.match(line):
            yield _column(m["name"], "-", float(m["value"]), _AXES.get(m["name"], ""))


def _of_su2(lines: Sequence[str], path: Path) -> tuple[dict[str, Stated], dict[str, Stated]]:
    """Condition and sizes that a forces breakdown states: the body moves against the free stream, in the axes of the mesh."""
    conditions, stated = dict[str, Stated](), dict[str, Stated]()
    for n, line in enumerate(lines, start=1):
        place = f"{path.name}:{n}"
        for key, size in _SIZES.items():
            if (m := size.search(line)) and 0.0 < float(m["value"]) < math.inf:
                stated.setdefault(key, Stated(float(m["value"]), place))
        if m := _ANGLES.search(line):
            conditions |= {
                a: Stated(math.radians(float(m[a])), place)
                for a in ("alpha", "beta")
                if m[a] and abs(float(m[a])) <= 360.0
            }
        if (m := _FLOW.match(line)) and "U" not in conditions:
            flow = [float(x) for x in re.findall(_NUMBER, m["flow"])]
            if len(flow) not in (2, 3) or not all(map(math.isfinite, [*flow, float(m["speed"])])):
                continue
            conditions["U"] = Stated(float(m["speed"]), place)
            own = [0.0 - v for v in [*flow, 0.0][:3]]
            conditions |= {c: Stated(v + 0.0, place) for c, v in zip("uvw", own, strict=True)}
    if {"alpha", "beta"} & conditions.keys():
        conditions = {k: v for k, v in conditions.items() if k not in ("u", "v", "w")}
    return conditions, stated


def _is_cfx(text: str) -> bool:
    return any(map(_WALLS.match, map(str.strip, lines_of(text)))) or (
        "ANSYS" in text[:4000] and "CFX" in text[:4000] and "LIBRARY:" in text
    )


def _walls(lines: Sequence[str]) -> Iterator[RawColumn]:
    """Force and moment on all walls, pressure and viscous together, of the last summary."""
    last: dict[tuple[str, str], tuple[float, ...]] = {}
    section: tuple[str, str] | None = None
    for line in map(str.strip, lines):
        if m := _WALLS.match(line):
            section = (m["what"], m["share"])
        elif section and (m := _SUM.search(line)):
            last[section] = tuple(float(m[a]) for a in "xyz")
            section = None
    for what, names, unit in (("Force", "XYZ", "N"), ("Moment", "KMN", "N*m")):
        shares = [last[what, s] for s in ("Pressure", "Viscous") if (what, s) in last]
        if shares:
            yield from (
                _column(f"{what} {a}", unit, sum(s[i] for s in shares), c)
                for i, (a, c) in enumerate(zip("xyz", names, strict=True))
            )

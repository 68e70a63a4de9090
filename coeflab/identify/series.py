"""A measured or simulated motion as a CSV with a unit in every header."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import LARGEST_NUMBER
from coeflab.core.text.delimited import Cells, read_cells, require_unit
from coeflab.core.texts import input_error, words
from coeflab.core.types import Array, brief, locking
from coeflab.core.units import Header, factor, parse_header
from coeflab.identify.kinematics import FORWARD, by_positions, contradicted, drift, sideways
from coeflab.law.symbols import ANGULAR, CONTROLS, LINEAR, MOTIONS
from coeflab.motion.vehicle import Vehicle
from coeflab.tables.importers.table import raw
from coeflab.tables.vocabulary import one_name
from coeflab.vehicle.parameter_parts import THRUST

FEWEST = 50  # rows: fewer hold no motion from which forces could be told
COMMAND = "command"
TILT = ".tilt"
TIME = {"t": "t", "time": "t"}
ANGLES = ("phi", "theta")
PLACES = ("x", "y", "psi")  # over ground, and the heading
LEFT = "-"  # in the place of a name: a column that is passed over
SAME_PLACE = {
    "north": "x",
    "northing": "x",
    "east": "y",
    "easting": "y",
    "heading": "psi",
    "yaw": "psi",
}  # where the file has no column of the other name
EXAMPLES = {
    "length": "x [m]", "time": "t [s]", "speed": "u [m/s]", "rate": "r [rad/s]", "angle": "dr [rad]", "force": "thrust [N]",
}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("time velocity attitude controls wrench")
class MotionSeries:
    """One motion, SI, FRD, about the reference point of the vehicle.

    Attributes
    ----------
    file : str
    time : (n,) array
        s, rising, steps even or not.
    velocity : (n, 6) array
        u v w p q r through the water; zero where the file has no such column.
    attitude : (n, 4) array
        Unit quaternion, from roll and pitch, heading left at zero.
    controls : (n, 3) array
        dr ds db, rad.
    wrench : (n, 6) array
        Force and moment of the thrusters.
    given : frozenset of str
        Columns that the file has, by their plain names.
    findings : tuple of Finding
        What follows from positions, and where they contradict the velocities.
    """

    file: str
    time: Array
    velocity: Array
    attitude: Array
    controls: Array
    wrench: Array
    given: frozenset[str]
    findings: tuple[Finding, ...] = ()

    @property
    def moving(self) -> frozenset[str]:
        """Motions and controls that vary, or that are not zero."""
        both = np.hstack([self.velocity, self.controls])
        return frozenset(n for n, x in zip((*MOTIONS, *CONTROLS), both.T, strict=True) if np.any(x != 0.0))


def read_series(path: Path, vehicle: Vehicle, columns: str = "") -> MotionSeries:
    """Read a time series.

    Columns ``t`` and ``u`` are needed, or ``x``, ``y`` and ``psi``, of which u, v and r follow; v w p q r, phi and theta, dr ds db,
    ``thrust`` and the thrusters of the vehicle (with ``.tilt``) are taken where they are, others are passed over. A thruster's column
    is what it does: no lag of the file is applied to it.

    Parameters
    ----------
    path : Path
    vehicle : Vehicle
        Whose thrusters the commands are for.
    columns : str
        Names of all columns of a file without a header, or in the place of its own: ``t [s], x [m], y [m], -psi [deg], -``. A minus before
        a name changes the sign, one alone passes a column over.

    Raises
    ------
    InputError
        A missing column, a unit that does not fit, a blank cell, text, NaN, times that do not rise, too few rows; velocities that
        are not along the body, by positions and heading.
    """
    cells, signs = _named(path, columns) if columns else (read_cells(path), {})
    plain = {h.name for h in cells.headers}
    names = [TIME.get(h.name, one_name(h.name)) for h in cells.headers]
    names = [n if SAME_PLACE.get(n, n) in plain else SAME_PLACE.get(n, n) for n in names]
    for k, name in enumerate(names):
        if _dimension(name, vehicle) and name in names[:k]:
            text = cells.headers[k].text
            raise input_error("identify.beside_another", path, cells.first_line - 1, text, text=shown(text), name=name)
    by_places = "u" not in names and set(PLACES) <= set(names)
    for needed, example in (("t", "t [s]"), ("u", "u [m/s]")):
        if needed not in names and not (needed == "u" and by_places):
            raise InputError(
                f"no column {needed}", f'a column "{example}"' + ", or x, y and psi" * (needed == "u"), file=path,
                line=cells.first_line - 1, column=needed,
                advice="" if columns else 'Columns of other names, or of a file without names: --columns "t [s], x [m], y [m], psi [deg]".',
            )  # fmt: skip
    found: dict[str, Array] = {}
    for name, header in zip(names, cells.headers, strict=True):
        kind = _dimension(name, vehicle)
        if not kind or (name in PLACES and header.unit is None and not by_places):
            continue
        found[name] = signs.get(header.name, 1.0) * _values(cells, header, kind, vehicle, name)
    _rising(found["t"], cells)
    if by_places:
        lacking = tuple(m for m in ("u", "v", "r") if m not in found)
        found = by_positions(found)
        findings = [Finding.of("record.derived", path.name, Severity.NOTE, columns=lacking, places=PLACES)]
        if (ahead := sideways(found)) < FORWARD:
            findings.append(Finding.of("record.sideways", path.name, Severity.FAIL, statistic=ahead, threshold=FORWARD))
    else:
        findings = [*contradicted(found, path.name), *drift(found, path.name)]
    for one in findings:
        if one.severity is Severity.FAIL:
            wording = words(one)
            raise InputError(wording.statement, wording.rule, file=path, advice=wording.advice)
    time = found["t"]
    n = len(time)
    zero = np.zeros(n)
    roll, pitch = (found.get(a, zero) for a in ANGLES)
    commands = {k: v for k, v in found.items() if k not in ("t", *MOTIONS, *CONTROLS, *ANGLES, *PLACES)}
    for thruster in vehicle.thrusters:
        if thruster.lag is not None and thruster.name in commands:
            findings.append(Finding.of("record.lag", thruster.name, Severity.NOTE, statistic=thruster.lag))
    return MotionSeries(
        path.name, time, np.column_stack([found.get(m, zero) for m in MOTIONS]),
        _attitude(roll, pitch), np.column_stack([found.get(c, zero) for c in CONTROLS]),
        _wrench(commands, vehicle, n), frozenset(found), tuple(findings),
    )  # fmt: skip


def _named(path: Path, columns: str) -> tuple[Cells, dict[str, float]]:
    """The cells of any delimited text under names of a person's own, and the signs of its columns."""
    names = [name.strip() for name in columns.split(",")]
    table = raw(path, {"header": -1})
    if len(names) != len(table.columns):
        raise input_error(
            "identify.names_columns", path, column="--columns", count_of_names=len(names), count_of_columns=len(table.columns),
        )  # fmt: skip
    used = [
        (parse_header(name.removeprefix("-").strip()), column)
        for name, column in zip(names, table.columns, strict=True)
        if name != LEFT
    ]
    if not used:
        raise InputError("no name", "names with units, such as t [s]", file=path, column="--columns")
    texts = [column.texts or tuple(map(repr, column.values.tolist())) for _, column in used]
    signs = {h.name: -1.0 for h in (parse_header(n[1:].strip()) for n in names if n.startswith("-") and n != LEFT)}
    lines = tuple(int(n) for n in table.lines)
    return Cells(path, tuple(h for h, _ in used), lines[0], tuple(zip(*texts, strict=True)), lines), signs


def _dimension(name: str, vehicle: Vehicle) -> str:
    """Dimension of a column, empty for one that is passed over."""
    if name == "t":
        return "time"
    if name in LINEAR:
        return "speed"
    if name in ANGULAR:
        return "rate"
    if name in PLACES[:2]:
        return "length"
    if name in (*CONTROLS, *ANGLES, PLACES[2]) or (name.endswith(TILT) and _thruster(name.removesuffix(TILT), vehicle)):
        return "angle"
    if name == THRUST:
        return "force"
    return COMMAND if _thruster(name, vehicle) else ""


def _thruster(name: str, vehicle: Vehicle) -> str:
    return next((t.curve.unit for t in vehicle.thrusters if t.name == name), "")


def _values(cells: Cells, header: Header, kind: str, vehicle: Vehicle, name: str) -> Array:
    """A column in SI, every cell a number."""
    line = cells.first_line - 1
    if kind == COMMAND:
        unit = _thruster(name, vehicle)
        written = require_unit(header, cells.file, line, f"{name} [{unit}]")
        if written not in (COMMAND, unit):
            raise UnitsError(
                f"[{written}]", f"[{unit}], as the thrust curve has it", file=cells.file, line=line, column=header.text
            )
        scale = 1.0
    else:
        written = require_unit(header, cells.file, line, EXAMPLES[kind])
        try:
            scale = factor(written, kind)
        except UnitsError as why:
            raise UnitsError(
                why.found, why.expected, file=cells.file, line=line, column=header.text, advice=why.advice
            ) from None
    with np.errstate(over="ignore"):
        values = cells.numbers(header.name) * scale
    wild = np.flatnonzero(np.abs(values) > LARGEST_NUMBER)
    if len(wild):
        row = int(wild[0])
        raise input_error(
            "identify.finite_number_most", cells.file, cells.line(row), header.text, found=shown(cells.texts(header.name)[row]),
            largest_number=LARGEST_NUMBER,
        )  # fmt: skip
    wrong = np.flatnonzero(~np.isfinite(values))
    if len(wrong):
        row = int(wrong[0])
        text = cells.texts(header.name)[row]
        raise input_error(
            "identify.finite_number_every", cells.file, cells.line(row), header.text,
            found=shown(text) if text else "a blank cell",
        )  # fmt: skip
    return values


def _rising(time: Array, cells: Cells) -> None:
    """Raise unless there are enough times, one after the other."""
    wrong = np.flatnonzero(np.diff(time) <= 0.0)
    header = next(h.text for h in cells.headers if h.name in TIME)
    if len(wrong):
        row = int(wrong[0]) + 1
        found = "twice the time" if time[row] == time[row - 1] else "a time before the last one"
        raise input_error("identify.times_rise", cells.file, cells.line(row), header, found=found, time=time[row])
    if len(time) < FEWEST:
        raise input_error(
            "identify.record_longer_more", cells.file, cells.line(len(time) - 1), header, count_of_time=len(time),
            fewest=FEWEST,
        )  # fmt: skip


def _attitude(roll: Array, pitch: Array) -> Array:
    """(n, 4) quaternions at heading zero (Fossen 2011, appendix E)."""
    cr, sr, cp, sp = np.cos(roll / 2.0), np.sin(roll / 2.0), np.cos(pitch / 2.0), np.sin(pitch / 2.0)
    return np.column_stack([cr * cp, sr * cp, cr * sp, -sr * sp])


def _wrench(commands: dict[str, Array], vehicle: Vehicle, n: int) -> Array:
    """(n, 6) of the thrusters; commands that stand for long are worked out once."""
    if not commands:
        return np.zeros((n, 6))
    rows, place = np.unique(np.column_stack(list(commands.values())), axis=0, return_inverse=True)
    wrenches = np.array([vehicle.wrench(dict(zip(commands, map(float, row), strict=True))) for row in rows])
    return np.asarray(wrenches[place.ravel()])

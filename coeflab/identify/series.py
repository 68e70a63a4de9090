"""A measured or simulated motion as a CSV with a unit in every header."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.limits import LARGEST_NUMBER
from coeflab.core.text.delimited import Cells, read_cells, require_unit
from coeflab.core.types import Array, brief, locked
from coeflab.core.units import Header, factor
from coeflab.law.symbols import ANGULAR, CONTROL_COLUMNS, CONTROLS, LINEAR, MOTIONS
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.parameter_parts import THRUST

FEWEST = 50  # rows: fewer hold no motion from which forces could be told
COMMAND = "command"
TILT = ".tilt"
TIME = {"t": "t", "time": "t"}
ANGLES = ("phi", "theta")
SAME_NAME = {**TIME, **CONTROL_COLUMNS}
EXAMPLES = {
    "time": "t [s]", "speed": "u [m/s]", "rate": "r [rad/s]", "angle": "dr [rad]", "force": "thrust [N]",
}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
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
    """

    file: str
    time: Array
    velocity: Array
    attitude: Array
    controls: Array
    wrench: Array
    given: frozenset[str]

    def __post_init__(self) -> None:
        for name in ("time", "velocity", "attitude", "controls", "wrench"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    @property
    def moving(self) -> frozenset[str]:
        """Motions and controls that vary, or that are not zero."""
        both = np.hstack([self.velocity, self.controls])
        return frozenset(n for n, x in zip((*MOTIONS, *CONTROLS), both.T, strict=True) if np.any(x != 0.0))


def read_series(path: Path, vehicle: Vehicle) -> MotionSeries:
    """Read a time series.

    Columns ``t`` and ``u`` are needed; v w p q r, phi and theta, dr ds db, ``thrust`` and the thrusters of the vehicle (with
    ``.tilt``) are taken where they are, others are passed over.

    Parameters
    ----------
    path : Path
    vehicle : Vehicle
        Whose thrusters the commands are for.

    Raises
    ------
    InputError
        A missing column, a unit that does not fit, a blank cell, text, NaN, times that do not rise, too few rows.
    """
    cells = read_cells(path)
    columns: dict[str, Array] = {}
    for header in cells.headers:
        name = SAME_NAME.get(header.name, header.name)
        kind = _dimension(name, vehicle)
        if not kind:
            continue
        if name in columns:
            raise InputError(
                f"{shown(header.text)} beside another {name}", "one of them", file=path, line=cells.first_line - 1,
                column=header.text,
            )  # fmt: skip
        columns[name] = _values(cells, header, kind, vehicle, name)
    for needed, example in (("t", "t [s]"), ("u", "u [m/s]")):
        if needed not in columns:
            raise InputError(
                f"no column {needed}", f'a column "{example}"', file=path, line=cells.first_line - 1, column=needed
            )
    time = columns["t"]
    _rising(time, cells)
    n = len(time)
    zero = np.zeros(n)
    roll, pitch = (columns.get(a, zero) for a in ANGLES)
    commands = {k: v for k, v in columns.items() if k not in ("t", *MOTIONS, *CONTROLS, *ANGLES)}
    return MotionSeries(
        path.name, time, np.column_stack([columns.get(m, zero) for m in MOTIONS]),
        _attitude(roll, pitch), np.column_stack([columns.get(c, zero) for c in CONTROLS]),
        _wrench(commands, vehicle, n), frozenset(columns),
    )  # fmt: skip


def _dimension(name: str, vehicle: Vehicle) -> str:
    """Dimension of a column, empty for one that is passed over."""
    if name == "t":
        return "time"
    if name in LINEAR:
        return "speed"
    if name in ANGULAR:
        return "rate"
    if name in (*CONTROLS, *ANGLES) or (name.endswith(TILT) and _thruster(name.removesuffix(TILT), vehicle)):
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
        raise InputError(
            shown(cells.texts(header.name)[row]), f"a finite number of at most {LARGEST_NUMBER:g} in SI", file=cells.file,
            line=cells.line(row), column=header.text,
        )  # fmt: skip
    wrong = np.flatnonzero(~np.isfinite(values))
    if len(wrong):
        row = int(wrong[0])
        text = cells.texts(header.name)[row]
        raise InputError(
            shown(text) if text else "a blank cell", "a finite number in every row", file=cells.file,
            line=cells.line(row), column=header.text, advice="Remove the row; steps need not be even.",
        )  # fmt: skip
    return values


def _rising(time: Array, cells: Cells) -> None:
    """Raise unless there are enough times, one after the other."""
    wrong = np.flatnonzero(np.diff(time) <= 0.0)
    header = next(h.text for h in cells.headers if h.name in TIME)
    if len(wrong):
        row = int(wrong[0]) + 1
        found = "twice the time" if time[row] == time[row - 1] else "a time before the last one"
        raise InputError(
            f"{found}, {time[row]:.9g} s", "times that rise", file=cells.file, line=cells.line(row), column=header,
            advice="Sort the rows by time, and keep one row a time.",
        )  # fmt: skip
    if len(time) < FEWEST:
        raise InputError(
            f"{len(time)} rows", f"{FEWEST} or more", file=cells.file, line=cells.line(len(time) - 1), column=header,
            advice="Record longer, or more often.",
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

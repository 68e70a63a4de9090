"""Thrust and torque curves of a rotor from a bench: steps of the command, steady stretches, least squares.

T = a n + b n^2 and Q = c n + d n^2, as equations 41 to 48 of the TJ-FlyingFish paper have them with their constants unsquared.
Each steady stretch counts once, however long it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.table import ABSENT, Table, number
from coeflab.core.text.delimited import Cells, read_cells, require_unit
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.core.units import factor
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import CurveSegment, ParameterCurve, ParameterThruster

LOADS = {"thrust": ("T", "thrust", "force", "N"), "torque": ("Q", "torque", "moment", "N*m")}
WINDOW, STEADY = 0.5, 0.01  # s, and of the largest command: what the command may change by within it
FEWEST_ROWS, FEWEST_STRETCHES = 5, 4
LAWS, SIDES = ("n", "n^2"), ("n^2 ahead", "n^2 astern")


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("value u95 file_value")
class LoadLaw:
    """One load over the command.

    Attributes
    ----------
    load : {"thrust", "torque"}
    unit : str
        N or N m.
    value, u95 : (2,) array
        Factors of n and n^2, or of n^2 ahead and astern where the test goes through zero, and their 95 % half-widths, from the
        scatter of the stretches about the law.
    file_value : (2,) array or None
        Of the parameter file, where its curve is one polynomial of this form.
    rest, rest_u95 : float
        Load at no speed where a constant is fitted too.
    scatter : float
        Standard deviation of the stretches about the law.
    """

    load: str
    unit: str
    value: Array
    u95: Array
    file_value: Array | None
    rest: float
    rest_u95: float
    scatter: float

    @property
    def biased(self) -> bool:
        """Whether the balance reads a load at rest."""
        return abs(self.rest) > self.rest_u95


@brief
@dataclass(frozen=True, slots=True, eq=False)
class BenchTest:
    """What a bench test gives.

    Attributes
    ----------
    thruster, unit : str
        Name in the parameter file, and unit of its command.
    files : tuple of str
    command : (k,) array
        Mean of each steady stretch.
    rows : (k,) array
        How many rows each stretch has.
    loads : dict of str to (k,) array
        Means of thrust and torque.
    laws : tuple of LoadLaw
    statements : tuple of str
    """

    thruster: str
    unit: str
    files: tuple[str, ...]
    command: Array
    rows: Array
    loads: dict[str, Array]
    laws: tuple[LoadLaw, ...]
    statements: tuple[str, ...]

    @property
    def factors(self) -> tuple[str, str]:
        """What the two numbers of a law multiply."""
        return SIDES if _both_sides(self.command) else LAWS

    def at(self, law: LoadLaw, command: Array) -> Array:
        """Load of a law at commands (n,)."""
        return np.asarray(_design(command, command**2, _both_sides(self.command)) @ law.value)

    def as_json(self) -> dict[str, Any]:
        """Factors, stretches and statements as one JSON object."""
        return {
            "thruster": self.thruster,
            "series": list(self.files),
            "unit": self.unit,
            "curves": [
                {
                    "load": law.load, "unit": law.unit, "factors": list(self.factors), "value": law.value.tolist(),
                    "u95": law.u95.tolist(), "file_value": None if law.file_value is None else law.file_value.tolist(),
                    "rest": law.rest, "rest_u95": law.rest_u95, "scatter": law.scatter,
                }
                for law in self.laws
            ],
            "stretches": [
                {"command": float(n), "rows": int(k)} | {law.load: float(self.loads[law.load][i]) for law in self.laws}
                for i, (n, k) in enumerate(zip(self.command, self.rows, strict=True))
            ],
            "statements": list(self.statements),
        }  # fmt: skip

    def table(self) -> Table:
        """Factors beside those of the parameter file."""
        rows = []
        for law in self.laws:
            for k, name in enumerate(self.factors):
                stated = None if law.file_value is None else float(law.file_value[k])
                agrees = "" if stated is None else "yes" if abs(law.value[k] - stated) <= law.u95[k] else "no"
                unit = f"{law.unit}/{self.unit}{'^2' if '^2' in name else ''}"
                cells = (number(float(law.value[k]), 5), number(float(law.u95[k]), 2))
                rows.append(
                    (f"{law.load}, {name}", *cells, unit, ABSENT if stated is None else number(stated, 5), agrees)
                )
        headers = ("factor", "value", "U95", "unit", "file", "agrees")
        return Table(f"Curves of {self.thruster}", headers, tuple(rows), self.statements, frozenset({0, 3, 5}))


def bench_test(files: Sequence[Path], parameters: ParameterFile, name: str, window: float = WINDOW) -> BenchTest:
    """Identify thrust and torque of a rotor.

    Parameters
    ----------
    files : sequence of Path
        Columns ``t``, the command by the thruster's name or its command (``speed [rpm]``), ``T [N]`` and, where it was measured,
        ``Q [N*m]``; of a rotor that turns astern below zero, all three.
    parameters : ParameterFile
    name : str
        Of its thruster.
    window : float
        s; the command is steady where it changes by less than 1 % of its largest value within it.

    Raises
    ------
    InputError
        No such thruster, a missing column or unit, no number in a cell, fewer than four steady stretches at different commands.
    """
    thruster = next((t for t in parameters.thrusters if t.name == name), None)
    if thruster is None:
        known = ", ".join(t.name for t in parameters.thrusters) or "none: the file has no thrusters"
        raise InputError(f"the thruster {shown(name)}", f"one of {known}", column="--thruster")
    means: list[Array] = []
    counts: list[int] = []
    for file in files:
        found = _stretches(file, thruster, window)
        means += [m for m, _ in found]
        counts += [n for _, n in found]
    if len(means) < FEWEST_STRETCHES:
        raise input_error(
            "identify.steady_stretches_rows", files[0], column="--window", count_of_means=len(means), fewest_rows=FEWEST_ROWS,
            fewest_stretches=FEWEST_STRETCHES,
        )  # fmt: skip
    table = np.array(means)
    table[np.abs(table[:, 0]) <= STEADY * np.max(np.abs(table[:, 0])), :2] = (
        0.0  # at rest; a tachometer's noise turns no rotor astern
    )
    command, squares = table[:, 0], table[:, 1]
    design = _design(command, squares, _both_sides(command))
    laws = []
    for k, load in enumerate(LOADS, 2):
        if np.isfinite(table[:, k]).all():
            laws.append(_law(load, thruster, design, table[:, k], _both_sides(command)))
    words = [
        f"{len(command)} steady stretches of {min(counts)} to {max(counts)} rows, {command.min():.5g} to {command.max():.5g} "
        f"{thruster.curve.unit}; each counts once",
        "U95 from the scatter of the stretches about the law; errors that all share, of balance and of speed, are not in it",
    ]
    words += [
        f"a constant fitted too is {law.rest:.2g} +- {law.rest_u95:.2g} {law.unit}: the balance reads a {law.load} at rest"
        for law in laws
        if law.biased
    ]
    loads = {load: table[:, k] for k, load in enumerate(LOADS, 2)}
    return BenchTest(
        name,
        thruster.curve.unit,
        tuple(f.name for f in files),
        command,
        np.array(counts),
        loads,
        tuple(laws),
        tuple(words),
    )


def with_curves(parameters: ParameterFile, found: BenchTest) -> ParameterFile:
    """The file with the curves of a bench test in the place of its thruster's, over the commands that were tested.

    Where a n + b n^2 falls somewhere, which no thruster's curve may, and where the test goes through zero to both sides, the curve is
    b n|n| of least squares alone, on each side of zero by its own stretches, and a note says so with their scatter about it. Thrust
    and torque have the sign of the command.

    Parameters
    ----------
    parameters : ParameterFile
    found : BenchTest

    Raises
    ------
    InputError
        A load that has not the sign of its command.
    """
    thruster = next(t for t in parameters.thrusters if t.name == found.thruster)
    curves, words = {}, []
    for load, law in zip(found.loads, found.laws, strict=False):
        old = thruster.curve if load == "thrust" else thruster.torque_curve or thruster.curve
        low, high = float(np.min(found.command)), float(np.max(found.command))
        a, b = (float(v) for v in law.value)
        ends = (min(low, 0.0), max(high, 0.0))
        plain = CurveSegment(low=ends[0], high=ends[1], coefficients=(0.0, a, b))
        curve = ParameterCurve(command=old.command, unit=old.unit, segments=(plain,))
        if low < 0.0 < high or (load == "thrust" and curve.falls_at() is not None):
            sides = [_side(load, found, sign) for sign in (-1.0, 1.0) if np.any(sign * found.command > 0.0)]
            curve = ParameterCurve(command=old.command, unit=old.unit, segments=tuple(piece for piece, _ in sides))
            words.append(
                f"{load} of {found.thruster} by n^2 on each side of zero: a n + b n^2 falls or the test goes through zero; "
                + "; ".join(text for _, text in sides)
            )
        curves["curve" if load == "thrust" else "torque_curve"] = curve
    result = thruster.model_copy(update=curves)
    notes = (
        *parameters.provenance.notes,
        f"curve of {found.thruster} from its bench test: {', '.join(found.files)}",
        *words,
    )
    return parameters.model_copy(
        update={
            "thrusters": tuple(result if t.name == found.thruster else t for t in parameters.thrusters),
            "provenance": parameters.provenance.model_copy(update={"notes": notes}),
        }
    )


def _side(load: str, found: BenchTest, sign: float) -> tuple[CurveSegment, str]:
    """The curve of the square of the command alone for the commands of one sign, and its scatter, a sentence."""
    at = sign * found.command > 0.0
    squares, values = found.command[at] ** 2, found.loads[load][at]
    slope = float(squares @ values / (squares @ squares))
    side = "ahead" if sign > 0.0 else "astern"
    if sign * slope <= 0.0:
        raise input_error("identify.one_sign_command", column="--thruster", load=load, side=side, slope=slope)
    end = float(np.max(np.abs(found.command[at])))
    low, high = (0.0, end) if sign > 0.0 else (-end, 0.0)
    stretches, unit = int(np.count_nonzero(at)), LOADS[load][3].replace("*", " ")
    left = values - slope * squares
    scatter = f"scatter {np.sqrt(left @ left / (stretches - 1)):.2g} {unit} of {stretches} stretches"
    text = f"{side} {slope:.5g} n^2, {scatter if stretches > 1 else 'one stretch, no scatter'}"
    return CurveSegment(low=low, high=high, coefficients=(0.0, 0.0, slope)), text


def _both_sides(command: Array) -> bool:
    """Whether a test goes through zero, where a n + b n^2 would be even in part."""
    return bool(np.min(command) < 0.0 < np.max(command))


def _design(command: Array, squares: Array, sides: bool) -> Array:
    """(n, 2) columns that the factors of a law multiply."""
    if not sides:
        return np.column_stack([command, squares])
    return np.column_stack([np.where(sign * command > 0.0, squares, 0.0) for sign in (1.0, -1.0)])


def _law(load: str, thruster: ParameterThruster, design: Array, values: Array, sides: bool) -> LoadLaw:
    from scipy.special import stdtrit

    scale = np.max(np.abs(design), axis=0)

    def fitted(columns: Array) -> tuple[Array, Array, float]:
        found, _, rank, _ = np.linalg.lstsq(columns, values, rcond=None)
        freedom = len(values) - int(rank)
        if rank < columns.shape[1] or freedom < 1:
            raise input_error(
                "identify.different_commands", column="--thruster", count_of_unique=len(np.unique(np.round(columns[:, 0], 6))),
            )  # fmt: skip
        left = values - columns @ found
        variance = float(left @ left) / freedom
        spread = np.sqrt(variance * np.diag(np.linalg.inv(columns.T @ columns)))
        return np.asarray(found, dtype=np.float64), float(stdtrit(freedom, 0.975)) * spread, float(np.sqrt(variance))

    value, u95, scatter = fitted(design / scale)
    rest, rest_u95, _ = fitted(np.column_stack([design / scale, np.ones(len(values))]))
    curve = thruster.curve if load == "thrust" else thruster.torque_curve
    stated = None
    if curve is not None and len(curve.segments) == 1 and not sides:
        factors = np.zeros(12)
        factors[: len(curve.segments[0].coefficients)] = curve.segments[0].coefficients
        stated = None if np.any(factors[[0, *range(3, 12)]]) else factors[1:3]
    unit = LOADS[load][3].replace("*", " ")
    return LoadLaw(load, unit, value / scale, u95 / scale, stated, float(rest[2]), float(rest_u95[2]), scatter)


def _stretches(file: Path, thruster: ParameterThruster, window: float) -> list[tuple[Array, int]]:
    """Means of command, its square, thrust and torque over each steady stretch, and its rows."""
    cells = read_cells(file)
    time = _column(cells, ("t", "time"), "time", "t [s]")
    unit = thruster.curve.unit
    command = _column(cells, (thruster.name, thruster.curve.command), "", f"{thruster.curve.command} [{unit}]", unit)
    _rising(time, cells)
    loads = [
        _column(cells, (short, long), dimension, f"{short} [{si}]", optional=short == "Q")
        for short, long, dimension, si in LOADS.values()
    ]
    smooth = _median(command)
    low, high = np.searchsorted(time, time - window / 2.0), np.searchsorted(time, time + window / 2.0, side="right")
    size = STEADY * float(np.max(np.abs(smooth)))
    steady = np.array([np.ptp(smooth[a:b]) <= size for a, b in zip(low, high, strict=True)])
    inside = (time - window / 2.0 >= time[0]) & (time + window / 2.0 <= time[-1])
    rows = np.column_stack([command, command**2, *loads])
    # A new stretch begins where the last steady row is no neighbour, or where the command has crept on.
    number = np.cumsum(np.diff(np.concatenate([[0], (steady & inside).astype(int)])) == 1)
    out = []
    for k in np.unique(number[steady & inside]):
        at = steady & inside & (number == k)
        if np.count_nonzero(at) >= FEWEST_ROWS:
            out.append((np.asarray(np.mean(rows[at], axis=0)), int(np.count_nonzero(at))))
    return out


def _rising(time: Array, cells: Cells) -> None:
    """Raise where a time is not after the last one."""
    wrong = np.flatnonzero(np.diff(time) <= 0.0)
    if len(wrong):
        row = int(wrong[0]) + 1
        raise InputError(f"{time[row]:.9g} s", "times that rise", file=cells.file, line=cells.line(row), column="t")


def _median(values: Array, half: int = 2) -> Array:
    """Running median of five."""
    padded = np.pad(values, half, mode="edge")
    return np.asarray(np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1), axis=1))


def _column(
    cells: Cells, names: Sequence[str], dimension: str, example: str, unit: str = "", optional: bool = False
) -> Array:
    """A column by one of its names, in SI, or as it stands where its unit is that of the command."""
    header = next((h for h in cells.headers if h.name in names), None)
    line = cells.first_line - 1
    if header is None:
        if optional:
            return np.full(len(cells), np.nan)
        raise input_error(
            "identify.unit_of_column", cells.file, line, names[0], names=" or ".join(names), example=example
        )
    written = require_unit(header, cells.file, line, example)
    if unit and written != unit:
        raise UnitsError(
            f"[{written}]", f"[{unit}], as the curve has it", file=cells.file, line=line, column=header.text
        )
    values = cells.numbers(header.name) * (1.0 if unit else factor(written, dimension))
    wrong = np.flatnonzero(~np.isfinite(values))
    if len(wrong):
        raise input_error("identify.blank_cell", cells.file, cells.line(int(wrong[0])), header.text)
    return np.asarray(values)

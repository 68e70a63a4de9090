"""Coefficients that somebody keeps in a sheet: a row a symbol with value, unit and U95, or a column a symbol, read as if typed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from coeflab.core.axes import parse_axes
from coeflab.core.errors import InputError, shown, together
from coeflab.core.files import readable
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.texts import input_error
from coeflab.core.wording import listed
from coeflab.law.symbols import CONTROLS, derivative, read_factors, respelled
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.reading import GENERAL, recognised
from coeflab.vehicle.own_numbers import OwnNumber, own_number
from coeflab.vehicle.parameter_file import ParameterFile

PRIMES, SI = ("-", "1", "prime", "primed", "nondimensional", "non-dimensional", "dimensionless"), ("si", "value_si")
UNITS, HALVES = ("unit", "units", "unit_si"), ("u95", "+-", "+/-", "\u00b1")
VALUES = ("value", "values", "wert", *PRIMES, *SI)
TURNED = frozenset("YZMNvwqr")  # by FLU; | | turns nothing
MOST = 8  # names of what is not taken
PRIME = "'"
KINDS = "a prime, Yv' or the unit 1, or SI, Yv with N/(m/s)"


class Listed(NamedTuple):
    """What a sheet gives, and what of it is not taken, each with its line."""

    numbers: tuple[OwnNumber, ...]
    left: tuple[str, ...]


class _Cell(NamedTuple):
    symbol: str
    value: float
    unit: str
    u95: float
    line: int


def read_coefficient_list(path: Path, axes: str, options: Mapping[str, Any] | None = None) -> Listed:
    """The numbers of a text table or spreadsheet.

    Parameters
    ----------
    path : Path
        A column of symbols beside one of values, and where there are such of units and U95; or a column a symbol over one row.
        A symbol with its prime is a prime; one without has a unit, or a column named ``prime`` or ``SI``.
    axes : str
        FRD or FLU, in which the signs hold.
    options : mapping, optional
        Of the reader: ``sheet``, ``decimal`` ...

    Raises
    ------
    InputError
        No symbols, no or several columns of values, neither a prime nor a unit, a control in FLU.
    """
    if not axes.strip():
        raise InputError("no axes", "FRD or FLU, in which the signs of the file hold", column="--axes",
                         advice="Add --axes: Kv', Yp', Z0' and M0' turn between them, Yv', Nv', Zw', Mw', Yr', Nr' do not.")  # fmt: skip
    frame = parse_axes(axes, key="--axes").name
    if frame not in ("FRD", "FLU"):
        raise InputError(frame, "FRD or FLU", column="--axes")
    if path.suffix.casefold() == ".json":
        raise InputError("JSON", "a text table or a spreadsheet", file=path,
                         advice="Numbers of a parameter file go into another by: coeflab merge.")  # fmt: skip
    name = next((n for n in recognised(readable(path)) if IMPORTERS.load(n).raw), GENERAL)
    raw = IMPORTERS.load(name).raw(path, dict(options or {}))  # type: ignore[misc]  # has one, see above
    left: list[str] = []
    numbers, complaints = [], []
    for cell in _by_columns(raw, left) or _by_rows(raw, left):
        try:
            numbers.append(_turned(_number(cell), frame))
        except InputError as why:
            complaints.append(InputError(why.found, why.expected, file=path, line=cell.line or None, advice=why.advice))
    if complaints:
        raise together(complaints)
    if not numbers:
        raise InputError("no coefficient", "symbols such as Yv' with a number each", file=path)
    return Listed(tuple(numbers), (*left, *(text.removesuffix(".") for text in raw.remarks)))


def with_sheet(file: ParameterFile, sheet: Listed, path: Path) -> ParameterFile:
    """A file of numbers of a sheet, with its sha256 and what of it is not taken."""
    notes = (
        *file.provenance.notes,
        f"numbers of {path.name}",
        *(f"not taken of {path.name}: {text}" for text in sheet.left),
    )
    inputs = (*file.provenance.inputs, InputFile(path.name, sha256_of(path)))
    return file.model_copy(update={"provenance": file.provenance.model_copy(update={"inputs": inputs, "notes": notes})})


def _word(name: str) -> str:
    return name.strip().strip("[]()").casefold()


def _line(raw: RawTable, row: int) -> int:
    return int(raw.lines[row]) if len(raw.lines) else 0


def _symbol(text: str) -> str:
    """A derivative as it is written, with its prime; empty where it is none."""
    name = respelled(text)
    is_prime = text.strip().endswith(("'", "\u2019", "\u2032", "\u00b4"))
    return f"{name}'" if name and is_prime else name


def _by_columns(raw: RawTable, left: list[str]) -> list[_Cell]:
    """A column a symbol, over one row of numbers; empty where rows are symbols."""
    named = [c for c in raw.columns if not c.is_text and _symbol(c.name)]
    if len(raw) != 1 or not named:
        return []
    _leave([c.name for c in raw.columns if not any(c is one for one in named)], left)
    return [_Cell(_symbol(c.name), float(c.values[0]), c.unit, np.nan, _line(raw, 0)) for c in named]


def _leave(others: Sequence[str], left: list[str]) -> None:
    """Name columns that are not taken."""
    if others:
        more = f" and {len(others) - MOST} more" * (len(others) > MOST)
        left.append(f"columns {', '.join(others[:MOST])}{more}")


def _by_rows(raw: RawTable, left: list[str]) -> Iterator[_Cell]:
    """A row a symbol; what is no derivative or has no number is left, with its line."""
    texts = [c for c in raw.columns if c.is_text]
    symbols = max(texts, key=lambda c: sum(bool(_symbol(t)) for t in c.texts), default=None)
    if symbols is None or not any(map(_symbol, symbols.texts)):
        raise input_error("vehicle.column_symbols", raw.path)
    halves = next((c for c in raw.columns if not c.is_text and _word(c.name) in HALVES), None)
    units = next((c for c in raw.columns if _word(c.name) in UNITS and c is not symbols), None)
    values = _values(raw, [symbols, halves, units])
    of_all = values.unit or next((w for w in (_word(values.name),) if w in (*PRIMES, *SI)), "")
    for row, text in enumerate(symbols.texts):
        symbol, value = _symbol(text), float(values.values[row])
        if symbol and np.isfinite(value):
            line = _line(raw, row)
            own = "" if units is None else units.texts[row].strip() if units.is_text else f"{units.values[row]:g}"
            unit = (
                _one_unit(of_all, "" if units is not None and _word(units.name) == "unit_si" else own, raw, line) or own
            )
            u95 = np.nan if halves is None else _half(float(halves.values[row]), value, halves.unit, unit, raw, line)
            yield _Cell(symbol, value, unit, u95, _line(raw, row))
        elif text.strip():
            left.append(f"{text.strip()} (line {_line(raw, row)}, no {'number' if symbol else 'derivative'})")
    used = [c for c in (symbols, values, units, halves) if c is not None]
    _leave([c.name for c in raw.columns if not any(c is one for one in used)], left)


def _one_unit(of_all: str, own: str, raw: RawTable, line: int) -> str:
    """The unit of a row, of the whole column or its own, where they do not contradict each other; empty where the column has none."""
    if not of_all or not own:
        return of_all
    pure = [_word(u) in PRIMES for u in (of_all, own)]
    if _word(of_all) in SI and not pure[1]:
        return own
    if pure[0] != pure[1] or (not pure[0] and own != of_all):
        raise input_error("vehicle.unit_beside_values", raw.path, line, own=shown(own), of_all=shown(of_all))
    return of_all


def _half(half: float, value: float, its: str, unit: str, raw: RawTable, line: int) -> float:
    """A half-width in the unit of its value."""
    if its == "%":
        return half * abs(value) / 100.0
    if its not in ("", "-", unit):
        raise input_error("vehicle.unit_value", raw.path, line, its=shown(its), value=shown(unit or "no unit"))
    return half


def _values(raw: RawTable, others: Sequence[RawColumn | None]) -> RawColumn:
    """The one column of values."""
    found = [c for c in raw.columns if not any(c is one for one in others) and np.any(np.isfinite(c.values))]
    named = [c for c in found if _word(c.name) in VALUES]
    chosen = [c for c in named if _word(c.name) == "value"] or named
    if len(chosen) != 1:
        seen = chosen or found
        raise input_error(
            "vehicle.one_values_named", raw.path, raw.header_line or None,
            value="columns of numbers " + listed([shown(c.name) for c in seen]) if seen else "no column of numbers",
            values=VALUES[0], halves=HALVES[0],
        )  # fmt: skip
    return chosen[0]


def _number(cell: _Cell) -> OwnNumber:
    d = derivative(cell.symbol)
    is_prime = cell.symbol.endswith("'") or _word(cell.unit) in PRIMES
    if not is_prime and not cell.unit:
        raise input_error("vehicle.neither_prime_nor", text=d.text, expected=KINDS, unit=d.unit)
    unit = "" if is_prime else d.unit if _word(cell.unit) in SI else cell.unit
    if cell.symbol.endswith("'") and _word(cell.unit) not in ("", *PRIMES):
        raise InputError(f"the unit {shown(cell.unit)} beside the prime {cell.symbol}", KINDS)
    half = f" +- {cell.u95!r}" if np.isfinite(cell.u95) else ""
    return own_number(f"{d.text}{PRIME * is_prime}={cell.value!r}{half} {unit}")


def _turned(number: OwnNumber, frame: str) -> OwnNumber:
    """With the sign that it has in FRD."""
    if frame == "FRD":
        return number
    d = derivative(number.symbol)
    if set(d.factors) & set(CONTROLS):
        raise input_error("vehicle.signs_frd", symbol=number.symbol)
    factors: Sequence[tuple[str, bool]] = read_factors(d.text[1:]) or ()
    turns = [d.component, *(name.removesuffix("dot") for name, absolute in factors if not absolute)]
    return replace(number, value=number.value * (-1.0) ** sum(t in TURNED for t in turns))

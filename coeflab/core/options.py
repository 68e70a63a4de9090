"""Options of plugins: a frozen dataclass of bounded numbers and words, filled from a plan or a command line."""

from __future__ import annotations

import dataclasses
import difflib
import math
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np

from coeflab.core.declarations import Declaration, Takes, key_of, meanings, taken
from coeflab.core.errors import InputError, shown, together
from coeflab.core.text.toml import value as toml_value
from coeflab.core.units import SI, quantity, with_unit

Options = TypeVar("Options")
TURNING = {"angle": "deg", "rate": "deg/s"}  # unit of a bare number on the command line


def bounded(default: float, low: float, high: float, *, degrees: bool = False) -> Any:
    """A dataclass field with bounds; an int default takes whole numbers only.

    Parameters
    ----------
    default, low, high : float
        The bounds are allowed values.
    degrees : bool
        An angle whose bare number is in degrees everywhere; a text has its unit, ``"0.1 rad"``.
    """
    whole = isinstance(default, int) and not isinstance(default, bool)
    kind = "whole number" if whole else "number"

    def read(value: Any, _file: Path) -> float:
        if degrees and isinstance(value, str):
            value = math.degrees(with_unit(value, "angle"))
        right = not isinstance(value, bool) and isinstance(value, int if whole else (int, float))
        if not right or not low <= value <= high:
            raise InputError(shown(value), f"a {kind} from {low:g} to {high:g}")
        return cast(float, value)

    within = f"{low:.10g} to {high:.10g}"
    return _option(default, f"angle, {within} deg, bare or with its unit" if degrees else f"{kind}, {within}", read)


def measured(default: float, low: float, high: float, dimension: str, frequency: bool = False) -> Any:
    """A dataclass field that takes an SI number, or a text with its unit (``"0.05 m^2"``); bounds in SI.

    Parameters
    ----------
    default, low, high : float
        SI; the bounds are allowed values.
    dimension : str
        Key of `coeflab.core.units.SI`.
    frequency : bool
        Whether a rate is a circular frequency, which is bare in rad/s everywhere, and no rate of turn.
    """

    def read(value: Any, _file: Path) -> float:
        number = quantity(value, dimension)
        if not low <= number <= high:
            degrees = dimension == "angle" and not isinstance(value, str) and low <= math.radians(number) <= high
            advice = f'Degrees are written "{value:g} deg".' if degrees else ""
            raise InputError(shown(value), f"{low:g} to {high:g} {SI[dimension]}".rstrip(), advice=advice)
        return number

    turns = dimension in TURNING and not frequency
    bare = (
        f"with its unit, bare in {TURNING[dimension]} on the command line"
        if turns
        else f"bare in {SI[dimension]} or with its unit"
    )
    return _option(default, f"{dimension}, {bare}", read, SI[dimension], TURNING[dimension] if turns else "")


def share(default: float, low: float, high: float) -> Any:
    """A dataclass field that takes a share of one, or a text in per cent (``"2 %"``).

    Parameters
    ----------
    default, low, high : float
        Of one; the bounds are allowed values.
    """

    def read(value: Any, _file: Path) -> float:
        number = value
        if isinstance(value, str) and value.rstrip().endswith("%"):
            try:
                number = float(value.rstrip()[:-1]) / 100.0
            except ValueError:
                number = None
        if isinstance(number, bool) or not isinstance(number, (int, float)) or not low <= number <= high:
            raise InputError(shown(value), f"a share from {low:g} to {high:g}, or in per cent such as 2%")
        return float(number)

    return _option(default, f"share, {low:g} to {high:g}, or in per cent (2%)", read)


def one_of(default: str, *choices: str) -> Any:
    """A dataclass field that takes one of some words."""

    def read(value: Any, _file: Path) -> str:
        if value not in choices:
            near = difflib.get_close_matches(str(value), choices, n=1)
            known = ", ".join(c or '""' for c in choices)
            raise InputError(shown(value), f"one of {known}", advice=f"Did you mean {near[0]}?" if near else "")
        return cast(str, value)

    return _option(default, ", ".join(dict.fromkeys(c or '""' for c in choices)), read)


def orders() -> Any:
    """A dataclass field that takes orders such as left=60 rotor1.tilt=1.5, words or a mapping, angles in rad; on the command line in deg."""

    def read(value: Any, file: Path) -> tuple[str, ...]:
        return _words([f"{k}={v}" for k, v in value.items()] if isinstance(value, Mapping) else value, file)

    result = _option((), "words", read)
    return dataclasses.field(default=result.default, metadata={**result.metadata, "orders": True})


def words(*default: str) -> Any:
    """A dataclass field that takes a list of words; a text is split at commas and blanks."""
    return _option(default, "words", _words)


def _words(value: Any, _file: Path) -> tuple[str, ...]:
    items = value.replace(",", " ").split() if isinstance(value, str) else value
    if not isinstance(items, (list, tuple)) or not all(isinstance(i, str) for i in items):
        raise InputError(shown(value), "a list of words")
    return tuple(items)


def text(default: str) -> Any:
    """A dataclass field that takes one line of text; a whole number counts as its digits."""

    def read(value: Any, _file: Path) -> str:
        digits = isinstance(value, int) and not isinstance(value, bool)
        if not (digits or isinstance(value, str)) or len(line := str(value)) > 200 or not line.isprintable():
            raise InputError(shown(value), "a line of text, or a whole number")
        return line

    return _option(default, "text", read)


def _option(default: Any, takes: str, read: Callable[[Any, Path], Any], unit: str = "", bare: str = "") -> Any:
    return dataclasses.field(default=default, metadata={"takes": Takes(takes, read, {}), "unit": unit, "bare": bare})


@dataclasses.dataclass(frozen=True, slots=True)
class Described:
    """An option as a reader sees it: name, what it takes, default and meaning."""

    name: str
    takes: str
    default: str
    meaning: str


@dataclasses.dataclass(frozen=True, slots=True)
class NoOptions:
    """What a plugin without options takes."""


def described(kind: type) -> tuple[Described, ...]:
    """Every option of an options dataclass or a declaration, its meaning from the Attributes of the docstring."""
    phrases = meanings(kind)
    if issubclass(kind, Declaration):
        keys = taken(kind)
        return tuple(
            Described(key_of(f.name), _with_unit(keys[f.name]), _default_of(f), phrases.get(f.name, ""))
            for f in dataclasses.fields(cast(Any, kind))
        )
    return tuple(
        Described(f.name, f.metadata["takes"].words, _default(f), phrases.get(f.name, ""))
        for f in dataclasses.fields(cast(Any, kind))
    )


def _with_unit(key: Takes) -> str:
    unit = key.schema.get("unit", "1")
    if "enum" in key.schema:
        return ", ".join(toml_value(word) for word in key.schema["enum"])
    if unit == SI["angle"]:
        return f"{key.words} with its unit"
    return key.words if unit == "1" else f"{key.words}, bare in {unit} or with its unit"


def _default_of(field: dataclasses.Field[Any]) -> str:
    """The default of a key as a file would have it; empty of one that must be given or is found by itself."""
    result = field.default if field.default_factory is dataclasses.MISSING else field.default_factory()
    if result is dataclasses.MISSING or result is None or isinstance(result, (Mapping, np.ndarray)):
        return ""
    return toml_value(list(result) if isinstance(result, tuple) else result)


def _default(field: dataclasses.Field[Any]) -> str:
    value = field.default
    if isinstance(value, tuple):
        return " ".join(value) or "none"
    unit = field.metadata["unit"]
    if bare := field.metadata.get("bare", ""):
        return f"{math.degrees(cast(float, value)):.10g} {bare}"
    text = value if isinstance(value, str) else f"{value:.10g} {unit}".rstrip()
    return text or '""'


def parse_options(kind: type[Options], given: Mapping[str, Any], where: str) -> Options:
    """Fill an options dataclass.

    Parameters
    ----------
    kind : type
        The dataclass.
    given : mapping of str to value
    where : str
        Stands before the option's name in an error.

    Raises
    ------
    InputError
        One message with every unknown option, wrong type and value out of bounds.
    """
    filled: dict[str, Any] = {}
    complaints = []
    fields = {f.name: f.metadata["takes"] for f in dataclasses.fields(cast(Any, kind))}
    explained = f"`coeflab formats {where}` explains every option."
    for name, value in given.items():
        if name not in fields:
            near = difflib.get_close_matches(name, fields, n=1)
            advice = (f"Did you mean {near[0]}? " if near else "") + explained
            unknown = f"the unknown option {shown(name)}"
            known = f"one of {', '.join(fields)}" if fields else "none: it has no options"
            complaints.append(InputError(unknown, known, column=where, advice=advice))
            continue
        try:
            filled[name] = fields[name].read(value, Path())
        except InputError as why:
            advice = f"{why.advice} {explained}".lstrip()
            complaints.append(type(why)(why.found, why.expected, column=f"{where}.{name}", advice=advice))
    if complaints:
        raise together(complaints)
    return kind(**filled)


RAD_AT_MOST = 1.6  # a bare angle below was typed in rad, as it was read until 1.0, as likely as in degrees


def in_degrees(kind: type, given: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Options as a command line has them: an angle without a unit is in degrees, a rate of turn in deg/s.

    Parameters
    ----------
    kind : type
        The dataclass.
    given : mapping of str to value
    where : str
        Stands before the option's name in an error.

    Raises
    ------
    InputError
        An angle or a rate between 0 and 1.6 without a unit, which may have been meant in rad.
    """
    out = dict(given)
    for name, unit in _bare_turns(kind, given).items():
        what = "an angle" if unit == TURNING["angle"] else "a rate"
        value = given[name]
        if 0.0 < abs(value) < RAD_AT_MOST:
            radians = unit.replace("deg", "rad")
            degrees = "degrees" if unit == TURNING["angle"] else unit
            raise InputError(
                f"{value}, {what} without a unit", f'{degrees}, at least {RAD_AT_MOST:g}, or a unit: "{value} {unit}"',
                column=f"{where}.{name}", advice=f'{"Radians are" if unit == TURNING["angle"] else "In radians it is"} written "{value} {radians}".',
            )  # fmt: skip
        out[name] = f"{value!r} {unit}"
    return out


def of_a_file(kind: type, given: Mapping[str, Any], where: str) -> Mapping[str, Any]:
    """Options as a file has them, whose angles and rates of turn have a unit.

    Parameters
    ----------
    kind : type
        The dataclass.
    given : mapping of str to value
    where : str
        Stands before the option's name in an error.

    Raises
    ------
    InputError
        An angle or a rate without a unit that is not 0.
    """
    for name, unit in _bare_turns(kind, given).items():
        if unit != TURNING["angle"] and given[name]:
            raise InputError(
                f"{given[name]}, a rate without a unit",
                f'a text with its unit, such as "3 {unit}"',
                column=f"{where}.{name}",
            )
        try:
            with_unit(given[name], "angle")
        except InputError as why:
            raise why.at(column=f"{where}.{name}") from None
    return given


def _bare_turns(kind: type, given: Mapping[str, Any]) -> dict[str, str]:
    """Options that are angles or rates of turn and stand without a unit, with the unit that a command line means."""
    bare = {f.name: f.metadata.get("bare", "") for f in dataclasses.fields(cast(Any, kind))}
    return {
        n: bare[n] for n, v in given.items() if bare.get(n) and isinstance(v, (int, float)) and not isinstance(v, bool)
    }


def named_numbers(texts: Iterable[str], column: str) -> dict[str, float]:
    """``left=60`` and the like as numbers by name.

    Raises
    ------
    InputError
        No name, no finite number, or a name twice.
    """
    out: dict[str, float] = {}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not name or not math.isfinite(number):
            raise InputError(shown(text), "NAME=NUMBER, such as left=60", column=column)
        if name in out:
            raise InputError(f"{shown(name)} twice", "every name once", column=column)
        out[name] = number
    return out

"""Units: read at the door, never seen further in. The units library is imported on first use."""

from __future__ import annotations

import functools
import math
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from tokenize import TokenError
from typing import Any

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.limits import bounded_number

STANDARD_GRAVITY = 9.80665  # m/s^2, 3rd General Conference on Weights and Measures (1901)
SI = {
    "length": "m",
    "speed": "m/s",
    "rate": "rad/s",
    "angle": "rad",
    "force": "N",
    "moment": "N*m",
    "density": "kg/m^3",
    "viscosity": "m^2/s",
    "mass": "kg",
    "mass rate": "kg/s",
    "time": "s",
    "frequency": "1/s",
    "acceleration": "m/s^2",
    "angular acceleration": "rad/s^2",
    "inertia": "kg*m^2",
    "volume": "m^3",
    "area": "m^2",
    "none": "",
}
_WRITTEN = {
    "kn": "knot",
    "kt": "knot",
    "rpm": "revolution/minute",
    **{f"{size}N{arm}": f"{size}N*{arm}" for size in ("", "m", "k", "M") for arm in ("m", "cm", "mm")},
}
# As the units library has them, to the last digit: what most files need without it.
_COMMON = {
    "length": {"m": 1.0, "mm": 0.001, "cm": 0.01, "km": 1000.0, "ft": 0.30479999999999996, "in": 0.0254},
    "speed": {
        "m/s": 1.0,
        "kn": 0.5144444444444445,
        "knot": 0.5144444444444445,
        "km/h": 0.2777777777777778,
        "ft/s": 0.30479999999999996,
        "cm/s": 0.01,
    },
    "rate": {"rad/s": 1.0, "deg/s": 0.017453292519943295, "rpm": 0.10471975511965977},
    "angle": {"rad": 1.0, "deg": 0.017453292519943295},
    "force": {"N": 1.0, "kN": 1000.0, "lbf": 4.4482216152605005},
    "moment": {
        "N*m": 1.0,
        "N m": 1.0,
        "Nm": 1.0,
        "kN*m": 1000.0,
        "lbf*ft": 1.3558179483314006,
        "ft*lbf": 1.3558179483314006,
    },
    "density": {"kg/m^3": 1.0, "kg/m3": 1.0, "g/cm^3": 999.9999999999999, "lb/ft^3": 16.01846337396015},
    "viscosity": {"m^2/s": 1.0, "m2/s": 1.0},
    "mass": {"kg": 1.0, "g": 0.001, "t": 1000.0, "lb": 0.4535923700000001},
    "time": {"s": 1.0, "min": 60.0, "h": 3600.0},
    "frequency": {"1/s": 1.0, "Hz": 1.0},
    "acceleration": {"m/s^2": 1.0, "m/s2": 1.0},
    "angular acceleration": {"rad/s^2": 1.0},
    "inertia": {"kg*m^2": 1.0, "kg m^2": 1.0},
    "volume": {
        "m^3": 1.0,
        "m3": 1.0,
        "cm^3": 1.0000000000000002e-06,
        "ft^3": 0.028316846591999994,
        "l": 0.0010000000000000002,
    },
    "area": {"m^2": 1.0, "m2": 1.0, "cm^2": 0.0001, "ft^2": 0.09290303999999999},
}
# Degrees in German, gon elsewhere, and by prefix a thousand million radians.
_TWO_MEANINGS = ("Grad", "grad", "GRAD", "Grd", "grd")
_LONGEST = 40
# Exponents are single digits: the units library would compute 9^9^9 for ever.
_NAME = r"[A-Za-zµμ°]+(?:\s*(?:\^|\*\*)\s*-?\s*[1-9])?"
_UNIT = re.compile(rf"\s*(?:1\s*/\s*)?{_NAME}(?:(?:\s*[*/·]\s*|\s+){_NAME})*\s*")
# kg/m3, m/s2, m s-1, N.m, N-m and N_m: digits behind lengths and times, a minus before a digit, and a point, a hyphen or an
# underscore between letters mean one thing.
_EXPONENT = re.compile(r"\b(mm|cm|dm|m|km|in|inch|ft|s|sec|min)-?[1-4]\b")
_BEHIND = re.compile(r"(?<=[A-Za-z])(?=-?[1-4])")
_POINT = re.compile(
    r"(?<=[A-Za-z0-9])\.(?=[A-Za-z])|(?<=[A-Za-z])\s*[-_]\s*(?=[A-Za-z])|(?<=[A-Za-z])\s+x\s+(?=[A-Za-z])"
)
_RAISED = str.maketrans(
    "\u00b9\u00b2\u00b3\u2074\u207b\u2212\u2010\u2011\u22c5\u2022\u2219\u00d7", "1234----\u00b7\u00b7\u00b7\u00b7"
)
_HEADER = re.compile(r"^(?P<name>[^\[\]]+?)\s*\[(?P<unit>[^\[\]]*)\]$")
_COMMA = re.compile(r",\s*\d")
_NUMBER = re.compile(r"^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$")

GRAMS = (0.9, 1.1)  # kg/m^3 of hot or high air, and g/cm^3 of water


@dataclass(frozen=True, slots=True)
class Header:
    """A column header ``name [unit]``; ``unit`` is None where no bracket was written."""

    text: str
    name: str
    unit: str | None


@functools.cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(cache_folder=None)


_DERIVED = re.compile(r"[A-Za-z*/()\u00b7 .]*(?:\^-?[1-9][A-Za-z*/()\u00b7 .]*)*")


_MOMENT = re.compile(r"\bNm\b")


def also_written(unit: str) -> str:
    """Another spelling of the unit of a derivative that `same_unit` takes: ``Nm/(m/s)`` of ``N*m/(m/s)``."""
    top, slash, bottom = unit.partition("/")
    if top != "N":
        return f"Nm{slash}{bottom}"
    return {"(m/s)": "N s/m", "(rad/s)": "N s/rad", "(m/s)^2": "N s^2/m^2"}.get(
        bottom, f"N {slash} {bottom}".rstrip(" /")
    )


def unit_ratio(one: str, other: str) -> float | None:
    """How much of a derivative's unit another is; None where they are of other kinds.

    Examples
    --------
    >>> unit_ratio("N s/m", "N/(m/s)"), round(unit_ratio("N/deg", "N/(rad)"), 4), unit_ratio("N", "N*m")
    (1.0, 57.2958, None)
    """
    if one.split() == other.split():
        return 1.0
    one, other = (_MOMENT.sub(r"(N*m)", text) for text in (one, other))
    if any(len(text) > _LONGEST or not _DERIVED.fullmatch(text) for text in (one, other)):
        return None
    import pint

    try:
        return float(_registry().Quantity(1.0, one).to(other).magnitude)
    except (pint.errors.PintError, TokenError, SyntaxError, AttributeError, TypeError, ValueError):
        return None


def same_unit(one: str, other: str) -> bool:
    """Whether two units are one, factor and all: ``N s/m`` and ``N/(m/s)`` are, ``N/(deg)`` and ``N/(rad)`` are not.

    A moment may be ``N*m``, ``N m`` or ``Nm``.
    """
    return math.isclose(unit_ratio(one, other) or 0.0, 1.0, rel_tol=1e-9)


def parse_header(text: str) -> Header:
    """Split ``"Y [N]"`` into name and unit."""
    clean = " ".join(text.split())
    match = _HEADER.match(clean)
    return Header(clean, match["name"], match["unit"].strip()) if match else Header(clean, clean, None)


def _spelled(unit: str) -> str:
    """The unit with ``^`` before exponents and ``*`` for a point, a hyphen, an underscore or an x between units."""
    plain = _POINT.sub("*", unit.translate(_RAISED))
    return _EXPONENT.sub(lambda found: _BEHIND.sub("^", found[0]), plain)


def _in_small_letters(unit: str, dimension: str) -> str:
    """Advice where only the capitals are wrong."""
    small = unit.lower()
    if small == unit:
        return ""
    try:
        factor(small, dimension)
    except UnitsError:
        return ""
    return f"Did you mean {small}? Capitals count."


@functools.cache
def factor(unit: str, dimension: str) -> float:
    """Factor that turns a number in ``unit`` into SI.

    Parameters
    ----------
    unit : str
        For example ``lbf``, ``ft*lbf``, ``kn``, ``deg/s``, ``kg/m^3`` or ``kg/m3``, ``N*m``, ``N.m``, ``N-m`` or ``Nm``;
        ``-`` for a pure number.
    dimension : str
        A key of `SI`.

    Raises
    ------
    UnitsError
        The unit is unknown, or of another dimension (a pure number is not an angle).
    """
    if unit in _COMMON.get(dimension, {}):
        return _COMMON[dimension][unit]
    expected = f"a unit of {dimension}, such as {SI[dimension]}" + (" or deg" if dimension == "angle" else "")
    expected = expected if dimension != "none" else "[-], a pure number"
    if unit == "-" or not unit:
        if dimension == "none":
            return 1.0
        raise UnitsError(f"[{unit}]", expected)
    if unit in _TWO_MEANINGS:
        raise UnitsError(f"[{unit}], which is degrees or gon", expected, advice="Write deg or gon.")
    spelled = unit if len(unit) > _LONGEST else _spelled(unit)
    plain = spelled.replace("(", " ").replace(")", " ")
    if unit not in _WRITTEN and (len(unit) > _LONGEST or not _UNIT.fullmatch(plain)):
        raise UnitsError(f"the unreadable unit {shown(unit)}", expected)
    import pint

    registry = _registry()
    si = SI[dimension] or "dimensionless"
    try:
        one = registry.Quantity(1.0, registry.parse_units(_WRITTEN.get(unit, spelled.replace("·", "*"))))
        value, double = float(one.to(si).magnitude), float((2.0 * one).to(si).magnitude)
        turns = dict(one.to_root_units().unit_items()).get("radian", 0)
    except pint.DimensionalityError:
        raise UnitsError(
            f"[{unit}], a unit of another dimension", expected, advice=_in_small_letters(unit, dimension)
        ) from None
    except pint.UndefinedUnitError:
        raise UnitsError(
            f"the unknown unit {shown(unit)}", expected, advice=_in_small_letters(unit, dimension)
        ) from None
    except (
        pint.PintError, ValueError, TypeError, AttributeError, SyntaxError, ArithmeticError, AssertionError, LookupError,
        TokenError,
    ) as why:  # fmt: skip
        raise UnitsError(f"the unreadable unit {shown(unit)} ({type(why).__name__})", expected) from None
    if turns != (dimension in ("angle", "rate", "angular acceleration")) or not math.isclose(double, 2.0 * value):
        raise UnitsError(f"[{unit}]", expected, advice="Write rad/s, deg/s or rpm." if dimension == "rate" else "")
    return value


def fits(unit: str, dimension: str) -> bool:
    """Whether a text is a unit of a dimension; an empty one is none."""
    try:
        return bool(unit) and factor(unit, dimension) > 0.0
    except UnitsError:
        return False


def with_unit(value: Any, dimension: str) -> float:
    """A number of a file in SI, `quantity`, where a bare number stands for SI but for angles: these need their unit, or are 0.

    So do densities about 1, which are thin air in kg/m^3 and water in g/cm^3.

    Raises
    ------
    InputError
        Not a finite number, an angle or a density about 1 without a unit, or a unit that does not fit.
    """
    if dimension == "density" and isinstance(value, (int, float)) and GRAMS[0] <= value <= GRAMS[1]:
        raise InputError(
            f"{value:g} kg/m^3, which is thin air", "a density of water, or one with its unit",
            advice=f'Is it g/cm^3? Then write "{value:g} g/cm^3"; of air "{value:g} kg/m^3".',
        )  # fmt: skip
    if dimension == "angle" and isinstance(value, (int, float)) and value and not isinstance(value, bool):
        raise InputError(
            f"{value!r}, an angle without a unit", 'a text with its unit, such as "20 deg"',
            advice=f'Write "{value!r} deg" or "{value!r} rad".' if math.isfinite(value) else "",
        )  # fmt: skip
    return quantity(value, dimension)


def density_as_written(value: Any) -> Any:
    """A density as `with_unit` reads it again: one about 1 kg/m^3, as of kinematic forces, with its unit."""
    return f"{value!r} kg/m^3" if isinstance(value, (int, float)) and GRAMS[0] <= value <= GRAMS[1] else value


def quantity(value: Any, dimension: str, *, file: str | Path | None = None, key: str = "") -> float:
    """A number of a TOML file in SI: a bare number is SI already, a text carries its unit (``"13.9792 ft"``).

    Parameters
    ----------
    value : object
        As TOML gave it.
    dimension : str
        Key of `SI`.
    file : path, optional
    key : str, optional
        Both for the error.

    Raises
    ------
    InputError
        Not a finite number, or a unit that does not fit.
    """
    expected = f'a number in {SI[dimension] or "-"} or a text with its unit, such as "2.5 {SI[dimension] or "-"}"'
    number: float
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise InputError(shown(value), expected, file=file, column=key)
    if isinstance(value, str):
        match = _NUMBER.match(value) if len(value) <= 2 * _LONGEST else None
        if not match:
            raise InputError(shown(value), expected, file=file, column=key)
        if _COMMA.match(match[2]):
            raise InputError(shown(value), expected, file=file, column=key, advice="Write a decimal point.")
        try:
            number = float(match[1]) * factor(match[2], dimension)
        except UnitsError as why:
            raise why.at(file, column=key) from None
    else:
        number = float(value) if abs(value) < sys.float_info.max else math.inf
    if not math.isfinite(number):
        raise InputError(shown(value), "a finite number", file=file, column=key)
    if out := bounded_number(number):
        raise InputError(shown(value), out, file=file, column=key)
    return number


def typed(text: str, dimension: str, option: str) -> float:
    """A number that a person typed behind an option: SI, or with its unit; an angle needs its unit.

    Parameters
    ----------
    text : str
    dimension : str
        Key of `SI`.
    option : str
        For the error.

    Raises
    ------
    InputError
        Not a number, or a unit that does not fit; names the option.
    """
    try:
        bare: float | str = float(text)
    except ValueError:
        bare = text
    try:
        return with_unit(bare, dimension)
    except InputError as why:
        raise why.at(column=option) from None


def positive_typed(text: str, dimension: str, option: str) -> float:
    """The same, of a number that must be above zero.

    Parameters
    ----------
    text : str
    dimension : str
        Key of `SI`.
    option : str
        For the error.
    """
    found = typed(text, dimension, option)
    if not found > 0.0:
        raise InputError(shown(text), f"a {dimension} above zero", column=option)
    return found


def three_typed(text: str, dimension: str, option: str) -> tuple[float, float, float]:
    """The same, of three numbers with commas between.

    Parameters
    ----------
    text : str
    dimension : str
        Key of `SI`.
    option : str
        For the error.
    """
    words = [w.strip() for w in text.split(",")]
    if len(words) != 3:
        raise InputError(shown(text), "three numbers with commas between", column=option)
    x, y, z = (typed(w, dimension, option) for w in words)
    return x, y, z

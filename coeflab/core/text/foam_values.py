"""Values of OpenFOAM dictionaries: numbers, lists, dimensions, units and plain arithmetic, each in one pass over its text."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from coeflab.core.arithmetic import ArithmeticProblem, evaluate
from coeflab.core.limits import FOAM_DEEPEST, FOAM_VALUE, LARGEST_NUMBER

TOKEN = re.compile(
    rb"""\s*+(?:(?P<skip>//[^\n]*+|/\*.*?(?:\*/|(?P<open>\Z)))
    |(?P<text>"(?:[^"\\]|\\.)*+(?:"|\Z))
    |(?P<code>\#\{.*?(?:\#\}|\Z))
    |(?P<inline>\$\{\{[^{}]*+\}\})
    |(?P<mark>[{};()\[\]])
    |(?P<word>(?:\$\{[^{}\s]*+\}|(?!/[/*])[^\s{};()\[\]"])++))""",
    re.DOTALL | re.VERBOSE,
)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*+|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
MACRO = re.compile(r"\$(?:\{([^{}\s]++)\}|([:!]?[\w./]++))")
IN_EXPRESSION = re.compile(r"\$(?:\{([^{}\s]++)\}|([:!]?[\w.]++))")  # where / divides
_LIST = re.compile(r"(?:List|Field)<\w+>")
_SWITCH = {"yes": True, "on": True, "true": True, "no": False, "off": False, "false": False}
_PI = math.pi / 180.0
# Units of OpenFOAM 12 and later, and the symbols of dimensions of the older ones.
_UNITS = {
    **dict.fromkeys(("kg", "m", "s", "K", "mol", "A", "Cd", "N", "J", "W", "Pa", "Hz", "rad"), 1.0),
    "rpm": math.pi / 30.0, "deg": _PI, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "g": 1e-3, "kPa": 1e3, "bar": 1e5, "min": 60.0,
    "hr": 3600.0, "h": 3600.0, "kN": 1e3, "rot": 2.0 * math.pi,
}  # fmt: skip
_UNIT = re.compile(r"([A-Za-z]+)\^?([-+]?\d+)?")
_QUALIFIED = re.compile(r"\b(?:Foam|std|constant|mathematical)::|(?<![\w:])::")
_FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    **{n: getattr(math, n) for n in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log", "log10", "pow")},
    "mag": abs, "abs": abs, "fabs": abs, "sqr": lambda x: x * x, "degToRad": lambda x: x * _PI, "radToDeg": lambda x: x / _PI,
    "min": min, "max": max, "vector": lambda x, y, z: [x, y, z],
}  # fmt: skip
_PIS = {"pi": math.pi, "M_PI": math.pi}


def computed(expression: str, named: Callable[[str], Any], *, whole_divides: bool) -> Any:
    """The value of plain arithmetic; nothing is executed.

    Parameters
    ----------
    expression : str
        Numbers, ``$names``, ``+ - * / ( )``, a few functions of one or two numbers, ``vector(x, y, z)``.
    named : callable
        The number of a name without its ``$``; None where there is none.
    whole_divides : bool
        Whether ``1/4`` is that of C++, zero (``#calc``), and so refused; else it is .25 (``#eval``).

    Raises
    ------
    ArithmeticProblem
        Anything else, or no finite value.
    """
    names: dict[str, Any] = dict(_PIS)

    def name(match: re.Match[str]) -> str:
        value = named(match[1] or match[2])
        if not is_finite(value):
            raise ArithmeticProblem(f"{match[0]} is no number that is known here")
        key = f"v{len(names)}x"
        names[key] = value
        return f" {key} "

    def divided(a: Any, b: Any) -> Any:
        if whole_divides and isinstance(a, int) and isinstance(b, int) and (b == 0 or a % b):
            raise ArithmeticProblem("whole numbers are divided, which C++ rounds to zero")
        return a / b

    text = _QUALIFIED.sub("", IN_EXPRESSION.sub(name, expression)).replace("pi()", "pi").strip().rstrip(";")
    if "^" in text or len(text) > FOAM_VALUE:
        raise ArithmeticProblem("no plain arithmetic")
    try:
        value = evaluate(text, names, _FUNCTIONS, number=_number, divide=divided)
    except (
        TypeError,
        ValueError,
    ) as why:  # a vector among numbers, a function of too many, a root of a negative number
        raise ArithmeticProblem(str(why)) from None
    if not (is_finite(value) or (isinstance(value, list) and all(map(is_finite, value)))):
        raise ArithmeticProblem("no finite number")
    return value


def is_finite(value: Any) -> bool:
    """Whether a value is a number within all bounds."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= LARGEST_NUMBER


def _number(text: str) -> int | float:
    """Whole numbers beyond all bounds are infinite, as long ones take Python time that grows with the square."""
    if text.lstrip("+-").isdigit():
        return int(text) if len(text) < 20 else float(text)
    return float(text)


def written(value: Any) -> str:
    """A computed value as a dictionary writes it."""
    return f"({' '.join(map(repr, value))})" if isinstance(value, list) else repr(value)


@lru_cache(maxsize=1000)
def value_of(text: str) -> Any:
    """The value of an entry whose macros are replaced; None where it is none.

    Numbers are numbers in SI, switches are true or false, lists are lists, quoted words keep their quotation marks, several
    words are a tuple. ``uniform``, ``constant``, dimensions and the count of a list are taken off.

    Examples
    --------
    >>> value_of("uniform (1 0 0.5)"), value_of("nu [0 2 -1 0 0 0 0] 1e-06"), value_of("60 [rpm]")
    ([1, 0, 0.5], 1e-06, 6.283185307179586)
    """
    if len(text) > FOAM_VALUE:
        return None
    content, stack, at = text.encode(), [[]], 0  # type: tuple[bytes, list[list[Any]], int]
    factor, has_units = 1.0, False
    while (match := TOKEN.match(content, at)) is not None:
        at = match.end()
        kind, token = match.lastgroup, match[match.lastgroup or 0].decode("utf-8", "replace")
        if token == "(" and len(stack) <= FOAM_DEEPEST // 2:
            stack.append([])
        elif token == ")" and len(stack) > 1:
            done = stack.pop()
            stack[-1].append(done)
        elif token == "[" and len(stack) == 1 and not has_units:
            end = content.find(b"]", at)
            unit = _unit_factor(content[at:end].decode("utf-8", "replace")) if end >= 0 else None
            if unit is None:
                return None
            factor, has_units, at = unit, True, end + 1
        elif kind == "word" and NUMBER.fullmatch(token):
            number = _number(token)
            stack[-1].append(number if abs(number) <= LARGEST_NUMBER else math.copysign(math.inf, number))
        elif kind in ("word", "text"):
            if not _LIST.fullmatch(token):
                stack[-1].append(token)
        elif kind not in ("skip", "open"):
            return None
    if len(stack) > 1 or content[at:].strip():
        return None
    return _whole(stack[0], factor, has_units=has_units)


def _whole(items: list[Any], factor: float, *, has_units: bool) -> Any:
    """One value of its items: what stands before it is taken off."""
    if has_units and len(items) == 2 and isinstance(items[0], str):
        items = items[1:]  # the name of a dimensioned number
    if len(items) > 1 and items[0] in ("uniform", "constant"):
        items = items[1:]
    if len(items) == 2 and isinstance(items[1], list) and items[0] == len(items[1]):
        items = items[1:]  # the count of a list
    if not items:
        return None
    value = items[0] if len(items) == 1 else tuple(items)
    if isinstance(value, str):
        value = _SWITCH.get(value, value)
    return value if factor == 1.0 else _scaled(value, factor)


def _scaled(value: Any, factor: float) -> Any:
    """A number, or a list of numbers, times a factor; None for anything else."""
    if isinstance(value, list):
        return [factor * v for v in value] if all(map(is_finite, value)) else None
    return factor * value if is_finite(value) else None


def _unit_factor(text: str) -> float | None:
    """SI per unit; 1 for a set of exponents; None where a unit is not known."""
    parts = text.split()
    if len(parts) in (5, 7) and all(map(NUMBER.fullmatch, parts)):
        return 1.0
    factor = 1.0
    for i, product in enumerate(text.split("/")):
        for part in product.replace("*", " ").replace(".", " ").split():
            match = _UNIT.fullmatch(part)
            if part == "1" or (match is None and part == "-"):
                continue
            if match is None or match[1] not in _UNITS or abs(int(match[2] or 1)) > 9:
                return None
            exponent = int(match[2] or 1)
            factor *= _UNITS[match[1]] ** (-exponent if i else exponent)
    return factor

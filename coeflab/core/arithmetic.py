"""Arithmetic that people write in files, computed without running any code of theirs."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from operator import truediv
from typing import Any

from coeflab.core.limits import ARITHMETIC_DEEPEST

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?)(?![A-Za-z_])"
    r"|(?P<name>[A-Za-z]\w*(?:\.[A-Za-z]\w*)*)|(?P<sign>\.?[*/^]|[-+(),]))",
    re.ASCII,
)


class ArithmeticProblem(ValueError):  # noqa: N818 - it is reported as an InputError by whoever knows the line
    """An expression that is no arithmetic of known names, or one without a finite value."""


def evaluate(
    text: str,
    names: Mapping[str, Any],
    functions: Mapping[str, Callable[..., Any]] | None = None,
    *,
    number: Callable[[str], Any] | None = None,
    divide: Callable[[Any, Any], Any] = truediv,
) -> Any:
    """The value of an expression in MATLAB's precedence: ``^`` from the left, then signs, ``* /``, ``+ -``.

    Parameters
    ----------
    text : str
    names : mapping of name to number or array
        Names may have dots.
    functions : mapping of name to callable, optional
        What a name followed by brackets calls; nothing else is callable.
    number : callable, optional
        What a number's letters mean; a float without it.
    divide : callable, optional
        What ``/`` does.

    Raises
    ------
    ArithmeticProblem
        Anything else than numbers, known names and the signs ``+ - * / ^ ( )``; division by zero, overflow, a root of
        a negative number; brackets deeper than 60.
    """
    reading = _Reading(_tokens(text), names, functions or {}, number or _decimal, divide)
    try:
        value = reading.sum(0)
    except ZeroDivisionError:
        raise ArithmeticProblem("a division by zero") from None
    except OverflowError:
        raise ArithmeticProblem("a number too large") from None
    if reading.at != len(reading.tokens):
        raise ArithmeticProblem(f"{reading.tokens[reading.at][1]} where nothing more was expected")
    if isinstance(value, complex):
        raise ArithmeticProblem("the root of a negative number")
    if isinstance(value, float) and not math.isfinite(value):
        raise ArithmeticProblem("a number that is not finite")
    return value


def _tokens(text: str) -> list[tuple[str, str]]:
    out, at = [], 0
    text = text.rstrip()
    while at < len(text):
        match = _TOKEN.match(text, at)
        if match is None:
            raise ArithmeticProblem(f"{text[at : at + 20].strip()} is no arithmetic")
        kind = match.lastgroup or ""
        out.append((kind, match[kind]))
        at = match.end()
    return out


def _decimal(text: str) -> float:
    """A number; the exponent may be that of Fortran."""
    return float(re.sub("[dD]", "e", text))


class _Reading:
    def __init__(
        self, tokens: list[tuple[str, str]], names: Mapping[str, Any], functions: Mapping[str, Callable[..., Any]],
        number: Callable[[str], Any], divide: Callable[[Any, Any], Any],
    ) -> None:  # fmt: skip
        self.tokens, self.names, self.functions, self.at = tokens, names, functions, 0
        self.number, self.divide = number, divide

    def _take(self, *signs: str) -> str:
        """The next sign if it is one of these, else nothing."""
        kind, text = self.tokens[self.at] if self.at < len(self.tokens) else ("", "")
        if kind == "sign" and text.removeprefix(".") in signs:
            self.at += 1
            return text.removeprefix(".")
        return ""

    def sum(self, depth: int) -> Any:
        value = self._product(depth)
        while sign := self._take("+", "-"):
            other = self._product(depth)
            value = value + other if sign == "+" else value - other
        return value

    def _product(self, depth: int) -> Any:
        value = self._signed(depth)
        while sign := self._take("*", "/"):
            other = self._signed(depth)
            value = value * other if sign == "*" else self.divide(value, other)
        return value

    def _signed(self, depth: int) -> Any:
        negative = False
        while sign := self._take("+", "-"):
            negative ^= sign == "-"
        value = self._atom(depth)
        while self._take("^"):
            flip = False
            while sign := self._take("+", "-"):
                flip ^= sign == "-"
            exponent = self._atom(depth)
            value = value ** (-exponent if flip else exponent)
        return -value if negative else value

    def _atom(self, depth: int) -> Any:
        if depth > ARITHMETIC_DEEPEST:
            raise ArithmeticProblem("brackets that are too deep")
        if self._take("("):
            return self._closed(depth)[0]
        kind, text = self.tokens[self.at] if self.at < len(self.tokens) else ("", "the end")
        if kind not in ("number", "name"):
            raise ArithmeticProblem(f"{text} where a number was expected")
        self.at += 1
        if kind == "number":
            return self.number(text)
        if self._take("("):
            if text not in self.functions:
                raise ArithmeticProblem(f"{text}(...), which is not computed here")
            return self.functions[text](*self._closed(depth))
        if text not in self.names:
            raise ArithmeticProblem(f"{text}, which has no number above")
        return self.names[text]

    def _closed(self, depth: int) -> list[Any]:
        values = [self.sum(depth + 1)]
        while self._take(","):
            values.append(self.sum(depth + 1))
        if not self._take(")"):
            raise ArithmeticProblem("a bracket that is not closed")
        return values

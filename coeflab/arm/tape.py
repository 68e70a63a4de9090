"""Scalars in symbols, each expression named once: what closed forms are put together from, by sympy."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import sympy as sp  # type: ignore[import-untyped]

from coeflab.core.types import brief

Vector = tuple[Any, Any, Any]
Wrench = tuple[Vector, Vector]
Square = list[list[Any]]
ZERO: Vector = (sp.S.Zero, sp.S.Zero, sp.S.Zero)
ROUNDING = 1e-15  # of a sine or cosine: what is closer to 0 or 1 is meant to be
LONGEST = 24  # operations of a line into which names used once are put back


class Line(NamedTuple):
    """A step: names, what they are, and what is being worked out.

    A strip has six names and the six arguments of `strip integral`; every other line one name and one expression.
    """

    names: tuple[sp.Symbol, ...]
    of: tuple[Any, ...]
    stage: str


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Parameter:
    """A number of the file that keeps its name.

    Attributes
    ----------
    symbol : sympy.Symbol
    value : float
        Of the file.
    unit, meaning : str
    """

    symbol: sp.Symbol
    value: float
    unit: str
    meaning: str


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Function:
    """A quantity in closed form.

    Attributes
    ----------
    name, meaning : str
    arguments : tuple of str
        ``q``, ``s``, ``down``, ``current``, ``acceleration``.
    lines : tuple of Line
        In the order in which they can be worked out.
    outputs : dict of str to (sympy.Matrix, str)
        By name: entries in symbols of the lines and arguments, and what they are.
    """

    name: str
    meaning: str
    arguments: tuple[str, ...]
    lines: tuple[Line, ...]
    outputs: dict[str, tuple[sp.Matrix, str]]

    @property
    def operations(self) -> int:
        """Additions, products and functions of the lines and outputs; a strip counts as one."""
        own = sum(operations(e) for line in self.lines if len(line.names) == 1 for e in line.of)
        strips = sum(len(line.names) > 1 for line in self.lines)
        return own + strips + sum(operations(e) for m, _ in self.outputs.values() for e in m)

    def expanded(self, output: str) -> sp.Matrix:
        """An output in the arguments alone. It grows by an order of magnitude with every link."""
        known: dict[Any, Any] = {}
        for line in self.lines:
            if len(line.names) == 1:
                known[line.names[0]] = line.of[0].xreplace(known)
        return self.outputs[output][0].xreplace(known)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ClosedForm:
    """The equations of a chain.

    Attributes
    ----------
    name : str
        Of the chain.
    links : tuple of (str, str)
        Name of each link and kind of its joint.
    functions : tuple of Function
    parameters : tuple of Parameter
        None where numbers stand in the equations.
    """

    name: str
    links: tuple[tuple[str, str], ...]
    functions: tuple[Function, ...]
    parameters: tuple[Parameter, ...] = ()

    @property
    def size(self) -> int:
        """Generalised speeds, 6 + n."""
        return 6 + len(self.links)

    def function(self, name: str) -> Function:
        """The function of a name."""
        return next(f for f in self.functions if f.name == name)

    def length(self, argument: str) -> int:
        """How many numbers an argument has."""
        return {"q": len(self.links), "s": self.size}.get(argument, 3)


def symbols_of(argument: str, count: int) -> list[Any]:
    """Symbols of an argument's entries."""
    return [sp.Symbol(f"{argument}{k}") for k in range(1, count + 1)]


def number(value: float) -> Any:
    """A number of an equation: 0, 1 and -1 exact, so that they vanish; the rest is floating point."""
    return sp.Integer(int(value)) if value in (-1.0, 0.0, 1.0) else sp.Float(float(value))


def right_angled(angle: float) -> tuple[float, float]:
    """Cosine and sine; exact at right angles."""
    c, s = math.cos(angle), math.sin(angle)
    return (round(c), round(s)) if min(abs(c), abs(s)) < ROUNDING else (c, s)


def operations(expression: Any) -> int:
    """Additions, products and functions; a sign is none."""
    if not expression.args:
        return 0
    own = 1 if expression.is_Pow or expression.is_Function else len(expression.args) - 1 - (expression.args[0] == -1)
    return own + sum(operations(e) for e in expression.args if not e.is_Atom)


def has_minus(expression: Any) -> bool:
    """Whether the expression is named by its negative: most terms have a minus, or sympy says so where as many have none."""
    if expression.is_Mul:
        return bool(expression.args[0].is_Number and expression.args[0] < 0)
    if not expression.is_Add:
        return False
    signs = [
        float(e.args[0]) < 0 if e.is_Mul and e.args[0].is_Number else e.is_Number and e < 0 for e in expression.args
    ]
    minus = sum(map(bool, signs))
    return minus > len(signs) - minus or (2 * minus == len(signs) and bool(expression.could_extract_minus_sign()))


class Tape:
    """Names of scalars, each expression once."""

    def __init__(self) -> None:
        self.lines: list[Line] = []
        self.stage = ""
        self._known: dict[Any, Any] = {}

    def name(self, expression: Any, called: str = "") -> Any:
        """A symbol for an expression, with the sign in front; atoms stay themselves."""
        if expression.is_Atom:
            return expression
        if negative := has_minus(expression):
            expression = -expression
        if not expression.is_Atom and expression not in self._known:
            symbol = sp.Symbol(called or f"x{len(self.lines)}")
            self._known[expression] = symbol
            self.lines.append(Line((symbol,), (expression,), self.stage))
        found = self._known.get(expression, expression)
        return -found if negative else found

    def vector(self, entries: Iterable[Any]) -> Vector:
        """Names of three expressions."""
        x, y, z = (self.name(e) for e in entries)
        return x, y, z

    def strip(self, start: Vector, more: Vector) -> tuple[Vector, Vector]:
        """Integrals over t from 0 to 1 of |u| u and of t |u| u, u = start + t more."""
        k = len(self.lines)
        result = tuple(sp.Symbol(f"strip{k}_{i}") for i in range(6))
        self.lines.append(Line(result, (*start, *more), self.stage))
        still = [a == 0 and b == 0 for a, b in zip(start, more, strict=True)]
        first, second = (
            [sp.S.Zero if s else e for s, e in zip(still, m, strict=True)] for m in (result[:3], result[3:])
        )
        return (first[0], first[1], first[2]), (second[0], second[1], second[2])

    def function(
        self, name: str, meaning: str, arguments: tuple[str, ...], outputs: dict[str, tuple[sp.Matrix, str]]
    ) -> Function:
        """What the outputs need, names that are used once put back where they are used."""
        uses: dict[Any, int] = {}

        def count(expression: Any) -> None:
            for node in sp.preorder_traversal(expression):
                twice = node.base if node.is_Pow else node  # a square is a product of two
                if twice.is_Symbol:
                    uses[twice] = uses.get(twice, 0) + 1

        for matrix, _ in outputs.values():
            for e in matrix:
                count(e)
        needed = []
        for line in reversed(self.lines):
            if any(n in uses for n in line.names):
                needed.append(line)
                for e in line.of:
                    count(e)
        put: dict[Any, Any] = {}
        seen: dict[Any, Any] = {}
        selected: list[Line] = []
        strips = many = 0
        for line in reversed(needed):
            of = tuple(e.xreplace(put) if e.args or e.is_Symbol else e for e in line.of)
            own = line.names[0]
            if len(line.names) > 1:
                strips += 1
                names = tuple(sp.Symbol(f"strip{strips}_{i}") for i in range(6))
            elif of[0] in seen or (uses[own] == 1 and operations(of[0]) <= LONGEST):
                put[own] = seen.get(of[0], of[0])
                continue
            else:
                many += own.name.startswith("x")
                names = (sp.Symbol(f"x{many}") if own.name.startswith("x") else own,)
                seen[of[0]] = names[0]
            put.update(zip(line.names, names, strict=True))
            selected.append(Line(names, of, line.stage))
        final = {key: (matrix.xreplace(put), what) for key, (matrix, what) in outputs.items()}
        return Function(name, meaning, arguments, tuple(selected), final)


def cross(a: Sequence[Any], b: Sequence[Any]) -> Vector:
    """A x b, without names."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def plus(a: Sequence[Any], b: Sequence[Any]) -> Vector:
    """A + b, without names."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def times(matrix: Square, vector: Sequence[Any]) -> Vector:
    """(3, 3) by (3,), without names."""
    x, y, z = (sum((m * v for m, v in zip(row, vector, strict=True)), sp.S.Zero) for row in matrix)
    return x, y, z


def transposed(matrix: Square) -> Square:
    """Rows for columns."""
    return [list(column) for column in zip(*matrix, strict=True)]


def product(t: Tape, a: Square, b: Square) -> Square:
    """(3, 3) by (3, 3), named."""
    return transposed([list(t.vector(times(a, column))) for column in transposed(b)])

"""Monomials of motion variables, with absolute values: ``v|v|``, ``v r^2``, ``alpha^2 beta``.

Notation of manoeuvring derivatives: Gertler & Hagen (1967), Feldman (1979).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Annotated, NamedTuple

import numpy as np

from coeflab.core.stored import Means, Name, Within, stored
from coeflab.core.types import Array, brief
from coeflab.law.symbols import read_factors


@stored()
class Factor(NamedTuple):
    """A power of a variable."""

    variable: Annotated[Name, Means("one of `variables`")]
    power: Annotated[int, Within((("ge", 1), ("le", 40))), Means("exponent")]
    absolute: Annotated[bool, Means("true: |variable|^power")] = False


@brief
@dataclass(frozen=True, slots=True)
class Term:
    """A product of powers.

    Attributes
    ----------
    factors : tuple of (variable, power, absolute)
        ``absolute`` factors are |x|^power; empty for the constant.
    """

    factors: tuple[tuple[str, int, bool], ...] = ()

    def __str__(self) -> str:
        if not self.factors:
            return "1"
        parts = [f"|{v}|" if a else v for v, _, a in self.factors]
        return " ".join(p + (f"^{n}" if n > 1 else "") for p, (_, n, _) in zip(parts, self.factors, strict=True))

    @property
    def suffix(self) -> str:
        """The SNAME subscript: ``vv``, ``v|v|``, ``vrr``; ``0`` for the constant."""
        return "".join((f"|{v}|" if a else v) * n for v, n, a in self.factors) or "0"

    @property
    def degree(self) -> int:
        """Total degree."""
        return sum(n for _, n, _ in self.factors)

    def odd_in(self, variable: str) -> bool:
        """Whether the term changes sign with a variable."""
        return sum(n for v, n, a in self.factors if v == variable and not a) % 2 == 1

    def evaluate(self, columns: Mapping[str, Array]) -> Array:
        """Values of the term, shape (n,).

        Parameters
        ----------
        columns : mapping of variable to (n,) array
        """
        out = np.ones(len(next(iter(columns.values()))))
        for variable, power, absolute in self.factors:
            base = np.abs(columns[variable]) if absolute else columns[variable]
            out = out * base**power
        return out


def parse_suffix(suffix: str) -> Term:
    """Read a SNAME subscript.

    Raises
    ------
    ValueError
        Not a product of motion variables and control angles.
    """
    if (term := term_of(suffix)) is None:
        raise ValueError(suffix)
    return term


def term_of(suffix: str) -> Term | None:
    """A subscript as a term; None where it is none of a steady motion."""
    factors = read_factors(suffix)
    if factors is None or any(name.endswith("dot") for name, _ in factors):
        return None
    return Term(tuple(Factor(name, n, absolute) for (name, absolute), n in Counter(factors).items()))


def power_terms(variables: tuple[str, ...], degree: int, form: str, parity: Mapping[str, str]) -> tuple[Term, ...]:
    """All products of powers up to a degree.

    Parameters
    ----------
    variables : tuple of str
    degree : int
        Of every variable (``tensor``) or of the product (``total``).
    form : {"tensor", "total", "additive"}
        ``additive`` has no products of two variables.
    parity : mapping of variable to {"odd", "even", "full"}
        Which powers of a variable may occur; absent means full.
    """
    out = []
    for powers in product(range(degree + 1), repeat=len(variables)):
        if form == "total" and sum(powers) > degree:
            continue
        if form == "additive" and sum(n > 0 for n in powers) > 1:
            continue
        wanted = {"odd": 1, "even": 0}
        rules = [parity.get(v, "full") for v in variables]
        if any(r in wanted and n % 2 != wanted[r] for n, r in zip(powers, rules, strict=True)):
            continue
        out.append(Term(tuple((v, n, False) for v, n in zip(variables, powers, strict=True) if n)))
    return tuple(sorted(out, key=lambda t: (t.degree, str(t))))


def design(terms: tuple[Term, ...], columns: Mapping[str, Array]) -> Array:
    """Design matrix, shape (n, p)."""
    return np.column_stack([t.evaluate(columns) for t in terms])

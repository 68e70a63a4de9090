"""Sums of products of velocities: what an expression says when it is multiplied out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from coeflab.core.arithmetic import ArithmeticProblem
from coeflab.core.types import brief

Product = tuple[tuple[str, int], ...]
MOST = 4000
HIGHEST = 12
NOTHING = 1e-15


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Products:
    """Numbers by product; a product is names with their powers, sorted, ``|v|`` a name of its own.

    Attributes
    ----------
    terms : mapping of product to float
    """

    terms: Mapping[Product, float]

    @classmethod
    def of(cls, name: str) -> Products:
        """One name."""
        return cls({((name, 1),): 1.0})

    @property
    def number(self) -> float | None:
        """The value where no name is left."""
        return self.terms.get((), 0.0) if set(self.terms) <= {()} else None

    def _one(self, doing: str) -> tuple[Product, float]:
        if len(self.terms) != 1:
            raise ArithmeticProblem(f"{doing} a sum")
        return next(iter(self.terms.items()))

    def __add__(self, other: Products | float) -> Products:
        out = dict(self.terms)
        for product, value in as_products(other).terms.items():
            out[product] = out.get(product, 0.0) + value
        return Products({p: v for p, v in out.items() if v != 0.0})

    __radd__ = __add__

    def __neg__(self) -> Products:
        return self * -1.0

    def __sub__(self, other: Products | float) -> Products:
        return self + as_products(other) * -1.0

    def __rsub__(self, other: float) -> Products:
        return as_products(other) + self * -1.0

    def __mul__(self, other: Products | float) -> Products:
        factor = as_products(other).terms
        if len(factor) * len(self.terms) > MOST:
            raise ArithmeticProblem(f"more than {MOST} products")
        out: dict[Product, float] = {}
        for a, x in self.terms.items():
            for b, y in factor.items():
                product = _joined(a, b)
                out[product] = out.get(product, 0.0) + x * y
        return Products({p: v for p, v in out.items() if v != 0.0})

    __rmul__ = __mul__

    def __pow__(self, power: Products | float) -> Products:
        exponent = as_products(power).number
        if exponent is None or exponent != int(exponent) or abs(exponent) > HIGHEST:
            raise ArithmeticProblem(f"a power that is no whole number up to {HIGHEST}")
        if exponent < 0:
            product, value = self._one("dividing by")
            if value == 0.0:
                raise ArithmeticProblem("division by zero")
            return Products({tuple((n, int(k * exponent)) for n, k in product): value**exponent})
        out = as_products(1.0)
        for _ in range(int(exponent)):
            out = out * self
        return out

    def __truediv__(self, other: Products | float) -> Products:
        return self * as_products(other) ** -1.0

    def __rtruediv__(self, other: float) -> Products:
        return as_products(other) * self**-1.0

    def __abs__(self) -> Products:
        if not self.terms:
            return self
        product, value = self._one("the absolute value of")
        named = ((n if n.startswith("|") or n == "U" else f"|{n}|", k) for n, k in product)
        return Products({_joined((), tuple(named)): abs(value)})

    def same(self, other: Products) -> bool:
        """Whether both are equal to rounding, term by term."""
        apart = (self - other).terms
        return all(abs(v) <= 1e-12 * max(abs(self.terms.get(p, 0.0)), NOTHING) for p, v in apart.items())


def as_products(value: Products | float) -> Products:
    """A number as a sum of products."""
    if isinstance(value, Products):
        return value
    return Products({(): float(value)} if value else {})


def _joined(a: Product, b: Product) -> Product:
    powers: dict[str, int] = {}
    for name, k in (*a, *b):
        powers[name] = powers.get(name, 0) + k
    return tuple(sorted((n, k) for n, k in powers.items() if k))

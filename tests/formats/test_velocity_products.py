"""Sums of products against numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.arithmetic import ArithmeticProblem, evaluate
from coeflab.formats.xdyn.products import Products, as_products

NAMES = ("u", "v", "r")
LEAVES = st.sampled_from([*NAMES, "2", "0.5", "3e-1"])
TEXTS = st.recursive(
    LEAVES,
    lambda inner: (
        st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda t: f"({t[0]}{t[1]}{t[2]})")
        | inner.map(lambda t: f"({t}^2)")
    ),
    max_leaves=8,
)


def number(products: Products, values: dict[str, float]) -> float:
    total = 0.0
    for product, factor in products.terms.items():
        bases = [(values[n.strip("|")], n.startswith("|"), power) for n, power in product]
        total += factor * math.prod((abs(b) if absolute else b) ** power for b, absolute, power in bases)
    return total


@given(TEXTS)
def test_multiplied_out_it_is_the_same_number(text: str) -> None:
    values = {"u": 1.3, "v": -0.7, "r": 0.4}
    direct = evaluate(text, values)
    products = as_products(evaluate(text, {n: Products.of(n) for n in NAMES}))
    scale = evaluate(text.replace("-", "+"), {n: abs(v) for n, v in values.items()})
    assert number(products, values) == pytest.approx(direct, rel=1e-9, abs=1e-12 * max(scale, 1.0))


def test_absolute_values_quotients_and_powers() -> None:
    u, v = Products.of("u"), Products.of("v")
    found = evaluate("abs(-2*v)*v/u^2 - 1/u + 3", {"u": u, "v": v}, {"abs": abs})
    assert found.terms == {(("u", -2), ("v", 1), ("|v|", 1)): 2.0, (("u", -1),): -1.0, (): 3.0}
    assert number(found, {"u": 2.0, "v": -3.0}) == pytest.approx(2.0 * 3.0 * -3.0 / 4.0 - 0.5 + 3.0)
    assert (u - u).terms == {}
    assert abs(u - u).number == 0.0


@pytest.mark.parametrize("text", ["1/(u+v)", "abs(u+v)", "u^v", "u^0.5", "u^13", "1/(u-u)"])
def test_what_is_no_sum_of_products(text: str) -> None:
    with pytest.raises(ArithmeticProblem):
        evaluate(text, {"u": Products.of("u"), "v": Products.of("v")}, {"abs": abs})


def test_equal_to_rounding() -> None:
    u, v = Products.of("u"), Products.of("v")
    assert (u + v * 0.1 * 3.0).same(u + v * 0.3)
    assert not (u + v * 0.3).same(u)
    assert np.isclose((u * 2.0 - 2.0 * u + 1.0).number, 1.0)

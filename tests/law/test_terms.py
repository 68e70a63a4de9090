"""Monomials with absolute values: their values, names, parities and families."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.law.terms import Term, design, parse_suffix, power_terms

VARIABLES = ("u", "v", "w", "p", "q", "r", "dr", "ds", "db")
factors = st.lists(
    st.tuples(st.sampled_from(VARIABLES), st.integers(1, 4), st.booleans()),
    max_size=3,
    unique_by=lambda f: (f[0], f[2]),
)


@given(factors, st.lists(st.floats(-3.0, 3.0), min_size=len(VARIABLES), max_size=len(VARIABLES)))
def test_a_term_is_the_product_of_its_powers(chosen, point):
    term = Term(tuple(chosen))
    at = dict(zip(VARIABLES, point, strict=True))
    wanted = math.prod((abs(at[v]) if a else at[v]) ** n for v, n, a in chosen)
    found = term.evaluate({v: np.array([x]) for v, x in at.items()})
    np.testing.assert_allclose(found, [wanted], rtol=1e-14)


@given(factors)
def test_the_subscript_reads_back_as_the_same_term(chosen):
    term = Term(tuple(chosen))
    assert set(parse_suffix(term.suffix).factors) == set(term.factors)
    assert term.degree == sum(n for _, n, _ in chosen)


@given(factors, st.sampled_from(VARIABLES))
def test_parity_is_what_a_change_of_sign_does(chosen, variable):
    term = Term(tuple(chosen))
    at = {v: np.array([0.7 + 0.1 * i]) for i, v in enumerate(VARIABLES)}
    turned = {**at, variable: -at[variable]}
    sign = -1.0 if term.odd_in(variable) else 1.0
    np.testing.assert_allclose(term.evaluate(turned), sign * term.evaluate(at), rtol=1e-13)


@pytest.mark.parametrize(
    ("suffix", "text"),
    [("0", "1"), ("v", "v"), ("v|v|", "v |v|"), ("vrr", "v r^2"), ("drdr", "dr^2"), ("|v|r", "|v| r")],
)
def test_notation_of_the_field(suffix, text):
    term = parse_suffix(suffix)
    assert str(term) == text
    assert term.suffix == suffix


@pytest.mark.parametrize("suffix", ["", "x", "v|v", "|v", "vd", "00", "v0", "||"])
def test_what_is_no_subscript_is_refused(suffix):
    with pytest.raises(ValueError, match=r"^.*$"):
        parse_suffix(suffix)


def exponents(terms, variables):
    return {tuple(sum(n for v, n, _ in t.factors if v == name) for name in variables) for t in terms}


@pytest.mark.parametrize("degree", [1, 2, 4])
def test_families_of_powers(degree):
    grid = [(i, j) for i in range(degree + 1) for j in range(degree + 1)]
    wanted = {
        "tensor": set(grid),
        "total": {(i, j) for i, j in grid if i + j <= degree},
        "additive": {(i, j) for i, j in grid if i == 0 or j == 0},
    }
    for form, powers in wanted.items():
        terms = power_terms(("alpha", "beta"), degree, form, {})
        assert exponents(terms, ("alpha", "beta")) == powers
        assert len(terms) == len(powers)
        assert terms[0] == Term()


@pytest.mark.parametrize(("rule", "allowed"), [("odd", {1, 3, 5}), ("even", {0, 2, 4}), ("full", set(range(6)))])
def test_parity_rules_of_one_variable(rule, allowed):
    assert {p for (p,) in exponents(power_terms(("v",), 5, "tensor", {"v": rule}), ("v",))} == allowed


def test_rules_hold_for_each_variable_of_a_product():
    found = exponents(power_terms(("a", "b"), 3, "tensor", {"a": "even", "b": "odd"}), ("a", "b"))
    assert found == {(0, 1), (2, 1), (0, 3), (2, 3)}


def test_the_design_has_one_column_per_term_in_their_order():
    x = np.array([-2.0, 0.5, 3.0])
    terms = power_terms(("v",), 2, "total", {})
    np.testing.assert_array_equal(design(terms, {"v": x}), np.column_stack([np.ones(3), x, x**2]))

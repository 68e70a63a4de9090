"""Names and expressions of the law for programs."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.arithmetic import evaluate
from coeflab.formats.exported_law import (
    expression,
    sname,
    spelt,
    written_accelerations,
    written_controls,
    written_terms,
)
from coeflab.law.symbols import COMPONENTS, derivative
from tests.vehicle.test_force_law import HULL, parameters

FACTOR = st.sampled_from([*"uvwpqr", "dr", "ds", "db", *(f"{m}dot" for m in "uvwpqr")])
PART = FACTOR | FACTOR.filter(lambda f: not f.endswith("dot")).map("|{}|".format)
SYMBOLS = st.builds(
    lambda c, parts: c + "".join(parts), st.sampled_from(COMPONENTS), st.lists(PART, min_size=1, max_size=4)
)


@given(SYMBOLS)
def test_a_spelt_symbol_comes_back(symbol: str) -> None:
    name = spelt(symbol + "'")
    assert name.isidentifier()
    assert sname(name) == symbol == derivative(symbol).text


@pytest.mark.parametrize(
    ("symbol", "law", "wanted"),
    [
        ("X0", "motion", "r2*h.X0*U^2*course"),
        ("Yv", "motion", "r2*h.Yv*U*v"),
        ("Nr", "motion", "r4*h.Nr*U*r"),
        ("Yv|v|", "motion", "r2*h.Yvav*v*abs(v)"),
        ("Yvvv", "motion", "r2*h.Yvvv*v^3/U"),
        ("Yvvrr", "motion", "r4*h.Yvvrr*v^2*r^2/U^2"),
        ("Ndrdr", "motion", "r3*h.Ndrdr*U^2*dr^2"),
        ("Yv", "rest", "h.rest.Yv*v"),
    ],
)
def test_expressions(symbol: str, law: str, wanted: str) -> None:
    (term,) = written_terms(parameters({symbol: -0.01}, law=law))
    places = {"prime": "h.", "rest": "h.rest."}
    assert expression(term, lambda kind, name: places[kind] + name, "^") == wanted


def test_at_rest_the_number_is_si() -> None:
    (term,) = written_terms(parameters({"Yv": -0.03}, law="rest"))
    assert (term.written, term.length_power, term.speed_power) == (pytest.approx(-0.03 * 500.0 * 1.5 * 4.0), 0, 0)


def test_products_of_the_ideal_fluid_only_where_nothing_is_measured() -> None:
    names = {t.symbol: t.written for t in written_terms(parameters({"Nv": -0.014}, HULL)) if t.kind == "potential"}
    assert "Nuv" not in names
    assert names["Yur"] == pytest.approx(-20.0 / (500.0 * 8.0))
    assert names["Muw"] == pytest.approx((580.0 - 20.0) / (500.0 * 8.0))


def test_accelerations_are_the_negative_added_mass() -> None:
    primes, source = written_accelerations(parameters({"Nv": -0.014}, HULL))
    assert primes["Yvdot"] == pytest.approx(-600.0 / (500.0 * 8.0))
    assert primes["Nrdot"] == pytest.approx(-72.0 / (500.0 * 32.0))
    assert len(primes) == 6
    assert "ellipsoid" in source


def test_controls_in_the_order_of_the_columns() -> None:
    terms = written_terms(parameters({"Mds": -0.01, "Xdrdr": -0.01, "Yv": -0.02}))
    assert written_controls(terms) == ("dr", "ds")
    assert evaluate(expression(terms[1], lambda *_: "k", "^"), {"r2": 2.0, "k": 3.0, "U": 2.0, "dr": 0.5}) == 6.0

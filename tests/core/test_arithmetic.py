"""Arithmetic of files: MATLAB's precedence, and nothing but arithmetic."""

from __future__ import annotations

import contextlib
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.arithmetic import ArithmeticProblem, evaluate


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("-2^2", -4.0), ("2^-1", 0.5), ("2^3^2", 64.0), ("2^-1^2", 0.25), ("--3", 3.0), ("1-2-3", -4.0), ("8/4/2", 1.0),
        ("2*-3", -6.0), ("1.5d2", 150.0), (".5E-1", 0.05), ("1./4", 0.25), ("2.^3", 8.0), ("3.*h.L", 15.0),
        ("( 1 + 2 )*x", 6.0), ("f(1, x) + 1", 4.0),
    ],
)  # fmt: skip
def test_values(text: str, value: float) -> None:
    assert evaluate(text, {"x": 2.0, "h.L": 5.0}, {"f": lambda a, b: a + b}) == value


@pytest.mark.parametrize(
    "text", ["", "1 +", "1 2", "(1", "1)", "2x", "3i", "x'", "x.y", "f(1)", "a=1", "1;2", "$", "**", "f("]
)
def test_everything_else_is_refused(text: str) -> None:
    with pytest.raises(ArithmeticProblem):
        evaluate(text, {"x": 1.0})


NUMBERS = st.floats(0.01, 100.0).map(repr)
SUMS = st.recursive(
    NUMBERS,
    lambda inner: (
        st.builds("({}{}{})".format, inner, st.sampled_from(["+", "-", "*", "/"]), inner)
        | st.builds("(-{})".format, inner)
    ),
    max_leaves=20,
)


@given(SUMS)
def test_as_python_reads_it(text: str) -> None:
    try:
        expected = eval(text, {"__builtins__": {}})
    except ZeroDivisionError:
        return
    if math.isfinite(expected):
        assert evaluate(text, {}) == expected


def test_arrays() -> None:
    x = np.array([1.0, 2.0])
    np.testing.assert_array_equal(evaluate("3*x^2 - abs(-x)", {"x": x}, {"abs": np.abs}), [2.0, 10.0])


@given(st.text(max_size=60))
def test_any_text_gives_a_number_or_a_problem(text: str) -> None:
    with contextlib.suppress(ArithmeticProblem):
        assert math.isfinite(evaluate(text, {"x": 1.0}))

from __future__ import annotations

import pytest

from coeflab.core.table import plus_minus
from coeflab.core.wording import finite, listed


@pytest.mark.parametrize(("names", "said"), [("a", "a"), ("ab", "a and b"), ("abc", "a, b and c")])
def test_names_in_a_row(names: str, said: str) -> None:
    assert listed(list(names)) == said


def test_numbers_that_json_cannot_hold() -> None:
    assert finite(0.5) == 0.5
    assert [finite(float(v)) for v in ("nan", "inf", "-inf")] == [None] * 3


@pytest.mark.parametrize(
    ("value", "u95", "shown"),
    [
        (-0.0260123, 0.0022345, "-0.0260 +- 0.0022"),
        (-0.02721, 0.0000996, "-0.02721 +- 0.00010"),
        (0.5, 0.0996, "0.50 +- 0.10"),
        (0.0, 0.001, "0.0000 +- 0.0010"),
        (-0.001, 12.3, "0 +- 12"),
        (-0.004, 0.35, "0.00 +- 0.35"),
        (123456.0, 1234.0, "123500 +- 1200"),
        (99.96, 9.96, "100 +- 10"),
        (12345678.0, 543210.0, "1.235e+07 +- 0.054e+07"),
        (8.5535e-6, 3.711e-6, "8.6e-06 +- 3.7e-06"),
        (4.593e-9, 1.4797e-8, "0.5e-08 +- 1.5e-08"),
        (9.96e-6, 9.96e-6, "1.0e-05 +- 1.0e-05"),
        (0.3, 1e-15, "0.300000 +- 1.0e-15"),
        (-0.0027, 0.0, "-0.002700"),
        (0.3, None, "0.300000"),
        (0.3, float("nan"), "0.300000"),
        (None, None, "-"),
    ],
)
def test_u95_has_two_digits_and_the_value_the_same_last_place(
    value: float | None, u95: float | None, shown: str
) -> None:
    assert plus_minus(value, u95) == shown

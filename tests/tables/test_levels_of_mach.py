"""Rows of several Mach numbers: which count, and what is no Mach number."""

from __future__ import annotations

import numpy as np
import pytest

import coeflab as cf

AT = {"frame": "FRD", "about": "midship", "beta": "+", "density": 1.2, "speed": 100.0, "length": "2 m LOA"}
BETA = np.arange(-5.0, 6.0)


def rows_with(name: str, values: np.ndarray) -> int:
    table = {"beta [deg]": BETA, "Y [N]": -10.0 * BETA, "N [N m]": -4.0 * BETA, name: values}
    return len(cf.read_table(table, columns={name.split(" [", maxsplit=1)[0]: "ignore"}, **AT))


@pytest.mark.parametrize(
    ("name", "values", "count"),
    [
        ("Mach", np.where(BETA < 0.0, 0.5, 0.8), 5),
        ("Mach", np.where(BETA == 3.0, np.nan, 0.5), 11),
        ("Mach", np.where(BETA == 0.0, 0.0, 0.6), 11),
        ("Mach", np.linspace(0.50, 0.52, 11), 11),
        ("Ma [N m]", 2.0 * BETA + 3.0, 11),
        ("M [N m]", np.resize([1.0, 2.0, 3.0], 11), 11),
    ],
)
def test_rows_of_the_lowest_mach_number_count(name: str, values: np.ndarray, count: int) -> None:
    assert rows_with(name, values) == count

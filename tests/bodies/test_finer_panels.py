"""What a smaller error would cost, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.added_masses import finer
from coeflab.core.axes import Datum
from coeflab.law.added_mass import AddedMass


def matrix(share: float, method: str = "panel") -> AddedMass:
    one = np.diag([1.0, 10.0, 10.0, 0.1, 2.0, 2.0])
    return AddedMass(one, np.zeros(3), Datum("nose"), "body", method, (), share * one)


def test_half_the_error_takes_four_times_the_panels() -> None:
    found = finer(matrix(0.08), {"panels": 6_000})
    assert found.statistic == pytest.approx(0.08)
    assert found["panels"] == 24_000
    assert found["left"] == pytest.approx(0.04)
    assert found["times"] == pytest.approx(16.0)
    assert found["memory"] == pytest.approx(4.0 * 24_000**2 / 2**30 + 400.0 / 1024.0, rel=1e-6)


def test_no_line_below_one_percent_nor_of_other_methods_and_the_most_is_said() -> None:
    assert finer(matrix(0.005), {}) is None
    assert finer(matrix(0.2, "strip"), {}) is None
    found = finer(matrix(0.2), {"panels": 32_000})
    assert found.code == "added_mass.finest"

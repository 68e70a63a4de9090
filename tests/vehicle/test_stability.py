"""Stability indices against Roddy (1990), DTRC/SHD-1298-08, Table 4."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.vehicle.stability import index_gradient, stability_index

MASS, MASS_MOMENT = 0.018296, -0.127467e-4
VERTICAL = (-0.013910, 0.010324, -0.007545, -0.003702)
HORIZONTAL = (-0.027834, -0.013648, 0.005251, -0.004444)


def test_vertical_plane_of_configuration_1() -> None:
    """Printed -1.162874; the coefficients that it is made of are printed to six decimals."""
    assert stability_index(*VERTICAL, -MASS, MASS_MOMENT) == pytest.approx(-1.16287, abs=5e-6)


def test_horizontal_plane_of_configuration_2() -> None:
    """Printed -.443297; from the printed coefficients it is -.44348."""
    assert stability_index(*HORIZONTAL, MASS, MASS_MOMENT) == pytest.approx(-0.44348, abs=5e-6)


def test_printed_horizontal_index_is_within_the_rounding_of_its_coefficients() -> None:
    gradient = index_gradient(*HORIZONTAL, MASS, MASS_MOMENT)
    rounding = 0.5e-6 * np.abs(gradient).sum()
    assert abs(stability_index(*HORIZONTAL, MASS, MASS_MOMENT) - (-0.443297)) < rounding


def test_a_body_whose_force_acts_behind_its_turning_arm_is_stable() -> None:
    """Weathercock: centre of lateral force aft (Nv > 0 with Yv < 0) makes the index larger than one."""
    assert stability_index(-0.03, 0.002, 0.005, -0.0045, MASS, 0.0) > 1.0


slopes = st.floats(0.002, 0.05)
signs = st.sampled_from([-1.0, 1.0])


@given(slopes, slopes, signs, st.floats(-0.01, 0.01), st.floats(0.001, 0.01))
def test_gradient_is_the_difference_quotient(y: float, n: float, sign: float, yr: float, nr: float) -> None:
    point = np.array([-y, sign * n, yr, -nr])
    found = index_gradient(*point, MASS, MASS_MOMENT)
    for k in range(4):
        step = np.zeros(4)
        step[k] = 1e-7
        ahead, behind = (stability_index(*(point + s), MASS, MASS_MOMENT) for s in (step, -step))
        assert found[k] == pytest.approx((ahead - behind) / 2e-7, rel=1e-5, abs=1e-5 * np.abs(found).max())

"""Stability indices against Roddy (1990), DTRC/SHD-1298-08, Table 4."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import k0

from coeflab.fits.uncertainty.propagation import Propagated
from coeflab.vehicle.stability import (
    Derived,
    Verdict,
    index_gradient,
    missing_for_stability,
    sense,
    stability,
    stability_index,
)
from tests.motion.vehicles import STABLE, made

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


def test_what_an_index_lacks_is_that_of_the_plane_that_lacks_less() -> None:
    whole = made(STABLE)
    assert missing_for_stability(whole) == ()
    assert missing_for_stability(whole.model_copy(update={"mass": None})) == ("mass",)
    fewer = tuple(c for c in whole.coefficients if c.symbol not in ("Nr'", "Zw'", "Mw'"))
    assert missing_for_stability(whole.model_copy(update={"coefficients": fewer})) == ("Nr'",)
    assert not stability(whole.model_copy(update={"coefficients": fewer}))


def of_uncertain(lever: float, arm: float, lever_half: float, arm_half: float):
    """G_h of a vehicle with Nv' = lever and Yr' - m' = arm, each with its U95, over two certain denominators."""
    plain = made(STABLE)
    file = made({**STABLE, "Nv": lever, "Yr": plain.mass.mass_prime + arm})
    deviations = {"Yv'": 1e-5, "Nv'": lever_half / 2.0, "Yr'": arm_half / 2.0, "Nr'": 1e-5}
    matrix = tuple(map(tuple, np.diag(np.square(list(deviations.values()))).tolist()))
    covariance = file.covariance.model_copy(update={"symbols": tuple(deviations), "matrix": matrix})
    whole = file.model_copy(update={"covariance": covariance})
    return next(d for d in stability(whole, 20_000, seed=7) if d.name == "G_h")


def test_a_product_of_two_small_uncertain_numbers_has_its_monte_carlo_limits():
    """Both near zero: to first order nothing moves the index. The product z of two standard normal numbers has the density
    K0(|z|) / pi, which is above 2.29 with a probability of 2.275 %."""
    found = of_uncertain(1e-6, 1e-6, 1e-2, 1e-2)
    above = brentq(lambda q: quad(k0, q, 40.0)[0] / np.pi - 0.02275, 1.0, 4.0)
    half = above * 5e-3 * 5e-3 / (STABLE["Yv"] * STABLE["Nr"])
    assert found.result.linear < 1e-3 * half
    assert found.interval == pytest.approx((1.0 - half, 1.0 + half), abs=0.04 * half)
    assert found.by_draws
    assert found.half_width is None
    assert sense(found) == "stable"
    assert found.in_words == "1.00, 95 % limits 0.86 to 1.14"
    assert "20000 draws, seed 7" in found.limits
    assert "leaves out the product of two small uncertain numbers" in found.limits


def test_where_the_linear_interval_is_stable_and_the_drawn_one_holds_zero_the_sign_is_open():
    found = of_uncertain(1e-6, 1e-6, 3e-2, 3e-2)
    assert found.value - found.result.linear > 0.9
    assert found.interval[0] < 0.0 < found.interval[1]
    assert not found.decided
    assert sense(found) == Verdict.SIGN_OPEN


def test_where_the_linear_interval_holds_zero_and_the_drawn_one_does_not_the_sign_is_that_of_the_draws():
    """Over an uncertain denominator the interval is skew: its near end is nearer than the linear one says."""
    plain = made(STABLE)
    file = made({**STABLE, "Nv": -0.109})
    values = {s: plain.coefficient(s).value for s in ("Yv'", "Nv'", "Yr'", "Nr'")} | {"Nv'": -0.109}
    deviations = np.abs(np.array(list(values.values()))) * np.array([0.8, 0.02, 0.02, 0.02]) / 2.0
    matrix = tuple(map(tuple, np.diag(np.square(deviations)).tolist()))
    covariance = file.covariance.model_copy(update={"symbols": tuple(values), "matrix": matrix})
    (found,) = (
        d for d in stability(file.model_copy(update={"covariance": covariance}), 20_000, seed=7) if d.name == "G_h"
    )
    assert found.value + found.result.linear > 0.0 > found.interval[1]
    assert sense(found) == "unstable"
    assert found.represented


def test_a_linear_interval_that_stands_for_the_draws_is_kept():
    found = of_uncertain(-6e-2, -5.6e-2, 6e-4, 5.6e-4)
    assert not found.by_draws
    assert found.interval == (found.value - found.result.linear, found.value + found.result.linear)
    assert found.limits == ""


@pytest.mark.parametrize(
    ("spread", "linear", "by_draws", "represented"),
    [
        (0.24, 1.0, False, True), (0.26, 1.0, True, True),  # a denominator known to a quarter
        (0.0, 1.09, False, True), (0.0, 1.11, True, True), (0.0, 0.91, False, True), (0.0, 0.89, True, True),  # a tenth of the drawn one
        (0.0, 0.26, True, True), (0.0, 0.24, True, False),  # a quarter of it
    ],
)  # fmt: skip
def test_which_interval_is_shown_at_the_bounds(spread: float, linear: float, by_draws: bool, represented: bool) -> None:
    found = Derived("G_h", "a", 0.5, Propagated(0.5, linear, 1.0, -0.5, 1.5, 20_000, 1), "", spread=spread)
    assert (found.by_draws, found.represented) == (by_draws, represented)

"""Propagation: linear against Monte Carlo, both against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.fits.uncertainty.propagation import normal_draws, propagate, reaches_zero


def test_draws_have_the_covariance_and_mean_zero() -> None:
    covariance = np.array([[4.0, 1.5], [1.5, 1.0]])
    drawn = normal_draws(covariance, 40_000, 1)
    assert drawn.mean(axis=0) == pytest.approx([0.0, 0.0], abs=1e-3)
    assert np.cov(drawn.T) == pytest.approx(covariance, rel=0.02)
    assert np.array_equal(drawn, normal_draws(covariance, 40_000, 1))
    assert not np.array_equal(drawn, normal_draws(covariance, 40_000, 2))
    assert normal_draws(covariance, 7, 1).shape == (7, 2)


def test_a_covariance_that_is_none_is_refused() -> None:
    with pytest.raises(ValueError, match="semidefinite"):
        normal_draws(np.array([[1.0, 2.0], [2.0, 1.0]]), 10, 1)


def test_common_errors_cancel_in_a_difference_and_add_in_a_sum() -> None:
    common = np.ones((2, 2))
    for sign, half in ((-1.0, 0.0), (1.0, 4.0)):
        found = propagate(lambda d, s=sign: d[:, 0] + s * d[:, 1], np.array([1.0, sign]), common, 20_000, 1)
        assert found.linear == pytest.approx(half, abs=1e-7)
        assert found.monte_carlo == pytest.approx(half, rel=0.02, abs=1e-6)


def test_a_monotonic_function_has_the_percentiles_of_its_input() -> None:
    found = propagate(lambda d: (1.0 + d[:, 0]) ** 3, np.array([3.0]), np.array([[0.1**2]]), 100_000, 1)
    assert found.value == 1.0
    assert found.linear == pytest.approx(0.6)
    assert (found.low, found.high) == pytest.approx((0.8**3, 1.2**3), rel=0.01)
    assert found.monte_carlo == pytest.approx(0.5 * (1.2**3 - 0.8**3), rel=0.01)


def test_an_interval_that_holds_zero() -> None:
    assert reaches_zero(-0.1, 0.1)
    assert reaches_zero(0.05, 0.1)
    assert not reaches_zero(-0.1, 0.09)

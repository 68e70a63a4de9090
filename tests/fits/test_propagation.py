"""Propagation: refits against an independent least squares, linear against Monte Carlo, both against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.types import Array
from coeflab.fits.statistics.slopes import Recommendation, design, recommend
from coeflab.fits.uncertainty.propagation import displaced, normal_draws, propagate, reaches_zero, refit


def swept(one_sided: bool = False, errors: bool = False) -> tuple[Array, Array, Array | None, Recommendation]:
    rng = np.random.default_rng(3)
    x = np.sin(np.radians(np.linspace(0.0 if one_sided else -16.0, 16.0, 21)))
    y = 1e-4 - 0.03 * x - 0.2 * x**3 + 5e-5 * rng.standard_normal(21)
    se = 5e-5 * (1.0 + np.abs(x) * 5.0) if errors else None
    return x, y, se, recommend(x, y, se, smallest=0.05)


@pytest.mark.parametrize("one_sided", [False, True])
@pytest.mark.parametrize("errors", [False, True])
def test_refit_agrees_with_least_squares_of_its_own(one_sided: bool, errors: bool) -> None:
    x, y, se, found = swept(one_sided, errors)
    rng = np.random.default_rng(4)
    xs = x + 0.01 * rng.standard_normal((6, 21))
    ys = y * (1.0 + 0.3 * rng.standard_normal((6, 21)))
    xs[0], ys[0] = x, y
    answer = refit(found.members, xs, ys)
    assert len(found.members) > 1
    assert answer[0] == pytest.approx(found.value, rel=1e-10)
    for i in range(6):
        alone = []
        for e in found.members:
            root = np.ones(len(e.rows)) if se is None else 1.0 / se[e.rows]
            matrix = design(e.terms, xs[i, e.rows]) * root[:, None]
            alone.append(np.linalg.lstsq(matrix, ys[i, e.rows] * root)[0][e.target])
        assert answer[i] == pytest.approx(np.median(alone), rel=1e-9)


def test_displaced_settings() -> None:
    x = np.sin(np.radians([-4.0, 0.0, 8.0]))
    one, none = np.ones(1), np.zeros(1)
    moved, force = displaced(x, np.radians([0.5]), one, np.array([1.0, 2.0, 3.0]), 1.1 * one, angular=True)
    assert np.degrees(np.arcsin(moved[0])) == pytest.approx([-3.5, 0.5, 8.5])
    assert force[0] == pytest.approx([1.1, 2.2, 3.3])
    control, _ = displaced(x, np.array([0.01]), one, x, one, angular=False)
    assert control[0] == pytest.approx(x + 0.01)
    rate, _ = displaced(x, none, 1.02 * one, x, one, angular=False)
    assert rate[0] == pytest.approx(1.02 * x)


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

"""Lack of fit against an analysis of variance by hand; leverage against statsmodels."""

from __future__ import annotations

import numpy as np
import pytest
import statsmodels.api as sm
from scipy import stats
from statsmodels.stats.outliers_influence import OLSInfluence

from coeflab.core.types import Array
from coeflab.fits.statistics.diagnostics import lack_of_fit, levels, replicate_groups
from coeflab.fits.statistics.least_squares import Factorised, aicc, factorise, solve

THREE_TIMES_TWO = np.array([1.0, 1.0, 2.0, 2.0, 3.0, 3.0])


def line(x: Array, y: Array) -> tuple[Factorised, Array]:
    f = factorise(np.column_stack([np.ones_like(x), x]))
    return f, solve(f, y)[1]


def test_lack_of_fit_is_the_analysis_of_variance_by_hand() -> None:
    """Level means 1, 4, 5; line through them 10/3 + 2 (x - 2), off by -1/3, 2/3, -1/3.

    Lack of fit: 2 (1/9 + 4/9 + 1/9) = 4/3 on 1 degree of freedom. Pure error: 3 (0.1^2 + 0.1^2) = 0.06 on 3.
    F = (4/3) / (0.06/3) = 66.67.
    """
    y = np.array([0.9, 1.1, 3.9, 4.1, 4.9, 5.1])
    f, residuals = line(THREE_TIMES_TWO, y)
    found = lack_of_fit(f, residuals, THREE_TIMES_TWO, 1e-9, known_errors=False)
    assert found == pytest.approx(stats.f.sf(200.0 / 3.0, 1, 3), rel=1e-9)
    assert found < 0.01


def test_a_line_through_the_level_means_does_not_lack_fit() -> None:
    y = np.array([0.9, 1.1, 1.9, 2.1, 2.9, 3.1])
    f, residuals = line(THREE_TIMES_TWO, y)
    assert lack_of_fit(f, residuals, THREE_TIMES_TWO, 1e-9, known_errors=False) == pytest.approx(1.0)


def test_lack_of_fit_with_known_errors_is_a_chi_square() -> None:
    x, y, se = np.arange(5.0), np.array([0.0, 1.3, 1.8, 3.1, 4.2]), 0.1
    f, residuals = line(x, y)
    total = float(np.sum((residuals / se) ** 2))
    assert lack_of_fit(f, residuals / se, x, 0.0, known_errors=True) == pytest.approx(stats.chi2.sf(total, 3), rel=1e-9)


def test_lack_of_fit_needs_something_to_compare_with() -> None:
    x = np.arange(6.0)
    f, residuals = line(x, x**2)
    assert np.isnan(lack_of_fit(f, residuals, x, 1e-9, known_errors=False))
    f, residuals = line(THREE_TIMES_TWO, np.repeat([1.0, 4.0, 5.0], 2))
    assert np.isnan(lack_of_fit(f, residuals, THREE_TIMES_TWO, 1e-9, known_errors=False)), "copies are no replicates"
    f, residuals = line(x[:2], x[:2])
    assert np.isnan(lack_of_fit(f, residuals, x[:2], 1e-9, known_errors=True))


def test_lack_of_fit_is_uniform_under_the_right_form() -> None:
    """A probability, so 5 % of right forms are below 5 %."""
    rng, x = np.random.default_rng(6), np.repeat(np.linspace(-1.0, 1.0, 6), 2)
    f = factorise(np.column_stack([np.ones(12), x]))
    _, residuals = solve(f, rng.normal(size=(12, 2000)))
    p = np.array([lack_of_fit(f, residuals[:, k], x, 1e-9, known_errors=False) for k in range(2000)])
    assert stats.kstest(p, "uniform").pvalue > 0.01


def test_replicate_groups_stay_within_the_tolerance_of_their_first_point() -> None:
    x = np.array([5.0, 0.0, 5.04, 9.0, 5.08, 0.01])
    assert [sorted(g) for g in replicate_groups(x, 0.05)] == [[1, 5], [0, 2]]
    assert [sorted(g) for g in replicate_groups(x, 0.1)] == [[1, 5], [0, 2, 4]]
    assert replicate_groups(x, 0.0) == []
    assert [sorted(g) for g in replicate_groups(np.array([1.0, -1.0, 1.0]), 0.0)] == [[0, 2]], "sides are not repeats"


def test_levels_put_both_sides_together() -> None:
    x = np.sin(np.radians([0.0, 0.2, -0.1, 3.93, -4.11, 4.03, 10.05, -9.98, 18.0]))
    np.testing.assert_array_equal(levels(x), [0, 0, 0, 1, 1, 1, 2, 2, 3])
    assert len(levels(np.array([]))) == 0
    np.testing.assert_array_equal(levels(np.zeros(3)), [0, 0, 0])


def test_leverage_is_that_of_statsmodels() -> None:
    rng = np.random.default_rng(1)
    x = rng.uniform(-1.0, 1.0, 15)
    y = x + 0.1 * rng.normal(size=15)
    f, _ = line(x, y)
    peer = OLSInfluence(sm.OLS(y, np.column_stack([np.ones(15), x])).fit())
    np.testing.assert_allclose(f.leverage, peer.hat_matrix_diag, rtol=1e-12)


@pytest.mark.parametrize("weighted", [False, True])
def test_aicc_is_the_likelihood_of_statsmodels_with_the_correction(weighted: bool) -> None:
    """Hurvich & Tsai (1989): -2 log L + 2k + 2k(k + 1)/(n - k - 1), less the constant n (log 2 pi + 1)."""
    rng, n, p = np.random.default_rng(5), 12, 3
    x = np.linspace(-1.0, 1.0, n)
    design, y = np.column_stack([np.ones(n), x, x**3]), x + 0.1 * rng.normal(size=n)
    weights = rng.uniform(0.3, 4.0, n) if weighted else np.ones(n)
    f = factorise(design, weights)
    k = p + 1
    wanted = -2.0 * sm.WLS(y, design, weights).fit().llf + 2 * k + 2 * k * (k + 1) / (n - k - 1)
    assert aicc(f, solve(f, y)[1]) + n * (np.log(2.0 * np.pi) + 1.0) == pytest.approx(wanted, rel=1e-10)
    few = factorise(design[:5])
    assert aicc(few, solve(few, y[:5])[1]) == np.inf

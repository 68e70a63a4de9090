"""HC2, HC3 against statsmodels; Bell-McCaffrey degrees of freedom against the n x n definition."""

from __future__ import annotations

import numpy as np
import pytest
import statsmodels.api as sm
from scipy import stats

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import factorise, solve
from coeflab.fits.statistics.robust_errors import bell_mccaffrey, hc_variance, t_factor, t_probability

CASES = [(n, p, weighted) for n, p in ((6, 2), (10, 3), (20, 4), (40, 6)) for weighted in (False, True)]


def case(n: int, p: int, weighted: bool) -> tuple[Array, Array, Array | None]:
    rng = np.random.default_rng(100 * n + p)
    x = np.sort(rng.uniform(-0.3, 0.3, n))
    y = -0.03 * x + 0.2 * x**3 + 1e-3 * (0.2 + np.abs(x)) * rng.standard_normal(n)
    return np.column_stack([x**k for k in range(p)]), y, rng.uniform(0.2, 5.0, n) if weighted else None


def by_definition(design: Array, weights: Array | None, column: int) -> float:
    """Imbens & Kolesar (2016), section 2.4: (sum of eigenvalues)^2 / sum of their squares of G'G.

    Column i of the n x n matrix G is the contrast's share a_i / sqrt(1 - h_i) times column i of I - H.
    """
    w = design if weights is None else design * np.sqrt(weights)[:, None]
    q, r = np.linalg.qr(w)
    hat = q @ q.T
    share = np.linalg.inv(r)[column] @ q.T
    g = (np.eye(len(w)) - hat) * (share / np.sqrt(1.0 - np.diag(hat)))[None, :]
    eigenvalues = np.linalg.eigvalsh(g.T @ g)
    return float(eigenvalues.sum() ** 2 / np.sum(eigenvalues**2))


@pytest.mark.parametrize(("n", "p", "weighted"), CASES)
def test_hc2_and_hc3_are_those_of_statsmodels(n: int, p: int, weighted: bool) -> None:
    design, y, weights = case(n, p, weighted)
    f = factorise(design, weights)
    coefficients, residuals = solve(f, y)
    for kind in (2, 3):
        peer = sm.WLS(y, design, 1.0 if weights is None else weights).fit(cov_type=f"HC{kind}")
        np.testing.assert_allclose(coefficients, peer.params, rtol=1e-9)
        np.testing.assert_allclose(np.sqrt(hc_variance(f, residuals, kind)), peer.bse, rtol=1e-10)


def test_hc_of_many_responses_is_hc_of_each() -> None:
    design, _, weights = case(10, 3, True)
    f = factorise(design, weights)
    y = np.random.default_rng(4).normal(size=(10, 7))
    _, residuals = solve(f, y)
    together = hc_variance(f, residuals, 2)
    assert together.shape == (3, 7)
    np.testing.assert_allclose(together[:, 4], hc_variance(f, residuals[:, 4], 2), rtol=1e-13)


@pytest.mark.parametrize(("n", "p", "weighted"), CASES)
def test_bell_mccaffrey_is_its_definition(n: int, p: int, weighted: bool) -> None:
    design, _, weights = case(n, p, weighted)
    found = bell_mccaffrey(factorise(design, weights))
    wanted = [by_definition(design, weights, k) for k in range(p)]
    np.testing.assert_allclose(found, wanted, rtol=1e-6 if p > 4 else 1e-9)
    assert np.all(found < n - p + 1e-9)


@pytest.mark.parametrize(("first", "second"), [(3, 3), (5, 5), (3, 27), (2, 10)])
def test_bell_mccaffrey_of_two_samples_is_welch_at_equal_variances(first: int, second: int) -> None:
    """Difference of two means: HC2 is s1^2/n1 + s2^2/n2, and its freedom Welch's with sigma^2 for both s^2.

    Balanced samples give n - 2 exactly; (3, 27) gives 2.5, the example of Imbens & Kolesar (2016), table 2.
    """
    inside = np.repeat([0.0, 1.0], [first, second])
    f = factorise(np.column_stack([np.ones(first + second), inside]))
    shares = np.array([1.0 / first, 1.0 / second])
    welch = shares.sum() ** 2 / (shares[0] ** 2 / (first - 1) + shares[1] ** 2 / (second - 1))
    assert bell_mccaffrey(f)[1] == pytest.approx(welch, rel=1e-12)
    if first == second:
        assert welch == pytest.approx(first + second - 2)
    y = np.random.default_rng(first).normal(size=first + second)
    _, residuals = solve(f, y)
    samples = y[:first], y[first:]
    wanted = sum(float(np.var(s, ddof=1)) / len(s) for s in samples)
    assert hc_variance(f, residuals, 2)[1] == pytest.approx(wanted, rel=1e-12)


def test_a_mean_has_one_degree_of_freedom_less_than_points() -> None:
    assert bell_mccaffrey(factorise(np.ones((9, 1))))[0] == pytest.approx(8.0, rel=1e-12)


def test_a_coefficient_that_one_point_carries_has_no_interval() -> None:
    """Four runs at rest and one at an angle: no residual tells how noisy the one is."""
    x, y = np.array([0.0, 0.0, 0.0, 0.0, 1.0]), np.array([0.1, -0.1, 0.2, -0.2, 1.0])
    f = factorise(np.column_stack([np.ones(5), x]))
    _, residuals = solve(f, y)
    for kind in (2, 3):
        intercept, slope = hc_variance(f, residuals, kind)
        assert np.isnan(slope)
        assert intercept > 0.0
    assert bell_mccaffrey(f)[0] == pytest.approx(3.0)
    assert np.isnan(t_factor(bell_mccaffrey(f)[1]))


def test_a_point_of_leverage_one_leaves_the_other_coefficients_alone() -> None:
    """A column that is zero but for one row takes that row out: the others are as without it."""
    design, y, _ = case(10, 2, False)
    lone = np.zeros(10)
    lone[7] = 1.0
    with_lone, without = factorise(np.column_stack([design, lone])), factorise(np.delete(design, 7, axis=0))
    _, residuals = solve(with_lone, y)
    _, plain = solve(without, np.delete(y, 7))
    for kind in (2, 3):
        found = hc_variance(with_lone, residuals, kind)
        np.testing.assert_allclose(found[:2], hc_variance(without, plain, kind), rtol=1e-10)
        assert np.isnan(found[2])
    np.testing.assert_allclose(bell_mccaffrey(with_lone)[:2], bell_mccaffrey(without), rtol=1e-10)


def test_student_factor_and_probability_are_those_of_scipy_stats() -> None:
    freedom = np.array([0.7, 1.0, 2.5, 10.0, 300.0])
    np.testing.assert_allclose(t_factor(freedom), stats.t.ppf(0.975, freedom), rtol=1e-9)
    np.testing.assert_allclose(t_factor(freedom, 0.9), stats.t.ppf(0.95, freedom), rtol=1e-9)
    np.testing.assert_allclose(t_probability(-2.2, freedom), 2 * stats.t.sf(2.2, freedom), rtol=1e-9)
    assert np.isnan(t_factor(0.0))

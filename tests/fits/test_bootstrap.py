"""Bootstrap replicates in closed form against one QR solution per resample."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.types import Array
from coeflab.fits.statistics.diagnostics import draw_counts, pairs, percentile_interval, wild
from coeflab.fits.statistics.least_squares import factorise, solve

CASES = [(p, weighted) for p in (2, 3, 4, 5) for weighted in (False, True)]
REPLICATES = 300


def case(p: int, weighted: bool, n: int = 20) -> tuple[Array, Array, Array | None]:
    """A sweep of -18 to 18 degrees in powers of v', and three responses of the size of Y', N' and K'."""
    rng = np.random.default_rng(p)
    x = np.sin(np.radians(np.linspace(-18.0, 18.0, n)))
    responses = np.outer(x, [-0.03, -0.014, -6e-4]) + 1e-4 * rng.standard_normal((n, 3))
    return np.column_stack([x**k for k in range(p)]), responses, rng.uniform(0.3, 3.0, n) if weighted else None


def by_qr(design: Array, response: Array, root: Array) -> Array:
    scale = np.linalg.norm(design, axis=0)
    q, r = np.linalg.qr(design / scale * root[:, None])
    return np.asarray(np.linalg.solve(r, q.T @ (root[:, None] * response)) / scale[:, None])


@pytest.mark.parametrize(("p", "weighted"), CASES)
def test_pairs_are_the_qr_solution_of_each_resample(p: int, weighted: bool) -> None:
    design, y, weights = case(p, weighted)
    counts = draw_counts(len(y), REPLICATES, 11)
    found = pairs(factorise(design, weights), y, counts)
    assert found.shape == (REPLICATES, p, 3)
    for k in range(REPLICATES):
        root = np.sqrt(counts[k] if weights is None else counts[k] * weights)
        wanted = by_qr(design, y, root)
        np.testing.assert_allclose(found[k], wanted, rtol=0, atol=1e-10 * np.abs(wanted).max())


@pytest.mark.parametrize(("p", "weighted"), CASES)
def test_wild_replicates_are_refits_of_flipped_residuals(p: int, weighted: bool) -> None:
    design, y, weights = case(p, weighted)
    f = factorise(design, weights)
    coefficients, residuals = solve(f, y[:, 0])
    found = wild(f, coefficients, residuals, REPLICATES, 5)
    root = np.ones(len(y)) if weights is None else np.sqrt(weights / weights.mean())
    hat = (design * root[:, None]) @ np.linalg.pinv(design * root[:, None])
    signs = np.random.default_rng(5).integers(0, 2, size=(REPLICATES, len(y))) * 2.0 - 1.0
    for k in range(REPLICATES):
        made = design @ coefficients + signs[k] * residuals / np.sqrt(1.0 - np.diag(hat)) / root
        wanted = by_qr(design, made[:, None], root)[:, 0]
        np.testing.assert_allclose(found[k], wanted, rtol=0, atol=1e-10 * np.abs(wanted).max())


def test_wild_replicates_have_the_hc2_variance() -> None:
    """Signs of +-1 on residuals over sqrt(1 - h): the variance over all 2^n sign patterns is HC2's."""
    design, y, _ = case(2, False, n=8)
    f = factorise(design)
    coefficients, residuals = solve(f, y[:, 0])
    replicates = wild(f, coefficients, residuals, 200_000, 3)
    exact = f.estimator**2 @ (residuals**2 / (1.0 - f.leverage))
    np.testing.assert_allclose(replicates.var(axis=0), exact, rtol=0.02)


def test_same_seed_same_draws() -> None:
    design, y, _ = case(3, False)
    f = factorise(design)
    coefficients, residuals = solve(f, y[:, 0])
    assert np.array_equal(draw_counts(20, 50, 7), draw_counts(20, 50, 7))
    assert not np.array_equal(draw_counts(20, 50, 7), draw_counts(20, 50, 8))
    assert np.array_equal(wild(f, coefficients, residuals, 50, 7), wild(f, coefficients, residuals, 50, 7))
    assert not np.array_equal(wild(f, coefficients, residuals, 50, 7), wild(f, coefficients, residuals, 50, 8))


def test_every_resample_draws_n_rows() -> None:
    counts = draw_counts(13, 4000, 2)
    assert np.all(counts.sum(axis=1) == 13)
    np.testing.assert_allclose(counts.mean(axis=0), 1.0, atol=0.08)


@pytest.mark.parametrize("p", [2, 3, 4])
def test_resamples_that_do_not_determine_the_coefficients_are_nan(p: int) -> None:
    """Six settings, each run twice: p - 1 settings drawn, or one row six times, determine nothing."""
    x = np.repeat(np.linspace(-0.3, 0.3, 6), 2)
    f = factorise(np.column_stack([x**k for k in range(p)]))
    y = np.random.default_rng(0).normal(size=(12, 1))
    too_few, enough = np.zeros((2, 12))
    too_few[: 2 * (p - 1)] = 6.0 / (p - 1)
    enough[: 2 * p] = 6.0 / p
    one_row = np.zeros(12)
    one_row[3] = 12.0
    found = pairs(f, y, np.array([too_few, enough, one_row, np.ones(12)]))
    assert np.all(np.isnan(found[[0, 2]]))
    assert np.all(np.isfinite(found[[1, 3]]))
    np.testing.assert_allclose(found[3, :, 0], solve(f, y[:, 0])[0], rtol=1e-9)


def test_percentile_interval_is_the_quantiles_of_what_could_be_used() -> None:
    values = np.arange(1001.0)
    assert percentile_interval(values) == (pytest.approx(25.0), pytest.approx(975.0), 1.0)
    assert percentile_interval(values, 0.5)[:2] == (pytest.approx(250.0), pytest.approx(750.0))
    holes = np.concatenate([values, np.full(1001, np.nan)])
    assert percentile_interval(holes) == (pytest.approx(25.0), pytest.approx(975.0), 0.5)
    low, high, usable = percentile_interval(np.concatenate([holes, [np.nan]]))
    assert np.isnan(low)
    assert np.isnan(high)
    assert usable == 1001 / 2003

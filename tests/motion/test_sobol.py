"""Sobol indices against printed analytic values and against scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats
from scipy.special import ndtr

from coeflab.core.types import Array
from coeflab.motion.uncertainty.sobol import design, exchanged, known_share, sobol_indices

ROWS = 4096


def results(function, a: Array, b: Array, groups) -> tuple[Array, Array, Array]:
    return function(a), function(b), np.array([function(x) for x in exchanged(a, b, groups)])


def singles(n: int) -> list[tuple[int, ...]]:
    return [(i,) for i in range(n)]


def ishigami(z: Array) -> Array:
    x = np.pi * (2.0 * ndtr(z) - 1.0)
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


A_OF_G = np.array([0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0])


def g_function(z: Array) -> Array:
    return np.prod((np.abs(4.0 * ndtr(z) - 2.0) + A_OF_G) / (1.0 + A_OF_G), axis=1)


def test_ishigami() -> None:
    """Saltelli et al., Global Sensitivity Analysis, 2008: a = 7, b = 0.1; S 0.3139 0.4424 0, S_T 0.5576 0.4424 0.2437."""
    found = sobol_indices(*results(ishigami, *design(ROWS, 3, 1), singles(3)))
    np.testing.assert_allclose(found.first, [0.3139, 0.4424, 0.0], atol=0.02)
    np.testing.assert_allclose(found.total, [0.5576, 0.4424, 0.2437], atol=0.02)
    for value, (low, high) in ((found.first, found.first_bounds), (found.total, found.total_bounds)):
        assert np.all(low <= value)
        assert np.all(value <= high)


def test_g_function() -> None:
    """Saltelli et al. 2010, Table 4: a = 0 1 4.5 9 99 99 99 99; S 0.716 0.179 0.024 0.007 0.000, S_T 0.787 0.242 0.034 0.010."""
    found = sobol_indices(*results(g_function, *design(ROWS, 8, 2), singles(8)))
    np.testing.assert_allclose(found.first[:5], [0.716, 0.179, 0.024, 0.007, 0.0], atol=0.02)
    np.testing.assert_allclose(found.total[:4], [0.787, 0.242, 0.034, 0.010], atol=0.02)
    v = (1.0 / 3.0) / (1.0 + A_OF_G) ** 2
    np.testing.assert_allclose(found.first, v / (np.prod(1.0 + v) - 1.0), atol=0.02)


def test_same_numbers_as_scipy() -> None:
    f_a, f_b, f_ab = results(ishigami, *design(512, 3, 3), singles(3))
    theirs = stats.sobol_indices(
        func={"f_A": f_a[None], "f_B": f_b[None], "f_AB": f_ab[:, None, :]}, n=512
    )  # fmt: skip
    ours = sobol_indices(f_a, f_b, f_ab)
    np.testing.assert_allclose(ours.first, np.ravel(theirs.first_order), atol=1e-12)
    np.testing.assert_allclose(ours.total, np.ravel(theirs.total_order), atol=1e-12)


def test_bootstrap_is_that_of_one_replicate_at_a_time() -> None:
    f_a, f_b, f_ab = results(ishigami, *design(256, 3, 4), singles(3))
    from coeflab.motion.uncertainty.sobol import drawn_counts

    replicates = 200
    each = []
    for counts in np.vstack(list(drawn_counts(256, replicates, 1))):
        rows = np.repeat(np.arange(256), counts.astype(int))
        one = stats.sobol_indices(
            func={"f_A": f_a[None, rows], "f_B": f_b[None, rows], "f_AB": f_ab[:, None, rows]}, n=256
        )
        each.append((np.ravel(one.first_order), np.ravel(one.total_order)))
    found = sobol_indices(f_a, f_b, f_ab, replicates=replicates, seed=1)
    levels = [2.275013194817921, 97.72498680518208]
    np.testing.assert_allclose(found.first_bounds, np.percentile([e[0] for e in each], levels, axis=0), atol=1e-11)
    np.testing.assert_allclose(found.total_bounds, np.percentile([e[1] for e in each], levels, axis=0), atol=1e-11)


def test_a_group_of_correlated_inputs_has_the_share_of_its_block() -> None:
    """y = c.x with x of a block covariance: S = S_T = c_g' C_g c_g / c' C c."""
    covariance = np.array([[1.0, 0.8, 0.0], [0.8, 2.0, 0.0], [0.0, 0.0, 0.5]])
    c = np.array([1.0, -1.5, 2.0])
    root = np.linalg.cholesky(covariance)
    groups = [(0, 1), (2,)]
    found = sobol_indices(*results(lambda z: z @ root.T @ c, *design(1024, 3, 5), groups))
    block = float(c[:2] @ covariance[:2, :2] @ c[:2])
    shares = np.array([block, c[2] ** 2 * 0.5]) / float(c @ covariance @ c)
    np.testing.assert_allclose(found.first, shares, atol=5e-3)
    np.testing.assert_allclose(found.total, shares, atol=5e-3)


def test_rows_without_a_result_are_left_out_whole() -> None:
    f_a, f_b, f_ab = results(ishigami, *design(256, 3, 6), singles(3))
    holed = f_ab.copy()
    holed[1, 7] = np.nan
    kept = np.arange(256) != 7
    found, wanted = sobol_indices(f_a, f_b, holed), sobol_indices(f_a[kept], f_b[kept], f_ab[:, kept])
    assert found.rows == 255
    np.testing.assert_array_equal(found.first, wanted.first)


@pytest.mark.parametrize("value", [0.0, 3.0])
def test_a_result_that_does_not_vary_has_no_indices(value: float) -> None:
    same = np.full(64, value)
    found = sobol_indices(same, same, np.vstack([same, same]))
    assert np.isnan(found.first).all()
    assert np.isnan(found.total_bounds).all()


def test_rows_must_be_a_power_of_two() -> None:
    with pytest.raises(ValueError, match="100 rows"):
        design(100, 2, 1)


def test_design_depends_on_the_seed_alone() -> None:
    np.testing.assert_array_equal(design(64, 4, 9)[1], design(64, 4, 9)[1])
    assert not np.array_equal(design(64, 4, 9)[0], design(64, 4, 10)[0])


def test_share_of_one_correlated_input_is_the_squared_correlation_of_a_linear_result() -> None:
    covariance = np.array([[1.0, 0.8], [0.8, 2.0]])
    c = np.array([1.0, -1.5])
    z = np.random.default_rng(1).standard_normal((20_000, 2))
    x = z @ np.linalg.cholesky(covariance).T
    wanted = (covariance @ c) ** 2 / np.diag(covariance) / float(c @ covariance @ c)
    np.testing.assert_allclose(known_share(x, x @ c), wanted, atol=0.01)
    assert np.isnan(known_share(x, np.ones(len(x)))).all()
    assert known_share(np.column_stack([x, np.ones(len(x))]), x @ c)[2] == 0.0

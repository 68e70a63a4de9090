"""One law for several groups of rows: closed forms, independent peers, and the level of the test."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import ttest_ind

from coeflab.fits.statistics.groups import Poolability, noise_of_groups, poolability
from coeflab.fits.statistics.stacked import freed

SWEEP = np.linspace(-0.3, 0.3, 13)


def two(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pooled and separate design of two groups with intercepts of their own, and the group of every row."""
    designs = [np.column_stack([v, v * np.abs(v), v**3]) for v in (first, second)]
    ones = [np.ones((len(v), 1)) for v in (first, second)]
    group = np.repeat([0, 1], [len(first), len(second)])
    own = np.column_stack([group == 0, group == 1]).astype(float)
    pooled = np.column_stack([np.vstack(designs), own])
    separate = np.column_stack([np.where((group == g)[:, None], pooled, 0.0) for g in (0, 1)])
    assert np.linalg.matrix_rank(separate) == 2 * (designs[0].shape[1] + ones[0].shape[1])
    return pooled, separate, group


def test_the_noise_of_a_group_is_the_scatter_about_its_own_law() -> None:
    """Two lines that no common line fits: only the residuals about each line count, with n - 2 degrees of freedom."""
    x = np.arange(6.0)
    e = np.array([1.0, -2.0, 1.0, 1.0, -2.0, 1.0])
    design, group = np.column_stack([np.r_[x, x], np.ones(12)]), np.repeat([0, 1], 6)
    noise = noise_of_groups(design, np.r_[3 * x + e, -5 * x + 9 + 10 * e], group, None)
    slope = float(np.polyfit(x, e, 1)[0])
    rest = e - np.polyval(np.polyfit(x, e, 1), x)
    assert slope == pytest.approx(0.0, abs=1e-12)
    expected = np.sqrt(np.sum(rest**2) / 4.0)
    assert noise == pytest.approx(np.repeat([expected, 10 * expected], 6), rel=1e-9)


def test_stated_errors_are_weights_inside_a_group() -> None:
    rng = np.random.default_rng(5)
    errors = np.tile([1.0, 3.0], 200)
    group = np.repeat([0, 1], 200)
    true = errors * np.where(group == 0, 0.2, 2.0)
    noise = noise_of_groups(np.ones((400, 1)), true * rng.standard_normal(400), group, errors)
    assert noise[1::2] / noise[::2] == pytest.approx(3.0, rel=1e-12)
    assert noise == pytest.approx(true, rel=0.15)


def test_a_group_without_scatter_of_its_own_is_as_noisy_as_the_noisiest() -> None:
    y = np.r_[1.0, -1.0, 1.0, -1.0, 1.0, 5.0, 7.0]
    noise = noise_of_groups(np.ones((7, 1)), y, np.array([0, 0, 0, 0, 0, 1, 1]), None)
    assert noise == pytest.approx(np.full(7, np.std(y[:5], ddof=1)))
    assert noise_of_groups(np.ones((2, 1)), y[:2], np.array([0, 1]), None) == pytest.approx(np.ones(2))


def test_no_group_is_quieter_than_a_thousandth_of_the_noisiest() -> None:
    y = np.r_[np.zeros(5), 1.0, -1.0, 1.0, -1.0, 1.0]
    noise = noise_of_groups(np.ones((10, 1)), y, np.repeat([0, 1], 5), None)
    assert noise[0] == pytest.approx(1e-3 * noise[-1])


def test_two_means_give_welchs_t() -> None:
    rng = np.random.default_rng(2)
    a, b = rng.standard_normal(9), 1.0 + 3.0 * rng.standard_normal(14)
    group = np.repeat([0, 1], [9, 14])
    separate = np.column_stack([group == 0, group == 1]).astype(float)
    found = poolability(np.ones((23, 1)), separate, np.r_[a, b], np.ones(23))
    assert found.restrictions == 1
    assert found.statistic == pytest.approx(ttest_ind(a, b, equal_var=False).statistic ** 2, rel=1e-9)


def test_one_restriction_is_the_t_test_of_the_equation() -> None:
    """The same slope in two groups, against the t test (CR2, Bell & McCaffrey) of the stacked fit."""
    rng = np.random.default_rng(4)
    y = np.r_[-0.02 * SWEEP, -0.021 * SWEEP] + 1e-4 * rng.standard_normal(26)
    group = np.repeat([0, 1], 13)
    separate = np.column_stack([np.r_[SWEEP, 0 * SWEEP], np.r_[0 * SWEEP, SWEEP]])
    found = poolability(np.r_[SWEEP, SWEEP][:, None], separate, y, np.ones(26))
    peer = freed([separate], [y], [np.arange(26)], (np.array([[1.0, -1.0]]), np.zeros(1)), [None], 26)
    assert found.probability == pytest.approx(peer.probability[0], rel=1e-6)
    assert len(np.unique(group)) == 2


@pytest.mark.parametrize("noisy", [(1.0, 1.0), (1.0, 5.0), (5.0, 1.0)])
def test_one_law_is_rejected_no_more_often_than_the_level_says(noisy: tuple[float, float]) -> None:
    """True law, unequal noise, intercepts apart: 800 seeded pairs of groups at 5 %; 4 sigma above is 8.1 %."""
    second = np.linspace(-0.2, 0.25, 10)
    pooled, separate, group = two(SWEEP, second)
    exact = pooled @ np.array([-0.02, -0.05, 0.1, 1e-3, -2e-3])
    sigma = 1e-4 * np.array(noisy)[group]
    rng, hits = np.random.default_rng(6), 0
    for _ in range(800):
        y = exact + sigma * rng.standard_normal(len(group))
        hits += poolability(pooled, separate, y, noise_of_groups(pooled, y, group, None)).probability < 0.05
    assert hits / 800 <= 0.081, hits
    if noisy == (1.0, 1.0):
        assert hits / 800 >= 0.02, hits


def test_laws_that_differ_are_rejected() -> None:
    pooled, separate, group = two(SWEEP, SWEEP)
    y = pooled @ np.array([-0.02, -0.05, 0.1, 1e-3, -2e-3]) + 1e-4 * np.random.default_rng(1).standard_normal(26)
    y = y + np.where(group == 1, -0.01 * np.r_[SWEEP, SWEEP], 0.0)
    found = poolability(pooled, separate, y, noise_of_groups(pooled, y, group, None))
    assert found.restrictions == 3
    assert found.probability < 1e-3


def test_intercepts_of_their_own_are_no_disagreement() -> None:
    pooled, separate, _ = two(SWEEP, SWEEP)
    y = pooled @ np.array([-0.02, -0.05, 0.1, 1.0, -2.0]) + 1e-4 * np.random.default_rng(1).standard_normal(26)
    assert poolability(pooled, separate, y, np.ones(26)).probability > 0.05


def test_exact_rows_agree_or_do_not() -> None:
    pooled, separate, group = two(SWEEP, SWEEP)
    y = pooled @ np.array([-0.02, -0.05, 0.1, 1e-3, -2e-3])
    assert poolability(pooled, separate, y, np.ones(26)).probability == 1.0
    assert poolability(pooled, separate, y + (group == 1) * np.r_[SWEEP, SWEEP], np.ones(26)).probability == 0.0


def test_groups_without_a_common_coefficient_are_not_tested() -> None:
    separate = np.column_stack([np.r_[SWEEP, 0 * SWEEP], np.r_[0 * SWEEP, SWEEP]])
    found = poolability(separate, separate, np.r_[SWEEP, SWEEP], np.ones(26))
    assert isinstance(found, Poolability)
    assert found.restrictions == 0
    assert np.isnan(found.probability)


def test_a_law_that_hangs_on_single_rows_is_not_tested() -> None:
    """Two rows and two coefficients in the second group: no residual shows their noise."""
    first, second = SWEEP, np.array([-0.2, 0.2])
    x = np.r_[first, second]
    group = np.repeat([0, 1], [13, 2])
    own = np.column_stack([group == 0, group == 1]).astype(float)
    pooled = np.column_stack([x, own])
    separate = np.column_stack([np.where((group == g)[:, None], pooled, 0.0) for g in (0, 1)])
    y = -0.02 * x + 1e-4 * np.random.default_rng(8).standard_normal(15)
    assert poolability(pooled, separate, y, np.ones(15)).restrictions == 0

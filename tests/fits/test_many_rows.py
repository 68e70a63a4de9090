"""Sweeps of thousands of rows: condensed to strips without bias, bad rows left out, the slope as from every row."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.fits.statistics.many_rows import EACH_ROW, SETTINGS, by_neighbours, condensed_rows
from coeflab.fits.statistics.origin_slope import curve, estimate
from coeflab.fits.statistics.slope_mixture import prepare

RNG = np.random.default_rng(11)
TRUE = -0.03


def force(x: np.ndarray) -> np.ndarray:
    return TRUE * x - 0.1 * x * np.abs(x)


@pytest.mark.parametrize("n", [EACH_ROW + 20, 3000])
@pytest.mark.parametrize("noise", [1e-4, 1e-6])
def test_the_slope_of_many_rows_is_the_true_one_and_narrow(n: int, noise: float) -> None:
    x = RNG.uniform(-0.3, 0.3, n)
    found = estimate(x, force(x) + noise * RNG.standard_normal(n))
    assert found.lower <= TRUE <= found.upper
    assert found.u95 < 40.0 * noise / np.sqrt(n / EACH_ROW) / 0.3 + 2e-6
    assert found.used.all()


def test_means_of_a_strip_are_means_of_the_curve_too() -> None:
    """A strip of v|v| is not v|v| at its mean: without the nodes the slope of this curve is 0.5 % off."""
    x = np.linspace(-0.3, 0.3, 2001)
    few = condensed_rows(x, force(x))
    assert len(few.x) == SETTINGS
    at_mean = prepare(few.x, few.variance)
    over = prepare(few.x, few.variance, strips=few.strips)
    true = few.strips.mean(force(few.strips.nodes.ravel()), 0)
    assert np.abs(true - few.y).max() < 2e-7
    assert np.abs(force(few.x) - few.y).max() > 10.0 * np.abs(true - few.y).max()
    assert not np.array_equal(at_mean.terms, over.terms)


def test_replicates_of_few_settings_keep_their_settings() -> None:
    settings = np.linspace(-0.3, 0.3, 13)
    x = np.repeat(settings, 100)
    few = condensed_rows(x, force(x) + 1e-4 * RNG.standard_normal(len(x)))
    assert few.x == pytest.approx(settings)


def test_wrong_rows_among_thousands_are_left_out_and_no_others() -> None:
    x = RNG.uniform(-0.3, 0.3, 5000)
    y = force(x) + 1e-4 * RNG.standard_normal(5000)
    wrong = RNG.choice(np.flatnonzero(np.abs(x) > 0.05), 15, replace=False)
    y[wrong] *= 3.0
    found = estimate(x, y)
    assert set(np.flatnonzero(~found.used)) == set(wrong)
    assert found.lower <= TRUE <= found.upper


def test_false_alarms_of_clean_rows_are_rare() -> None:
    """In about one clean campaign of fifty."""
    alarms = 0
    for seed in range(15):
        rng = np.random.default_rng(seed)
        x = rng.uniform(-0.3, 0.3, 1000)
        near = by_neighbours(x, force(x) + 1e-4 * rng.standard_normal(1000))
        alarms += bool(np.any(near.probability < 0.02 / 1000))
    assert alarms <= 1


def test_stated_errors_weigh_the_rows() -> None:
    x = np.linspace(-0.3, 0.3, 401)
    se = np.where(x > 0.0, 1e-5, 1e-3)
    y = force(x) + se * RNG.standard_normal(401)
    few = condensed_rows(x, y, se)
    assert few.variance[few.x < -0.01].min() > 1e3 * few.variance[few.x > 0.01].max()


def test_the_curve_of_condensed_rows_is_that_of_the_points() -> None:
    x = np.linspace(-0.3, 0.3, 801)
    found = estimate(x, force(x))
    at = np.linspace(-0.28, 0.28, 15)
    assert curve(found, at)[0] == pytest.approx(force(at), abs=2e-6)

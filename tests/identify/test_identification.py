"""Planted coefficients behind noisy columns, and what cannot be told apart."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.fits.sparse import scaled_optimizer
from coeflab.identify.identification import Products, exchangeable, identify, multiples, products, reliability

ROWS, LENGTH = 600, 20
TRUE = np.array([2.0, -1.0, 0.0, 0.5, 0.0])
NAMES = tuple(range(len(TRUE)))


def halves(noise: float, seed: int = 1, nearly: float = 0.3) -> tuple[np.ndarray, np.ndarray]:
    """Two readings of five columns, the second nearly the first, and of the response."""
    rng = np.random.default_rng(seed)
    clean = rng.standard_normal((ROWS, len(TRUE)))
    clean[:, 1] = clean[:, 0] + nearly * clean[:, 1]
    whole = np.column_stack([clean, clean @ TRUE])
    first, second = (whole + noise * rng.standard_normal(whole.shape) for _ in range(2))
    return first, second


def summed(first: np.ndarray, second: np.ndarray) -> Products:
    return products(first, second, np.arange(ROWS) // LENGTH)


def test_one_half_as_instrument_of_the_other_takes_the_bias_out() -> None:
    every = range(len(TRUE))
    instruments, plain = [], []
    for seed in range(30):
        first, second = halves(0.15, seed)
        instruments.append(summed(first, second).solved(every))
        both = (first + second) / 2.0
        plain.append(summed(both, both).solved(every))
    error = np.std(instruments, axis=0) / np.sqrt(30.0)
    assert np.all(np.abs(np.mean(instruments, axis=0) - TRUE) < 4.0 * error + 0.03)
    assert np.mean(plain, axis=0)[1] > -0.8


def test_without_noise_it_is_least_squares() -> None:
    first, _ = halves(0.0)
    p = summed(first, first)
    found = p.solved(NAMES)
    assert found == pytest.approx(TRUE, abs=1e-10)
    assert found == pytest.approx(np.linalg.lstsq(first[:, :-1], first[:, -1], rcond=None)[0], abs=1e-10)
    assert np.all(p.noise == 0.0)
    assert float(p.misfit(NAMES, found).sum()) == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_planted_columns_are_kept(seed: int) -> None:
    found = identify(summed(*halves(0.05, seed)), scaled_optimizer("stlsq"), seed=seed, resamples=60)
    assert found.retained == (0, 1, 3)
    for j in found.retained:
        assert found.low[j] < found.coefficients[j] < found.high[j]
        assert found.coefficients[j] == pytest.approx(TRUE[j], abs=0.1)
    assert np.all(np.isnan(found.coefficients[[2, 4]]))
    assert np.min(found.frequency[[0, 1, 3]]) > 0.9
    assert found.left < 0.05


def test_the_seed_alone_decides() -> None:
    p = summed(*halves(0.4))
    one, same, other = (identify(p, scaled_optimizer("stlsq"), seed=s, resamples=40) for s in (5, 5, 6))
    assert np.array_equal(one.frequency, same.frequency)
    assert not np.array_equal(one.frequency, other.frequency)


def test_units_of_columns_and_response_do_not_matter() -> None:
    units = np.array([1e3, 1e-4, 7.0, 0.3, 1e6, 55.0])
    first, second = halves(0.05)
    one = identify(summed(first, second), scaled_optimizer("stlsq"), seed=1, resamples=40)
    other = identify(summed(first * units, second * units), scaled_optimizer("stlsq"), seed=1, resamples=40)
    assert one.retained == other.retained
    assert other.coefficients == pytest.approx(one.coefficients * units[-1] / units[:-1], rel=1e-6, nan_ok=True)


def test_too_few_stretches_give_no_interval() -> None:
    first, second = halves(0.05)
    p = products(first, second, np.arange(ROWS) // 100)
    found = identify(p, scaled_optimizer("stlsq"), seed=1, resamples=40)
    assert np.all(np.isnan(found.low))
    assert found.retained == (0, 1, 3)


def test_a_column_that_does_as_well_is_named() -> None:
    first, second = halves(0.05)
    apart = summed(first, second)
    assert exchangeable(apart, (0, 1, 3)) == {0: (), 1: (), 3: ()}
    rng = np.random.default_rng(9)
    again = [np.insert(h, 4, h[:, 3] + 0.05 * rng.standard_normal(ROWS), axis=1) for h in (first, second)]
    assert exchangeable(summed(*again), (0, 1, 3))[3] == (4,)


def test_reliability_is_the_share_that_is_no_noise() -> None:
    rng = np.random.default_rng(2)
    signal = rng.standard_normal((20000, 1)) * np.array([1.0, 1.0, 0.0, 0.0])
    noise = np.array([0.0, 1.0, 1.0, 0.0])
    first, second = (signal + noise * rng.standard_normal((20000, 4)) for _ in range(2))
    assert reliability(first, second) == pytest.approx([1.0, 0.5, 0.0, 0.0], abs=0.03)


def test_multiples_of_a_column_are_named() -> None:
    columns = np.random.default_rng(3).standard_normal((50, 3))
    columns = np.column_stack([columns, -1e3 * columns[:, 1], columns[:, 0] + 0.01 * columns[:, 2]])
    assert multiples(columns.T @ columns) == {3: 1}

"""The error of a percentile is the scatter of that percentile over many samples."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.motion.uncertainty.spread import quantile_error


@pytest.mark.parametrize("level", [2.5, 50.0, 97.5])
def test_it_is_what_repeated_samples_scatter(level: float) -> None:
    samples = np.random.default_rng(3).standard_normal((600, 400))
    scatter = float(np.std(np.percentile(samples, level, axis=1)))
    said = float(np.sqrt(np.mean([quantile_error(s, level) ** 2 for s in samples])))
    assert said == pytest.approx(scatter, rel=0.15)


@pytest.mark.parametrize(("level", "rank"), [(2.5, 3), (50.0, 50), (97.5, 98)])
def test_it_is_the_bootstrap_of_the_order_statistic(level: float, rank: int) -> None:
    rng = np.random.default_rng(4)
    sample = 1e6 + rng.standard_normal(100)
    drawn = np.sort(sample[rng.integers(0, 100, (40_000, 100))], axis=1)[:, rank - 1]
    assert quantile_error(sample, level) == pytest.approx(float(np.std(drawn)), rel=0.02)

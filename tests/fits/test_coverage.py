"""Does a 95 % interval cover the truth in 95 % of campaigns? Synthetic campaigns with known slopes."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import factorise, solve
from coeflab.fits.statistics.robust_errors import bell_mccaffrey, hc_variance, t_factor
from coeflab.fits.statistics.slopes import design

SLOPE = -0.028
CAMPAIGNS = 4000
FORMS = {"line": ("1", "x"), "odd cubic": ("1", "x", "x3")}
NOISE = 2e-4


def settings(n: int, one_sided: bool) -> Array:
    return np.sin(np.radians(np.linspace(0.0 if one_sided else -18.0, 18.0, n)))


def noise(x: Array, growing: bool) -> Array:
    """Standard deviation of every point; growing means five times as much at 18 degrees as at rest."""
    return NOISE * (0.25 + np.abs(x) / np.abs(x).max()) if growing else np.full(len(x), NOISE)


def coverage(form: str, n: int, growing: bool, one_sided: bool) -> float:
    x, terms = settings(n, one_sided), FORMS[form]
    f = factorise(design(terms, x))
    truth = design(terms, x) @ np.array([1e-4, SLOPE, -0.2])[: len(terms)]
    shocks = np.random.default_rng(1).standard_normal((n, CAMPAIGNS))
    coefficients, residuals = solve(f, truth[:, None] + noise(x, growing)[:, None] * shocks)
    half = np.sqrt(hc_variance(f, residuals, 2)[1]) * t_factor(bell_mccaffrey(f)[1])
    return float(np.mean(np.abs(coefficients[1] - SLOPE) <= half))


@pytest.mark.parametrize("growing", [False, True], ids=["constant noise", "growing noise"])
@pytest.mark.parametrize("n", [10, 15, 20])
@pytest.mark.parametrize("form", FORMS)
def test_symmetric_sweeps_cover_in_93_to_97_percent(form: str, n: int, growing: bool) -> None:
    assert 0.93 <= coverage(form, n, growing, one_sided=False) <= 0.97


@pytest.mark.parametrize("growing", [False, True], ids=["constant noise", "growing noise"])
@pytest.mark.parametrize("n", [10, 15, 20])
@pytest.mark.parametrize("form", FORMS)
def test_one_sided_sweeps_cover_in_at_least_93_percent(form: str, n: int, growing: bool) -> None:
    """Wider than asked for where the noise grows: the end that carries the slope is the noisy one."""
    assert coverage(form, n, growing, one_sided=True) >= 0.93

"""Designs of a sweep against equal spacing, on readings that the search has not seen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.fits.statistics.designs import Response, designed, predicted_u95
from coeflab.fits.statistics.origin_slope import estimate

PAGE = (Path(__file__).parents[2] / "docs" / "next_tests.md").read_text()
LEVELS = np.sin(np.radians(np.arange(1.0, 13.0)))
RUNS = 7
SCENARIOS = [(0.1, 0.002), (0.3, 0.002), (1.0, 0.002), (1.0, 0.006), (0.3, 0.006)]  # bend over slope; noise


def response(bend: float, noise: float) -> Response:
    return Response(lambda x: x + bend * x * np.abs(x) / LEVELS[-1], noise)


@pytest.mark.slow
def test_a_design_beats_equal_spacing_and_says_by_how_much() -> None:
    """9 to 29 %, mean 17; the best of all 364 symmetric designs of three of these lies at 2 to 16 %."""
    gains = []
    for bend, noise in SCENARIOS:
        one = response(bend, noise)
        found, equal = designed([one], RUNS, LEVELS), np.linspace(-LEVELS[-1], LEVELS[-1], RUNS)
        then, plain = (predicted_u95(one, x, 100, seed=5) for x in (found, equal))
        gains.append(1.0 - then / plain)
        assert predicted_u95(one, found) == pytest.approx(then, rel=0.15)
    assert min(gains) > 0.08, gains
    assert np.mean(gains) > 0.15, gains
    assert max(gains) > 0.25, gains
    assert [f"{100.0 * g:.0f}" for g in gains] == ["9", "17", "29", "19", "9"]
    assert "noise of 1 and 3 % of it: 9, 17, 29 and, noisier, 9 and 19 %; mean 17" in PAGE


@pytest.mark.parametrize("bend", [0.0, 0.3])
def test_the_prediction_is_the_estimators_u95(bend: float) -> None:
    """The median of 120 campaigns that were read, within a tenth; of a line U95 goes with the noise, so 30 % more noise is seen."""
    one, x = response(bend, 0.003), np.linspace(-0.2, 0.2, 9)
    rng = np.random.default_rng(11)
    u95 = [estimate(x, one.curve(x) + rng.normal(0.0, 0.003, 9)).u95 for _ in range(120)]
    assert predicted_u95(one, x, 300) == pytest.approx(np.median(u95), rel=0.1)


def test_two_settings_give_nothing() -> None:
    assert predicted_u95(response(0.0, 0.01), np.array([-0.1, 0.1])) == float("inf")


@pytest.mark.parametrize(("count", "rest"), [(6, 0), (7, 1)])
def test_pairs_and_a_run_at_rest(count: int, rest: int) -> None:
    found = designed([response(0.3, 0.01)], count, LEVELS[::3])
    assert len(found) == count
    assert np.sum(found == 0.0) == rest
    np.testing.assert_allclose(found, -found[::-1])


def test_rows_that_were_run_count() -> None:
    one = response(0.3, 0.003)
    x = np.linspace(-0.2, 0.2, 7)
    read = one.curve(x) + np.random.default_rng(2).normal(0.0, one.noise, 7)
    ran = Response(one.curve, one.noise, 1.0, x, read)
    found = designed([ran], 3, LEVELS[1::2])
    assert len(found) == 3
    assert 0.0 not in found
    assert predicted_u95(ran, found) < predicted_u95(ran, np.zeros(0))


def test_a_solver_gets_no_setting_twice() -> None:
    one = response(1.0, 0.003)
    x = np.concatenate([-LEVELS[3:5], LEVELS[3:5]])
    found = designed([Response(one.curve, one.noise, 1.0, x, one.curve(x))], 8, LEVELS[:6], distinct=True)
    assert len(np.unique(found)) == len(found) == 8
    assert not np.intersect1d(found.round(9), x.round(9)).size


def test_of_an_odd_curve_one_side_is_run() -> None:
    one = response(0.3, 0.003)
    found = designed([Response(one.curve, one.noise, odd=True)], 4, LEVELS[2::3])
    assert len(found) == 4
    assert (found > 0.0).all()

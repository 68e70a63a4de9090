"""Profile likelihood: the parabola of a linear model, the skew of a curved one, ends that are open."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.kernels.output_error import estimate
from coeflab.kernels.output_problem import Problem, problem
from coeflab.kernels.profile_likelihood import WILKS_95, profile, profile_interval

T = np.linspace(0.0, 2.0, 15)
DESIGN = np.column_stack([np.ones_like(T), T])


def straight(**more: np.ndarray) -> Problem:
    y = 1.0 + 2.0 * T + 0.05 * np.sin(9.0 * T)
    return problem(lambda s: s @ DESIGN.T, y, 0.1, np.ones(2), **more)


@pytest.mark.parametrize("prior", [np.inf, 0.05])
def test_a_linear_model_has_a_parabola(prior: float) -> None:
    p = straight(prior_mean=np.array([1.0, 2.1]), prior_error=np.array([np.inf, prior]))
    best = estimate(p)
    error = best.standard_errors[1]
    away = np.array([-2.0, -0.5, 0.0, 1.0, 3.0])
    assert profile(p, best, 1, best.parameters[1] + away * error) == pytest.approx(away**2, rel=1e-4, abs=1e-7)
    low, high = profile_interval(p, best, 1)
    half = np.sqrt(WILKS_95) * error
    assert (low, high) == pytest.approx((best.parameters[1] - half, best.parameters[1] + half), rel=1e-4)


def test_one_parameter_alone_is_profiled_too() -> None:
    p = problem(lambda s: s * T, 2.0 * T + 0.01 * np.cos(5.0 * T), 0.1, np.ones(1))
    best = estimate(p)
    assert profile(p, best, 0, best.parameters + best.standard_errors) == pytest.approx([1.0], rel=1e-6)


def test_a_curved_model_has_a_skew_interval() -> None:
    """y = exp(-b t) with few points: large b is hard to tell from larger, small b is not."""
    t = np.array([0.5, 1.0])
    p = problem(lambda s: np.exp(-s * t), np.exp(-2.0 * t), 0.05, np.ones(1))
    best = estimate(p)
    low, high = profile_interval(p, best, 0)
    assert high - best.parameters[0] > 1.15 * (best.parameters[0] - low)
    for end in (low, high):
        assert np.sum((np.exp(-end * t) - np.exp(-2.0 * t)) ** 2) / 0.05**2 == pytest.approx(WILKS_95, rel=1e-4)


def test_an_end_that_never_rises_is_open_and_a_bound_is_an_end() -> None:
    def saturating(s: np.ndarray) -> np.ndarray:
        return 1.0 - np.exp(-np.abs(s) * (1.0 + T))

    p = problem(saturating, np.ones_like(T), 0.05, np.array([5.0]))
    low, high = profile_interval(p, estimate(p), 0)
    assert 0.0 < low < 5.0
    assert high == np.inf
    p = problem(saturating, np.ones_like(T), 0.05, np.array([5.0]), high=np.array([40.0]))
    assert profile_interval(p, estimate(p), 0)[1] == 40.0

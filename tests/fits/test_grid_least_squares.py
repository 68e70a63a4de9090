"""Least squares over grids: exact sequences return their law; scatter and odd orders widen the interval."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.fits.uncertainty.grid_convergence import Convergence
from coeflab.fits.uncertainty.several_grids import fitted_convergence

SIZES = np.array([1.0, 1.25, 1.6, 2.0, 2.6])


@given(st.floats(0.6, 1.95), st.floats(-5.0, 5.0), st.sampled_from([-0.3, 0.4]), st.integers(0, 4))
@settings(max_examples=25, deadline=None)
def test_an_exact_power_law_comes_back(order: float, limit: float, size: float, used: int) -> None:
    found = fitted_convergence(limit + size * SIZES**order, SIZES, used=used)
    assert found.convergence is Convergence.FITTED
    assert found.order == pytest.approx(order, abs=1e-4)
    assert found.extrapolated == pytest.approx(limit, abs=1e-3)
    assert found.safety == 1.25
    assert found.half_width == pytest.approx(1.25 * abs(size) * SIZES[used] ** order, rel=5e-3)


def test_the_order_of_the_grids_does_not_matter() -> None:
    f = 1.0 + 0.1 * SIZES**1.5
    turn = np.array([3, 0, 4, 1, 2])
    there = fitted_convergence(f[turn], 2.0 * SIZES[turn], used=1)
    assert there.half_width == pytest.approx(fitted_convergence(f, SIZES).half_width)


@pytest.mark.parametrize(("order", "form"), [(4.0, "h^2"), (0.2, "h^1 + a h^2")])
def test_an_order_out_of_range_is_fitted_by_fixed_orders_with_factor_three(order: float, form: str) -> None:
    found = fitted_convergence(1.0 + 0.1 * SIZES**order, SIZES)
    assert found.order == pytest.approx(order, abs=1e-3)
    assert found.safety == 3.0
    assert form in found.statement


def test_scatter_beyond_the_steps_is_said_and_widens() -> None:
    f = np.array([1.0, 1.4, 0.9, 1.5, 1.0])
    found = fitted_convergence(f, SIZES)
    assert "scatter" in found.statement
    assert found.half_width > np.ptp(f) / 2


def test_interval_covers_the_limit_under_small_noise() -> None:
    rng = np.random.default_rng(5)
    covered = 0
    for _ in range(60):
        f = 2.0 + 0.2 * SIZES**2 + 0.004 * rng.standard_normal(5)
        found = fitted_convergence(f, SIZES)
        covered += abs(f[0] - 2.0) <= found.half_width
    assert covered >= 54


@pytest.mark.parametrize("sizes", [(1.0, 2.0, 3.0), (1.0, 1.0, 2.0, 3.0), (0.0, 1.0, 2.0, 3.0)])
def test_too_few_or_impossible_grids_are_refused(sizes: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"grids|cell sizes"):
        fitted_convergence(np.arange(float(len(sizes))), np.array(sizes))


@given(st.floats(-3.0, -0.1), st.integers(0, 4), st.sampled_from([-1.0, 1.0]))
@settings(max_examples=25, deadline=None)
def test_values_that_diverge_take_three_times_their_range(order: float, used: int, sign: float) -> None:
    """h to a negative power: differences grow as the grid is refined."""
    f = 2.0 + sign * 0.1 * SIZES**order
    found = fitted_convergence(f, SIZES, used=used)
    assert found.convergence is Convergence.SCATTERED
    assert found.half_width >= 3.0 * float(np.ptp(f)) * (1.0 - 1e-12)


@given(st.floats(0.55, 1.9), st.floats(0.0, 3.0))
@settings(max_examples=25, deadline=None)
def test_a_finest_grid_that_departs_never_narrows_a_study_of_five(order: float, further: float) -> None:
    f = 2.0 + 0.1 * SIZES**order
    before = fitted_convergence(f, SIZES).half_width
    f[0] -= further * float(np.ptp(f))
    after = fitted_convergence(f, SIZES).half_width
    assert after >= before * (1.0 - 1e-6)

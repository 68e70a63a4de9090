"""Grid convergence: the printed example of Celik et al. (2008), exact sequences, and what it refuses to say."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.types import Array
from coeflab.fits.uncertainty.grid_convergence import (
    Convergence,
    GridConvergence,
    cell_sizes,
    extrapolated,
    grid_convergence,
    observed_order,
)

PRINTED = [
    ((18000, 8000, 4500), (6.063, 5.972, 5.863), 1.53, 6.1685),
    ((18000, 4500, 980), (10.7880, 10.7250, 10.6050), 0.75, 10.8801),
    ((18000, 4500, 980), (6.0042, 5.9624, 6.0909), 1.51, 6.0269),
]
GRIDS = cell_sizes(np.array([1169985.0, 607541.0, 192998.0]))


def sequence(limit: float, size: float, order: float, sizes: Array) -> Array:
    return limit + size * sizes**order


@pytest.mark.parametrize(("cells", "values", "order", "limit"), PRINTED)
def test_order_and_limit_of_table_1_of_celik(
    cells: tuple[int, ...], values: tuple[float, ...], order: float, limit: float
) -> None:
    f, h = np.array(values), cell_sizes(np.array(cells, dtype=float), dimension=2)
    p = observed_order(f, h)
    assert p is not None
    assert round(p, 2) == order
    assert extrapolated(f, h, p) == pytest.approx(limit, abs=1e-4)


def test_the_first_column_of_celik_as_a_whole() -> None:
    f = np.array([6.063, 5.972, 5.863])
    found = grid_convergence(f, np.array([1.0, 1.5, 2.0]))
    assert found.convergence is Convergence.MONOTONIC
    assert found.safety == 1.25
    assert found.relative is not None
    approximate, beyond = (f[0] - f[1]) / f[0], (found.extrapolated - f[0]) / found.extrapolated
    assert [round(100 * e, 1) for e in (approximate, beyond, found.relative)] == [1.5, 1.7, 2.2]


def test_the_fixed_point_form_of_celik_has_the_same_root() -> None:
    f, (r21, r32) = (6.063, 5.972, 5.863), (1.5, 4.0 / 3.0)
    ratio, p = (f[2] - f[1]) / (f[1] - f[0]), 1.0
    for _ in range(200):
        p = abs(np.log(abs(ratio)) + np.log((r21**p - 1.0) / (r32**p - 1.0))) / np.log(r21)
    assert observed_order(np.array(f), np.array([1.0, r21, r21 * r32])) == pytest.approx(p, rel=1e-9)


@given(
    limit=st.floats(-10.0, 10.0), size=st.floats(0.05, 1.0), sign=st.sampled_from([-1.0, 1.0]),
    order=st.floats(0.55, 2.05), r21=st.floats(1.15, 2.5), r32=st.floats(1.15, 2.5), used=st.integers(0, 2),
    turn=st.permutations([0, 1, 2]),
)  # fmt: skip
@settings(max_examples=80, deadline=None)
def test_planted_order_and_limit_come_back_on_every_grid(
    limit: float, size: float, sign: float, order: float, r21: float, r32: float, used: int, turn: list[int]
) -> None:
    h = np.array([1.0, r21, r21 * r32])
    f = sequence(limit, sign * size, order, h)
    found = grid_convergence(f[turn], 7.0 * h[turn], used=turn.index(used))
    assert found.convergence is Convergence.MONOTONIC
    assert found.order == pytest.approx(order, rel=1e-5)
    assert found.extrapolated == pytest.approx(limit, abs=1e-4)
    assert found.half_width == pytest.approx(1.25 * size * h[used] ** order, rel=1e-4)
    assert found.values == pytest.approx(tuple(f))


def test_an_order_beyond_the_formal_one_is_replaced_and_said() -> None:
    f = sequence(1.0, 0.1, 3.5, GRIDS)
    found = grid_convergence(f, GRIDS)
    assert found.order == pytest.approx(3.5, rel=1e-6)
    assert found.order_used == 2.0
    assert found.safety == 3.0
    assert "not in the asymptotic range" in found.statement
    assert found.half_width == pytest.approx(3.0 * abs(f[1] - f[0]) / (GRIDS[1] ** 2.0 - 1.0))


def test_an_order_near_zero_takes_three_times_the_range_and_at_least_order_one_half() -> None:
    f, wide = sequence(1.0, 0.1, 0.2, GRIDS), np.array([1.0, 4.0, 16.0])
    found = grid_convergence(f, GRIDS)
    assert found.convergence is Convergence.SLOW
    assert found.order == pytest.approx(0.2, rel=1e-6)
    assert found.extrapolated is None
    assert found.half_width == pytest.approx(1.25 * abs(f[1] - f[0]) / (GRIDS[1] ** 0.5 - 1.0))
    far = grid_convergence(sequence(1.0, 0.1, 0.2, wide), wide)
    assert far.half_width == pytest.approx(3.0 * 0.1 * (16.0**0.2 - 1.0))


def test_a_scheme_of_higher_order_may_have_a_higher_one() -> None:
    f = sequence(1.0, 0.1, 3.5, GRIDS)
    assert grid_convergence(f, GRIDS, formal_order=4.0).safety == 1.25


def test_two_grids_take_the_formal_order_and_the_factor_three() -> None:
    h = np.array([1.0, 1.5])
    found = grid_convergence(sequence(2.0, 0.3, 2.0, h), h)
    assert found.convergence is Convergence.TWO_GRIDS
    assert found.half_width == pytest.approx(0.9)
    assert "order 2 assumed, factor 3" in found.statement
    assert found.order is None


@pytest.mark.parametrize(
    ("values", "kind", "half", "word"),
    [
        ((1.0, 2.0, 2.5), Convergence.DIVERGENT, 4.5, "diverging"),
        ((1.0, 2.0, 1.5), Convergence.GROWING, 1.25 / (2.0**0.5 - 1.0), "growing differences"),
        ((1.0, 1.2, 0.6), Convergence.OSCILLATORY, 0.3, "half the range"),
        ((1.0, 1.0, 1.4), Convergence.OSCILLATORY, 0.2, "last digit"),
        ((1.0, 1.0, 1.0), Convergence.UNCHANGED, 0.0, "does not change"),
        ((1.0,), Convergence.ONE_GRID, None, "unknown"),
    ],
)
def test_what_does_not_converge_is_said_in_words(
    values: tuple[float, ...], kind: Convergence, half: float | None, word: str
) -> None:
    found = grid_convergence(np.array(values), np.array([1.0, 2.0, 4.0])[: len(values)])
    assert found.convergence is kind
    assert word in found.statement
    assert found.half_width == (None if half is None else pytest.approx(half))
    assert found.extrapolated is None
    assert (found.relative is None) == (half is None)


def test_divergence_takes_account_of_unequal_ratios() -> None:
    """A coarse step half as long in log h halves the difference at order zero: 1.9 to 1 converges, 1.1 to 1 of 2 not."""
    h = np.array([1.0, 2.0, 2.0 * 2.0**0.5])
    assert grid_convergence(np.array([0.0, 1.0, 1.8]), h).convergence is Convergence.MONOTONIC
    assert grid_convergence(np.array([0.0, 1.0, 1.6]), h).convergence is Convergence.SLOW
    assert grid_convergence(np.array([0.0, 1.0, 1.4]), h).convergence is Convergence.DIVERGENT
    assert observed_order(np.array([0.0, 1.0, 1.4]), h) is None


def test_differences_within_the_noise_have_no_order() -> None:
    values, noise = np.array([18.428, 18.522, 19.772]), 2.0 * np.array([0.0984, 0.122, 0.0681])
    found = grid_convergence(values, GRIDS, used=1, noise=noise)
    blur = float(np.hypot(noise[0], noise[1]))
    assert found.convergence is Convergence.NOISE
    assert found.order is None
    growth = GRIDS[1] ** 2 - 1.0
    assert found.half_width == pytest.approx(3.0 * (abs(18.522 - 18.428) + blur / growth))
    quiet = grid_convergence(values, GRIDS, used=1, noise=0.01 * noise)
    assert quiet.convergence is Convergence.MONOTONIC
    assert quiet.order is not None


@given(st.floats(0.1, 50.0), st.floats(-5.0, 5.0), st.lists(st.floats(0.0, 4.0), min_size=3, max_size=3))
@settings(max_examples=60, deadline=None)
def test_units_do_not_matter(scale: float, offset: float, raw: list[float]) -> None:
    f = np.round(np.array(raw), 3)
    here, there = grid_convergence(f, GRIDS), grid_convergence(scale * f, 3.0 * GRIDS)
    assert here.convergence is there.convergence
    assert (here.half_width is None) == (there.half_width is None)
    if here.half_width is not None:
        assert there.half_width == pytest.approx(scale * here.half_width, rel=1e-6)


@pytest.mark.parametrize("sizes", [(1.0, 1.0, 2.0), (0.0, 1.0, 2.0), (-1.0, 1.0, 2.0)])
def test_impossible_sizes_are_refused(sizes: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="cell sizes"):
        grid_convergence(np.array([1.0, 1.1, 1.3]), np.array(sizes))


def test_cell_sizes() -> None:
    assert cell_sizes(np.array([8000.0, 1000.0])) == pytest.approx([1.0, 2.0])
    assert cell_sizes(np.array([400.0, 100.0]), dimension=2) == pytest.approx([1.0, 2.0])


def test_a_value_of_zero_has_no_relative_half_width() -> None:
    found: GridConvergence = grid_convergence(np.array([0.0, 0.1, 0.4]), np.array([1.0, 2.0, 4.0]))
    assert found.half_width is not None
    assert found.relative is None


WORSE = (Convergence.DIVERGENT, Convergence.GROWING, Convergence.SLOW)


@given(
    order=st.floats(0.05, 6.0), sign=st.sampled_from([-1.0, 1.0]), r21=st.floats(1.1, 2.5), r32=st.floats(1.1, 2.5),
    moved=st.sampled_from([(0, 0), (1, 0), (2, 0), (2, 1)]), by=st.floats(-8.0, 8.0),
)  # fmt: skip
@settings(max_examples=400, deadline=None)
def test_a_force_that_stops_a_study_from_converging_never_narrows_it(
    order: float, sign: float, r21: float, r32: float, moved: tuple[int, int], by: float
) -> None:
    """One value of a converging study is changed so that it does not converge; the value in use stays, or is the finest."""
    h = np.array([1.0, r21, r21 * r32])
    f = 3.0 + sign * 0.1 * h**order
    before = grid_convergence(f, h, used=moved[1])
    f[moved[0]] += by * float(np.ptp(f))
    after = grid_convergence(f, h, used=moved[1])
    assert before.half_width is not None
    assert after.half_width is not None
    if before.convergence.converges and not after.convergence.converges:
        assert after.half_width >= before.half_width * (1.0 - 1e-9)
    if not after.convergence.converges:
        assert after.convergence in WORSE
        assert after.half_width >= 3.0 * float(np.ptp(f)) * (1.0 - 1e-12)


@given(st.floats(0.1, 6.0), st.floats(1.0, 5.0), st.floats(1.1, 2.5), st.floats(0.0, 2.0))
@settings(max_examples=200, deadline=None)
def test_differences_that_are_larger_all_over_never_narrow_it(
    order: float, larger: float, ratio: float, noise: float
) -> None:
    h = np.array([1.0, ratio, ratio**2])
    blur = np.full(3, noise * 0.1)
    f = 0.1 * h**order
    small, large = (grid_convergence(k * f, h, noise=blur).half_width for k in (1.0, larger))
    assert large >= small * (1.0 - 1e-9)


@given(st.integers(0, 2), st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3))
@settings(max_examples=200, deadline=None)
def test_half_the_range_at_least_where_three_values_differ(used: int, raw: list[float]) -> None:
    """Whatever they do, three values that differ have a half-width, and one that oscillates has half their range."""
    f = np.round(np.array(raw), 6)
    found = grid_convergence(f, GRIDS, used=used)
    assert found.half_width is not None
    if found.convergence is Convergence.OSCILLATORY:
        assert found.half_width == pytest.approx(0.5 * float(np.ptp(f)))
    elif not found.convergence.converges:
        assert found.half_width >= 3.0 * float(np.ptp(f)) * (1.0 - 1e-12)

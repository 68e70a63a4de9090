"""The convex hull of the data: what lies in it, whatever the units; flat data; reading outside."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from coeflab.kernels.domain import half_spaces, inside
from coeflab.kernels.extrapolation import TAPER, clamped, taper_weight

seeds = st.integers(0, 2**32 - 1)
sizes = st.sampled_from([1e-2, 1.0, 1e3, 1e6])


def cloud(seed: int, n: int, d: int, size: float, shift: float) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return size * (shift + rng.random((n, d)) * rng.choice([1e-2, 1.0, 1e2], d))


@settings(max_examples=60, deadline=None)
@given(seeds, st.integers(6, 30), st.integers(1, 4), sizes, st.sampled_from([0.0, 1.0, -50.0]))
def test_every_mixture_of_data_lies_inside_and_every_step_beyond_lies_outside(seed, n, d, size, shift):
    points = cloud(seed, n, d, size, shift)
    spaces = half_spaces(points)
    assert np.all(inside(spaces, points))
    rng = np.random.default_rng(seed + 1)
    assert np.all(inside(spaces, rng.dirichlet(np.ones(n), 20) @ points))
    width = np.ptp(points, axis=0)
    for direction in rng.standard_normal((10, d)):
        scaled = direction / width
        farthest = points[np.argmax(points @ scaled)]
        beyond = farthest + 0.01 * width**2 * scaled / np.linalg.norm(direction)
        assert not inside(spaces, beyond[None])[0]


@settings(max_examples=40, deadline=None)
@given(seeds, st.integers(5, 20))
def test_membership_does_not_depend_on_units(seed, n):
    points = cloud(seed, n, 2, 1.0, 0.0)
    probes = np.random.default_rng(seed + 2).uniform(-0.2, 1.2, (50, 2)) * np.ptp(points, axis=0) + points.min(axis=0)
    first = half_spaces(points)
    margin = np.abs(probes @ first[:, :2].T + first[:, 2]) / np.linalg.norm(
        first[:, :2] * np.ptp(points, axis=0), axis=1
    )
    assume(np.min(margin) > 1e-6)
    factor = np.array([57.295779513, 1e-3])
    second = half_spaces(points * factor)
    np.testing.assert_array_equal(inside(first, probes), inside(second, probes * factor))


def test_a_triangle_by_hand():
    spaces = half_spaces(np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]))
    assert len(spaces) == 3
    found = inside(spaces, np.array([[0.5, 0.5], [1.0, 0.5], [1.1, 0.5], [-0.01, 0.0], [2.0, 0.0]]))
    assert found.tolist() == [True, True, False, False, True]


def test_data_that_are_flat_in_one_variable_pin_it():
    points = np.column_stack([np.linspace(-1.0, 1.0, 9), np.full(9, 0.3)])
    found = inside(half_spaces(points), np.array([[0.0, 0.3], [1.0, 0.3], [1.01, 0.3], [0.0, 0.31], [0.0, 0.29]]))
    assert found.tolist() == [True, True, False, False, False]


@pytest.mark.parametrize("points", [[[0.5]], [[0.5, 1.0]], [[0.5, 1.0], [0.5, 1.0], [0.5, 1.0]]])
def test_one_point_is_all_there_is(points):
    data = np.array(points)
    spaces = half_spaces(data)
    assert inside(spaces, data[:1])[0]
    assert not inside(spaces, data[:1] + 1e-3)[0]


def test_the_nearest_point_of_the_box():
    low, high = np.array([-1.0, 0.0]), np.array([1.0, 2.0])
    found = clamped(np.array([[0.5, 1.0], [3.0, -4.0], [-2.0, 2.5]]), low, high)
    np.testing.assert_array_equal(found, [[0.5, 1.0], [1.0, 0.0], [-1.0, 2.0]])


def test_the_taper_leaves_the_box_with_its_slope_and_ends_flat():
    low, high = np.array([-1.0]), np.array([1.0])
    end = TAPER * 2.0

    def weight(beyond: float) -> float:
        return float(taper_weight(np.array([[1.0 + beyond]]), low, high)[0])

    assert weight(-0.5) == weight(0.0) == 1.0
    assert weight(end) == weight(5.0) == 0.0
    assert weight(end / 2.0) == pytest.approx(0.5, abs=1e-12)
    step = 1e-6 * end
    assert abs(weight(step) - 1.0) < 1e-10
    assert abs(weight(end - step)) < 1e-10
    track = [weight(s) for s in np.linspace(0.0, end, 50)]
    assert np.all(np.diff(track) < 0.0)


def test_the_largest_overshoot_counts_and_a_flat_variable_tapers_at_once():
    low, high = np.array([0.0, 3.0]), np.array([1.0, 3.0])
    found = taper_weight(np.array([[0.5, 3.0], [1.05, 3.0], [0.5, 3.0001]]), low, high)
    np.testing.assert_allclose(found, [1.0, 0.5, 0.0], atol=1e-12)

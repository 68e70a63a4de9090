"""The convex hull of the data: what lies in it, whatever the units; flat data; reading outside."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from coeflab.law.domain import TAPER, Domain, clamped, half_spaces, inside, taper_weight

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


def test_data_on_a_plane_have_their_hull_within_it():
    """A triangle tilted in space, and two points: no more lies inside than the mixtures of the data."""
    corners = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 3.0]])
    rng = np.random.default_rng(7)
    for data in (corners, np.vstack([corners, rng.dirichlet(np.ones(3), 9) @ corners]), corners[1:]):
        spaces = half_spaces(data)
        assert np.all(inside(spaces, rng.dirichlet(np.ones(len(data)), 50) @ data))
        outside = np.array([[2.0, 1.0, 3.0], [1.1, 0.5, 1.5], [0.5, 0.5, 1.4], [-0.1, 0.0, 0.0]])
        assert not inside(spaces, outside).any()


@pytest.mark.parametrize("points", [[[0.5]], [[0.5, 1.0]], [[0.5, 1.0], [0.5, 1.0], [0.5, 1.0]]])
def test_one_point_is_all_there_is(points):
    data = np.array(points)
    spaces = half_spaces(data)
    assert inside(spaces, data[:1])[0]
    assert not inside(spaces, data[:1] + 1e-3)[0]


TRIANGLE = np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def held(points: list[list[float]], data: np.ndarray) -> np.ndarray:
    return clamped(np.array(points), half_spaces(data), data.min(axis=0), data.max(axis=0))


def test_the_nearest_point_of_a_box():
    box = np.array([[-1.0, 0.0], [1.0, 0.0], [-1.0, 2.0], [1.0, 2.0]])
    found = held([[0.5, 1.0], [3.0, -4.0], [-2.0, 2.5], [0.3, 9.0]], box)
    np.testing.assert_allclose(found, [[0.5, 1.0], [1.0, 0.0], [-1.0, 2.0], [0.3, 2.0]], atol=1e-14)


def test_the_nearest_point_of_a_triangle_by_hand():
    """In widths x' = (x + 1) / 2, y' = y the slope is x' + y' / 2 = 1: (1, 1) falls on (0.6, 0.8)."""
    found = held([[1.0, 1.0], [-1.0, 1.0], [0.2, -3.0], [0.0, 5.0], [7.0, 0.1], [0.2, 0.2]], TRIANGLE)
    wanted = [[0.2, 0.8], [-0.2, 0.8], [0.2, 0.0], [0.0, 1.0], [1.0, 0.0], [0.2, 0.2]]
    np.testing.assert_allclose(found, wanted, atol=1e-14)


@settings(max_examples=60, deadline=None)
@given(seeds, st.integers(6, 25), st.integers(1, 4), sizes, st.sampled_from([0.0, 1.0]), st.sampled_from([2.0, 1e4]))
def test_no_point_of_the_hull_is_nearer(seed, n, d, size, shift, reach):
    """For the nearest point c of a convex hull, (x - c) . (p - c) <= 0 for every datum p, in box widths."""
    data = cloud(seed, n, d, size, shift)
    low, width = data.min(axis=0), np.ptp(data, axis=0)
    points = low + width * np.random.default_rng(seed + 3).uniform(-reach, reach, (40, d))
    spaces = half_spaces(data)
    found = clamped(points, spaces, low, data.max(axis=0))
    within = inside(spaces, points)
    np.testing.assert_array_equal(found[within], points[within])
    assert np.all(inside(spaces, found))
    x, c, p = ((y - low) / width for y in (points, found, data))
    turn = np.einsum("nd,npd->np", x - c, p[None] - c[:, None])
    assert np.all(turn <= 1e-8 * reach)


@settings(max_examples=30, deadline=None)
@given(seeds)
def test_the_nearest_point_does_not_depend_on_units_or_company(seed):
    data = cloud(seed, 12, 3, 1.0, 0.0)
    points = np.random.default_rng(seed + 4).uniform(-3.0, 4.0, (20, 3)) * np.ptp(data, axis=0) + data.min(axis=0)
    factor = np.array([57.295779513, 1e-3, 1.0])
    first, second = held(points, data), held(points * factor, data * factor)
    np.testing.assert_allclose(second / factor, first, rtol=0.0, atol=1e-8 * np.ptp(data, axis=0).max())
    alone = np.vstack([held(points[i : i + 1], data) for i in range(len(points))])
    np.testing.assert_allclose(alone, first, rtol=0.0, atol=1e-8 * np.ptp(data, axis=0).max())


def test_data_on_a_line_or_in_one_variable_hold_points_there():
    line = np.column_stack([np.linspace(0.0, 1.0, 9), 2.0 * np.linspace(0.0, 1.0, 9) + 1e3])
    found = held([[1.0, 1e3], [5.0, 1010.0], [0.25, 1000.5]], line)
    np.testing.assert_allclose(found, [[0.5, 1001.0], [1.0, 1002.0], [0.25, 1000.5]], atol=1e-9)
    pinned = np.column_stack([TRIANGLE, np.full(3, 0.3)])
    np.testing.assert_allclose(held([[1.0, 1.0, 7.0]], pinned), [[0.2, 0.8, 0.3]], atol=1e-12)


def test_what_has_no_nearest_point_is_nan():
    found = held([[np.nan, 0.0], [np.inf, 0.0], [2.0, 0.0]], TRIANGLE)
    assert np.isnan(found).all(axis=1).tolist() == [True, True, False]
    low, high = np.array([0.0, 0.0]), np.array([1.0, 1.0])
    contradiction = np.array([[1.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
    assert np.isnan(clamped(np.array([[0.5, 0.5]]), contradiction, low, high)).all()


def test_the_taper_leaves_the_hull_with_its_slope_and_ends_flat():
    low, high = np.array([-1.0]), np.array([1.0])
    end = TAPER * 2.0

    def weight(beyond: float) -> float:
        x = 1.0 + beyond
        return float(taper_weight(np.array([[x]]), np.array([[min(x, 1.0)]]), low, high)[0])

    assert weight(-0.5) == weight(0.0) == 1.0
    assert weight(end) == weight(5.0) == 0.0
    assert weight(end / 2.0) == pytest.approx(0.5, abs=1e-12)
    step = 1e-6 * end
    assert abs(weight(step) - 1.0) < 1e-10
    assert abs(weight(end - step)) < 1e-10
    track = [weight(s) for s in np.linspace(0.0, end, 50)]
    assert np.all(np.diff(track) < 0.0)


def test_the_distance_counts_in_widths_and_a_flat_variable_tapers_at_once():
    low, high = np.array([0.0, 0.0, 3.0]), np.array([1.0, 10.0, 3.0])
    nearest = np.array([[1.0, 10.0, 3.0]])
    beyond = np.array([[0.0, 0.0, 0.0], [0.03, 0.4, 0.0], [0.06, 0.8, 0.0], [0.0, 0.0, 1e-4], [np.nan, 0.0, 0.0]])
    np.testing.assert_allclose(taper_weight(nearest + beyond, nearest, low, high), [1.0, 0.5, 0, 0, 0], atol=1e-12)


@pytest.mark.parametrize(
    ("low", "rows", "beyond"),
    [
        ([-1.0, -1.0], [[1, 1, -1], [1, -1, -1], [-1, 1, -1], [-1, -1, -1]], ()),  # a rhombus touches its box
        ([0.0, 0.0], [[1, 1, -1], [-1, 0, 0], [0, -1, 0]], ()),
        ([0.0, 0.0], [[1, 1, -1]], ("alpha", "beta")),
        ([-1.0, 0.0], [[1, 0, -1], [-1, 0, -1], [0, 1, -1], [0, -1, -1]], ("beta",)),  # one-sided, but for its rows
        ([-1.0, -1.0], [[0, 0, -1]], ("alpha", "beta")),
        ([-1.0, -1.0], [[1, 0, 2], [-1, 0, -9], [0, 1, -1], [0, -1, -1]], ("alpha",)),  # beside the box
    ],
)
def test_half_spaces_that_leave_the_box_are_named(
    low: list[float], rows: list[list[float]], beyond: tuple[str, ...]
) -> None:
    """Points below `low` had a value, and a hull beside its box gave that of the nearest point of nowhere."""
    domain = Domain(("alpha", "beta"), np.array(low), np.ones(2), np.array(rows, dtype=float))
    assert domain.beyond_its_box() == beyond

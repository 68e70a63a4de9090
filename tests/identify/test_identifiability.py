"""What a Jacobian determines: covariances, open parameters and the sets that are known only together."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.identify.determined import dependent_sets, determined

RNG = np.random.default_rng(7)
ALL = np.ones(4, dtype=bool)


def test_full_rank_gives_the_inverse() -> None:
    data = 20.0 * RNG.normal(size=(30, 3))
    covariance, is_open = determined(data, np.zeros((0, 3)))
    assert covariance == pytest.approx(np.linalg.inv(data.T @ data), rel=1e-10)
    assert not is_open.any()


def test_half_the_size_is_the_limit() -> None:
    for error, expected in ((0.49, False), (0.51, True)):
        covariance, is_open = determined(np.array([[1.0 / error]]), np.zeros((0, 1)))
        assert covariance[0, 0] == pytest.approx(error**2)
        assert is_open.tolist() == [expected]


def test_sums_of_three_are_found_and_no_more() -> None:
    a, b, d = 50.0 * RNG.normal(size=(3, 30))
    data = np.column_stack([a, b, a + b, d])
    (change,) = dependent_sets(data, ALL)
    assert change / change[0] == pytest.approx([1.0, 1.0, -1.0, 0.0], abs=1e-9)
    _, is_open = determined(data, np.zeros((0, 4)))
    assert is_open.tolist() == [True, True, True, False]


def test_two_pairs_are_two_sets() -> None:
    a, b = 50.0 * RNG.normal(size=(2, 30))
    found = dependent_sets(np.column_stack([a, 2.0 * a, b, -b]), ALL)
    assert [np.flatnonzero(c).tolist() for c in found] == [[0, 1], [2, 3]]
    assert found[0][1] / found[0][0] == pytest.approx(-0.5)
    assert found[1][3] / found[1][2] == pytest.approx(1.0)


def test_what_is_determined_may_follow() -> None:
    """Two columns that are alike but for a third, which is known well by itself: the pair is open all the same."""
    a, d = 50.0 * RNG.normal(size=(2, 30))
    faint = np.eye(31)[-1]
    data = np.column_stack([np.append(a, 0.0), np.append(a + d, 0.0) + 0.3 * faint, np.append(100.0 * d, 0.0)])
    _, is_open = determined(data, np.zeros((0, 3)))
    assert is_open.tolist() == [True, True, False]
    (change,) = dependent_sets(data, ALL[:3])
    assert np.flatnonzero(change).tolist() == [0, 1]
    assert change[0] == pytest.approx(-change[1], rel=1e-4)


def test_fewer_rows_than_parameters() -> None:
    _, is_open = determined(np.array([[3.0, 1.0]]), np.zeros((0, 2)))
    assert is_open.all()
    (change,) = dependent_sets(np.array([[3.0, 1.0]]), np.ones(2, dtype=bool))
    # The second alone is too faint to see, and needs no partner.
    assert np.flatnonzero(change).tolist() == [1]
    _, with_prior = determined(np.array([[3.0, 1.0]]), np.array([[0.0, 10.0]]))
    assert not with_prior.any()

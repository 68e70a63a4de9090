"""Oriented boxes in any attitude."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.mesh.oriented_box import oriented_box
from coeflab.law.transforms import rotation

TURN = rotation(0.3, -0.7, 1.1)


def corners(*sides: float) -> np.ndarray:
    return np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * sides - np.array(sides) / 2


@pytest.mark.parametrize("first", [np.eye(3), TURN])
def test_a_turned_box_is_found(first: np.ndarray) -> None:
    points = corners(3.0, 2.0, 1.0) @ TURN.T + [5.0, 6.0, 7.0]
    turn, sides, centre = oriented_box(points, first)
    assert sides == pytest.approx([3.0, 2.0, 1.0], rel=1e-6)
    assert centre == pytest.approx([5.0, 6.0, 7.0])
    assert np.linalg.det(turn) == pytest.approx(1.0)
    assert np.abs(turn.T @ TURN) == pytest.approx(np.eye(3), abs=1e-5)


def test_it_holds_all_points_and_is_no_larger_than_the_first() -> None:
    rng = np.random.default_rng(3)
    points = rng.normal(size=(3000, 3)) * [3, 1, 0.4] @ TURN.T
    turn, sides, centre = oriented_box(points, np.eye(3))
    local = (points - centre) @ turn
    assert np.all(np.abs(local) <= sides / 2 + 1e-9)
    assert np.prod(sides) <= np.prod(np.ptp(points, axis=0))
    assert list(sides) == sorted(sides, reverse=True)


def test_a_flat_cloud_keeps_the_first_attitude() -> None:
    flat = corners(3.0, 2.0, 0.0)
    turn, sides, _ = oriented_box(flat, np.eye(3))
    assert sides == pytest.approx([3.0, 2.0, 0.0])
    assert turn == pytest.approx(np.eye(3))

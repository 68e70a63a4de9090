"""Where motions settle: closed forms, at rest, and where they settle nowhere."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from coeflab.core.types import Array
from coeflab.motion.steady_state import differences, growth, settled

ONE = np.eye(1)


def drag(push: Array) -> Callable[[Array], Array]:
    return lambda x: np.tile(push[:, None], (len(x) // len(push), 1)) - 2.0 * x * np.abs(x)


def test_quadratic_drag_ahead_astern_and_at_rest() -> None:
    push = np.array([8.0, 1e-6, -8.0, 0.0])
    x, found = settled(drag(push), ONE, np.full((4, 1), 0.3) * np.sign(push)[:, None], np.maximum(np.abs(push), 1e-9))
    assert found.all()
    assert x[:, 0] == pytest.approx([2.0, np.sqrt(0.5e-6), -2.0, 0.0], rel=1e-7, abs=1e-12)


def test_a_start_on_the_wrong_side_comes_round() -> None:
    x, found = settled(drag(np.array([8.0])), ONE, np.array([[-5.0]]), np.array([8.0]))
    assert found.all()
    assert x[0, 0] == pytest.approx(2.0, rel=1e-8)


def test_it_settles_where_the_motion_ends_not_where_another_root_is() -> None:
    """x' = x - x^3: 0 is a root, but unstable; from either side the motion ends at +-1."""
    x, _ = settled(lambda x: x - x**3, ONE, np.array([[0.01], [-0.01]]), np.ones(2))
    assert x[:, 0] == pytest.approx([1.0, -1.0])


def test_no_rest_is_not_found_and_spoils_no_neighbour() -> None:
    def forces(x: Array) -> Array:
        return np.column_stack([np.where(np.arange(len(x)) % 2 == 0, 1.0 + x[:, 0] ** 2, 1.0 - x[:, 0])])

    x, found = settled(forces, ONE, np.zeros((2, 1)), np.ones(2))
    assert found.tolist() == [False, True]
    assert np.isnan(x[0, 0])
    assert x[1, 0] == pytest.approx(1.0)


def test_differences_in_one_call() -> None:
    calls: list[int] = []

    def forces(x: Array) -> Array:
        calls.append(len(x))
        return np.column_stack([x[:, 0] * x[:, 1], np.sin(x[:, 0])])

    at = np.array([[0.3, 2.0], [1.0, -1.0]])
    expected = np.array([[[y, x], [np.cos(x), 0.0]] for x, y in at])
    assert differences(forces, at) == pytest.approx(expected, abs=1e-9)
    assert calls == [8]


def test_growth_of_disturbances() -> None:
    slopes = np.array([[[-1.0, 0.0], [0.0, -3.0]], [[0.0, 2.0], [2.0, 0.0]], [[np.nan, 0.0], [0.0, 0.0]]])
    assert growth(2.0 * np.eye(2), slopes) == pytest.approx([-0.5, 1.0, np.nan], nan_ok=True)

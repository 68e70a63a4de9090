"""Eigenvalues of small motions against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.motion.small_motions import growth, linearised, modes


def test_a_pendulum_with_damping() -> None:
    """theta'' = -4 sin(theta) - 0.4 theta': eigenvalues -0.2 +- i sqrt(3.96) below, one positive above."""

    def rates(state: np.ndarray) -> np.ndarray:
        return np.array([state[1], -4.0 * np.sin(state[0]) - 0.4 * state[1]])

    below = modes(linearised(rates, np.zeros(2), np.ones(2)))
    assert below == pytest.approx(np.array([-0.2 + 1j * np.sqrt(3.96), -0.2 - 1j * np.sqrt(3.96)]), abs=1e-8)
    assert growth(below) == "stable"
    above = modes(linearised(rates, np.array([np.pi, 0.0]), np.ones(2)))
    assert above[0].real == pytest.approx(-0.2 + np.sqrt(4.04), abs=1e-8)
    assert growth(above) == "unstable"


def test_without_damping_it_is_neutral() -> None:
    assert growth(modes(np.array([[0.0, 1.0], [-4.0, 0.0]]))) == "neutral"
    assert growth(modes(np.zeros((0, 0)))) == "neutral"


def test_differences_scale_with_the_state() -> None:
    slope = linearised(lambda x: np.array([1e-6 * x[0] ** 2]), np.array([1e6]), np.array([1e6]))
    assert slope == pytest.approx(np.array([[2.0]]), rel=1e-8)

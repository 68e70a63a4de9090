"""The rotors of the TJ-FlyingFish against forces at points, crossed with their levers."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.published.flyingfish.model import calibrated
from coeflab.published.flyingfish.rotors import Rotors, rotor_wrench, steady_residuals

ROTORS = Rotors(
    np.array([0.0998, 0.1658, 0.0064, 0.0032, 0.0008, 0.0029]),
    np.array([18.2222, 15.8047, 24.7142, 0.0489, 0.1554, 0.1872]),
    np.array([6.0355e-4, 2.5604e-7]),
    np.array([1.81713e-7, 5.1233e-9]),
)
CONSTANTS = np.array([-1.6661, 2.2297, -0.3949, 0.22649, -0.01520])


def drawn(n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    random = np.random.default_rng(4)
    motion = random.normal(size=(n, 5)) * [0.4, 0.3, 0.2, 0.2, 0.3]
    return motion, random.normal(size=(n, 4)), random.uniform(100.0, 2500.0, size=(n, 4))


def test_the_corrected_sign_is_that_of_forces_at_the_rotors() -> None:
    arm, height = 0.3, -0.02
    _, angles, speeds = drawn(5)
    thrust, torque = 1e-3 * speeds, 1e-5 * speeds
    sin, cos, zero = np.sin(angles), np.cos(angles), np.zeros(5)
    along = [
        np.column_stack(rows)
        for rows in (
            (sin[:, 0], zero, cos[:, 0]), (-sin[:, 1], zero, cos[:, 1]), (zero, -sin[:, 2], cos[:, 2]),
            (zero, sin[:, 3], cos[:, 3]),
        )
    ]  # fmt: skip
    at = [(0.0, arm, -height), (0.0, -arm, -height), (arm, 0.0, -height), (-arm, 0.0, -height)]
    force, moment = np.zeros((5, 3)), np.zeros((5, 3))
    for i, hand in enumerate((1.0, 1.0, -1.0, -1.0)):
        pushed = thrust[:, i : i + 1] * along[i]
        force += pushed
        moment += np.cross(at[i], pushed) + hand * torque[:, i : i + 1] * along[i]
    got = rotor_wrench(angles, thrust, torque, arm, height, -1.0)
    assert got == pytest.approx(np.hstack([force, moment]), abs=1e-12)
    printed = rotor_wrench(angles, thrust, torque, arm, height)
    assert printed[:, :5] == pytest.approx(got[:, :5])
    assert printed[:, 5] - got[:, 5] == pytest.approx(2.0 * arm * np.sum(thrust * sin, axis=1))


def test_row_one_of_table_1_by_hand() -> None:
    """Surge: T1 sin 79.72 deg + T2 sin 75.30 deg = (0.0998 + 18.2222 * 0.5) * 0.5 = 4.60545 N."""
    angles, speeds = np.radians([[79.72, -75.30, 0.0, 0.0]]), np.array([[2056.42, 2100.45, 623.62, 250.03]])
    t1 = 2.5604e-7 * 2056.42**2 + 6.0355e-4 * 2056.42
    t2 = 2.5604e-7 * 2100.45**2 + 6.0355e-4 * 2100.45
    by_hand = t1 * np.sin(np.radians(79.72)) + t2 * np.sin(np.radians(75.30)) - 4.60545
    got = steady_residuals(ROTORS, CONSTANTS, np.array([[0.5, 0.0, 0.0, 0.0, 0.0]]), angles, speeds)
    assert got[0, 0] == pytest.approx(by_hand, abs=1e-12)
    assert np.max(np.abs(got[:, :3])) < 5e-4
    assert np.max(np.abs(got[:, 3:])) < 1.5e-4


def test_calibrated_constants_are_the_least_squares() -> None:
    """They leave the least squares: every step aside is worse."""
    motion, angles, speeds = drawn(6)
    left = steady_residuals(ROTORS, CONSTANTS, motion, angles, speeds).ravel()
    found = calibrated(ROTORS, motion, angles, speeds)
    best = steady_residuals(ROTORS, found, motion, angles, speeds).ravel()
    assert best @ best <= left @ left
    for k in range(5):
        for step in (1e-3, -1e-3):
            other = found + step * np.eye(5)[k]
            worse = steady_residuals(ROTORS, other, motion, angles, speeds).ravel()
            assert worse @ worse > best @ best

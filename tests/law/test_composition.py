"""The 6 x 6 congruence transform and what a kinetic energy must be."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.law.definiteness import composed, definiteness
from coeflab.law.transforms import moved, turned

RNG = np.random.default_rng(4)
ROOT = RNG.normal(size=(6, 6))
MATRIX = ROOT @ ROOT.T
ROTATION = np.linalg.qr(RNG.normal(size=(3, 3)))[0]
ROTATION = ROTATION * np.sign(np.linalg.det(ROTATION))
SHIFT = np.array([2.0, -0.7, 1.3])


def test_there_and_back() -> None:
    assert np.max(np.abs(moved(moved(MATRIX, SHIFT), -SHIFT) - MATRIX)) < 1e-12 * np.max(moved(MATRIX, SHIFT))
    assert np.max(np.abs(turned(turned(MATRIX, ROTATION), ROTATION.T) - MATRIX)) < 1e-12
    both = turned(moved(turned(moved(MATRIX, SHIFT), ROTATION), -ROTATION @ SHIFT), ROTATION.T)
    assert np.max(np.abs(both - MATRIX)) < 1e-12 * np.max(moved(MATRIX, SHIFT))


def test_kinetic_energy_does_not_depend_on_the_point() -> None:
    """v at the old point = v at the new one + omega x (old - new), written out."""
    v, omega = RNG.normal(size=3), RNG.normal(size=3)
    old = np.concatenate([v + np.cross(omega, -SHIFT), omega])
    new = np.concatenate([v, omega])
    assert new @ moved(MATRIX, SHIFT) @ new == pytest.approx(old @ MATRIX @ old, rel=1e-12)


def test_kinetic_energy_does_not_depend_on_the_axes() -> None:
    v, omega = RNG.normal(size=3), RNG.normal(size=3)
    inner, outer = np.concatenate([v, omega]), np.concatenate([ROTATION @ v, ROTATION @ omega])
    assert outer @ turned(MATRIX, ROTATION) @ outer == pytest.approx(inner @ MATRIX @ inner, rel=1e-12)


def test_two_spheres_on_a_rod() -> None:
    """Parallel axes: K stays, M and N get 2 m l^2; nothing couples about the middle."""
    one = ellipsoid_added_mass(np.array([0.1, 0.1, 0.1]), 1000.0)
    m = one[0, 0]
    centres = [np.array([5.0, 0.0, 0.0]), np.array([-5.0, 0.0, 0.0])]
    found = composed([one, one], [np.eye(3)] * 2, centres, np.zeros(3))
    assert found == pytest.approx(np.diag([2 * m, 2 * m, 2 * m, 0.0, 50.0 * m, 50.0 * m]), rel=1e-14, abs=1e-12)
    about_one = composed([one, one], [np.eye(3)] * 2, centres, centres[1])
    assert about_one[5, 5] == pytest.approx(100.0 * m)
    assert about_one[1, 5] == pytest.approx(10.0 * m)
    assert about_one[2, 4] == pytest.approx(-10.0 * m)


def test_signs_of_a_mast() -> None:
    """Mass above the origin (z < 0): surge couples to pitch with m z, sway to roll with -m z."""
    one = np.diag([1.0, 2.0, 0.0, 0.0, 0.0, 0.0])
    found = composed([one], [np.eye(3)], [np.array([0.0, 0.0, -3.0])], np.zeros(3))
    assert found[0, 4] == pytest.approx(-3.0)
    assert found[1, 3] == pytest.approx(6.0)


def test_definite_or_not() -> None:
    assert definiteness(MATRIX).holds
    assert definiteness(np.zeros((6, 6))).holds
    assert definiteness(np.diag([1.0, 0.0, 1e-9, 1e9, 0.0, 1.0])).holds
    assert not definiteness(np.diag([1.0, 1.0, 1.0, 1.0, 1.0, -1e-6])).holds
    lopsided = MATRIX.copy()
    lopsided[0, 1] *= 1.0 + 1e-6
    assert not definiteness(lopsided).holds
    coupled = np.eye(6)
    coupled[1, 5] = coupled[5, 1] = 1.01
    assert definiteness(coupled).smallest == pytest.approx(-0.01)
    hollow = np.diag([0.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    hollow[0, 1] = hollow[1, 0] = 1e-3
    assert not definiteness(hollow).holds
    assert not definiteness(np.full((6, 6), np.nan)).holds

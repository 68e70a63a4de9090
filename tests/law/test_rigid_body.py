"""Motion of a rigid body in water against closed forms and conservation laws."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.law.rigid_body import about_another, ideal_force, inertia_doubt, parallel_axis, rigid_body_inertia
from coeflab.law.transforms import moved, velocity_transfer
from tests.rigid_motion import motion, rotation

MASS, CENTRE = 7.0, np.array([0.1, -0.05, 0.2])
OWN = np.array([[1.0, 0.1, 0.0], [0.1, 2.0, 0.2], [0.0, 0.2, 2.5]])
ROOT = np.random.default_rng(3).normal(size=(6, 6))
ADDED = ROOT @ ROOT.T
START = np.array([1.0, 0.2, -0.1, 0.3, -0.2, 0.4])
TIMES = np.linspace(0.0, 4.0, 81)


def free(_time: np.ndarray, nu: np.ndarray) -> np.ndarray:
    return np.zeros_like(nu)


def test_a_spinning_top_without_forces_precesses() -> None:
    """Symmetric about x: p stays, q and r turn at (1 - Ix/It) p (Euler's equations)."""
    found = motion(2.0, np.zeros(3), np.diag([1.0, 3.0, 3.0]), np.zeros((6, 6)), free,
                   np.array([0, 0, 0, 2.0, 0.1, 0.0]), TIMES)  # fmt: skip
    turn = (1.0 - 1.0 / 3.0) * 2.0 * TIMES
    np.testing.assert_allclose(found.velocity[:, 3], 2.0, rtol=1e-9)
    np.testing.assert_allclose(found.velocity[:, 4], 0.1 * np.cos(turn), atol=1e-9)
    np.testing.assert_allclose(found.velocity[:, 5], 0.1 * np.sin(turn) * -1.0, atol=1e-9)


def test_a_ballistic_centre_of_gravity_goes_straight() -> None:
    inertia = OWN + parallel_axis(MASS, CENTRE)
    found = motion(MASS, CENTRE, inertia, np.zeros((6, 6)), free, START, TIMES)
    way = found.position + np.array([rotation(q) @ CENTRE for q in found.attitude])
    straight = way[0] + np.outer(TIMES, START[:3] + np.cross(START[3:], CENTRE))
    np.testing.assert_allclose(way, straight, atol=1e-8)


def test_in_an_ideal_fluid_energy_and_both_momenta_stay() -> None:
    """Kirchhoff's equations: the impulse of body and fluid is constant in earth axes (Lamb 1932, article 119)."""
    inertia = OWN + parallel_axis(MASS, CENTRE)
    total = rigid_body_inertia(MASS, CENTRE, inertia) + ADDED
    found = motion(MASS, CENTRE, inertia, ADDED, lambda _, nu: ideal_force(ADDED, nu), START, TIMES)
    impulse = found.velocity @ total
    energy = np.einsum("ni,ni->n", found.velocity, impulse) / 2.0
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)
    turned = [rotation(q) for q in found.attitude]
    linear = np.array([r @ i[:3] for r, i in zip(turned, impulse, strict=True)])
    angular = np.array([r @ i[3:] for r, i in zip(turned, impulse, strict=True)]) + np.cross(found.position, linear)
    np.testing.assert_allclose(linear, np.tile(linear[0], (len(linear), 1)), atol=1e-7)
    np.testing.assert_allclose(angular, np.tile(angular[0], (len(angular), 1)), atol=1e-7)


def test_the_motion_does_not_depend_on_the_point() -> None:
    shift = np.array([0.4, 0.1, -0.3])
    inertia = OWN + parallel_axis(MASS, CENTRE)
    here = motion(MASS, CENTRE, inertia, ADDED, lambda _, nu: ideal_force(ADDED, nu), START, TIMES)
    added = moved(ADDED, shift)
    there = motion(MASS, CENTRE - shift, about_another(inertia, MASS, CENTRE, CENTRE - shift), added,
                   lambda _, nu: ideal_force(added, nu), velocity_transfer(shift) @ START, TIMES)  # fmt: skip
    np.testing.assert_allclose(there.velocity, here.velocity @ velocity_transfer(shift).T, atol=1e-8)


def test_a_force_in_time() -> None:
    found = motion(2.0, np.zeros(3), np.eye(3), np.zeros((6, 6)),
                   lambda t, nu: np.tile([4.0 * np.cos(t[0]), 0, 0, 0, 0, 0], (len(nu), 1)), np.zeros(6), TIMES)  # fmt: skip
    np.testing.assert_allclose(found.velocity[:, 0], 2.0 * np.sin(TIMES), atol=1e-9)
    np.testing.assert_allclose(found.position[:, 0], 2.0 - 2.0 * np.cos(TIMES), atol=1e-9)


@pytest.mark.parametrize(
    ("inertia", "said"),
    [
        (OWN, ""),
        (np.diag([1.0, 1.0, 2.0]), ""),
        (np.diag([1.0, 1.0, 2.1]), "larger than the others"),
        (np.diag([-1.0, 2.0, 2.0]), "-1"),
        (np.array([[1.0, 0.3, 0], [0, 1.0, 0], [0, 0, 1.0]]), "not symmetric"),
    ],
)
def test_what_inertia_a_body_can_have(inertia: np.ndarray, said: str) -> None:
    found = inertia_doubt(MASS, CENTRE, inertia + parallel_axis(MASS, CENTRE))
    assert said in found if said else found == ""


def test_an_unstable_motion_is_an_error() -> None:
    with pytest.raises(ArithmeticError):
        motion(2.0, np.zeros(3), np.eye(3), np.zeros((6, 6)), lambda _, nu: nu**3 * 50.0, START, TIMES)

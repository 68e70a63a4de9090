"""The ideal-fluid force: against C_A of the textbook, no work, the Munk moment, the table of conventions."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.law.rigid_body import ideal_force, ideal_quadratics
from coeflab.law.transforms import force_transfer, moved, skew, velocity_transfer

RNG = np.random.default_rng(8)
ROOT = RNG.normal(size=(6, 6))
MATRIX = ROOT @ ROOT.T
NU = RNG.normal(size=(40, 6))


def coriolis(matrix: np.ndarray, nu: np.ndarray) -> np.ndarray:
    """C_A as Fossen (2011) prints it, equation 6.43."""
    v, w = nu[:3], nu[3:]
    upper = skew(matrix[:3, :3] @ v + matrix[:3, 3:] @ w)
    lower = skew(matrix[3:, :3] @ v + matrix[3:, 3:] @ w)
    return np.block([[np.zeros((3, 3)), -upper], [-upper, -lower]])


def test_it_is_minus_c_of_nu_times_nu() -> None:
    expected = np.array([-coriolis(MATRIX, nu) @ nu for nu in NU])
    np.testing.assert_allclose(ideal_force(MATRIX, NU), expected, atol=1e-12)


def test_it_does_no_work() -> None:
    np.testing.assert_allclose(np.einsum("ij,ij->i", ideal_force(MATRIX, NU), NU), 0.0, atol=1e-11)


def test_quadratics_give_the_same_force() -> None:
    q = ideal_quadratics(MATRIX)
    np.testing.assert_allclose(np.einsum("ijk,nj,nk->ni", q, NU, NU), ideal_force(MATRIX, NU), atol=1e-12)
    np.testing.assert_array_equal(q, np.swapaxes(q, 1, 2))


def test_a_moved_point_sees_the_same_force() -> None:
    shift = np.array([0.4, -0.2, 0.9])
    there = ideal_force(moved(MATRIX, shift), NU @ velocity_transfer(shift).T)
    np.testing.assert_allclose(there, ideal_force(MATRIX, NU) @ force_transfer(shift).T, atol=1e-11)


def test_velocity_derivatives_of_a_body_with_two_planes() -> None:
    """Munk moment and the rotary shares, in the acceleration derivatives of the conventions."""
    m = np.diag([2.0, 30.0, 28.0, 0.1, 9.0, 11.0])
    m[1, 5] = m[5, 1] = 1.5
    m[2, 4] = m[4, 2] = -1.4
    xudot, yvdot, zwdot, yrdot, zqdot = -m[0, 0], -m[1, 1], -m[2, 2], -m[1, 5], -m[2, 4]
    slope = 2.0 * ideal_quadratics(m)[:, 0, :]
    names = {
        "Yr": (1, 5),
        "Nr": (5, 5),
        "Zq": (2, 4),
        "Mq": (4, 4),
        "Nv": (5, 1),
        "Mw": (4, 2),
        "Yv": (1, 1),
        "Zw": (2, 2),
    }
    expected = {
        "Yr": xudot, "Nr": yrdot, "Zq": -xudot, "Mq": -zqdot,
        "Nv": yvdot - xudot, "Mw": xudot - zwdot, "Yv": 0.0, "Zw": 0.0,
    }  # fmt: skip
    for symbol, at in names.items():
        assert slope[at] == pytest.approx(expected[symbol], abs=1e-12), symbol
    assert expected["Nv"] < 0.0 < expected["Mw"], "the Munk moment turns the nose away from the flow"

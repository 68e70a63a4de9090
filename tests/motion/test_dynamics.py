"""Rates of the whole state beside other ways to write them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from coeflab.law.rigid_body import (
    ideal_force,
    ideal_quadratics,
    momentum_quadratics,
    rigid_body_force,
    rigid_body_inertia,
)
from coeflab.motion.dynamics import euler_angles, forms_of_pairs, rotations
from coeflab.motion.ensemble import alone
from coeflab.motion.simulators import rigid_body
from tests.formats.massed import ADDED, CENTRE, INERTIA, MASS
from tests.motion.fleet import coasting, massive, swimmer

CURRENT = np.array([0.3, -0.2, 0.1])


def states(n: int = 9) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(3)
    state = rng.normal(size=(14, n))
    state[3:7] /= np.linalg.norm(state[3:7], axis=0)
    return state, 0.2 * rng.normal(size=(3, n)), rng.normal(size=(6, n))


def test_accelerations_are_those_of_the_vehicle() -> None:
    v, (state, controls, wrench) = swimmer(), states()
    found = alone(v).dynamics(CURRENT).rates(state, controls, wrench)[7:13].T
    np.testing.assert_allclose(found, v.acceleration(state[7:13].T, state[3:7].T, controls.T, wrench.T), rtol=1e-12)


def test_kinematics_are_rotations_and_quaternion_products() -> None:
    state, controls, wrench = states()
    rates = alone(swimmer()).dynamics(CURRENT).rates(state, controls, wrench)
    turned = rotations(state[3:7].T)
    np.testing.assert_allclose(rates[:3].T, np.einsum("nij,nj->ni", turned, state[7:10].T) + CURRENT, atol=1e-14)
    w, p, spin = state[3], state[4:7].T, state[10:13].T
    np.testing.assert_allclose(rates[3], -0.5 * np.sum(p * spin, axis=1), atol=1e-14)
    np.testing.assert_allclose(rates[4:7].T, 0.5 * (w[:, None] * spin + np.cross(p, spin)), atol=1e-14)


def test_heading_rate_is_the_slope_of_yaw() -> None:
    state, controls, wrench = states()
    dynamics = alone(swimmer()).dynamics(CURRENT)
    rates = dynamics.rates(state, controls, wrench)
    h = 1e-6
    yaw = [euler_angles(((q := state[3:7] + s * h * rates[3:7]) / np.linalg.norm(q, axis=0)).T)[:, 2] for s in (1, -1)]
    np.testing.assert_allclose(rates[13], (yaw[0] - yaw[1]) / (2 * h), rtol=1e-6, atol=1e-6)


def test_products_of_velocities_do_no_work() -> None:
    """nu . C(nu) nu = 0, of the body and of the ideal fluid."""
    nu = np.random.default_rng(4).normal(size=(20, 6))
    rows, columns = np.triu_indices(6)
    pairs = (nu[:, rows] * nu[:, columns]).T
    rigid = forms_of_pairs(momentum_quadratics(rigid_body_inertia(MASS, CENTRE, INERTIA)))
    ideal = forms_of_pairs(ideal_quadratics(ADDED))
    np.testing.assert_allclose((rigid @ pairs).T, -rigid_body_force(MASS, CENTRE, INERTIA, nu), atol=1e-12)
    np.testing.assert_allclose((ideal @ pairs).T, ideal_force(ADDED, nu), atol=1e-12)
    for form in (rigid, ideal):
        force = (form @ pairs).T
        assert np.abs(np.sum(nu * force, axis=1)).max() < 1e-13 * np.abs(force).max()


def test_quaternion_attitude_is_that_of_euler_angles() -> None:
    """A body without fluid, spun gently: Euler's equations with rates of roll, pitch and yaw (Fossen 2011, equation 2.40)."""
    v = massive(centre=np.zeros(3))
    spin = np.array([0.3, 0.05, 0.2])
    motion = rigid_body.simulate(v, coasting(4.0, [0, 0, 0, *spin]), {"tolerance": 1e-12, "record": 0.5})

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        phi, theta, w = y[0], y[1], y[3:]
        p, q, r = w
        turn = q * np.sin(phi) + r * np.cos(phi)
        angles = [p + turn * np.tan(theta), q * np.cos(phi) - r * np.sin(phi), turn / np.cos(theta)]
        return np.concatenate([angles, -np.linalg.solve(v.inertia, np.cross(w, v.inertia @ w))])

    found = solve_ivp(rates, (0, 4), [0, 0, 0, *spin], "DOP853", t_eval=motion.time, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(motion.angles, found.y[:3].T, atol=1e-9)
    assert np.abs(motion.angles[:, 0]).max() > 0.5
    assert motion.heading[-1] == pytest.approx(motion.angles[-1, 2], abs=1e-9)

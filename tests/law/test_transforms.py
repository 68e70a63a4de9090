"""Reference point, axes and inertia against the formulas of the literature and against point masses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from coeflab.core.types import Array
from coeflab.law.rigid_body import rigid_body_force
from coeflab.law.transforms import derivative_transfer, force_transfer, skew, velocity_transfer

numbers = st.floats(-10.0, 10.0, allow_subnormal=False)
vectors = arrays(float, 3, elements=numbers)
sixes = arrays(float, 6, elements=numbers)
matrices = arrays(float, (6, 6), elements=numbers)
U, V, W, P, Q, R = range(6)
X, Y, Z, K, M, N = range(6)


@given(vectors, vectors)
def test_skew_is_the_cross_product(a: Array, b: Array) -> None:
    np.testing.assert_allclose(skew(a) @ b, np.cross(a, b), atol=1e-12)


@given(sixes, vectors)
def test_velocity_elsewhere_is_v_plus_omega_cross_shift(nu: Array, shift: Array) -> None:
    moved = velocity_transfer(shift) @ nu
    np.testing.assert_allclose(moved[:3], nu[:3] + np.cross(nu[3:], shift), atol=1e-12)
    np.testing.assert_array_equal(moved[3:], nu[3:])


@given(sixes, vectors)
def test_moment_elsewhere_is_k_minus_shift_cross_f(tau: Array, shift: Array) -> None:
    moved = force_transfer(shift) @ tau
    np.testing.assert_array_equal(moved[:3], tau[:3])
    np.testing.assert_allclose(moved[3:], tau[3:] - np.cross(shift, tau[:3]), atol=1e-11)


@given(sixes, sixes, vectors)
def test_power_is_the_same_about_any_point(nu: Array, tau: Array, shift: Array) -> None:
    power = (force_transfer(shift) @ tau) @ (velocity_transfer(shift) @ nu)
    assert power == pytest.approx(tau @ nu, abs=1e-9)


@given(matrices, vectors, vectors)
def test_derivatives_there_and_back_and_by_two_steps(d: Array, one: Array, two: Array) -> None:
    left, right = derivative_transfer(one)
    moved = left @ d @ right
    left, right = derivative_transfer(-one)
    scale = 1e-12 * (1.0 + np.abs(moved).max()) * (1.0 + np.abs(one).max() ** 2)
    np.testing.assert_allclose(left @ moved @ right, d, rtol=0, atol=scale)
    left, right = derivative_transfer(two)
    both_left, both_right = derivative_transfer(one + two)
    wanted = both_left @ d @ both_right
    np.testing.assert_allclose(left @ moved @ right, wanted, rtol=0, atol=1e-10 * (1.0 + np.abs(wanted).max()))


@given(matrices, sixes, vectors)
def test_transferred_derivatives_give_the_transferred_force(d: Array, nu: Array, shift: Array) -> None:
    left, right = derivative_transfer(shift)
    found = (left @ d @ right) @ (velocity_transfer(shift) @ nu)
    wanted = force_transfer(shift) @ (d @ nu)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9 * (1.0 + np.abs(d).max() * 1e3))


@given(matrices, numbers)
def test_port_starboard_derivatives_of_an_origin_moved_forward(d: Array, dx: float) -> None:
    left, right = derivative_transfer(np.array([dx, 0.0, 0.0]))
    moved = left @ d @ right
    tolerance = {"rel": 1e-12, "abs": 1e-9}
    assert moved[Y, V] == pytest.approx(d[Y, V], **tolerance)
    assert moved[N, V] == pytest.approx(d[N, V] - dx * d[Y, V], **tolerance)
    assert moved[Y, R] == pytest.approx(d[Y, R] - dx * d[Y, V], **tolerance)
    assert moved[N, R] == pytest.approx(d[N, R] - dx * (d[N, V] + d[Y, R]) + dx**2 * d[Y, V], **tolerance)


@given(matrices, numbers)
def test_vertical_plane_derivatives_have_the_other_sign(d: Array, dx: float) -> None:
    """w at a point ahead is w - q dx, and M there is M + dx Z."""
    left, right = derivative_transfer(np.array([dx, 0.0, 0.0]))
    moved = left @ d @ right
    tolerance = {"rel": 1e-12, "abs": 1e-9}
    assert moved[M, W] == pytest.approx(d[M, W] + dx * d[Z, W], **tolerance)
    assert moved[Z, Q] == pytest.approx(d[Z, Q] + dx * d[Z, W], **tolerance)
    assert moved[M, Q] == pytest.approx(d[M, Q] + dx * (d[M, W] + d[Z, Q]) + dx**2 * d[Z, W], **tolerance)


def test_an_added_mass_matrix_stays_symmetric() -> None:
    root = np.random.default_rng(2).normal(size=(6, 6))
    left, right = derivative_transfer(np.array([0.4, -0.1, 0.2]))
    moved = left @ (root @ root.T) @ right
    np.testing.assert_allclose(moved, moved.T, atol=1e-12)
    assert np.linalg.eigvalsh(moved).min() > 0.0


def turned(omega: Array, time: float) -> Array:
    """Rotation matrix of a constant body rate (Rodrigues)."""
    rate = float(np.linalg.norm(omega))
    s = skew(omega / rate)
    return np.asarray(np.eye(3) + np.sin(rate * time) * s + (1.0 - np.cos(rate * time)) * s @ s)


@settings(max_examples=20)
@given(st.integers(0, 10_000))
def test_rigid_body_force_is_the_rate_of_momentum_of_point_masses(seed: int) -> None:
    """Five masses on a rigid body in steady motion, their earth-fixed momentum differentiated numerically."""
    rng = np.random.default_rng(seed)
    masses, places = rng.uniform(0.5, 3.0, 5), rng.normal(size=(5, 3))
    v, omega = rng.normal(size=3), rng.normal(size=3)
    total, centre = masses.sum(), masses @ places / masses.sum()
    inertia = sum(m * (p @ p * np.eye(3) - np.outer(p, p)) for m, p in zip(masses, places, strict=True))

    def momenta(time: float) -> Array:
        """Linear momentum, and angular momentum about the place where the reference point is at time zero."""
        steps = 400
        turn = turned(omega, time)
        middles = [(k + 0.5) * time / steps for k in range(steps)]
        origin = np.sum([turned(omega, t) @ v for t in middles], axis=0) * time / steps
        speeds = (v + np.cross(omega, places)) @ turn.T
        at = origin + places @ turn.T
        return np.concatenate([masses @ speeds, np.sum(masses[:, None] * np.cross(at, speeds), axis=0)])

    step = 1e-4
    wanted = (momenta(step) - momenta(-step)) / (2.0 * step)
    found = rigid_body_force(float(total), centre, inertia, np.concatenate([v, omega])[None, :])[0]
    np.testing.assert_allclose(found, wanted, atol=2e-6 * (1.0 + np.abs(wanted).max()))


def test_a_rotating_arm_balance_reads_y_r_less_m_u() -> None:
    """Fluid force less inertia: (Yr - m U) r and (Nr - m xG U) r, for a body with its tail-to-nose axis on the arc."""
    mass, xg, speed, rates = 706.0, 0.013, 2.0, np.array([-0.11, 0.05, 0.08])
    inertia = np.diag([25.0, 800.0, 800.0])
    nu = np.zeros((3, 6))
    nu[:, U], nu[:, R] = speed, rates
    inertial = rigid_body_force(mass, np.array([xg, 0.0, 0.0]), inertia, nu)
    np.testing.assert_allclose(inertial[:, Y], mass * speed * rates, rtol=1e-13)
    np.testing.assert_allclose(inertial[:, N], mass * xg * speed * rates, rtol=1e-13)
    np.testing.assert_allclose(inertial[:, X], -mass * xg * rates**2, rtol=1e-13)


def test_inertia_does_no_work_in_steady_motion() -> None:
    rng = np.random.default_rng(8)
    nu = rng.normal(size=(50, 6))
    root = rng.normal(size=(3, 3))
    force = rigid_body_force(3.0, rng.normal(size=3), root @ root.T, nu)
    np.testing.assert_allclose(np.einsum("ij,ij->i", force, nu), 0.0, atol=1e-12 * np.abs(force).max() * 50)

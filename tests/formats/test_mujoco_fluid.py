"""The ellipsoid law of MuJoCo: closed forms of its parts, and the ellipsoid of given added masses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.formats.mujoco.law import FluidEllipsoid, ellipsoid_of_masses
from coeflab.law.rigid_body import ideal_force

AXES = np.array([1.5, 0.3, 0.2])
RHO = 1000.0
SEMI = st.floats(0.05, 3.0)


def law(**coefficients: float) -> FluidEllipsoid:
    return FluidEllipsoid(
        AXES, **{"blunt": 0, "slender": 0, "angular": 0, "kutta": 0, "magnus": 0, **coefficients}, density=RHO
    )


def test_without_coefficients_it_is_the_ideal_fluid() -> None:
    nu = np.random.default_rng(1).normal(size=(30, 6))
    force, torque = law().force(nu[:, :3], nu[:, 3:])
    expected = ideal_force(ellipsoid_added_mass(AXES, RHO), nu)
    np.testing.assert_allclose(np.hstack([force, torque]), expected, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize(("axis", "front"), [(0, 0.06), (1, 0.3), (2, 0.45)])
def test_drag_along_an_axis(axis: int, front: float) -> None:
    v = 2.0 * np.eye(3)[axis][None]
    force, torque = law(blunt=0.7, slender=0.1).force(v, np.zeros((1, 3)))
    area = np.pi * front
    assert force[0, axis] == pytest.approx(-RHO * 4.0 * (0.7 * area + 0.1 * (np.pi * 0.45 - area)))
    np.testing.assert_allclose(torque, 0.0, atol=1e-12)


def test_lift_of_small_drift() -> None:
    """Kutta: -C rho pi b c ((a/b)^2 - 1) U v; Magnus: C rho V w x v."""
    force, _ = law(kutta=0.2).force(np.array([[2.0, 1e-6, 0.0]]), np.zeros((1, 3)))
    assert force[0, 1] == pytest.approx(-0.2 * RHO * np.pi * 0.06 * (25.0 - 1.0) * 2.0 * 1e-6, rel=1e-6)
    magnus, _ = law(magnus=0.2).force(np.array([[2.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 0.1]]))
    plain, _ = law().force(np.array([[2.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 0.1]]))
    assert (magnus - plain)[0, 1] == pytest.approx(0.2 * RHO * 4.0 / 3.0 * np.pi * 0.09 * 0.2)


def test_angular_drag_about_z() -> None:
    w = np.array([[0.0, 0.0, -0.5]])
    _, torque = law(angular=0.3).force(np.zeros((1, 3)), w)
    assert torque[0, 2] == pytest.approx(RHO * 0.3 * 8.0 / 15.0 * np.pi * 0.2 * 1.5**4 * 0.25)


@given(SEMI, SEMI, SEMI)
@settings(max_examples=25)
def test_the_ellipsoid_of_its_own_masses(a: float, b: float, c: float) -> None:
    axes = np.array([a, b, c])
    found, miss = ellipsoid_of_masses(np.diag(ellipsoid_added_mass(axes, RHO))[:3], RHO)
    assert miss < 1e-9
    np.testing.assert_allclose(found, axes, rtol=1e-6)

"""Meridian quadrature and strip theory against spheres, spheroids and cylinders."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.closed_forms.revolution import (
    graded_nodes,
    lamb_end_correction,
    meridian_integrals,
    strip_added_mass,
)


def spheroid(a: float, b: float, middle: float = 0.0) -> tuple[np.ndarray, ...]:
    x, w = graded_nodes(-a, a, 40)
    return x + middle, w, b * np.sqrt(1.0 - (x / a) ** 2), -(b**2) * x / a**2


def test_graded_nodes_integrate_a_root() -> None:
    """The integral of x^(1/3) over [0, 1] is 3/4: grading makes it easy, plain Gauss does not."""
    graded, plain = (
        abs(float(np.sum(w * np.cbrt(x))) - 0.75) for x, w in (graded_nodes(0, 1, 40, 4), graded_nodes(0, 1, 40))
    )
    assert graded < 1e-8 < plain
    x, w = graded_nodes(2.0, 5.0, 48, 3)
    assert float(np.sum(w)) == pytest.approx(3.0, rel=1e-9)
    assert np.all((x > 2.0) & (x < 5.0))


def test_sphere() -> None:
    found = meridian_integrals(*spheroid(2.0, 2.0, 7.0))
    assert found.volume == pytest.approx(4.0 / 3.0 * np.pi * 8.0, rel=1e-13)
    assert found.centre == pytest.approx(7.0, rel=1e-13)
    assert found.wetted_surface == pytest.approx(16.0 * np.pi, rel=1e-13)


def test_prolate_spheroid() -> None:
    e = np.sqrt(1.0 - 1.0 / 36.0)
    found = meridian_integrals(*spheroid(3.0, 0.5))
    assert found.wetted_surface == pytest.approx(2.0 * np.pi * 0.25 * (1.0 + 6.0 / e * np.arcsin(e)), rel=1e-6)
    assert found.second_moment == pytest.approx(found.volume * 9.0 / 5.0, rel=1e-13)


def test_strip_of_a_spheroid_is_its_displaced_mass() -> None:
    integrals = meridian_integrals(*spheroid(3.0, 0.5))
    mass = 1000.0 * integrals.volume
    expected = np.diag([0.0, mass, mass, 0.0, mass * 9.0 / 5.0, mass * 9.0 / 5.0])
    assert strip_added_mass(integrals, 1000.0) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("a", "b"), [(3.0, 0.5), (1.0, 0.9), (40.0, 1.0)])
def test_end_correction_makes_the_spheroid_exact(a: float, b: float) -> None:
    integrals = meridian_integrals(*spheroid(a, b))
    correction = lamb_end_correction(2.0 * a, integrals.volume)
    exact = ellipsoid_added_mass(np.array([a, b, b]), 1000.0)
    assert strip_added_mass(integrals, 1000.0, correction) == pytest.approx(exact, rel=1e-11, abs=1e-9)


def test_end_correction_vanishes_for_the_slender() -> None:
    k = lamb_end_correction(1.0, 1e-9)
    assert (k.axial, k.lateral, k.turning) == pytest.approx((0.0, 1.0, 1.0), abs=1e-6)

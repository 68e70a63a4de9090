"""Lamb's ellipsoid against direct integration, printed values, and its limits."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass, mixed_integral, shape_factors

GENERAL = [(3.0, 2.0, 1.0), (1.0, 0.4, 0.7), (0.5, 1.5, 1.4), (6.0, 1.0, 1.0), (0.3, 1.0, 1.0), (1.0, 1.0, 0.999)]


def integral(axes: tuple[float, ...], *extra: float) -> float:
    """abc times the integral of 1 / (product of (extra^2 + l) Delta), by l = (s / (1 - s))^2."""

    def integrand(s: float) -> float:
        t = s / (1.0 - s)
        delta = np.prod([np.sqrt(a * a + t * t) for a in axes])
        return 2.0 * t / (1.0 - s) ** 2 / (delta * np.prod([e * e + t * t for e in extra]))

    return float(np.prod(axes) * quad(integrand, 0.0, 1.0, epsabs=1e-14, epsrel=1e-13, limit=400)[0])


def diagonal(*axes: float) -> np.ndarray:
    matrix = ellipsoid_added_mass(np.array(axes), 1.0)
    assert np.array_equal(matrix, np.diag(np.diag(matrix)))
    return np.diag(matrix)


@pytest.mark.parametrize("axes", GENERAL)
def test_against_direct_integration(axes: tuple[float, float, float]) -> None:
    factors = [integral(axes, a) for a in axes]
    assert shape_factors(np.array(axes)) == pytest.approx(factors, rel=1e-10)
    mass = 4.0 * np.pi / 3.0 * np.prod(axes)
    found = diagonal(*axes)
    assert found[:3] == pytest.approx([mass * f / (2.0 - f) for f in factors], rel=1e-10)
    for i in range(3):
        b, c = axes[(i + 1) % 3], axes[(i + 2) % 3]
        mixed = integral(axes, b, c)
        lamb = mass / 5.0 * (b * b - c * c) ** 2 * mixed / (2.0 - (b * b + c * c) * mixed)
        assert found[3 + i] == pytest.approx(lamb, rel=1e-9, abs=1e-14)


def test_mixed_integral_at_equal_arguments() -> None:
    assert mixed_integral(2.0, 2.0, 2.0) == pytest.approx(0.4 * 2.0**-2.5, rel=1e-14)
    assert mixed_integral(0.0, 1.0, 1.0) == pytest.approx(3.0 * np.pi / 8.0, rel=1e-14)


def test_sphere() -> None:
    assert diagonal(2.0, 2.0, 2.0)[:3] == pytest.approx([0.5 * 4.0 * np.pi / 3.0 * 8.0] * 3, rel=1e-14)
    assert not np.any(diagonal(2.0, 2.0, 2.0)[3:])


def test_spheroid_of_the_printed_example() -> None:
    """Corrected eccentricity: e^2 = 1 - (b/a)^2, at a = 1, b = 0.4; all over the displaced mass."""
    found = diagonal(1.0, 0.4, 0.4)
    mass = 4.0 * np.pi / 3.0 * 0.16
    assert found[:3] / mass == pytest.approx([0.1563, 0.7619, 0.7619], abs=5e-5)
    assert found[4] / mass == pytest.approx(0.0847, abs=5e-5)


def test_prolate_closed_form() -> None:
    """Lamb 114: alpha0 = 2 (1 - e^2) / e^3 (artanh e - e)."""
    e = np.sqrt(1.0 - 0.16)
    alpha = 2.0 * (1.0 - e * e) / e**3 * (np.arctanh(e) - e)
    assert shape_factors(np.array([1.0, 0.4, 0.4]))[0] == pytest.approx(alpha, rel=1e-13)


def test_disc_has_no_thickness() -> None:
    assert diagonal(2.0, 2.0, 0.0) == pytest.approx(
        [0, 0, 8.0 / 3.0 * 8, 16.0 / 45.0 * 32, 16.0 / 45.0 * 32, 0], rel=1e-14
    )
    assert diagonal(0.0, 2.0, 2.0) == pytest.approx(
        [8.0 / 3.0 * 8, 0, 0, 0, 16.0 / 45.0 * 32, 16.0 / 45.0 * 32], rel=1e-14
    )


@pytest.mark.parametrize("thin", [1e-4, 1e-8, 1e-13])
def test_thin_ellipsoids_approach_the_elliptic_disc(thin: float) -> None:
    flat = diagonal(1.0, 0.4, 0.0)
    assert flat[2] == pytest.approx(4.0 * np.pi / 3.0 * 0.16 / 1.150655, rel=1e-5)
    assert diagonal(1.0, 0.4, thin) == pytest.approx(flat, rel=20.0 * thin + 1e-13, abs=20.0 * thin)


@pytest.mark.parametrize("thin", [1e-3, 1e-6, 1e-9])
def test_needle_has_sections_only(thin: float) -> None:
    mass = 4.0 * np.pi / 3.0 * thin**2
    found = diagonal(1.0, thin, thin) / mass
    close = 40.0 * thin**2 * np.log(2.0 / thin) + 1e-13
    assert found == pytest.approx([0.0, 1.0, 1.0, 0.0, 0.2, 0.2], abs=close)
    axial = thin**2 * (np.log(2.0 / thin) - 1.0)
    assert found[0] == pytest.approx(axial, rel=close * 10 + 1e-12)


def test_smooth_through_equal_axes() -> None:
    """A quotient that cancelled would be noisy here; steps of 1e-7 change the values by that much and no more."""
    for centre in ((1.0, 1.0, 1.0), (1.0, 1.0, 0.3), (0.3, 1.0, 1.0)):
        for i in range(3):
            step = np.eye(3)[i]
            values = np.array([diagonal(*(np.array(centre) + k * 1e-7 * step)) for k in range(-3, 4)])
            assert np.max(np.abs(np.diff(values, n=2, axis=0))) < 2e-12
            assert np.all(np.diff(values, axis=0)[:, 0] > 0.0) or i == 0


def test_turning_near_the_sphere() -> None:
    """Lamb's form expands to m/5 (b^2 - c^2)^2 I / (2 - 2 b^2 I), I = 2/5 at the unit sphere."""
    for small in (1e-3, 1e-5, 1e-7):
        b, c = 1.0 + small / 2.0, 1.0 - small / 2.0
        lead = 4.0 * np.pi / 15.0 * (2.0 * small) ** 2 * 0.4 / 1.2
        assert diagonal(1.0, b, c)[3] == pytest.approx(lead, rel=10.0 * small + 1e-8)


def test_nothing_displaced() -> None:
    assert not np.any(ellipsoid_added_mass(np.array([1.0, 0.0, 0.0]), 1000.0))


def test_permuting_axes_permutes_entries() -> None:
    a, b = diagonal(3.0, 2.0, 1.0), diagonal(1.0, 3.0, 2.0)
    assert b == pytest.approx([a[2], a[0], a[1], a[5], a[3], a[4]], rel=1e-14)


def test_size_and_density() -> None:
    a = np.diag(ellipsoid_added_mass(np.array([3.0, 2.0, 1.0]), 1.0))
    b = np.diag(ellipsoid_added_mass(np.array([6.0, 4.0, 2.0]), 1025.0))
    assert b == pytest.approx(1025.0 * a * [8, 8, 8, 32, 32, 32], rel=1e-14)

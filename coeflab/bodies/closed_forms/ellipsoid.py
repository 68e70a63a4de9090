"""Added mass of an ellipsoid in unbounded fluid, from the needle through the sphere to the disc.

Source: Lamb, Hydrodynamics (1932), sections 114-115 and 121 a; Carlson's symmetric integrals after DLMF 19.23 and 19.36.
"""

from __future__ import annotations

import numpy as np
from scipy.special import elliprd

from coeflab.core.types import Array

_DUPLICATIONS = 40


def mixed_integral(x: float, y: float, z: float) -> float:
    """Integral over t from 0 of (t+x)^(-1/2) (t+y)^(-3/2) (t+z)^(-3/2), for y, z > 0 and x >= 0.

    Notes
    -----
    It is the difference quotient of R_D in y and z. Carlson's duplication, applied to that quotient, has positive
    terms only, so y = z needs no case of its own; every step shrinks the spread of the arguments fourfold.
    """
    total, weight = 0.0, 1.0
    for _ in range(_DUPLICATIONS):
        p, s, r = np.sqrt([x, y, z])
        shared = p * s + p * r + s * r
        total += weight * 3.0 * (s * s + s * r + r * r + shared) / ((s + r) * s * r * (y + shared) * (z + shared))
        x, y, z, weight = (x + shared) / 4.0, (y + shared) / 4.0, (z + shared) / 4.0, weight / 16.0
    mean = (x + 3.0 * y + 3.0 * z) / 7.0
    return float(2.0 / 3.0 * (total + weight * 0.6 * mean**-2.5))


def _shape_integrals(axes: Array) -> Array:
    """(3,) integrals over lambda of 1 / ((axis^2 + lambda) Delta); infinite for an axis of zero."""
    a, b, c = axes**2
    return np.array([2.0 / 3.0 * elliprd(b, c, a), 2.0 / 3.0 * elliprd(a, c, b), 2.0 / 3.0 * elliprd(a, b, c)])


def shape_factors(axes: Array) -> Array:
    """Lamb's alpha0, beta0, gamma0 of the semi-axes; their sum is 2, from which the largest is taken.

    At most one axis may be zero.
    """
    scaled = axes / np.max(axes)
    r = _shape_integrals(scaled)
    short = int(np.argmin(scaled))
    factors = np.empty(3)
    for i in range(3):
        if i != short:
            factors[i] = np.prod(scaled) * r[i] if np.isfinite(r[i]) else 0.0
    factors[short] = 2.0 - sum(factors[i] for i in range(3) if i != short)
    return factors


def _turning(axes: Array, r: Array, i: int) -> float:
    """Added moment of inertia about axis ``i`` per density.

    Notes
    -----
    Lamb's m/5 (b^2 - c^2)^2 I / (2 - (b^2 + c^2) I), with the denominator written as alpha0 + 2 J,
    J = gamma0 - b^2 I = beta0 - c^2 I >= 0, and abc divided out of both.
    """
    j, k = sorted(({0, 1, 2} - {i}), key=lambda n: -axes[n])
    b, c = axes[j], axes[k]
    if axes[i] == 0.0:
        return 0.0
    if c == 0.0:
        integral, rest = 2.0 / b**2, r[j]
    else:
        mixed = mixed_integral(axes[i] ** 2, b**2, c**2)
        integral, rest = np.prod(axes) * mixed, r[j] - c**2 * mixed
    return float(4.0 * np.pi / 15.0 * ((b - c) * (b + c)) ** 2 * integral / (r[i] + 2.0 * rest))


def ellipsoid_added_mass(axes: Array, density: float) -> Array:
    """(6, 6) added mass about the centre, along the principal axes.

    Parameters
    ----------
    axes : (3,) array
        Semi-axes along x, y, z, m, none negative. One may be zero (a disc); with two at zero nothing is displaced and
        nothing accelerated.
    density : float
        kg/m^3.

    Returns
    -------
    (6, 6) array
        kg and kg m^2, diagonal.

    Notes
    -----
    Lamb 114 (8): A11 = m alpha0 / (2 - alpha0) with 2 - alpha0 = beta0 + gamma0, which neither disc nor needle cancels;
    abc is divided out, so that a disc of radius a gives 8/3 rho a^3 and 16/45 rho a^5 at zero thickness.
    """
    if np.count_nonzero(axes) < 2:
        return np.zeros((6, 6))
    size = float(np.max(axes))
    scaled = axes / size
    factors, r = shape_factors(scaled), _shape_integrals(scaled)
    out = np.zeros(6)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        out[i] = size**3 * 4.0 * np.pi / 3.0 * factors[i] / (r[j] + r[k])
        out[3 + i] = size**5 * _turning(scaled, r, i)
    return density * np.diag(out)


def spheroid_munk_slope(length: float, diameter: float) -> float:
    """Nv' of a prolate spheroid in potential flow by its length: -2 (k2 - k1) V / L^3; its Yv' is zero.

    Parameters
    ----------
    length, diameter : float
        m.
    """
    moved = ellipsoid_added_mass(np.array([length, diameter, diameter]) / 2.0, 1.0)
    return float(-2.0 * (moved[1, 1] - moved[0, 0]) / length**3)

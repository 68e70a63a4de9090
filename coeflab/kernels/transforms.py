"""Moving the reference point and turning the axes of 6-vectors and 6 x 6 derivative matrices.

Order of components: u v w p q r and X Y Z K M N. Source: Fossen (2011), section 7.5 (the transformation H).
"""

from __future__ import annotations

import numpy as np

from coeflab.kernels.least_squares import Array


def skew(a: Array) -> Array:
    """Matrix S with S @ b = a x b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def velocity_transfer(shift: Array) -> Array:
    """(6, 6) matrix H: velocity at a point ``shift`` away = H @ velocity at the old point (v + omega x shift)."""
    h = np.eye(6)
    h[:3, 3:] = -skew(shift)
    return h


def force_transfer(shift: Array) -> Array:
    """(6, 6) matrix: force and moment about the new point = it @ those about the old one (K - shift x F)."""
    t = np.eye(6)
    t[3:, :3] = -skew(shift)
    return t


def derivative_transfer(shift: Array) -> tuple[Array, Array]:
    """Matrices (A, B) with D_new = A @ D_old @ B for a matrix of derivatives d(force)/d(velocity)."""
    return force_transfer(shift), velocity_transfer(-shift)


def rigid_body_force(mass: float, centre: Array, inertia: Array, nu: Array) -> Array:
    """C_RB(nu) nu, the force and moment that hold a body in a steady motion, shape (n, 6).

    Parameters
    ----------
    mass : float
        kg.
    centre : (3,) array
        Centre of gravity from the reference point, m, FRD.
    inertia : (3, 3) array
        About the reference point, kg m^2.
    nu : (n, 6) array
        Velocities at the reference point.

    Notes
    -----
    Newton-Euler about a body point (Fossen 2011, equation 3.42): F = m (w x v + w x (w x rG)),
    K = w x (I w) + m rG x (w x v).
    """
    v, w = nu[:, :3], nu[:, 3:]
    spin = np.cross(w, v)
    force = mass * (spin + np.cross(w, np.cross(w, centre)))
    moment = np.cross(w, w @ inertia.T) + mass * np.cross(centre, spin)
    return np.hstack([force, moment])

"""The force that an ideal fluid exerts on a body in steady motion, and the share of it in each velocity derivative.

Kirchhoff's equations (Lamb 1932, article 124; Fossen 2011, property 6.2): with the fluid's momenta p = M11 v + M12 w and
h = M21 v + M22 w, the force is -w x p and the moment -w x h - v x p, which is -C_A(nu) nu.
"""

from __future__ import annotations

import numpy as np

from coeflab.kernels.least_squares import Array

LEVI_CIVITA = np.zeros((3, 3, 3))
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    LEVI_CIVITA[_i, _j, _k], LEVI_CIVITA[_i, _k, _j] = 1.0, -1.0


def ideal_force(matrix: Array, nu: Array) -> Array:
    """-C_A(nu) nu, shape (n, 6).

    Parameters
    ----------
    matrix : (6, 6) array
        Added mass about the point that ``nu`` and the moments are about.
    nu : (n, 6) array
        u v w p q r.
    """
    momentum = nu @ ((matrix + matrix.T) / 2.0)
    v, w, p, h = nu[:, :3], nu[:, 3:], momentum[:, :3], momentum[:, 3:]
    return np.hstack([-np.cross(w, p), -np.cross(w, h) - np.cross(v, p)])


def ideal_quadratics(matrix: Array) -> Array:
    """(6, 6, 6) array Q, symmetric in its last two axes: force i = sum of Q[i, j, k] nu_j nu_k."""
    return momentum_quadratics((matrix + matrix.T) / 2.0)


def momentum_quadratics(m: Array) -> Array:
    """The same for momenta ``m @ nu`` of a matrix that need not be symmetric, as some simulators are given it."""
    out = np.zeros((6, 6, 6))
    out[:3, 3:, :] -= np.einsum("iab,bk->iak", LEVI_CIVITA, m[:3])
    out[3:, 3:, :] -= np.einsum("iab,bk->iak", LEVI_CIVITA, m[3:])
    out[3:, :3, :] -= np.einsum("iab,bk->iak", LEVI_CIVITA, m[:3])
    return np.asarray((out + np.swapaxes(out, 1, 2)) / 2.0)

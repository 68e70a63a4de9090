"""Drag, side force and lift from body-axis forces.

Fossen (2011), section 2.4: X, Y, Z = R(alpha, beta) @ (-D, S, -L), with R = Ry(-alpha) Rz(beta) as below. For FRD axes:
D along the relative flow, S to starboard and L upward, both normal to it.
"""

from __future__ import annotations

import numpy as np

from coeflab.kernels.least_squares import Array


def incidence(u: Array, v: Array, w: Array) -> tuple[Array, Array]:
    """(alpha, beta) = (atan2(w, u), asin(v / V)), radians; zero at V = 0."""
    speed = np.sqrt(u**2 + v**2 + w**2)
    ratio = np.divide(v, speed, out=np.zeros_like(speed), where=speed > 0.0)
    return np.arctan2(w, u), np.arcsin(np.clip(ratio, -1.0, 1.0))


def wind_forces(alpha: Array, beta: Array, x: Array, y: Array, z: Array) -> tuple[Array, Array, Array]:
    """(D, S, L) from FRD forces, each (n,)."""
    ca, sa, cb, sb = np.cos(alpha), np.sin(alpha), np.cos(beta), np.sin(beta)
    drag = -(ca * cb * x + sb * y + sa * cb * z)
    side = -ca * sb * x + cb * y - sa * sb * z
    lift = sa * x - ca * z
    return drag, side, lift


def body_forces(alpha: Array, beta: Array, drag: Array, side: Array, lift: Array) -> tuple[Array, Array, Array]:
    """(X, Y, Z) in FRD from (D, S, L), each (n,)."""
    ca, sa, cb, sb = np.cos(alpha), np.sin(alpha), np.cos(beta), np.sin(beta)
    return (
        -ca * cb * drag - ca * sb * side + sa * lift,
        -sb * drag + cb * side,
        -sa * cb * drag - sa * sb * side - ca * lift,
    )

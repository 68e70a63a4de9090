"""Equations of motion of many vehicles at once: restoring forces, accelerations and the rates of the whole state.

Equations (Fossen 2011, equations 3.42, 4.6, 6.9, 2.68 and property 8.1), about the reference point, with the velocity nu
through a steady irrotational current::

    (M_RB + M_A) nu_dot = tau(nu, controls) - C_RB(nu) nu + g(attitude) + thrust        eta_dot = J(q) nu + current

with -C_A(nu) nu inside tau. The state is position (NED), attitude (quaternion, body to NED, scalar first), nu, and the
heading turned since the start.
"""

from __future__ import annotations

import numpy as np

from coeflab.kernels.least_squares import Array
from coeflab.kernels.transforms import skew

STATE = 14
POSITION, ATTITUDE, VELOCITY, HEADING = slice(0, 3), slice(3, 7), slice(7, 13), 13


def rotations(attitude: Array) -> Array:
    """(n, 3, 3) rotations, body to earth, of unit quaternions (n, 4)."""
    w, x, y, z = attitude.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def euler_angles(attitude: Array) -> Array:
    """(n, 3) roll, pitch and yaw, rad, of unit quaternions; yaw within -pi and pi."""
    turned = rotations(attitude)
    roll = np.arctan2(turned[:, 2, 1], turned[:, 2, 2])
    pitch = -np.arcsin(np.clip(turned[:, 2, 0], -1.0, 1.0))
    return np.column_stack([roll, pitch, np.arctan2(turned[:, 1, 0], turned[:, 0, 0])])


def from_euler(roll: float, pitch: float, yaw: float) -> Array:
    """(4,) unit quaternion of roll, pitch and yaw, rad (Fossen 2011, appendix E)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll / 2, pitch / 2, yaw / 2]), np.sin([roll / 2, pitch / 2, yaw / 2])
    return np.array(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    )


def turned_about(axis: Array, angle: float) -> Array:
    """(3, 3) rotation about a unit axis (3,), rad, right-handed (Rodrigues)."""
    s = skew(axis)
    return np.asarray(np.eye(3) + np.sin(angle) * s + (1.0 - np.cos(angle)) * s @ s)


def restoring(attitude: Array, weight: float, buoyancy: float, centre: Array, centre_of_buoyancy: Array) -> Array:
    """(n, 6) force and moment of weight and buoyancy about the reference point (Fossen 2011, equation 4.6, as a force)."""
    down = rotations(attitude)[:, 2, :]
    lever = weight * np.asarray(centre) - buoyancy * np.asarray(centre_of_buoyancy)
    return np.asarray(np.hstack([(weight - buoyancy) * down, np.cross(lever, down)]))

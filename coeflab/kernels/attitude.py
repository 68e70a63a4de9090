"""Attitudes of parts: angles of a rotation, and which of the equivalent ones is the tidy one."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np

from coeflab.kernels.least_squares import Array

RIGHT = np.pi / 2.0
UPRIGHT = 0.99


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """(3, 3) matrix from the part's axes to the body's: yaw, then pitch, then roll, rad (Fossen 2011, equation 2.18)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    about_z = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(about_z @ about_y @ about_x)


def angles(turn: Array) -> tuple[float, float, float]:
    """Roll, pitch and yaw of a (3, 3) rotation, rad; pitched straight up or down, roll is zero."""
    pitch = float(np.arcsin(np.clip(-turn[2, 0], -1.0, 1.0)))
    if np.hypot(turn[0, 0], turn[1, 0]) < 1e-9:
        return 0.0, pitch, float(np.arctan2(-turn[0, 1], turn[1, 1]))
    return float(np.arctan2(turn[2, 1], turn[2, 2])), pitch, float(np.arctan2(turn[1, 0], turn[0, 0]))


def relabelled(turn: Array, normal: bool = False) -> Array:
    """The same three axes in the order and with the signs that come nearest to the body's own: the largest trace.

    Parameters
    ----------
    turn : (3, 3) array
        Orthonormal columns.
    normal : bool
        Whether the third column stays the third.
    """
    best, first = turn, (-np.inf,)
    for order in permutations(range(3)):
        if normal and order[2] != 2:
            continue
        for signs in product((1.0, -1.0), repeat=3):
            made = turn[:, order] * signs
            if np.linalg.det(made) < 0.0:
                continue
            # Of equal traces the axes that point ahead, to starboard and down first, whatever signs came in.
            key = (round(float(np.trace(made)), 9), *np.round(made.T.ravel(), 6).tolist())
            if key > first:
                best, first = made, key
    return np.asarray(best)


def about_axis(axis: Array) -> Array:
    """(3, 3) rotation of a part that is round about its own x: x forward, else to starboard, else up.

    Its y is level; where x stands within 8 deg of upright, y is as near to starboard as can be.
    """
    leading = int(np.argmax(np.abs(axis) > np.abs(axis).max() - 1e-6))
    x = axis / np.linalg.norm(axis) * np.sign(axis[leading]) * (-1.0 if leading == 2 else 1.0)
    y = np.array([0.0, 1.0, 0.0]) - x * x[1] if abs(x[2]) > UPRIGHT else np.cross([0.0, 0.0, 1.0], x)
    y /= np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)])


def snapped(turn: Array, within: float) -> Array:
    """The rotation with angles within ``within`` of a right angle set to it, rad.

    A part whose x stands upright within that angle is set upright first, where roll and yaw are one.
    """
    roll, pitch, yaw = angles(turn)
    if abs(abs(pitch) - RIGHT) <= within:
        yaw, roll = float(np.arctan2(-turn[0, 1], turn[1, 1])), 0.0
    near = [RIGHT * round(a / RIGHT) if abs(a - RIGHT * round(a / RIGHT)) <= within else a for a in (roll, pitch, yaw)]
    return rotation(*near)

"""Moving the reference point, of forces and of added mass, and turning the axes.

Order of components: u v w p q r and X Y Z K M N. Source: Fossen (2011), section 7.5 (the transformation H).

Drag, side force and lift from body-axis forces.

Fossen (2011), section 2.4: X, Y, Z = R(alpha, beta) @ (-D, S, -L), with R = Ry(-alpha) Rz(beta) as below. For FRD axes:
D along the relative flow, S to starboard and L upward, both normal to it.

Attitudes of parts: angles of a rotation, and which of the equivalent ones is the tidy one.
"""

from __future__ import annotations

from itertools import permutations, product
from typing import Any

import numpy as np

from coeflab.core.types import Array


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


def incidence(u: Array, v: Array, w: Array) -> tuple[Array, Array]:
    """(alpha, beta) = (atan2(w, u), asin(v / V)), radians; zero at V = 0, whatever the signs of zeros are."""
    speed = np.sqrt(u**2 + v**2 + w**2)
    ratio = np.divide(v, speed, out=np.zeros_like(speed), where=speed > 0.0)
    return np.arctan2(w + 0.0, u + 0.0), np.arcsin(np.clip(ratio, -1.0, 1.0))


def wind_forces(alpha: Array, beta: Array, x: Array, y: Array, z: Array) -> tuple[Array, Array, Array]:
    """(D, S, L) from FRD forces, each (n,)."""
    ca, sa, cb, sb = np.cos(alpha), np.sin(alpha), np.cos(beta), np.sin(beta)
    drag = -(ca * cb * x + sb * y + sa * cb * z)
    side = -ca * sb * x + cb * y - sa * sb * z
    lift = sa * x - ca * z
    return drag, side, lift


def wind_errors(alpha: Array, beta: Array, x: Array, y: Array, z: Array) -> tuple[Array, Array, Array]:
    """Standard errors of (D, S, L) from independent ones of X, Y and Z, each (n,)."""
    none = np.zeros_like(x)
    shares = zip(
        *(wind_forces(alpha, beta, *e) for e in ((x, none, none), (none, y, none), (none, none, z))), strict=True
    )
    drag, side, lift = (np.sqrt(a**2 + b**2 + c**2) for a, b, c in shares)
    return drag, side, lift


def body_forces(alpha: Array, beta: Array, drag: Array, side: Array, lift: Array) -> tuple[Array, Array, Array]:
    """(X, Y, Z) in FRD from (D, S, L), each (n,)."""
    return along_body(np.cos(alpha), np.sin(alpha), np.cos(beta), np.sin(beta), drag, side, lift)


def along_body(ca: Any, sa: Any, cb: Any, sb: Any, drag: Any, side: Any, lift: Any) -> tuple[Any, Any, Any]:
    """The same from cosines and sines of alpha and beta: arithmetic alone, for numbers, arrays and what numba compiles."""
    return (
        -ca * cb * drag - ca * sb * side + sa * lift,
        -sb * drag + cb * side,
        -sa * cb * drag - sa * sb * side - ca * lift,
    )


RIGHT = np.pi / 2.0
UPRIGHT = 0.99


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """(3, 3) matrix from the part's axes to the body's: yaw, then pitch, then roll, rad (Fossen 2011, equation 2.18)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    about_z = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(about_z @ about_y @ about_x)


def denavit_hartenberg(theta: float, d: float, a: float, alpha: float) -> tuple[Array, Array]:
    """(3, 3) rotation and (3,) shift of A_(j-1)^j = Rz(theta) Tz(d) Tx(a) Rx(alpha), rad and m.

    The distal convention of the URV paper (section 4.2): x of frame j lies along the common normal of joints j and j + 1.
    """
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    turn = np.array([[ct, -st * ca, st * sa], [st, ct * ca, -ct * sa], [0.0, sa, ca]])
    return turn, np.array([a * ct, a * st, d])


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
            result = turn[:, order] * signs
            if np.linalg.det(result) < 0.0:
                continue
            # Of equal traces the axes that point ahead, to starboard and down first, whatever signs came in.
            key = (round(float(np.trace(result)), 9), *np.round(result.T.ravel(), 6).tolist())
            if key > first:
                best, first = result, key
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


def moved(matrix: Array, shift: Array) -> Array:
    """The (6, 6) matrix about a point ``shift`` (3,) away from the old one, same axes.

    Kinetic energy does not depend on the point: M_new = H^T M_old H, with H the velocity at the old point from that at
    the new one (Fossen 2011, section 7.5.4).
    """
    back = velocity_transfer(-shift)
    return np.asarray(back.T @ matrix @ back)


def turned(matrix: Array, rotation: Array) -> Array:
    """The (6, 6) matrix in outer axes; ``rotation`` (3, 3) takes components along the part's axes to the outer ones."""
    both = np.kron(np.eye(2), rotation)
    return np.asarray(both @ matrix @ both.T)


def turned_about(axis: Array, angle: float) -> Array:
    """(3, 3) rotation about a unit axis (3,), rad, right-handed (Rodrigues)."""
    s = skew(axis)
    return np.asarray(np.eye(3) + np.sin(angle) * s + (1.0 - np.cos(angle)) * s @ s)

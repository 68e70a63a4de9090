"""The motion of a rigid body in water, integrated by a way of its own: what ours and other simulators are compared with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.law.rigid_body import rigid_body_inertia
from coeflab.law.transforms import skew


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """A motion, one row a time.

    Attributes
    ----------
    time : (n,) array
        s.
    position : (n, 3) array
        Of the reference point, NED, m.
    attitude : (n, 4) array
        Unit quaternion, scalar first, body to NED.
    velocity : (n, 6) array
        u v w p q r at the reference point, FRD.
    """

    time: Array
    position: Array
    attitude: Array
    velocity: Array


def rotation(quaternion: Array) -> Array:
    """(3, 3) rotation, body to earth, of a quaternion (4,), scalar first."""
    q = quaternion / np.linalg.norm(quaternion)
    s = skew(q[1:])
    return np.asarray(np.eye(3) + 2.0 * q[0] * s + 2.0 * s @ s)


def motion(
    mass: float,
    centre: Array,
    inertia: Array,
    added: Array,
    force: Callable[[Array, Array], Array],
    start: Array,
    times: Array,
    tolerance: float = 1e-10,
) -> Trajectory:
    """Integrate from the origin, upright and heading north, by the Dormand-Prince method of order 8.

    No step is longer than the time between two rows: inside a long step of a stiff motion, such as roll that is damped
    fast, interpolation is worse than the tolerance.

    Parameters
    ----------
    mass : float
        kg.
    centre : (3,) array
        Centre of gravity from the reference point, m, FRD.
    inertia : (3, 3) array
        About the reference point, kg m^2.
    added : (6, 6) array
        Added mass about the reference point.
    force : callable
        Time and (n, 6) velocities -> (n, 6) forces about the reference point, everything but inertia.
    start : (6,) array
        Velocities at the first time.
    times : (n,) array
        s, increasing; where the motion is wanted.
    tolerance : float
        Relative, of a step.

    Raises
    ------
    ArithmeticError
        The step became too small, as with an inertia that is not positive definite.
    """
    from scipy.integrate import solve_ivp

    inverse = np.linalg.inv(rigid_body_inertia(mass, centre, inertia) + added)

    def rates(time: float, state: Array) -> Array:
        quaternion, nu = state[3:7], state[None, 7:]
        w = nu[0, 3:]
        out = np.empty(13)
        out[:3] = rotation(quaternion) @ nu[0, :3]
        out[3] = -0.5 * quaternion[1:] @ w
        out[4:7] = 0.5 * (quaternion[0] * w + np.cross(quaternion[1:], w))
        out[7:] = inverse @ (force(np.array([time]), nu) - _gyroscopic(mass, centre, inertia, nu))[0]
        return out

    first = np.concatenate([np.zeros(3), [1.0, 0.0, 0.0, 0.0], start])
    found = solve_ivp(
        rates,
        (times[0], times[-1]),
        first,
        method="DOP853",
        t_eval=times,
        rtol=tolerance,
        atol=tolerance,
        max_step=float(np.min(np.diff(times))),
    )
    if not found.success:
        raise ArithmeticError(found.message)
    states = found.y.T
    attitude = states[:, 3:7] / np.linalg.norm(states[:, 3:7], axis=1)[:, None]
    return Trajectory(found.t, states[:, :3], attitude, states[:, 7:])


def _gyroscopic(mass: float, centre: Array, inertia: Array, nu: Array) -> Array:
    """C_RB(nu) nu by Newton and Euler: F = m (w x v + w x (w x rG)), K = w x (I w) + m rG x (w x v)."""
    v, w = nu[:, :3], nu[:, 3:]
    spin = np.cross(w, v)
    force = mass * (spin + np.cross(w, np.cross(w, centre)))
    return np.hstack([force, np.cross(w, w @ inertia.T) + mass * np.cross(centre, spin)])

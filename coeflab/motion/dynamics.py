"""Equations of motion of many vehicles at once: restoring forces, accelerations and the rates of the whole state.

Equations (Fossen 2011, equations 3.42, 4.6, 6.9, 2.68 and property 8.1), about the reference point, with the velocity nu
through a steady irrotational current::

    (M_RB + M_A) nu_dot = tau(nu, controls) - C_RB(nu) nu + g(attitude) + thrust        eta_dot = J(q) nu + current

with -C_A(nu) nu inside tau. The state is position (NED), attitude (quaternion, body to NED, scalar first), nu, and the
heading turned since the start.

Every product of two velocities (the ideal fluid's and -C_RB(nu) nu) is one quadratic form of the 21 pairs, so that a member of an
ensemble may have a mass and an added mass of its own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass
from coeflab.law.force_law import ForceLaw
from coeflab.law.rigid_body import axes_in_earth, kinematics, weighed

FIRST, SECOND = np.triu_indices(6)
FLAT = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Dynamics:
    """What a march needs to know of vehicles.

    Attributes
    ----------
    law : ForceLaw
        Its terms; the ideal quadratics are those of ``quadratics``.
    quadratics : (6, 21) or (m, 6, 21) array
        Force of every pair of velocities u u, u v, .. r r.
    inverse : (6, 6) or (m, 6, 6) array
        Accelerations of unit forces; zero rows for what is held.
    excess : (1,) or (m,) array
        Weight less buoyancy, N.
    lever : (3, 1) or (3, m) array
        W r_G - B r_B, N m.
    current : (3,) array
        North, east, down, m/s.
    """

    law: ForceLaw
    quadratics: Array
    inverse: Array
    excess: Array
    lever: Array
    current: Array

    def members(self, chosen: NDArray[np.int64]) -> Dynamics:
        """Those of some members; what all share stays shared."""
        law = self.law
        if law.coefficient.ndim == 2:
            law = replace(law, coefficient=law.coefficient[chosen])
        return Dynamics(
            law,
            self.quadratics[chosen] if self.quadratics.ndim == 3 else self.quadratics,
            self.inverse[chosen] if self.inverse.ndim == 3 else self.inverse,
            self.excess[chosen] if len(self.excess) > 1 else self.excess,
            self.lever[:, chosen] if self.lever.shape[1] > 1 else self.lever,
            self.current,
        )

    def rates(self, state: Array, controls: Array, wrench: Array) -> Array:
        """Time derivatives of the states, (14, n).

        Parameters
        ----------
        state : (14, n) array
            As `coeflab.motion.dynamics` has it.
        controls : (3, n) array
            dr, ds, db, rad.
        wrench : (6, n) array
            Of the thrusters.
        """
        nu = state[7:13]
        # Numbers are several times quicker than arrays of one.
        moving = tuple(state[3:13] if state.shape[1] > 1 else state[3:13, 0].tolist())
        axes = axes_in_earth(*moving[:4])
        *steady, turning, flat = kinematics(axes, *moving)
        out = np.empty_like(state)
        for k, rate in enumerate(steady):
            out[k] = rate
        out[:3] += self.current[:, None]
        total = self.law.term_force(nu, controls) + wrench
        pairs = nu[FIRST] * nu[SECOND]
        total += (
            self.quadratics @ pairs if self.quadratics.ndim == 2 else np.einsum("nip,pn->in", self.quadratics, pairs)
        )
        for k, force in enumerate(weighed(self.excess, *self.lever, *axes[2::3])):
            total[k] += force
        out[7:13] = self.inverse @ total if self.inverse.ndim == 2 else np.einsum("nij,jn->in", self.inverse, total)
        out[13] = np.where(flat > FLAT, turning / np.maximum(flat, FLAT), 0.0)
        return out


def forms_of_pairs(quadratics: Array) -> Array:
    """(.., 6, 21) forms of the pairs from (.., 6, 6, 6) quadratics."""
    both = quadratics + np.swapaxes(quadratics, -1, -2)
    return np.asarray(both[..., FIRST, SECOND] * np.where(FIRST == SECOND, 0.5, 1.0))


STATE = 14
POSITION, ATTITUDE, VELOCITY, HEADING = slice(0, 3), slice(3, 7), slice(7, 13), 13


def rotations(attitude: Array) -> Array:
    """(n, 3, 3) rotations, body to earth, of unit quaternions (n, 4)."""
    return np.array(axes_in_earth(*attitude.T)).T.reshape(-1, 3, 3).swapaxes(1, 2)


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


def restoring(attitude: Array, weight: float, buoyancy: float, centre: Array, centre_of_buoyancy: Array) -> Array:
    """(n, 6) force and moment of weight and buoyancy about the reference point (Fossen 2011, equation 4.6, as a force)."""
    lever = weight * np.asarray(centre) - buoyancy * np.asarray(centre_of_buoyancy)
    return np.column_stack(weighed(weight - buoyancy, *lever, *axes_in_earth(*attitude.T)[2::3]))

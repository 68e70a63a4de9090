"""Rates of the whole state of many vehicles at once, one column a vehicle.

The same equations as `coeflab.kernels.vehicle_motion`: every product of two velocities (the ideal fluid's and -C_RB(nu) nu)
is one quadratic form of the 21 pairs, so that a member of an ensemble may have a mass and an added mass of its own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.kernels.least_squares import Array
from coeflab.kernels.motion_law import MotionLaw
from coeflab.kernels.transforms import rigid_body_force

FIRST, SECOND = np.triu_indices(6)
FLAT = 1e-12


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Dynamics:
    """What a march needs to know of vehicles.

    Attributes
    ----------
    law : MotionLaw
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

    law: MotionLaw
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
            As `coeflab.kernels.vehicle_motion` has it.
        controls : (3, n) array
            dr, ds, db, rad.
        wrench : (6, n) array
            Of the thrusters.
        """
        nu = state[7:13]
        # Numbers are several times quicker than arrays of one.
        w, x, y, z, u, v, down, p, q, r = state[3:13] if state.shape[1] > 1 else state[3:13, 0].tolist()
        ahead = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))
        aside = (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x))
        below = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
        out = np.empty_like(state)
        for k in range(3):
            out[k] = ahead[k] * u + aside[k] * v + below[k] * down + self.current[k]
        out[3] = -0.5 * (x * p + y * q + z * r)
        out[4] = 0.5 * (w * p + y * r - z * q)
        out[5] = 0.5 * (w * q + z * p - x * r)
        out[6] = 0.5 * (w * r + x * q - y * p)
        total = self.law.term_force(nu, controls) + wrench
        pairs = nu[FIRST] * nu[SECOND]
        total += (
            self.quadratics @ pairs if self.quadratics.ndim == 2 else np.einsum("nip,pn->in", self.quadratics, pairs)
        )
        gx, gy, gz = ahead[2], aside[2], below[2]
        lx, ly, lz = self.lever
        for k, weight in enumerate((gx, gy, gz)):
            total[k] += self.excess * weight
        total[3] += ly * gz - lz * gy
        total[4] += lz * gx - lx * gz
        total[5] += lx * gy - ly * gx
        out[7:13] = self.inverse @ total if self.inverse.ndim == 2 else np.einsum("nij,jn->in", self.inverse, total)
        # Horizontal direction of the x axis, which moves as r times the y axis less q times the z axis.
        flat = ahead[0] * ahead[0] + ahead[1] * ahead[1]
        north, east = r * aside[0] - q * below[0], r * aside[1] - q * below[1]
        out[13] = np.where(flat > FLAT, (ahead[0] * east - ahead[1] * north) / np.maximum(flat, FLAT), 0.0)
        return out


def rigid_body_quadratics(mass: float, centre: Array, inertia: Array) -> Array:
    """(6, 21) -C_RB(nu) nu as a form of the pairs (Fossen 2011, equation 3.42), by polarisation."""
    unit = np.eye(6)
    alone = -rigid_body_force(mass, centre, inertia, unit)
    both = -rigid_body_force(mass, centre, inertia, unit[FIRST] + unit[SECOND])
    crossed = both - alone[FIRST] - alone[SECOND]
    return np.asarray(np.where((FIRST == SECOND)[:, None], alone[FIRST], crossed).T)


def ideal_pairs(ideal: Array) -> Array:
    """(.., 6, 21) forms of the pairs from (.., 6, 6, 6) quadratics."""
    both = ideal + np.swapaxes(ideal, -1, -2)
    return np.asarray(both[..., FIRST, SECOND] * np.where(FIRST == SECOND, 0.5, 1.0))

"""Steady motion of a vehicle with four rotors that tilt about their arms, as the TJ-FlyingFish paper prints it.

Equations 35-40 (rotors), 47 and 48 (thrust and torque), 25-30 (damping) and 51-56 (steady motion) with v = p = q = 0.
Rotors 1 and 2 stand to starboard and port, 3 and 4 ahead and astern. Errata: equation 47 prints 0.0006 for 6.0355e-4;
equation 40 prints + for its lever term, where the rotor positions of equations 38 and 39 give -: ``lever`` is that sign.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Rotors:
    """What the paper prints of the vehicle in water.

    Attributes
    ----------
    linear, quadratic : (6,) array
        Damping of u v w p q r; the force is -(linear + quadratic |u|) u.
    thrust, torque : (2,) array
        Factors of the speed and of its square, N and N m per rpm and rpm^2.
    """

    linear: Array
    quadratic: Array
    thrust: Array
    torque: Array


def rotor_wrench(angles: Array, thrust: Array, torque: Array, arm: float, height: float, lever: float = 1.0) -> Array:
    """X Y Z K M N of the rotors, shape (n, 6); equations 35-40.

    Parameters
    ----------
    angles : (n, 4) array
        beta, rad.
    thrust, torque : (n, 4) array
        N and N m.
    arm, height : float
        L and z_t, m.
    lever : float
        1 as equation 40 is printed, -1 as the rotor positions give.
    """
    across, along = thrust * np.sin(angles), thrust * np.cos(angles)
    spun, turned = torque * np.sin(angles), torque * np.cos(angles)
    ahead, aside = across[:, 0] - across[:, 1], across[:, 3] - across[:, 2]
    return np.column_stack(
        [
            ahead,
            aside,
            np.sum(along, axis=1),
            (along[:, 0] - along[:, 1]) * arm + aside * height + spun[:, 0] - spun[:, 1],
            (along[:, 3] - along[:, 2]) * arm - ahead * height + spun[:, 2] - spun[:, 3],
            lever * np.sum(across, axis=1) * arm + turned @ np.array([1.0, 1.0, -1.0, -1.0]),
        ]
    )


def steady_residuals(
    rotors: Rotors, constants: Array, motion: Array, angles: Array, speeds: Array, lever: float = 1.0
) -> Array:
    """Left minus right side of equations 51-56, shape (n, 6), N and N m.

    Parameters
    ----------
    rotors : Rotors
    constants : (5,) array
        In the order of `CONSTANTS`: (m - rho V) g in N, m in kg, rho g V z_B in N m, L and z_t in m.
    motion : (n, 5) array
        u w r phi theta, SI and rad.
    angles, speeds : (n, 4) array
        beta in rad, rotor speeds in rpm.
    lever : float
        See `rotor_wrench`.
    """
    u, w, r, roll, pitch = motion.T
    weight, mass, righting, arm, height = constants
    zero = np.zeros(len(motion))
    nu = np.column_stack([u, zero, w, zero, zero, r])
    thrust = rotors.thrust[0] * speeds + rotors.thrust[1] * speeds**2
    torque = rotors.torque[0] * speeds + rotors.torque[1] * speeds**2
    needed = (rotors.linear + rotors.quadratic * np.abs(nu)) * nu
    needed[:, 0] += weight * np.sin(pitch)
    needed[:, 1] += mass * u * r - weight * np.cos(pitch) * np.sin(roll)
    needed[:, 2] -= weight * np.cos(pitch) * np.cos(roll)
    needed[:, 3] -= righting * np.cos(pitch) * np.sin(roll)
    needed[:, 4] -= righting * np.sin(pitch)
    return np.asarray(rotor_wrench(angles, thrust, torque, arm, height, lever) - needed)

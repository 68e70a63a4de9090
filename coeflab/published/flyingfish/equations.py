"""Equations 1 to 34 of the TJ-FlyingFish paper as it prints them, in Euler angles and one component at a time.

They share nothing with the equations that coeflab integrates, which are compared with them. Where the paper errs, an argument
says which reading is meant.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from coeflab.core.types import Array


def earth_rates(nu: Array, angles: Array) -> Array:
    """(n, 6) rates of x y z phi theta psi; equations 1 to 6.

    Parameters
    ----------
    nu : (n, 6) array
        u v w p q r, m/s and rad/s.
    angles : (n, 3) array
        phi theta psi, rad.
    """
    u, v, w, p, q, r = nu.T
    (sf, st, sp), (cf, ct, cp) = np.sin(angles.T), np.cos(angles.T)
    return np.column_stack(
        [
            u * cp * ct - v * (cf * sp - cp * sf * st) + w * (sf * sp + cf * cp * st),
            u * ct * sp + v * (cf * cp + sf * sp * st) - w * (cp * sf - cf * sp * st),
            -u * st + v * ct * sf + w * cf * ct,
            p + q * sf * st / ct + r * cf * st / ct,
            q * cf - r * sf,
            q * sf / ct + r * cf / ct,
        ]
    )


def damping(linear: Array, quadratic: Array, nu: Array) -> Array:
    """(n, 6) X_D .. N_D, against the motion where positive; equations 13 to 18 and 25 to 30."""
    return np.asarray((linear + quadratic * np.abs(nu)) * nu)


def body_rates(
    nu: Array, lean: Array, push: Array, drag: Array, mass: float, inertia: Array, gravity: float,
    buoyancy: float = 0.0, righting: float = 0.0,
) -> Array:  # fmt: skip
    """(n, 6) rates of u v w p q r: equations 7 to 12, with buoyancy 19 to 24 without added mass.

    Parameters
    ----------
    nu : (n, 6) array
    lean : (n, 2) array
        phi theta, rad.
    push, drag : (n, 6) array
        X_P .. N_P and X_D .. N_D, N and N m.
    mass : float
        kg.
    inertia : (3,) array
        I_x I_y I_z, kg m^2.
    gravity : float
        m/s^2.
    buoyancy, righting : float
        rho V g in N and rho g V z_B in N m; none in air.
    """
    u, v, w, p, q, r = nu.T
    (sf, st), (cf, ct) = np.sin(lean.T), np.cos(lean.T)
    x, y, z, k, m, n = (push - drag).T
    ix, iy, iz = inertia
    g = gravity * (1.0 - buoyancy / (mass * gravity))
    return np.column_stack(
        [
            x / mass + v * r - w * q - g * st,
            y / mass + w * p - u * r + g * ct * sf,
            z / mass + u * q - p * v + g * ct * cf,
            (k - (iz - iy) * q * r + righting * ct * sf) / ix,
            (m - (ix - iz) * r * p + righting * st) / iy,
            (n + (ix - iy) * p * q) / iz,
        ]
    )


def aerial_wrench(thrust: Array, torque: Array, arm: float, as_printed: bool = False) -> Array:
    """(n, 6) X_P .. N_P in air; equations 31 to 34.

    Parameters
    ----------
    thrust, torque : (n, 4) array
        N and N m.
    arm : float
        L, m.
    as_printed : bool
        Otherwise thrust is up, against z, and acts where equations 38 and 39 have the rotors: Z_P and K_P change their signs.
    """
    t1, t2, t3, t4 = thrust.T
    q1, q2, q3, q4 = torque.T
    up = 1.0 if as_printed else -1.0
    zero = np.zeros(len(thrust))
    return np.column_stack(
        [zero, zero, up * (t1 + t2 + t3 + t4), up * (t1 - t2) * arm, (t3 - t4) * arm, q1 + q2 - q3 - q4]
    )


def dash(force: Callable[[float], float], mass: float, start: float, distance: float) -> tuple[float, float]:
    """Time and speed after a distance on a straight line under a force of the speed alone, by quadrature over the speed.

    Parameters
    ----------
    force : callable
        N, of the speed along the line.
    mass : float
        kg.
    start, distance : float
        m/s and m, along the line. The force must not vanish on the way.
    """
    from scipy.integrate import quad
    from scipy.optimize import brentq

    sign = 1.0 if force(start) > 0.0 else -1.0
    most = max(1.0, abs(start))
    while sign * force(start + sign * most) <= 0.0:
        most /= 2.0

    def covered(speed: float) -> float:
        return float(quad(lambda s: mass * s / force(s), start, speed, epsabs=1e-13, epsrel=1e-12, limit=200)[0])

    end = float(brentq(lambda s: covered(s) - distance, start, start + sign * most, xtol=1e-14, rtol=1e-14))
    time = float(quad(lambda s: mass / force(s), start, end, epsabs=1e-13, epsrel=1e-12, limit=200)[0])
    return time, end


def rise(force: Callable[[float], float], mass: float, start: float) -> tuple[float, float]:
    """Time and height until a craft that is slowed down stands, by quadrature; parameters as of `dash`."""
    from scipy.integrate import quad

    time = quad(lambda s: mass / force(s), start, 0.0, epsabs=1e-13, epsrel=1e-12)[0]
    return float(time), float(quad(lambda s: mass * s / force(s), start, 0.0, epsabs=1e-13, epsrel=1e-12)[0])

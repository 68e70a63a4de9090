"""Equations 1 to 34 of the TJ-FlyingFish paper as it prints them, in Euler angles and one component at a time.

They share nothing with the equations that coeflab integrates, which are compared with them. Where the paper errs, an argument
says which reading is meant.
"""

from __future__ import annotations

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


def dash(drive: float, linear: float, quadratic: float, mass: float, distance: float) -> tuple[float, float]:
    """Time and speed after a distance on a straight line from rest under a constant force against the damping, in closed form.

    No numbers where the force does not drive it that way.

    m ds/dt = F - a s - b s^2 is a Riccati equation with constant factors: s tends to the larger root of its right side.

    Parameters
    ----------
    drive, linear, quadratic : float
        F > 0 in N, a in N s/m, b > 0 in N s^2/m^2.
    mass, distance : float
        kg and m.
    """
    from scipy.optimize import brentq

    if not (drive > 0.0 and quadratic > 0.0 and linear >= 0.0):
        return float("nan"), float("nan")
    spread = float(np.sqrt(linear**2 + 4.0 * quadratic * drive))
    fast, other = (-linear + spread) / (2.0 * quadratic), (-linear - spread) / (2.0 * quadratic)
    rate, share = spread / mass, fast / other

    def covered(time: float) -> float:
        return float(fast * time + mass / quadratic * np.log((1.0 - share * np.exp(-rate * time)) / (1.0 - share)))

    longest = distance / fast + 1.0 / rate
    while covered(longest) < distance:
        longest *= 2.0
    time = float(brentq(lambda t: covered(t) - distance, 0.0, longest, xtol=1e-14, rtol=1e-14))
    faded = share * float(np.exp(-rate * time))
    return time, float((fast - other * faded) / (1.0 - faded))


def rise(brake: float, linear: float, quadratic: float, mass: float, start: float) -> tuple[float, float]:
    """Time and height until a craft that is slowed down stands, by quadrature over the speed.

    Parameters
    ----------
    brake, linear, quadratic, mass : float
        m ds/dt = -(F + a s + b s^2); as of `dash`.
    start : float
        m/s.
    """
    from scipy.integrate import quad

    def slowed(s: float) -> float:
        return mass / (brake + linear * s + quadratic * s**2)

    time = quad(slowed, 0.0, start, epsabs=1e-13, epsrel=1e-12)[0]
    return float(time), float(quad(lambda s: s * slowed(s), 0.0, start, epsabs=1e-13, epsrel=1e-12)[0])


def turned(rate: float, linear: float, quadratic: float, inertia: float, time: float) -> tuple[float, float]:
    """Angle and rate after a time of a turn that nothing but the damping slows down, in closed form.

    Parameters
    ----------
    rate : float
        At the start, rad/s, above zero.
    linear, quadratic, inertia : float
        I dr/dt = -(a r + b r^2): a in N m s, b > 0 in N m s^2, I in kg m^2.
    time : float
        s.
    """
    decay = linear / inertia
    spent = float(-np.expm1(-decay * time)) / decay if decay else time
    grown = 1.0 + quadratic * rate / inertia * spent
    return float(inertia / quadratic * np.log(grown)), rate * (1.0 - decay * spent) / grown

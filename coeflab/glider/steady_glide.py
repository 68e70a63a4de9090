"""Steady glides in the vertical plane: closed forms for speed and glide angle, roots of the pitch balance.

Leonard and Graver (2001), section on steady glides, and equations 28-30 of the THAUV paper. FRD axes, depth positive down, alpha = atan2(w, u),
glide angle zeta = theta - alpha (below zero on a dive), lift and drag over V^2 linear and quadratic in alpha, radians::

    L = (L0 + L1 alpha) V^2      D = (D0 + D2 alpha^2) V^2      M = (M0 + M1 alpha) V^2 - damping V q
    D = -m0 g sin(zeta)          L = m0 g cos(zeta)             V^2 = |m0| g / sqrt((L/V^2)^2 + (D/V^2)^2)
    V^2 (munk sin(alpha) cos(alpha) + M0 + M1 alpha) - ahead cos(theta) - below sin(theta) = 0

with the net mass m0 (weight less buoyancy, over g), munk = m3 - m1 where M does not hold the Munk moment and zero where it
does, and ahead, below the sums of m g x and m g z of all masses about the reference point. The paper's equation 19 writes
r_rx and r_rz for the latter; they are the whole centre of gravity's.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief

SAMPLES = 1441


@brief
@dataclass(frozen=True, slots=True)
class Polar:
    """Forces over V^2; angles in radians.

    Attributes
    ----------
    lift, drag, moment : (float, float)
        L0 and L1, D0 and D2, M0 and M1: N/(m/s)^2 and N m/(m/s)^2.
    damping : float
        -M_q/V, N m/(m/s rad/s); above zero damps.
    """

    lift: tuple[float, float]
    drag: tuple[float, float]
    moment: tuple[float, float]
    damping: float = 0.0

    def lift_at(self, alpha: Array) -> Array:
        """L/V^2, shape of ``alpha``."""
        return self.lift[0] + self.lift[1] * alpha

    def drag_at(self, alpha: Array) -> Array:
        """D/V^2, shape of ``alpha``."""
        return self.drag[0] + self.drag[1] * alpha**2

    def moment_at(self, alpha: Array) -> Array:
        """M/V^2 at no pitch rate, shape of ``alpha``."""
        return self.moment[0] + self.moment[1] * alpha


def glide(polar: Polar, net_weight: float, alpha: Array) -> tuple[Array, Array]:
    """Speed, m/s, and glide angle, rad, of a steady glide at an angle of attack.

    Parameters
    ----------
    polar : Polar
    net_weight : float
        m0 g, N; below zero for a climb.
    alpha : array
        rad. Where the lift has not the sign of the net weight the glide angle lies beyond 90 degrees: it goes astern.
    """
    lift, drag = polar.lift_at(alpha), polar.drag_at(alpha)
    down = np.sign(net_weight)
    return np.sqrt(abs(net_weight) / np.hypot(lift, drag)), np.arctan2(-drag * down, lift * down)


def shallowest(polar: Polar) -> tuple[float, float]:
    """Glide angles, rad, nearest to level of a dive and of a climb (Leonard and Graver 2001).

    Best |L|/D; zero where drag does not grow with the angle of attack, for the lift of the law has no bound.
    """
    if polar.drag[1] == 0.0:
        return 0.0, 0.0
    slope = polar.lift[1]
    tilt = polar.drag[1] * polar.lift[0] / slope**2
    reach = float(np.sqrt(tilt**2 + polar.drag[0] / slope * (polar.drag[1] / slope)))
    return float(np.arctan(2.0 * (tilt - reach))), float(np.arctan(2.0 * (tilt + reach)))


def pitch_moment(
    polar: Polar, net_weight: float, munk: float, ahead: float, below: float, alpha: Array
) -> Array:  # fmt: skip
    """Moment, N m, nose up, that is left over on a glide in balance of forces; zero where it is steady."""
    speed, zeta = glide(polar, net_weight, alpha)
    theta = zeta + alpha
    hydrodynamic = munk * np.sin(alpha) * np.cos(alpha) + polar.moment_at(alpha)
    return speed**2 * hydrodynamic - ahead * np.cos(theta) - below * np.sin(theta)


def balanced(
    polar: Polar, net_weight: float, munk: float, ahead: float, below: float, within: tuple[float, float]
) -> Array:  # fmt: skip
    """Every angle of attack, rad, at which an upright glide ahead is steady.

    Sign changes on `SAMPLES` angles, each brought to rounding by Brent's method; two roots closer than a sample are
    missed. Shape (n,), rising.

    Parameters
    ----------
    polar : Polar
    net_weight, munk, ahead, below : float
        N, kg, N m, N m; see the module.
    within : (float, float)
        Angles of attack to search, rad.
    """
    from scipy.optimize import brentq

    def left_over(alpha: Array) -> Array:
        return pitch_moment(polar, net_weight, munk, ahead, below, alpha)

    at = np.linspace(*within, SAMPLES)
    forward = polar.lift_at(at) * np.sign(net_weight) > 0.0
    sign = np.sign(left_over(at))
    found = [float(at[i]) for i in np.flatnonzero((sign == 0.0) & forward)]
    for i in np.flatnonzero((sign[1:] * sign[:-1] < 0.0) & forward[1:] & forward[:-1]):
        found.append(float(brentq(left_over, at[i], at[i + 1], xtol=1e-15, rtol=1e-14)))
    roots = np.array(sorted(found))
    return np.asarray(roots[np.abs(glide(polar, net_weight, roots)[1] + roots) < np.pi / 2])

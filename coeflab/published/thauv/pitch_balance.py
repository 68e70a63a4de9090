"""Constants of a glider's pitch balance from its steady speeds: m3 - m1, the moment below, a moment ahead per setting.

A steady speed gives the angle of attack by the balance of forces, V^2 |L, D|/V^2 = |m0| g, and so one equation of
`coeflab.glider.motion`, linear in the constants. Its solution starts the least squares of the speeds themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.glider.steady_glide import Polar, balanced, glide

STEEP = np.radians(40.0)
NOWHERE = 1.0


@brief
@dataclass(frozen=True, slots=True)
class GlideSpeed:
    """A glide whose speed is known.

    Attributes
    ----------
    polar : Polar
    net_weight : float
        m0 g, N.
    setting : int
        Which of the moments ahead it flies with, from 0.
    speed : float
        m/s.
    """

    polar: Polar
    net_weight: float
    setting: int
    speed: float


def incidence_at(known: GlideSpeed) -> float:
    """Angle of attack, rad, at which the forces balance at the speed, on the side that lifts against the net weight.

    NaN where no angle up to 40 degrees has that speed.
    """
    from scipy.optimize import brentq

    rest = -known.polar.lift[0] / known.polar.lift[1]
    ends = rest, rest + float(np.sign(known.net_weight)) * STEEP

    def apart(alpha: float) -> float:
        return float(glide(known.polar, known.net_weight, np.array(alpha))[0]) - known.speed

    if apart(ends[0]) * apart(ends[1]) > 0.0:
        return float("nan")
    return float(brentq(apart, *ends, xtol=1e-14))


def speed_of(known: GlideSpeed, constants: Array) -> float:
    """Speed, m/s, of the steady glide that is nearest to the known one; NaN where there is none.

    ``constants`` are m3 - m1, kg, below, and one moment ahead per setting, N m.
    """
    munk, below, ahead = (float(v) for v in (*constants[:2], constants[2 + known.setting]))
    alpha = balanced(known.polar, known.net_weight, munk, ahead, below, (-STEEP, STEEP))
    speeds = glide(known.polar, known.net_weight, alpha)[0]
    return float(speeds[np.argmin(np.abs(speeds - known.speed))]) if len(speeds) else float("nan")


def calibrated(known: Sequence[GlideSpeed], munk: float | None = None) -> Array:
    """Constants as `speed_of` takes them, by least squares of the speeds; NaN where the speeds do not determine them.

    Parameters
    ----------
    known : sequence of GlideSpeed
        At least as many as constants.
    munk : float, optional
        m3 - m1, kg, where it is known; zero where the polar's moment holds the Munk moment.
    """
    from scipy.optimize import least_squares

    rows, moments = _linear(known)
    given = [] if munk is None else [munk]
    free = rows[:, len(given) :]
    moments = moments - rows[:, : len(given)] @ np.array(given)
    if not np.isfinite(rows).all() or np.linalg.matrix_rank(free) < free.shape[1]:
        return np.full(rows.shape[1], np.nan)
    start = np.linalg.lstsq(free, moments)[0]

    def misfit(constants: Array) -> Array:
        found = np.array([speed_of(k, np.array([*given, *constants])) for k in known])
        return np.where(np.isfinite(found), found - [k.speed for k in known], NOWHERE)

    fitted = least_squares(misfit, start, x_scale=np.abs(start), method="lm", diff_step=1e-5).x
    return np.array([*given, *fitted])


def _linear(known: Sequence[GlideSpeed]) -> tuple[Array, Array]:
    """Rows of the pitch balance, linear in the constants, and what they must give."""
    rows, moments = np.zeros((len(known), 3 + max(k.setting for k in known))), np.zeros(len(known))
    for i, k in enumerate(known):
        a = np.array(incidence_at(k))
        theta = float(glide(k.polar, k.net_weight, a)[1] + a)
        rows[i, :2] = k.speed**2 * float(np.sin(a) * np.cos(a)), -np.sin(theta)
        rows[i, 2 + k.setting] = -np.cos(theta)
        moments[i] = -(k.speed**2) * float(k.polar.moment_at(a))
    return rows, moments

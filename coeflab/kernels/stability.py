"""Directional stability indices of a submerged body, with their first-order uncertainty.

Feldman (1979); Roddy (1990) Table 4: G = 1 - N_v (Y_r - m) / [Y_v (N_r - x_G m)], all primed; positive is stable.
"""

from __future__ import annotations

import numpy as np

from coeflab.kernels.least_squares import Array


def stability_index(
    force_slope: Array, moment_slope: Array, force_rate: Array, moment_rate: Array, mass: float, mass_moment: float
) -> Array:
    """G_h from (Yv', Nv', Yr', Nr', m', xG'm'), numbers or arrays of one shape.

    For G_v pass (Zw', Mw', Zq', Mq', -m', xG'm'): there the mass term changes its sign, G_v = 1 - Mw'(Zq' + m') /
    [Zw'(Mq' - xG'm')], the limit of high speed without restoring moment.
    """
    lever = moment_slope * (np.asarray(force_rate) - mass)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.asarray(1.0 - lever / (force_slope * (np.asarray(moment_rate) - mass_moment)))


def index_gradient(
    force_slope: float, moment_slope: float, force_rate: float, moment_rate: float, mass: float, mass_moment: float
) -> Array:
    """Derivatives of the index by its first four arguments, shape (4,); not finite where a denominator is zero."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        slope, lever = np.float64(force_slope), np.float64(moment_slope)
        a, b = force_rate - mass, np.float64(moment_rate - mass_moment)
        product = lever * a / (slope * b)
        return np.array([product / slope, -a / (slope * b), -lever / (slope * b), product / b])

"""Reading a linear model outside its data: refused, held at the edge, or tapered to the edge.

The taper is defined here, by the cubic step 1 - 3 t^2 + 2 t^3 of Hermite interpolation.
"""

from __future__ import annotations

import numpy as np

from coeflab.kernels.least_squares import Array

TAPER = 0.1


def clamped(points: Array, low: Array, high: Array) -> Array:
    """The nearest points of the bounding box, shape (n, d)."""
    return np.asarray(np.clip(points, low, high), dtype=np.float64)


def taper_weight(points: Array, low: Array, high: Array) -> Array:
    """How much of the free continuation remains, shape (n,): 1 inside the box, 0 from `TAPER` box widths beyond it.

    Between them w = 1 - 3 t^2 + 2 t^3, where t is the largest overshoot of any variable, in box widths over `TAPER`.
    The step has no slope at either end. With f the free continuation and e the value at the nearest point of the box,
    the tapered value e + w (f - e) therefore leaves the box with the slope of f and settles at e. A variable without
    width in the data tapers at once.

    Parameters
    ----------
    points : (n, d) array
    low, high : (d,) array
        Bounding box.
    """
    beyond = np.maximum(np.maximum(low - points, points - high), 0.0)
    width = TAPER * (high - low)
    overshoot = np.where(beyond > 0.0, 1.0, 0.0)
    np.divide(beyond, width, out=overshoot, where=(width > 0.0) & (beyond < width))
    t = np.max(overshoot, axis=1, initial=0.0)
    return np.asarray(1.0 - t**2 * (3.0 - 2.0 * t), dtype=np.float64)

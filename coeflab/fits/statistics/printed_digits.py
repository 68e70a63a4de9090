"""What the rounding of printed digits does to a coefficient that is linear in the readings.

Scatter of a digit and more makes the errors of rounding independent, each uniform over the digit. Without scatter they follow the
curve: a staircase, which only its bound holds. Noise of standard deviation s leaves exp(-2 pi^2 s^2 / digit^2) of the staircase, its
first harmonic (Widrow & Kollar 2008, chapter 5).
"""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array

UNIFORM = 12.0**0.5  # a digit over its standard error


def half_width(by_row: Array, rounding: Array, noise: float) -> Array:
    """95 % half-widths of coefficients, shape (p,), by rounding.

    Parameters
    ----------
    by_row : (p, n) array
        How much a reading moves each coefficient.
    rounding : (n,) array
        Standard error of each reading by its last digit, that digit over the root of 12; zero where it is not rounded.
    noise : float
        Standard deviation of a reading about the curve, its rounding among it.

    Examples
    --------
    >>> mean = np.full((1, 4), 0.25)
    >>> half_width(mean, np.full(4, 0.1 / UNIFORM), 0.0).round(4), half_width(mean, np.full(4, 0.1 / UNIFORM), 1.0).round(4)
    (array([0.05]), array([0.0289]))
    """
    size = float(np.max(rounding, initial=0.0))
    independent = 2.0 * np.linalg.norm(by_row * rounding, axis=1)
    bound = np.abs(by_row) @ rounding * (UNIFORM / 2.0)
    return np.asarray(np.sqrt(independent**2 + np.maximum(bound**2 - independent**2, 0.0) * _staircase(size, noise)))


def of_means(rounding: Array, variance: Array, noise: float) -> Array:
    """Standard errors of means (m,) by rounding: the staircase is in the mean of readings beside each other, what is independent is not.

    Parameters
    ----------
    rounding : (m,) array
        Standard error of a reading by its last digit.
    variance : (m,) array
        Of a mean over that of a reading.
    noise : float
        As in `half_width`.
    """
    left = _staircase(float(np.max(rounding, initial=0.0)), noise)
    return np.asarray(rounding * np.sqrt(variance + np.maximum(1.0 - variance, 0.0) * left))


def _staircase(size: float, noise: float) -> float:
    """What noise leaves of the variance of the staircase."""
    own = max(noise**2 - size**2, 0.0) / (UNIFORM * size) ** 2 if size else 0.0
    return float(np.exp(-4.0 * np.pi**2 * own))

"""Standard errors that stand unequal noise, with degrees of freedom that stand small samples.

HC2 and HC3: MacKinnon & White (1985). Degrees of freedom: Bell & McCaffrey (2002) in the form of Imbens & Kolesar
(2016), equation for one contrast under equal reference variances.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtr, stdtrit

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import Factorised

FULL_LEVERAGE = 1.0 - 1e-9
EXACT = 1e-12  # of the response: residuals of arithmetic
SILENT = 1e-6  # of the pooled scatter: less is no noise but rows that repeat each other to the last digit, and no U95
CONSTANT = 1e-9  # share of a constant that the columns may leave over


def hangs_on_one_point(f: Factorised) -> NDArray[np.bool_]:
    """Coefficients that a point of leverage 1 moves, boolean (p,): no residual shows that point's noise."""
    squares = f.estimator**2
    alone = squares[:, f.leverage >= FULL_LEVERAGE].sum(axis=1)
    return np.asarray(alone > 1e-18 * squares.sum(axis=1))


def _inflated(f: Factorised, residuals: Array, power: int) -> Array:
    """Squared residuals over (1 - h)^power; a point of leverage 1 has no residual and adds nothing."""
    room = np.where(f.leverage < FULL_LEVERAGE, 1.0 - f.leverage, np.inf) ** power
    return np.asarray(residuals**2 / (room if residuals.ndim == 1 else room[:, None]))


def hc_variance(f: Factorised, residuals: Array, kind: int) -> Array:
    """HC2 (``kind=2``) or HC3 (``kind=3``) variances of the coefficients, shape (p,) or (p, m).

    NaN for a coefficient that a point of leverage 1 moves.
    """
    variance = np.asarray(f.estimator**2 @ _inflated(f, residuals, kind - 1))
    variance[hangs_on_one_point(f)] = np.nan
    return variance


def bell_mccaffrey(f: Factorised) -> Array:
    """Degrees of freedom of the HC2 variance of every coefficient, shape (p,).

    Satterthwaite's match of the first two moments; computed in O(n p^2) without the n x n residual maker. Zero for a
    coefficient that a point of leverage 1 moves.
    """
    room = np.where(f.leverage < FULL_LEVERAGE, 1.0 - f.leverage, np.inf)
    weights = f.estimator**2 / room
    first = np.sum(weights * np.where(np.isfinite(room), room, 0.0), axis=1)
    gram = np.einsum("pn,ni,nj->pij", weights, f.basis, f.basis)
    second = weights**2 @ (1.0 - 2.0 * f.leverage) + np.sum(gram**2, axis=(1, 2))
    known = (second > 0) & ~hangs_on_one_point(f)
    return np.asarray(np.where(known, first**2 / np.where(known, second, 1.0), 0.0))


def t_factor(freedom: Array | float, level: float = 0.95) -> Array:
    """Two-sided Student factor; NaN where the degrees of freedom vanish."""
    return np.asarray(stdtrit(freedom, 0.5 + 0.5 * level))


def t_probability(ratio: Array | float, freedom: Array | float) -> Array:
    """Two-sided probability of a larger |t| by chance."""
    return np.asarray(2.0 * stdtr(freedom, -np.abs(ratio)))

"""How far a percentile of a sample may be off because the sample is finite."""

from __future__ import annotations

import numpy as np
from scipy.special import betainc

from coeflab.kernels.least_squares import Array


def quantile_error(sample: Array, level: float) -> float:
    """Standard error of a percentile, from the order statistics alone.

    J. S. Maritz, R. G. Jarrett, J. American Statistical Association 73 (1978): the moments of the order statistic under the
    sample itself, whose weights are differences of the incomplete beta function. No shape of the distribution is assumed.

    Parameters
    ----------
    sample : (n,) array
        Independent draws, two at least.
    level : float
        Per cent.
    """
    n = len(sample)
    rank = np.clip(np.floor(level / 100.0 * n + 0.5), 1, n)
    edges = betainc(rank, n - rank + 1.0, np.arange(n + 1) / n)
    weights, ordered = np.diff(edges), np.sort(sample) - np.mean(sample)
    mean = float(weights @ ordered)
    return float(np.sqrt(max(float(weights @ ordered**2) - mean**2, 0.0)))

"""Whether the terms that a smaller linear model leaves out matter: the F test of nested models.

Fisher's ratio for equal, independent, normal noise; Draper & Smith, Applied Regression Analysis (1998), chapter 6.
"""

from __future__ import annotations

from scipy.special import fdtrc

from coeflab.core.types import dataclass


@dataclass(frozen=True, slots=True)
class NestedTest:
    """Fisher's ratio.

    Attributes
    ----------
    ratio : float
        NaN where it cannot be computed.
    between, within : int
        Degrees of freedom of numerator and denominator.
    probability : float
        Of so large a ratio by noise alone; NaN where it cannot be computed.
    """

    ratio: float
    between: int
    within: int
    probability: float


def nested_test(small: float, small_rank: int, full: float, full_rank: int, n: int) -> NestedTest:
    """Compare two nested models by their weighted sums of squared residuals.

    Parameters
    ----------
    small, full : float
        Sums of squares of the smaller and of the full model.
    small_rank, full_rank : int
    n : int
        Rows.
    """
    between, within = full_rank - small_rank, n - full_rank
    if between <= 0 or within <= 0 or full <= 0.0:
        return NestedTest(float("nan"), between, within, float("nan"))
    ratio = max(small - full, 0.0) / between / (full / within)
    return NestedTest(float(ratio), between, within, float(fdtrc(between, within, ratio)))

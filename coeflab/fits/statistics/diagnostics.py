"""Does the form fit, and does one point carry it? Lack of fit, replicates."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree
from scipy.special import chdtrc, fdtrc, stdtrit

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import Factorised, Index


def levels(x: Array, width: float = 0.02) -> Index:
    """Group |x| into nominal levels: a level spans at most ``width`` of the largest |x|.

    Returns
    -------
    (n,) integer array
        Level of every point, 0 nearest the origin.
    """
    size = np.abs(x)
    order = np.argsort(size, kind="stable")
    step = width * float(size.max(initial=0.0)) or 1.0
    level, start, out = -1, -np.inf, np.empty(len(x), dtype=np.int64)
    for i in order:
        if size[i] - start > step:
            level, start = level + 1, size[i]
        out[i] = level
    return out


def replicate_groups(x: Array, tolerance: float) -> list[Index]:
    """Indices of points that repeat one setting: sorted neighbours within ``tolerance`` of the group's first."""
    order = np.argsort(x, kind="stable")
    groups: list[list[int]] = []
    for i in order:
        if groups and x[i] - x[groups[-1][0]] <= tolerance:
            groups[-1].append(int(i))
        else:
            groups.append([int(i)])
    return [np.array(g) for g in groups if len(g) > 1]


REPEATED = 0.01  # of the largest setting: a model is aligned to a nominal angle no better


def scatter_of_replicates(settings: Array, residuals: Array) -> float | None:
    """Standard deviation of one run, from runs that all but repeat a setting; None where none does.

    Every row is compared with its nearest neighbour; residuals about a law take out what the settings differ by.

    Parameters
    ----------
    settings : (n, d) array
        Each column as a share of its largest value; rows within `REPEATED` of each other repeat a setting.
    residuals : (n,) array
    """
    row, nearest = _repeats(settings)
    return float(np.sqrt(np.mean((residuals[row] - residuals[nearest]) ** 2) / 2.0)) if len(row) else None


def pairs_of_replicates(settings: Array) -> int:
    """Pairs of runs behind `scatter_of_replicates`: its degrees of freedom."""
    return len({frozenset(pair) for pair in zip(*_repeats(settings), strict=True)})


def _repeats(settings: Array) -> tuple[Index, Index]:
    """Rows that repeat a setting, and the nearest other row of each."""
    if len(settings) < 2:
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    away, other = cKDTree(settings).query(settings, k=2, p=np.inf)
    # Of rows at no distance either may come first.
    nearest = np.where(other[:, 0] == np.arange(len(settings)), other[:, 1], other[:, 0])
    near = np.flatnonzero(away[:, 1] <= REPEATED)
    return near, nearest[near]


SHARE, SCATTERS = 0.05, 3.0
CERTAIN, SINGULAR = 0.995, 1e-6  # below Student's quantile, 1 % on both sides; of the largest singular value
LEAST_FREEDOM = 5  # about a curve: below, what the curve itself misses of seven smooth readings looks like scatter
NARROWEST = 0.5  # of the range of the data, in which a law that is to hold over it may be said to hold


def allowed_miss(scatter: float | None, largest: float) -> float:
    """What a law may miss a point by: three times the scatter of repeated runs plus 5 % of the largest force."""
    return SCATTERS * (scatter or 0.0) + SHARE * largest


def about_a_curve(x: Array, y: Array) -> tuple[float, int]:
    """Sum of squares of readings of one motion about a smooth curve of their own, and its degrees of freedom.

    Parameters
    ----------
    x, y : (n,) array

    Examples
    --------
    >>> x = np.linspace(-1.0, 1.0, 13)
    >>> squares, freedom = about_a_curve(x, x + 0.4 * x * np.abs(x))
    >>> freedom, squares < 1e-20
    (7, True)
    """
    a = np.abs(x)
    columns = np.stack([np.ones_like(x), x, x * a, x * x, x**3, a**3], 1)[:, : len(x) // 2 + 1]
    along, sizes, _ = np.linalg.svd(columns, full_matrices=False)
    along = along[:, sizes > SINGULAR * sizes[:1]]
    rest = y - along @ (along.T @ y)
    return float(rest @ rest), len(x) - along.shape[1]


def certain_miss(scatter: float | None, pairs: int, squares: float, freedom: int, largest: float) -> float:
    """`allowed_miss`, or more: Student's quantile of the scatter of repeated runs or of readings about a curve of their own, the smaller.

    Parameters
    ----------
    scatter : float or None
        Of repeated runs.
    pairs : int
        Of these.
    squares : float
        Of the readings about curves.
    freedom : int
        Of those squares.
    largest : float
        Force.

    Examples
    --------
    >>> [round(certain_miss(1.0, pairs, 0.0, 0, 0.0), 2) for pairs in (1, 2, 5, 20)]
    [63.66, 9.92, 4.03, 3.0]
    >>> [round(certain_miss(1.0, 1, 4.0 * n, n, 0.0), 2) for n in (4, 6)]
    [63.66, 7.41]
    """
    by = [(scatter or 0.0, pairs), (float(np.sqrt(squares / max(freedom, 1))), freedom)]
    counted = [(size, n) for (size, n), least in zip(by, (1, LEAST_FREEDOM), strict=True) if n >= least]
    noise = min((float(stdtrit(n, CERTAIN)) * size for size, n in counted), default=0.0)
    return max(allowed_miss(scatter, largest), noise + SHARE * largest)


def lack_of_fit(f: Factorised, residuals: Array, x: Array, tolerance: float, known_errors: bool) -> float:
    """Probability that a right form would misfit more than this one does.

    With standard errors in the table the residual sum is a chi-square; else replicates give the pure error and the
    ratio is an F. NaN where neither exists.

    Parameters
    ----------
    f : Factorised
    residuals : (n,) array
        Weighted residuals; already divided by the standard errors when ``known_errors``.
    x : (n,) or (n, d) array
        Where the points lie; those that agree are replicates.
    tolerance : float
        Within which they agree.
    known_errors : bool
    """
    freedom = f.freedom
    if freedom < 1:
        return float("nan")
    total = float(np.sum(residuals**2))
    if known_errors:
        return float(chdtrc(freedom, total))
    groups = replicate_groups(x, tolerance)
    pure_freedom = sum(len(g) - 1 for g in groups)
    if pure_freedom < 1 or freedom - pure_freedom < 1:
        return float("nan")
    pure = sum(float(np.sum((residuals[g] - residuals[g].mean()) ** 2)) for g in groups)
    if pure <= 1e-24 * max(total, 1e-300):
        return float("nan")
    ratio = ((total - pure) / (freedom - pure_freedom)) / (pure / pure_freedom)
    return float(fdtrc(freedom - pure_freedom, pure_freedom, max(ratio, 0.0)))

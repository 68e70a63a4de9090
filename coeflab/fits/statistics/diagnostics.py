"""Does the form fit, and does one point carry it? Lack of fit, replicates; rows drawn for a bootstrap; Student mixtures."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy import special
from scipy.spatial import cKDTree
from scipy.special import chdtrc, fdtrc

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import Factorised, Index

# Members kept for the quantiles of a mixture, and where its distribution is tabulated.
KEPT = 256
TABLE = np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, 2001)[1:-1])


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
    if len(residuals) < 2:
        return None
    away, other = cKDTree(settings).query(settings, k=2, p=np.inf)
    # Of rows at no distance either may come first.
    own = other[:, 0] == np.arange(len(residuals))
    nearest = np.where(own, other[:, 1], other[:, 0])
    near = away[:, 1] <= REPEATED
    if not np.any(near):
        return None
    return float(np.sqrt(np.mean((residuals[near] - residuals[nearest[near]]) ** 2) / 2.0))


SHARE, SCATTERS = 0.05, 3.0
NARROWEST = 0.5  # of the range of the data, in which a law that is to hold over it may be said to hold


def allowed_miss(scatter: float | None, largest: float) -> float:
    """What a law may miss a point by: three times the scatter of repeated runs plus 5 % of the largest force."""
    return SCATTERS * (scatter or 0.0) + SHARE * largest


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


BLOCK = 128
TOGETHER = 8_000_000  # rows times replicates that are held at once, 64 MB an array


def pieces(n: int, replicates: int) -> list[int]:
    """Sizes of the pieces in which so many replicates of n rows are made: one, unless they would not fit into memory."""
    most = max(1, TOGETHER // max(n, 1))
    return [min(most, replicates - start) for start in range(0, replicates, most)]


def draw_counts(n: int, replicates: int, seed: int) -> Array:
    """How often each of n rows is drawn in each replicate, shape (replicates, n)."""
    return _counts(np.random.default_rng(seed), n, replicates)


def drawn_counts(n: int, replicates: int, seed: int) -> Iterator[Array]:
    """`draw_counts` in `pieces`, for many rows."""
    rng = np.random.default_rng(seed)
    return (_counts(rng, n, size) for size in pieces(n, replicates))


def _counts(rng: np.random.Generator, n: int, replicates: int) -> Array:
    drawn = rng.integers(0, n, size=(replicates, n))
    counts = np.empty((replicates, n))
    for start in range(0, replicates, BLOCK):
        some = drawn[start : start + BLOCK]
        some += n * np.arange(len(some))[:, None]
        counts[start : start + BLOCK] = np.bincount(some.ravel(), minlength=some.size).reshape(some.shape)
    return counts


def mixture_quantiles(log_weight: Array, mean: Array, scale: Array, freedom: Array, tail: Array) -> tuple[Array, Array]:
    """Lower, median, upper (b, 3) and standard deviation (b,) of Student mixtures (b, c); tail (b,)."""
    keep = np.argpartition(-log_weight, min(KEPT, mean.shape[1]) - 1, axis=1)[:, :KEPT]
    log_weight, mean, scale, freedom = (np.take_along_axis(z, keep, 1) for z in (log_weight, mean, scale, freedom))
    w = special.softmax(log_weight, axis=1)
    middle = (w * mean).sum(1)
    sd = np.sqrt((w * (scale**2 + (mean - middle[:, None]) ** 2)).sum(1))
    goal = np.stack([tail, np.full(len(tail), 0.5), 1.0 - tail], 1)
    reach = 12.0 * np.maximum(1.0, special.stdtrit(freedom.min(), 1.0 - tail) / 4.0) * sd
    low, high = np.repeat((middle - reach)[:, None], 3, 1), np.repeat((middle + reach)[:, None], 3, 1)
    most = freedom.max()
    tables = [special.stdtr(nu, TABLE * np.sqrt(nu / (1.0 - TABLE**2))) for nu in (most, most - 1.0)]
    first = (freedom == most)[:, None]

    def below(z: Array) -> Array:
        u = (z[..., None] - mean[:, None]) / scale[:, None]
        u /= np.sqrt(freedom[:, None] + u * u)
        share = np.interp(u, TABLE, tables[0])
        if not first.all():
            share = np.where(first, share, np.interp(u, TABLE, tables[1]))
        return np.asarray((w[:, None] * share).sum(2))

    for _ in range(22):
        z = 0.5 * (low + high)
        right = below(z) < goal
        low, high = np.where(right, z, low), np.where(right, high, z)
    return 0.5 * (low + high), sd

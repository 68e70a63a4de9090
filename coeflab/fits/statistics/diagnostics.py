"""Does the form fit, and does one point carry it? Lack of fit, replicates, leverage.

Pairs and wild bootstrap, all replicates at once.

Both work in the orthonormal basis of the design, where the closed forms are well conditioned; tests hold them to the
QR solution of each replicate within 1e-10.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations_with_replacement

import numpy as np
from scipy.special import chdtrc, fdtrc

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import Factorised, Index
from coeflab.fits.statistics.linear_model import FULL_LEVERAGE, hangs_on_one_point

HIGH_LEVERAGE = 3.0


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


def high_leverage(f: Factorised) -> Array:
    """Points with more than three times the mean leverage, boolean (n,)."""
    return np.asarray(f.leverage > min(HIGH_LEVERAGE * f.rank / len(f.leverage), 0.99))


LEAST_PIVOT = 1e-9
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


def pairs(f: Factorised, responses: Array, counts: Array) -> Array:
    """Coefficients of every resample of rows.

    Parameters
    ----------
    f : Factorised
        Full-rank design.
    responses : (n, m) array
    counts : (B, n) array
        From `draw_counts`.

    Returns
    -------
    (B, p, m) array
        NaN where the resample does not determine the coefficients.
    """
    q, p = f.basis, f.basis.shape[1]
    weighted = responses * f.root_weights[:, None]
    upper = np.triu_indices(p)
    squares = q[:, upper[0]] * q[:, upper[1]]
    products = (q[:, :, None] * weighted[:, None, :]).reshape(len(q), -1)
    sums = np.hstack([squares, products]).T @ counts.T
    gram, moments = sums[: squares.shape[1]], sums[squares.shape[1] :]
    solved = _solved(gram, moments.reshape(p, weighted.shape[1], len(counts)), p)
    return np.moveaxis(np.tensordot(f.back, solved, axes=1), 2, 0)


def _solved(gram: Array, moments: Array, p: int) -> Array:
    """Solutions (p, m, B) of B small systems by one Cholesky factorisation along the batch.

    Parameters
    ----------
    gram : (p (p + 1) / 2, B) array
        Upper triangles, row by row.
    moments : (p, m, B) array
    p : int

    Notes
    -----
    In the orthonormal basis a pivot is the share of a direction that the resample still holds; where one falls below
    1e-9 the resample does not determine the coefficients and the answer is NaN.
    """
    lower: list[list[Array]] = [[] for _ in range(p)]
    at = {(row, column): k for k, (row, column) in enumerate(combinations_with_replacement(range(p), 2))}
    poor = np.zeros(gram.shape[1], dtype=bool)
    for j in range(p):
        for i in range(j, p):
            rest = gram[at[j, i]].copy()
            for k in range(j):
                rest -= lower[i][k] * lower[j][k]
            if i == j:
                weak = rest < LEAST_PIVOT
                poor |= weak
                rest = np.sqrt(np.where(weak, 1.0, rest))
            else:
                rest /= lower[j][j]
            lower[i].append(rest)
    out = moments.copy()
    for i in range(p):
        for k in range(i):
            out[i] -= lower[i][k] * out[k]
        out[i] /= lower[i][i]
    for i in reversed(range(p)):
        for k in range(i + 1, p):
            out[i] -= lower[k][i] * out[k]
        out[i] /= lower[i][i]
    out[:, :, poor] = np.nan
    return out


def wild(f: Factorised, coefficients: Array, residuals: Array, replicates: int, seed: int) -> Array:
    """Coefficients of every wild replicate: residuals over sqrt(1 - h) with random signs (Davidson & Flachaire 2008).

    Parameters
    ----------
    f : Factorised
    coefficients : (p,) array
    residuals : (n,) array
        Weighted residuals from `solve`.
    replicates, seed : int

    Returns
    -------
    (B, p) array
        NaN for a coefficient that a point of leverage 1 moves.
    """
    rng, n = np.random.default_rng(seed), len(residuals)
    room = np.sqrt(np.where(f.leverage < FULL_LEVERAGE, 1.0 - f.leverage, np.inf))
    signs = (rng.integers(0, 2, size=(size, n)) * 2.0 - 1.0 for size in pieces(n, replicates))
    moved = np.vstack([coefficients + (s * (residuals / room)) @ f.estimator.T for s in signs])
    moved[:, hangs_on_one_point(f)] = np.nan
    return moved


def percentile_interval(replicates: Array, level: float = 0.95) -> tuple[float, float, float]:
    """Percentile interval and the share of replicates that could be used."""
    usable = replicates[np.isfinite(replicates)]
    if len(usable) < 0.5 * len(replicates):
        return float("nan"), float("nan"), len(usable) / len(replicates)
    low, high = np.quantile(usable, [0.5 - level / 2, 0.5 + level / 2])
    return float(low), float(high), len(usable) / len(replicates)

"""Pairs and wild bootstrap, all replicates at once.

Both work in the orthonormal basis of the design, where the closed forms are well conditioned; tests hold them to the
QR solution of each replicate within 1e-10.
"""

from __future__ import annotations

import numpy as np

from coeflab.kernels.least_squares import Array, Factorised
from coeflab.kernels.robust import FULL_LEVERAGE, hangs_on_one_point


def draw_counts(n: int, replicates: int, seed: int) -> Array:
    """How often each of n rows is drawn in each replicate, shape (replicates, n)."""
    drawn = np.random.default_rng(seed).integers(0, n, size=(replicates, n))
    flat = drawn + n * np.arange(replicates)[:, None]
    return np.bincount(flat.ravel(), minlength=replicates * n).reshape(replicates, n).astype(float)


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
    products = q[:, upper[0]] * q[:, upper[1]]
    flat = counts @ products
    gram = np.empty((counts.shape[0], p, p))
    gram[:, upper[0], upper[1]] = flat
    gram[:, upper[1], upper[0]] = flat
    moments = (counts @ (q[:, :, None] * weighted[:, None, :]).reshape(len(q), -1)).reshape(len(counts), p, -1)
    back = f.back
    if p == 2:
        determinant = gram[:, 0, 0] * gram[:, 1, 1] - gram[:, 0, 1] ** 2
        poor = determinant < 1e-9 * np.maximum(gram[:, 0, 0] * gram[:, 1, 1], 1e-300)
        safe = np.where(poor, 1.0, determinant)[:, None]
        first = (gram[:, 1, 1, None] * moments[:, 0] - gram[:, 0, 1, None] * moments[:, 1]) / safe
        second = (gram[:, 0, 0, None] * moments[:, 1] - gram[:, 0, 1, None] * moments[:, 0]) / safe
        solved: Array = np.stack([first, second], axis=1)
    else:
        poor = np.linalg.eigvalsh(gram)[:, 0] < 1e-9
        gram[poor] = np.eye(p)
        solved = np.asarray(np.linalg.solve(gram, moments), dtype=np.float64)
    solved[poor] = np.nan
    return np.asarray(np.einsum("jp,bpm->bjm", back, solved))


def wild(f: Factorised, coefficients: Array, residuals: Array, replicates: int, seed: int) -> Array:
    """Coefficients of every wild replicate: residuals over sqrt(1 - h) with random signs (Davidson & Flachaire 2008).

    Parameters
    ----------
    f : Factorised
    coefficients : (p,) array
    residuals : (n,) array
        Weighted residuals from `solve`.

    Returns
    -------
    (B, p) array
        NaN for a coefficient that a point of leverage 1 moves.
    """
    signs = np.random.default_rng(seed).integers(0, 2, size=(replicates, len(residuals))) * 2.0 - 1.0
    room = np.sqrt(np.where(f.leverage < FULL_LEVERAGE, 1.0 - f.leverage, np.inf))
    moved = np.asarray(coefficients + (signs * (residuals / room)) @ f.estimator.T)
    moved[:, hangs_on_one_point(f)] = np.nan
    return moved


def percentile_interval(replicates: Array, level: float = 0.95) -> tuple[float, float, float]:
    """Percentile interval and the share of replicates that could be used."""
    usable = replicates[np.isfinite(replicates)]
    if len(usable) < 0.5 * len(replicates):
        return float("nan"), float("nan"), len(usable) / len(replicates)
    low, high = np.quantile(usable, [0.5 - level / 2, 0.5 + level / 2])
    return float(low), float(high), len(usable) / len(replicates)

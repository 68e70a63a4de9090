"""Linear least squares: column scaling, QR, and the singular values of R.

The factorisation depends on the design matrix only, so that one factorisation serves many responses: several force
components, 4,000 synthetic campaigns, or the replicates of a wild bootstrap.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass

Index = NDArray[np.int64]


BLOCK = 8192


@dataclass(frozen=True, slots=True, eq=False)
class Factorised:
    """A factorised design matrix.

    Attributes
    ----------
    design : (n, p) array
        The design matrix, rows multiplied by the square root of the weights.
    root_weights : (n,) array
        Square roots of the weights, scaled to mean square 1.
    basis : (n, rank) array
        Orthonormal basis of the column space.
    back : (p, rank) array
        Coefficients = back @ basis.T @ (root_weights * y).
    leverage : (n,) array
        Diagonal of the hat matrix.
    rank : int
        Numerical rank of the column-scaled design.
    condition : float
        Condition number of the column-scaled design.
    null : (p, p - rank) array
        Directions of the coefficients, columns scaled to unit length, that the rows leave open.
    """

    design: Array
    root_weights: Array
    basis: Array
    back: Array
    leverage: Array
    rank: int
    condition: float
    null: Array

    @property
    def estimator(self) -> Array:
        """Pseudo-inverse, shape (p, n): coefficients = estimator @ (root_weights * y)."""
        return self.back @ self.basis.T

    @property
    def freedom(self) -> int:
        """Residual degrees of freedom."""
        return int(self.design.shape[0]) - self.rank


def factorise(design: Array, weights: Array | None = None) -> Factorised:
    """Factorise a design matrix: QR of the column-scaled matrix in blocks of rows, then the singular values of R.

    Beside the matrix only its basis is held, so that a long table needs about twice the memory of its design.

    Parameters
    ----------
    design : (n, p) array
    weights : (n,) array, optional
        Relative weights (inverse variances); only their ratios matter.
    """
    n = design.shape[0]
    root = np.ones(n) if weights is None else np.sqrt(weights / np.mean(weights))
    weighted = design if weights is None else design * root[:, None]
    scale = np.sqrt(np.einsum("ij,ij->j", weighted, weighted))
    scale[scale == 0.0] = 1.0
    p = weighted.shape[1]
    cuts = [*range(0, max(n - BLOCK, 1), BLOCK), n]
    q = np.empty((n, min(n, p)) if len(cuts) == 2 else (n, p))
    tops = []
    for low, high in pairwise(cuts):
        q[low:high], top = np.linalg.qr(weighted[low:high] / scale)
        tops.append(top)
    mixed, r = np.linalg.qr(np.vstack(tops))
    left, singular, right = np.linalg.svd(r)
    keep = singular > singular[0] * max(weighted.shape) * np.finfo(float).eps if singular.size else singular > 0
    turn, rank = mixed @ left[:, : len(singular)][:, keep], int(keep.sum())
    for k, (low, high) in enumerate(pairwise(cuts)):
        q[low:high, :rank] = q[low:high] @ turn[k * q.shape[1] : (k + 1) * q.shape[1]]
    basis = q[:, :rank]
    back = (right[: len(singular)][keep].T / singular[keep]) / scale[:, None]
    full = singular.size == p and singular[-1] > 0
    condition = float(singular[0] / singular[-1]) if full else float("inf")
    leverage = np.minimum(np.einsum("ij,ij->i", basis, basis), 1.0)
    open_rows = np.concatenate([~keep, np.ones(right.shape[0] - len(singular), dtype=bool)])
    return Factorised(weighted, root, basis, back, leverage, rank, condition, right[open_rows].T)


def solve(f: Factorised, response: Array) -> tuple[Array, Array]:
    """Coefficients and weighted residuals.

    Parameters
    ----------
    f : Factorised
    response : (n,) or (n, m) array
        One response or m of them.

    Returns
    -------
    coefficients : (p,) or (p, m) array
    residuals : (n,) or (n, m) array
        Residuals times the square root of the weights.

    Notes
    -----
    One step of iterative refinement makes up for rounding in the pseudo-inverse.
    """
    weighted = response * (f.root_weights if response.ndim == 1 else f.root_weights[:, None])
    coefficients = f.back @ (f.basis.T @ weighted)
    coefficients = coefficients + f.back @ (f.basis.T @ (weighted - f.design @ coefficients))
    residuals: Array = weighted - f.design @ coefficients
    return coefficients, residuals


def aicc(f: Factorised, residuals: Array) -> Array:
    """Akaike's criterion with the small-sample correction of Hurvich & Tsai (1989), for normal errors.

    Infinite where n - k - 1 <= 0, with k = p + 1 parameters (the variance counts).
    """
    n, k = f.design.shape[0], f.rank + 1
    if n - k - 1 <= 0:
        return np.full(np.shape(residuals)[1:], np.inf)
    mean_square = np.maximum(np.sum(residuals**2, axis=0) / n, np.finfo(float).tiny)
    log_weights = 2.0 * np.sum(np.log(f.root_weights))
    return np.asarray(n * np.log(mean_square) - log_weights + 2 * k + 2 * k * (k + 1) / (n - k - 1))

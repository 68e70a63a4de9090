"""Linear least squares through a column-scaled singular value decomposition.

The factorisation depends on the design matrix only, so that one factorisation serves many responses: several force
components, 4,000 synthetic campaigns, or the replicates of a wild bootstrap.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Factorised:
    """A factorised design matrix.

    Attributes
    ----------
    design : (n, p) array
        The design matrix, rows multiplied by the square root of the weights.
    root_weights : (n,) array
        Square roots of the weights, scaled to mean square 1.
    basis : (n, p) array
        Orthonormal basis of the column space.
    estimator : (p, n) array
        Pseudo-inverse: coefficients = estimator @ (root_weights * y).
    leverage : (n,) array
        Diagonal of the hat matrix.
    rank : int
        Numerical rank of the column-scaled design.
    condition : float
        Condition number of the column-scaled design.
    """

    design: Array
    root_weights: Array
    basis: Array
    estimator: Array
    leverage: Array
    rank: int
    condition: float

    @property
    def freedom(self) -> int:
        """Residual degrees of freedom."""
        return int(self.design.shape[0]) - self.rank


def factorise(design: Array, weights: Array | None = None) -> Factorised:
    """Factorise a design matrix.

    Parameters
    ----------
    design : (n, p) array
    weights : (n,) array, optional
        Relative weights (inverse variances); only their ratios matter.
    """
    n = design.shape[0]
    root = np.ones(n) if weights is None else np.sqrt(weights / np.mean(weights))
    weighted = design * root[:, None]
    scale = np.linalg.norm(weighted, axis=0)
    scale[scale == 0.0] = 1.0
    left, singular, right = np.linalg.svd(weighted / scale, full_matrices=False)
    keep = singular > singular[0] * max(weighted.shape) * np.finfo(float).eps if singular.size else singular > 0
    basis = left[:, keep]
    estimator = (right[keep].T / singular[keep]) @ basis.T / scale[:, None]
    condition = float(singular[0] / singular[-1]) if singular.size and singular[-1] > 0 else float("inf")
    leverage = np.minimum(np.einsum("ij,ij->i", basis, basis), 1.0)
    return Factorised(weighted, root, basis, estimator, leverage, int(keep.sum()), condition)


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
    coefficients = f.estimator @ weighted
    coefficients = coefficients + f.estimator @ (weighted - f.design @ coefficients)
    residuals: Array = weighted - f.design @ coefficients
    return coefficients, residuals


def classical_variance(f: Factorised, residuals: Array) -> Array:
    """Variances of the coefficients under equal, independent errors, shape (p,) or (p, m)."""
    variance = np.sum(residuals**2, axis=0) / max(f.freedom, 1)
    return np.asarray(np.multiply.outer(np.sum(f.estimator**2, axis=1), variance))


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

"""How well a linear model predicts the rows that it has not seen.

K-fold cross-validation: Stone (1974); the rule of one standard error: Breiman et al. (1984), section 3.4.3.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import Index

OPEN = 1e-7


def unit_columns(design: Array) -> tuple[Array, Array]:
    """Design with columns of length 1, and their lengths (1 for a column of zeros)."""
    size = np.sqrt(np.einsum("ij,ij->j", design, design))
    size = np.where(size > 0.0, size, 1.0)
    return design / size, size


def constrained_space(constraint: tuple[Array, Array] | None, p: int) -> tuple[Array, Array]:
    """A point b0 (p,) and directions F (p, k) with C (b0 + F z) = d for every z.

    Raises
    ------
    ValueError
        The constraint cannot hold.
    """
    if constraint is None or not len(constraint[1]):
        return np.zeros(p), np.eye(p)
    c, d = constraint
    size = np.linalg.norm(c, axis=1)
    c, d = c / size[:, None], d / size
    left, singular, right = np.linalg.svd(c)
    rank = int(np.sum(singular > 1e-12 * singular[0]))
    start = right[:rank].T @ ((left[:, :rank].T @ d) / singular[:rank])
    if float(np.max(np.abs(c @ start - d))) > 1e-9 * float(np.max(np.abs(d), initial=0.0)):
        raise ValueError("the constraint cannot hold")
    return start, right[rank:].T


def thirds(keys: Sequence[Array], parts: int = 3) -> Index:
    """Fold of every row, shape (n,): 0 1 2 0 1 2 ... along the rows sorted by the first key, then the next.

    Parameters
    ----------
    keys : sequence of (n,) arrays
        Motion variables, the most important first.
    parts : int
    """
    order = np.lexsort(tuple(reversed([*keys])))
    fold = np.empty(len(order), dtype=np.int64)
    fold[order] = np.arange(len(order)) % parts
    return fold


def shuffled_folds(n: int, parts: int, seed: int) -> Index:
    """Fold of every row at random, sizes alike, shape (n,)."""
    return np.asarray(np.random.default_rng(seed).permutation(np.arange(n) % parts), dtype=np.int64)


def predict_left_out(
    design: Array,
    response: Array,
    fold: Index,
    constraint: tuple[Array, Array] | None = None,
    root_weights: Array | None = None,
    asked: Array | None = None,
) -> Array:
    """Every row predicted by the fit to the other folds, shape (n,); NaN where those do not determine it.

    Parameters
    ----------
    design : (n, p) array
    response : (n,) array
    fold : (n,) array
    constraint : ((k, p) array, (k,) array), optional
        C and d of C b = d.
    root_weights : (n,) array, optional
    asked : (n, p) array, optional
        Rows to predict in place of those of the design.
    """
    unit, size = unit_columns(design)
    wanted = unit if asked is None else asked / size
    scaled = None if constraint is None else (constraint[0] / size, constraint[1])
    start, free = constrained_space(scaled, design.shape[1])
    matrix, target = unit @ free, response - unit @ start
    root = np.ones(len(target)) if root_weights is None else root_weights
    out = np.full(len(target), np.nan)
    for k in np.unique(fold):
        test = fold == k
        train = ~test
        if not np.any(train):
            continue
        left, singular, right = np.linalg.svd(matrix[train] * root[train, None], full_matrices=False)
        keep = singular > OPEN * singular.max(initial=0.0)
        seen = right[keep]
        z = seen.T @ ((left[:, keep].T @ (root[train] * target[train])) / singular[keep])
        rows = wanted[test] @ free
        hidden = np.linalg.norm(rows - (rows @ seen.T) @ seen, axis=1)
        known = hidden <= 1e-6 * np.maximum(np.linalg.norm(rows, axis=1), 1e-300)
        out[test] = np.where(known, rows @ z + wanted[test] @ start, np.nan)
    return out


def one_standard_error(errors: Array) -> int:
    """Row of the sparsest candidate whose mean error lies within one standard error of the best.

    Parameters
    ----------
    errors : (m, k) array
        Mean square error of every candidate in every fold, candidates from rich to sparse.
    """
    mean = errors.mean(axis=1)
    best = int(np.argmin(mean))
    spread = float(errors[best].std(ddof=1) / np.sqrt(errors.shape[1])) if errors.shape[1] > 1 else 0.0
    inside: NDArray[np.intp] = np.flatnonzero(mean <= mean[best] + spread)
    return int(inside[-1])

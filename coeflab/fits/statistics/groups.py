"""Groups of rows under one linear law: how noisy each group is, and whether one law serves them all.

The test is that of Chow (1960), in the form that stands unequal noise: a Wald test of the pooled law inside the separate
laws with HC2 errors, referred to an F distribution by the approximate Hotelling T^2 of Tipton & Pustejovsky (2015,
section 3.2). For one restriction that is the t test of Bell & McCaffrey (2002).

How well a linear model predicts the rows that it has not seen.

K-fold cross-validation: Stone (1974); the rule of one standard error: Breiman et al. (1984), section 3.4.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import BLOCK, Factorised, Index, factorise
from coeflab.fits.statistics.robust_errors import FULL_LEVERAGE

FEWEST = 3
QUIETEST = 1e-3
ROUNDING = 1e-10


@dataclass(frozen=True, slots=True)
class Poolability:
    """One law for all groups, against a law for each.

    Attributes
    ----------
    restrictions : int
        Tested ones: coefficients that the separate laws have beyond the pooled one and that hang on no single row.
    statistic, freedom : float
        F and its second degrees of freedom; NaN where the rows cannot tell.
    probability : float
        Of so large an F by noise alone.
    """

    restrictions: int
    statistic: float
    freedom: float
    probability: float


UNTOLD = Poolability(0, float("nan"), float("nan"), float("nan"))


def noise_of_groups(design: Array, response: Array, group: Index, errors: Array | None) -> Array:
    """Standard deviation of every row, shape (n,): the residual scatter of its group about the group's own law.

    A group with fewer than three residual degrees of freedom gets the largest scatter of the others, all groups alike
    where none has as many. No group counts as quieter than a thousandth of the noisiest.

    Parameters
    ----------
    design : (n, p) array
    response : (n,) array
    group : (n,) array
    errors : (n,) array or None
        Standard errors as relative weights inside a group.
    """
    relative, scatter = np.ones(len(response)), np.full(int(group.max()) + 1, np.nan)
    for g in np.unique(group):
        rows = group == g
        f = factorise(design[rows], None if errors is None else errors[rows] ** -2.0)
        weighted = response[rows] * f.root_weights
        relative[rows] = 1.0 / f.root_weights
        if f.freedom >= FEWEST:
            scatter[g] = np.linalg.norm(weighted - f.basis @ (f.basis.T @ weighted)) / np.sqrt(f.freedom)
    known = scatter[np.isfinite(scatter)]
    largest = float(known.max(initial=0.0)) or 1.0
    return relative * np.maximum(np.where(np.isfinite(scatter), scatter, largest), QUIETEST * largest)[group]


def poolability(pooled: Array, separate: Array, response: Array, noise: Array) -> Poolability:
    """Test one law for all groups against a law for each, rows independent.

    Parameters
    ----------
    pooled : (n, p) array
        Design of the common law; its columns are combinations of those of ``separate``.
    separate : (n, q) array
    response : (n,) array
    noise : (n,) array
        Working standard deviations; the test holds its level when they are wrong.
    """
    f, common = factorise(separate, noise**-2.0), factorise(pooled, noise**-2.0)
    left, _, _ = np.linalg.svd(f.basis.T @ common.basis)
    contrast = left[:, common.rank :].T
    contrast = _on_several_rows(f, contrast)
    if not len(contrast):
        return UNTOLD
    weighted = response * f.root_weights
    inner = f.basis.T @ weighted
    residuals, apart = weighted - f.basis @ inner, contrast @ inner
    size = float(np.linalg.norm(weighted))
    if np.linalg.norm(residuals) <= ROUNDING * size:
        alike = np.linalg.norm(apart) <= 10.0 * ROUNDING * size
        return Poolability(len(contrast), 0.0 if alike else float("inf"), float("inf"), 1.0 if alike else 0.0)
    room = np.where(f.leverage < FULL_LEVERAGE, 1.0 - f.leverage, np.inf)
    moves = (contrast @ f.basis.T) / np.sqrt(room)
    expected = (moves * np.where(np.isfinite(room), room, 0.0)) @ moves.T
    root = np.linalg.cholesky((expected + expected.T) / 2.0)
    moves, apart = np.linalg.solve(root, moves), np.linalg.solve(root, apart)
    return _hotelling(f, moves, apart, residuals)


def _on_several_rows(f: Factorised, contrast: Array) -> Array:
    """The contrasts that no row of leverage 1 moves, whose noise no residual shows."""
    alone = f.basis[f.leverage >= FULL_LEVERAGE]
    if not len(alone) or not len(contrast):
        return contrast
    left, singular, _ = np.linalg.svd(contrast @ alone.T)
    return left[:, int(np.sum(singular > 1e-9)) :].T @ contrast


def _hotelling(f: Factorised, moves: Array, apart: Array, residuals: Array) -> Poolability:
    """F of contrasts whose covariance is the unit matrix under the working noise, from their HC2 covariance."""
    q, rank = len(moves), f.rank
    covariance = (moves * residuals) @ (moves * residuals).T
    square = np.einsum("qn,qn->n", moves, moves)
    gram = np.zeros((q * rank, q * rank))
    for low in range(0, len(square), BLOCK):
        rows = slice(low, low + BLOCK)
        pairs = (f.basis[rows, :, None] * moves.T[rows, None, :]).reshape(len(square[rows]), -1)
        gram += pairs.T @ pairs
    spread = float(np.sum((1.0 - 2.0 * f.leverage) * square**2) + np.sum(gram**2))
    shape = q * (q + 1) / (2.0 * spread)
    second = shape - q + 1.0
    singular = np.linalg.eigvalsh(covariance)
    if second <= 1.0 or singular[0] <= 1e-12 * singular[-1]:
        return Poolability(q, float("nan"), float("nan"), float("nan"))
    statistic = second / (shape * q) * float(apart @ np.linalg.solve(covariance, apart))
    return Poolability(q, statistic, second, float(fdtrc(q, second, statistic)))


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

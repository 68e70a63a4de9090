"""Groups of rows under one linear law: how noisy each group is, and whether one law serves them all.

The test is that of Chow (1960), in the form that stands unequal noise: a Wald test of the pooled law inside the separate
laws with HC2 errors, referred to an F distribution by the approximate Hotelling T^2 of Tipton & Pustejovsky (2015,
section 3.2). For one restriction that is the t test of Bell & McCaffrey (2002).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
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

"""Terms and coefficients of a force balance from rows that belong to stretches of time.

Rows of one stretch share their noise, so folds and resamples are made of whole stretches. Sparse regression: Brunton, Proctor
& Kutz (2016); resamples and inclusion frequency: Fasel et al. (2022); what is known only together: Belsley, Kuh & Welsch,
Regression Diagnostics (1980), chapter 3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.cross_validation import one_standard_error
from coeflab.kernels.least_squares import Array
from coeflab.kernels.sparse_selection import THRESHOLDS, ZERO, Optimizer

KEPT = 0.5
FOLDS = 5
FEWEST_STRETCHES = 8
INDEX = 30.0
SHARE = 0.5
LEVELS = (2.5, 97.5)


@dataclass(frozen=True, slots=True, eq=False)
class Balance:
    """One component of the force balance: ``response = design @ coefficients`` but for noise.

    Attributes
    ----------
    design : (n, p) array
    response : (n,) array
        N or N m.
    stretch : (n,) int array
        Which stretch of time a row belongs to.
    """

    design: Array
    response: Array
    stretch: NDArray[np.int64]

    def of(self, columns: Sequence[int]) -> Balance:
        """With some of the columns alone."""
        return Balance(self.design[:, list(columns)], self.response, self.stretch)

    def resampled(self, rng: np.random.Generator) -> Balance:
        """As many stretches, drawn with replacement."""
        names = np.unique(self.stretch)
        rows = [np.flatnonzero(self.stretch == s) for s in rng.choice(names, len(names))]
        taken = np.concatenate(rows)
        return Balance(self.design[taken], self.response[taken], np.repeat(np.arange(len(rows)), [len(r) for r in rows]))


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What the rows say of every column.

    Attributes
    ----------
    coefficients : (p,) array
        Least squares of the kept columns; NaN for the others.
    frequency : (p,) array
        Share of the resamples in which the sparse fit keeps a column.
    low, high : (p,) arrays
        2.5 and 97.5 percentiles of the resamples, the kept columns refitted; NaN where there are too few stretches.
    kept : tuple of int
    threshold : float
        Of the scaled problem, by cross-validation over stretches.
    rms : float
        Of the residuals over that of the response.
    """

    coefficients: Array
    frequency: Array
    low: Array
    high: Array
    kept: tuple[int, ...]
    threshold: float
    rms: float


def scaled(b: Balance) -> tuple[Array, Array]:
    """Columns and response of root mean square 1."""
    size, height = np.sqrt(np.mean(b.design**2, axis=0)), float(np.sqrt(np.mean(b.response**2)))
    return b.design / np.where(size > 0.0, size, 1.0), b.response / (height or 1.0)


def solved(b: Balance) -> Array:
    """(p,) least-squares coefficients."""
    size = np.sqrt(np.mean(b.design**2, axis=0))
    size = np.where(size > 0.0, size, 1.0)
    return np.asarray(np.linalg.lstsq(b.design / size, b.response, rcond=None)[0] / size)


def identify(b: Balance, optimizer: Optimizer, *, seed: int, resamples: int, kept: float = KEPT) -> Found:
    """Choose columns by how often a sparse fit keeps them, and fit those.

    Parameters
    ----------
    b : Balance
        Columns that are excited, none a multiple of another.
    optimizer : callable
        (matrix, y, threshold) -> coefficients (p,), all scaled.
    seed : int
        Of the resamples.
    resamples : int
    kept : float
        Least inclusion frequency of a column that is kept.
    """
    p = b.design.shape[1]
    at = _threshold(b, optimizer)
    rng = np.random.default_rng(seed)
    draws = [b.resampled(rng) for _ in range(resamples)]
    counts = np.zeros(p)
    for d in draws:
        counts[_support(d, optimizer, at)] += 1.0
    frequency = counts / max(resamples, 1)
    chosen = [int(j) for j in np.flatnonzero(frequency >= kept)] if resamples else _support(b, optimizer, at)
    coefficients, low, high = np.full((3, p), np.nan)
    left = b.response
    if chosen:
        coefficients[chosen] = solved(b.of(chosen))
        left = b.response - b.design[:, chosen] @ coefficients[chosen]
        if resamples and len(np.unique(b.stretch)) >= FEWEST_STRETCHES:
            again = np.array([solved(d.of(chosen)) for d in draws])
            low[chosen], high[chosen] = np.percentile(again, LEVELS, axis=0)
    whole = float(np.sqrt(np.mean(b.response**2)))
    rms = float(np.sqrt(np.mean(left**2))) / (whole or 1.0)
    return Found(coefficients, frequency, low, high, tuple(chosen), at, rms)


def _support(b: Balance, optimizer: Optimizer, threshold: float) -> list[int]:
    found = optimizer(*scaled(b), threshold)
    return [int(j) for j in np.flatnonzero(np.abs(found) > ZERO)]


def _threshold(b: Balance, optimizer: Optimizer) -> float:
    """The sparsest threshold whose error on left-out stretches is within one standard error of the best."""
    names = np.unique(b.stretch)
    fold = np.searchsorted(names, b.stretch) % min(FOLDS, len(names))
    errors = np.empty((len(THRESHOLDS), int(fold.max()) + 1))
    for k in range(errors.shape[1]):
        train = Balance(b.design[fold != k], b.response[fold != k], b.stretch[fold != k])
        for m, threshold in enumerate(THRESHOLDS):
            chosen = _support(train, optimizer, float(threshold))
            found = b.design[fold == k][:, chosen] @ solved(train.of(chosen)) if chosen else 0.0
            errors[m, k] = np.mean((b.response[fold == k] - found) ** 2)
    return float(THRESHOLDS[one_standard_error(errors)])


def known_together(design: Array) -> tuple[float, tuple[tuple[int, ...], ...]]:
    """Condition index of columns of length 1, and the sets of columns that it blurs.

    A set is what has more than half of its variance in one direction with an index above 30 (Belsley, Kuh & Welsch 1980).
    """
    length = np.linalg.norm(design, axis=0)
    _, singular, turned = np.linalg.svd(design / np.where(length > 0.0, length, 1.0), full_matrices=False)
    tiny = np.finfo(float).eps * float(singular.max(initial=0.0))
    singular = np.maximum(singular, tiny or 1.0)
    share = (turned / singular[:, None]) ** 2
    share /= share.sum(axis=0)
    index = singular[0] / singular if len(singular) else np.zeros(0)
    blurred = [share[index > INDEX].sum(axis=0) > SHARE] if np.any(index > INDEX) else []
    sets = [tuple(int(j) for j in np.flatnonzero(one)) for one in blurred]
    return float(index.max(initial=1.0)), tuple(s for s in sets if len(s) > 1)

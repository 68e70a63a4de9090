"""Terms and coefficients of a force balance whose columns are noisy as well as its response.

Least squares on noisy columns is biased towards zero, and by far more where columns are nearly dependent. So every average
is taken twice, over the even and over the odd rows of a series: their noises are independent, and the one half serves the
other as instrument (Reiersol 1950; Soderstrom & Stoica, Instrumental Variable Methods, 1983)::

    G = (A1' A2 + A2' A1) / 2        m = (A1' b2 + A2' b1) / 2        theta = G^-1 m

The diagonal of G has no noise in it but that of chance, and the antisymmetric part of A1' A2 nothing else. Rows of one
stretch of time share their noise, so folds and resamples are made of whole stretches. Sparse regression and inclusion
frequency: Brunton, Proctor & Kutz (2016), Fasel et al. (2022).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from coeflab.core.types import Array, brief
from coeflab.fits.statistics.sparse_selection import THRESHOLDS, ZERO, Optimizer, twins

SELDOM = 0.1
SURE = 3.0
RESOLVED = 1e-3
CLEARLY = 2.0
FOLDS = 5
FEWEST_STRETCHES = 8
ALL_LEFT_OUT, MOST = 1.0, 500.0  # odds of the chosen columns against one more; largest gain in log likelihood
ROUNDING = 1e-12


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Products:
    """Sums over every stretch, which all that follows is made of.

    Attributes
    ----------
    gram : (s, p, p) array
        Columns with columns, symmetric, free of the bias of noise.
    noise : (s, p, p) array
        Antisymmetric part, which noise alone makes; zero where one half is both.
    moment : (s, p) array
        Columns with the response.
    total : (s,) array
        Response with itself.
    """

    gram: Array
    noise: Array
    moment: Array
    total: Array

    def of(self, columns: Sequence[int]) -> Products:
        """With some of the columns alone."""
        at = np.asarray(columns, dtype=np.int64)
        pairs = (slice(None), at[:, None], at[None, :])
        return Products(self.gram[pairs], self.noise[pairs], self.moment[:, at], self.total)

    def taken(self, stretches: NDArray[np.int64]) -> Products:
        """Some stretches, each as often as it is named."""
        return Products(self.gram[stretches], self.noise[stretches], self.moment[stretches], self.total[stretches])

    def solved(self, columns: Sequence[int]) -> Array:
        """Coefficients of some columns."""
        if not len(columns):
            return np.zeros(0)
        some = self.of(columns)
        gram = some.gram.sum(axis=0)
        size = np.sqrt(np.abs(np.diag(gram)))
        size = np.where(size > 0.0, size, 1.0)
        scaled = np.linalg.lstsq(gram / np.outer(size, size), some.moment.sum(axis=0) / size, rcond=ROUNDING)[0]
        return np.asarray(scaled / size)

    def misfit(self, columns: Sequence[int], coefficients: Array) -> Array:
        """(s,) sums of squares that are left, free of the bias of noise; below zero by chance."""
        some = self.of(columns)
        return np.asarray((some.gram @ coefficients) @ coefficients - 2.0 * some.moment @ coefficients + self.total)


def products(first: Array, second: Array, stretch: NDArray[np.int64]) -> Products:
    """Sums over stretches.

    Parameters
    ----------
    first, second : (n, p + 1) arrays
        Columns and, last, the response, averaged over the one and the other half of the rows; the same array twice for
        ordinary least squares.
    stretch : (n,) int array
        From 0, none missing.
    """
    p, count = first.shape[1] - 1, int(stretch.max(initial=-1)) + 1
    whole = np.zeros((count, p + 1, p + 1))
    np.add.at(whole, stretch, first[:, :, None] * second[:, None, :])
    even, odd = (whole + whole.swapaxes(1, 2)) / 2.0, (whole - whole.swapaxes(1, 2)) / 2.0
    return Products(even[:, :p, :p], odd[:, :p, :p], even[:, :p, p], even[:, p, p])


def reliability(first: Array, second: Array) -> Array:
    """(p,) share of the power of columns that both halves see, from 1 without noise to 0 for noise alone."""
    both = np.sum(first * second, axis=0)
    power = (np.sum(first**2, axis=0) + np.sum(second**2, axis=0)) / 2.0
    return np.asarray(np.where(power > 0.0, both / np.where(power > 0.0, power, 1.0), 0.0))


def multiples(gram: Array) -> dict[int, int]:
    """Columns that are multiples of an earlier one, with that one, by the gram (p, p) of columns that are not zero."""
    size = np.sqrt(np.diag(gram))
    level, turned = np.linalg.eigh(gram / np.outer(size, size))
    return twins(np.sqrt(np.maximum(level, 0.0))[:, None] * turned.T)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What the products say of every column.

    Attributes
    ----------
    coefficients : (p,) array
        Of the kept columns; NaN for the others.
    frequency : (p,) array
        Share of the resamples in which the sparse fit keeps a column.
    low, high : (p,) arrays
        95 % intervals of the kept columns, see `half_widths`; NaN where there are too few stretches.
    retained : tuple of int
    threshold : float
        Of the scaled problem, by cross-validation over stretches.
    left : float
        Root mean square of what is left over that of the response, free of noise; 0 where chance makes it negative.
    """

    coefficients: Array
    frequency: Array
    low: Array
    high: Array
    retained: tuple[int, ...]
    threshold: float
    left: float


def square_root(p: Products) -> tuple[Array, Array]:
    """A matrix (k, k) and a response (k,) with the gram and moment of scaled columns, for optimizers that want rows.

    Directions that are below the noise are lifted to it, so that no coefficient runs away along them.
    """
    gram, noise, moment = p.gram.sum(axis=0), p.noise.sum(axis=0), p.moment.sum(axis=0)
    size = np.sqrt(np.maximum(np.diag(gram), np.finfo(float).tiny))
    height = np.sqrt(max(float(p.total.sum()), np.finfo(float).tiny))
    level, turned = np.linalg.eigh(gram / np.outer(size, size))
    floor = float(np.linalg.norm(noise / np.outer(size, size), ord=2))
    level = np.sqrt(np.maximum(level, max(floor, ROUNDING * level[-1])))
    return level[:, None] * turned.T, turned.T @ (moment / size / height) / level


def identify(p: Products, optimizer: Optimizer, *, seed: int, resamples: int) -> Found:
    """Choose columns and fit those.

    A sparse fit of every resample says how often it needs a column. Of the columns that it ever needs, the one is left out
    that lies nearest to zero in units of its scatter, until all lie three of them away from it. A column without which the
    others leave less than a thousandth of the force, which straight pieces between rows do not resolve, goes first.

    Parameters
    ----------
    p : Products
        Columns that are excited, none a multiple of another.
    optimizer : callable
        (matrix, y, threshold) -> coefficients (p,), all scaled.
    seed : int
        Of the resamples.
    resamples : int
    """
    columns, stretches = p.gram.shape[1], len(p.total)
    threshold = _threshold(p, optimizer)
    rng = np.random.default_rng(seed)
    # Which stretches each resample takes; the sums of all of them at once would not fit into memory.
    draws = [rng.integers(0, stretches, stretches) for _ in range(resamples)]
    counts = np.zeros(columns)
    for d in draws:
        counts[_support(p.taken(d), optimizer, threshold)] += 1.0
    frequency = counts / resamples
    chosen = [int(j) for j in np.flatnonzero(frequency >= SELDOM)]
    again = np.array([p.taken(d).solved(chosen) for d in draws])
    while chosen:
        sure = np.abs(p.solved(chosen)) / np.maximum(np.std(again, axis=0), np.finfo(float).tiny)
        without = _without(p, chosen)
        spare = without < RESOLVED**2
        if np.min(sure) >= SURE and not np.any(spare):
            break
        chosen.pop(int(np.argmin(np.where(spare, without, 1.0)) if np.any(spare) else np.argmin(sure)))
        again = np.array([p.taken(d).solved(chosen) for d in draws])
    coefficients, low, high = np.full((3, columns), np.nan)
    values = p.solved(chosen)
    coefficients[chosen] = values
    if stretches >= FEWEST_STRETCHES and chosen:
        half = half_widths(p, chosen)
        low[chosen], high[chosen] = values - half, values + half
    whole = float(p.total.sum())
    left = np.sqrt(max(float(p.misfit(chosen, values).sum()), 0.0) / whole) if whole > 0.0 else 0.0
    return Found(coefficients, frequency, low, high, tuple(chosen), threshold, float(left))


def half_widths(p: Products, retained: Sequence[int]) -> Array:
    """95 % half-widths of the kept columns: scatter over stretches, and what another choice of columns would say.

    Scatter is the jackknife over stretches by Student's factor. Percentiles of resampled stretches lack that factor, and
    cover 88 to 92 % where there are 12 to 20 stretches. Every column that was left out would move the values by as much
    as it does when it is added, and counts by the likelihood that its own value gains (see
    `coeflab.fits.statistics.remainder`).

    Parameters
    ----------
    p : Products
        Of all columns that could have been chosen.
    retained : sequence of int
    """
    values = p.solved(retained)
    error, freedom = _jackknife(p, retained)
    added, weights = [np.zeros(len(retained))], [ALL_LEFT_OUT]
    others = [k for k in range(p.gram.shape[1]) if k not in retained]
    for k in others:
        wider = [*retained, k]
        with_it, (errors, _) = p.solved(wider), _jackknife(p, wider)
        square = float(with_it[-1] / errors[-1]) ** 2 if errors[-1] > 0.0 else 0.0
        if square > 1.0:
            share = 1.0 - 1.0 / square
            weights.append(np.expm1(min((square - 1.0 - np.log(square)) / 2.0, MOST)) / len(others))
            moved = share * (with_it[:-1] - values)
            added.append(moved**2 + share * np.maximum(errors[:-1] ** 2 - error**2, 0.0))
    choice = np.array(weights) @ np.array(added) / np.sum(weights)
    return np.asarray(np.sqrt(error**2 + choice) * stdtrit(freedom, 0.975))


def _jackknife(p: Products, columns: Sequence[int]) -> tuple[Array, Array]:
    """Standard errors of columns, a stretch left out at a time, and their degrees of freedom.

    The latter say how evenly the stretches share a variance under white noise, as Bell & McCaffrey (2002) have them.
    """
    some = p.of(columns)
    whole, count = some.gram.sum(axis=0), len(p.total)
    size = np.sqrt(np.abs(np.diag(whole)))
    size = np.where(size > 0.0, size, 1.0)
    gram, moment = some.gram / np.outer(size, size), some.moment / size
    without = np.linalg.pinv(gram.sum(axis=0) - gram, rcond=ROUNDING) @ (moment.sum(axis=0) - moment)[:, :, None]
    spread = without[:, :, 0] - without[:, :, 0].mean(axis=0)
    error = np.sqrt((count - 1.0) / count * np.sum(spread**2, axis=0)) / size
    back = np.linalg.pinv(gram.sum(axis=0), rcond=ROUNDING)
    shares = np.maximum(np.einsum("ij,kjl,il->ki", back, gram, back), 0.0)
    freedom = np.sum(shares, axis=0) ** 2 / np.maximum(np.sum(shares**2, axis=0), np.finfo(float).tiny) - 1.0
    return np.asarray(error), np.asarray(np.maximum(freedom, 1.0))


def _without(p: Products, columns: Sequence[int]) -> Array:
    """For every column, at most what is left without it: share of the power of the response, with three standard errors."""
    out = []
    for j in columns:
        rest = [k for k in columns if k != j]
        left = p.misfit(rest, p.solved(rest))
        out.append(float(left.sum()) + SURE * float(np.std(left)) * np.sqrt(len(left)))
    return np.array(out) / max(float(p.total.sum()), np.finfo(float).tiny)


def _support(p: Products, optimizer: Optimizer, threshold: float) -> list[int]:
    found = optimizer(*square_root(p), threshold)
    return [int(j) for j in np.flatnonzero(np.abs(found) > ZERO)]


def _threshold(p: Products, optimizer: Optimizer) -> float:
    """The threshold with the least error on left-out stretches."""
    fold = np.arange(len(p.total)) % min(FOLDS, len(p.total))
    errors = np.zeros(len(THRESHOLDS))
    for k in range(int(fold.max()) + 1):
        train, test = p.taken(np.flatnonzero(fold != k)), p.taken(np.flatnonzero(fold == k))
        for m, threshold in enumerate(THRESHOLDS):
            chosen = _support(train, optimizer, float(threshold))
            errors[m] += test.misfit(chosen, train.solved(chosen)).sum()
    return float(THRESHOLDS[len(errors) - 1 - int(np.argmin(errors[::-1]))])


def exchangeable(p: Products, retained: Sequence[int]) -> dict[int, tuple[int, ...]]:
    """For every kept column those left out that do as well in its place.

    One does where the misfit grows by less than two standard errors over the stretches.
    """
    out: dict[int, tuple[int, ...]] = {}
    best = p.misfit(retained, p.solved(retained))
    fewest = np.finfo(float).eps * float(np.abs(p.total).sum())
    for j in retained:
        others = []
        for k in sorted(set(range(p.gram.shape[1])) - set(retained)):
            swapped = [k if i == j else i for i in retained]
            worse = p.misfit(swapped, p.solved(swapped)) - best
            error = float(np.std(worse)) * np.sqrt(len(worse))
            if worse.sum() <= max(CLEARLY * error, 100.0 * fewest):
                others.append(k)
        out[j] = tuple(others)
    return out

"""Which terms of a library a response has: a path of sparse fits, cross-validation, a criterion, and bootstrap frequencies.

Columns and response are scaled to root mean square 1 before any threshold is compared with a coefficient: hydrodynamic
coefficients of size 1e-2 in small motions would all lie below a threshold of 0.1.

Sequentially thresholded least squares: Brunton, Proctor & Kutz (2016). Choice of the threshold by cross-validation with
the rule of one standard error: Breiman et al. (1984). Criterion: Chen & Chen (2008), extended BIC with gamma = 1 and
log C(p, k) bounded by k log p. Inclusion frequency: Fasel et al. (2022).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass
from coeflab.fits.statistics.cross_validation import one_standard_error, shuffled_folds
from coeflab.law.terms import Term

Support = frozenset[int]
Optimizer = Callable[[Array, Array, float], Array]
THRESHOLDS = np.logspace(-2.4, -0.4, 6)
SAME = 1.0 - 1e-9
ZERO = 1e-12


@dataclass(frozen=True, slots=True)
class Selection:
    """Chosen terms.

    Attributes
    ----------
    support : tuple of int
        Columns of the library.
    threshold : float
        Of the scaled problem, by cross-validation.
    by_threshold : tuple of int
        What that threshold alone keeps.
    frequency : tuple of float
        Share of bootstrap resamples in which the optimizer at that threshold keeps each column.
    runner_up : float
        By how much the criterion of the best model with another support is worse; infinite if there is none.
    """

    support: tuple[int, ...]
    threshold: float
    by_threshold: tuple[int, ...]
    frequency: tuple[float, ...]
    runner_up: float


def library(variables: tuple[str, ...], degree: int, *, absolute: bool) -> tuple[Term, ...]:
    """Products of powers up to a total degree; with ``absolute`` also those with |x| in place of x, each function once.

    ``v|v|`` is in, ``|v|^2`` is not, as it is ``v^2``.
    """
    found: list[Term] = []
    for powers in product(range(degree + 1), repeat=len(variables)):
        if not 0 < sum(powers) <= degree:
            continue
        used = [(v, n) for v, n in zip(variables, powers, strict=True) if n]
        for flips in product((False, True) if absolute else (False,), repeat=len(used)):
            factors: list[tuple[str, int, bool]] = []
            for (v, n), flip in zip(used, flips, strict=True):
                factors += [(v, n, False)] if not flip else [(v, n - 1, False)] * (n > 1) + [(v, 1, True)]
            found.append(Term(tuple(factors)))
    return tuple(sorted(found, key=lambda t: (t.degree, len(t.factors), str(t))))


def scaled(design: Array, response: Array, *, intercept: bool) -> tuple[Array, Array, Array, float]:
    """Columns and response of root mean square 1, after the intercept is taken out of both; and their sizes."""
    matrix = design - design.mean(axis=0) if intercept else design
    y = response - response.mean() if intercept else response
    size = np.sqrt(np.mean(matrix**2, axis=0))
    size = np.where(size > ZERO * np.max(np.abs(design), axis=0, initial=0.0), size, 0.0)
    height = float(np.sqrt(np.mean(y**2)))
    return matrix / np.where(size > 0.0, size, 1.0), y / (height or 1.0), size, height


def twins(matrix: Array) -> dict[int, int]:
    """Columns that are multiples of an earlier one on these rows, with that one."""
    norm = np.linalg.norm(matrix, axis=0)
    cosine = np.abs(matrix.T @ matrix) / np.maximum(np.outer(norm, norm), 1e-300)
    out: dict[int, int] = {}
    for j in range(matrix.shape[1]):
        for i in range(j):
            if i not in out and norm[j] > 0.0 and cosine[i, j] > SAME:
                out[j] = i
                break
    return out


def _refit(matrix: Array, y: Array, support: Iterable[int]) -> Array:
    columns = sorted(support)
    out = np.zeros(matrix.shape[1])
    if columns:
        out[columns] = np.linalg.lstsq(matrix[:, columns], y, rcond=None)[0]
    return out


class _Criterion:
    """Extended BIC of supports, remembered; from the Gram matrix, so that a support costs one small solve."""

    def __init__(self, matrix: Array, y: Array, known: int) -> None:
        self.n, self.p = matrix.shape
        self.gram, self.moments, self.total = matrix.T @ matrix, matrix.T @ y, float(y @ y)
        self.price = float(np.log(self.n) + 2.0 * np.log(max(self.p, 1)))
        self.most = max(0, min(self.p, (self.n - known) // 2 - 1))
        self.seen: dict[Support, float] = {}

    def __call__(self, support: Support) -> float:
        if support in self.seen:
            return self.seen[support]
        value = float("inf")
        columns = sorted(support)
        if len(columns) <= self.most:
            left = self.total
            if columns:
                block = self.gram[np.ix_(columns, columns)]
                weights, _, rank, _ = np.linalg.lstsq(block, self.moments[columns], rcond=1e-12)
                left = self.total - float(weights @ self.moments[columns]) if rank == len(columns) else np.inf
            value = self.n * float(np.log(max(left, 1e-13 * self.total) / self.n)) + self.price * len(columns)
        self.seen[support] = value
        return value


def _neighbours(support: Support, p: int) -> list[Support]:
    """Supports one term more, one less, or with one term exchanged."""
    outside = [j for j in range(p) if j not in support]
    more = [support | {j} for j in outside]
    less = [support - {j} for j in sorted(support)]
    swapped = [(support - {i}) | {j} for i in sorted(support) for j in outside]
    return [*more, *less, *swapped]


def refine(matrix: Array, y: Array, starts: Iterable[Support], known: int = 0) -> tuple[Support, float]:
    """Best support by the criterion among those that adding, dropping and exchanging terms reach; lead over the next.

    Parameters
    ----------
    matrix : (n, p) array
    y : (n,) array
    starts : iterable of supports
    known : int
        Coefficients fitted beside the support.
    """
    criterion = _Criterion(matrix, y, known)
    for start in dict.fromkeys([*starts, frozenset[int]()]):
        here, value = start, criterion(start)
        while True:
            best = min(_neighbours(here, criterion.p), key=criterion, default=here)
            if not criterion(best) < value - 1e-9:
                break
            here, value = best, criterion(best)
    ranked = sorted(criterion.seen.items(), key=lambda item: (item[1], len(item[0]), sorted(item[0])))
    lead = ranked[1][1] - ranked[0][1] if len(ranked) > 1 else float("inf")
    return ranked[0][0], float(lead)


def _support(coefficients: Array) -> Support:
    return frozenset(int(i) for i in np.flatnonzero(np.abs(coefficients) > ZERO))


def select(
    design: Array,
    response: Array,
    optimizer: Optimizer,
    *,
    seed: int,
    folds: int = 5,
    resamples: int = 100,
    intercept: bool = True,
    thresholds: Array = THRESHOLDS,
) -> Selection:
    """Choose terms.

    Parameters
    ----------
    design : (n, p) array
        Library without a constant, unscaled.
    response : (n,) array
    optimizer : callable
        (matrix, y, threshold) -> coefficients (p,), all scaled.
    seed : int
        Of the folds and the resamples.
    folds, resamples : int
    intercept : bool
        Fit a constant that is not subject to selection.
    thresholds : (m,) array
        From rich to sparse.

    Notes
    -----
    Columns of zeros and columns that repeat an earlier one are never chosen.
    """
    matrix, y, size, _ = scaled(design, response, intercept=intercept)
    again = twins(matrix)
    active = [j for j in range(design.shape[1]) if size[j] > 0.0 and j not in again]
    p, n = design.shape[1], len(response)
    if not active or not np.any(y):
        return Selection((), float("nan"), (), tuple([0.0] * p), float("inf"))
    matrix = matrix[:, active]
    path = [_support(optimizer(matrix, y, float(t))) for t in thresholds]
    fold = shuffled_folds(n, folds, seed)
    errors = np.empty((len(thresholds), folds))
    for k in range(folds):
        train, test = fold != k, fold == k
        for m, t in enumerate(thresholds):
            support = _support(optimizer(matrix[train], y[train], float(t)))
            errors[m, k] = np.mean((y[test] - matrix[test] @ _refit(matrix[train], y[train], support)) ** 2)
    at = one_standard_error(errors)
    best, lead = refine(matrix, y, [path[at], *path], int(intercept))
    counts = np.zeros(p)
    rng = np.random.default_rng(seed + 1)
    for _ in range(resamples):
        rows: NDArray[np.intp] = rng.integers(0, n, n)
        for j in _support(optimizer(matrix[rows], y[rows], float(thresholds[at]))):
            counts[active[j]] += 1.0
    return Selection(
        support=tuple(active[j] for j in sorted(best)),
        threshold=float(thresholds[at]),
        by_threshold=tuple(active[j] for j in sorted(path[at])),
        frequency=tuple(float(c) for c in counts / max(resamples, 1)),
        runner_up=lead,
    )


def describe(selection: Selection, names: Mapping[int, str]) -> tuple[str, ...]:
    """How the terms were chosen, in words."""
    chosen = [names[j] for j in selection.support]
    first = [names[j] for j in selection.by_threshold]
    out = [
        f"Chosen: {', '.join(chosen) or 'no term'}. Cross-validation by one standard error takes the threshold "
        f"{selection.threshold:.3g} of the scaled problem, which alone keeps {', '.join(first) or 'no term'}; adding, "
        "dropping and exchanging terms by the extended BIC does the rest."
    ]
    often = ", ".join(
        f"{names[j]} {100 * selection.frequency[j]:.0f} %" for j in sorted(names) if selection.frequency[j] > 0
    )
    if often:
        out.append(f"Kept in bootstrap resamples at that threshold: {often}.")
    if selection.runner_up < 2.0:
        out.append(
            f"Another set of terms is as good within {selection.runner_up:.2g} of the criterion: the data do not distinguish them."
        )
    return tuple(out)

"""What the rows of a weighted Jacobian determine: covariances, open parameters, and sets that are known only together.

Columns are in units of the parameters' sizes, rows in units of the outputs' standard errors, so that a number below two is a
change of parameters that 95 % of repeated measurements would not show.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array

OPEN = 0.5  # standard uncertainty over size at which the 95 % interval reaches zero
SINGULAR = 1e-7  # of the largest singular value: the slopes are differences, good to about eps^(1/2)
TAKES_PART = 1e-4  # entry of a void direction: sqrt(eps) with room for the same slopes
LARGEST_SET = 5  # more names than that tell a reader nothing, and the sets to try grow as their binomial
NEW = 0.3  # share of a change outside of the span of earlier ones, sin 17 deg: less is the same statement again


def determined(data: Array, prior: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Covariance in units of sizes, and which parameters stay open: a standard uncertainty above `OPEN` of the size.

    Directions that nothing determines give every parameter that takes part in them an infinite variance.
    """
    both = np.vstack([data, prior])
    length = np.linalg.norm(both, axis=0)
    unit = np.where(length > 0.0, length, 1.0)
    _, singular, turned = np.linalg.svd(both / unit, full_matrices=True)
    singular = np.concatenate([singular, np.zeros(turned.shape[0] - len(singular))])
    void = singular <= SINGULAR * max(float(singular.max(initial=0.0)), np.finfo(float).tiny)
    known = turned[~void] / singular[~void, None]
    covariance = known.T @ known / np.outer(unit, unit)
    undetermined = np.any(np.abs(turned[void]) > TAKES_PART, axis=0) | (length == 0.0)
    return covariance, np.asarray(undetermined | (np.sqrt(np.diag(covariance)) > OPEN))


def dependent_sets(data: Array, free: NDArray[np.bool_], largest: int = LARGEST_SET) -> tuple[Array, ...]:
    """Short sets of parameters of which the data leave one combination open, one for every open direction.

    A set counts when some change of its parameters, the largest by its whole size, moves the outputs by less than two
    standard errors in all (1 / `OPEN`) while the parameters that are determined follow, and no smaller part of the set has
    such a change. Of sets of one length those that are seen least come first; a set that follows from earlier ones is left
    out.

    Parameters
    ----------
    data : (n, p) array
        Weighted Jacobian, columns by sizes.
    free : (p,) bool array
    largest : int
        Parameters in a set.
    """
    k = data.shape[1]
    _, doubtful = determined(data[:, free], np.zeros((0, int(free.sum()))))
    among = np.flatnonzero(free)[doubtful]
    sure = np.linalg.qr(data[:, np.setdiff1d(np.flatnonzero(free), among)])[0]
    triangle = np.asarray(np.linalg.qr(data - sure @ (sure.T @ data), mode="r"))
    selected: list[Array] = []
    for size in range(1, min(largest, len(among)) + 1):
        round_: list[tuple[float, Array]] = []
        for chosen in combinations(among.tolist(), size):
            if any(set(np.flatnonzero(one).tolist()) <= set(chosen) for one in selected):
                continue
            columns = triangle[:, list(chosen)]
            change = _least_seen(columns)
            shift = float(np.linalg.norm(columns @ change))
            if shift <= 1.0 / OPEN:
                whole = np.zeros(k)
                whole[list(chosen)] = change
                round_.append((shift, whole))
        for _, whole in sorted(round_, key=lambda one: round(one[0], 3)):
            if _is_new(whole, selected):
                selected.append(whole)
    return tuple(selected)


def _least_seen(columns: Array) -> Array:
    """The change with largest entry 1 that moves the outputs least (smallest singular vector)."""
    change = np.linalg.svd(columns, full_matrices=True)[2][-1]
    return np.asarray(change / change[np.argmax(np.abs(change))])


def _is_new(change: Array, accepted: list[Array]) -> bool:
    """Whether a change says more than those before it."""
    if not accepted:
        return True
    basis = np.linalg.qr(np.column_stack(accepted))[0]
    return bool(np.linalg.norm(change - basis @ (basis.T @ change)) > NEW * np.linalg.norm(change))

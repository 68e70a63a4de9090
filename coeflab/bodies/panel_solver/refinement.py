"""Added mass at vanishing panel size from two or three refinements, with an estimate of what is left.

Richardson extrapolation (Roache 1998) with one of two orders that theory knows: 2 on a smooth body, 4/3 where a
right-angled edge makes the potential grow as the power 2/3 of the distance from it. What three refinements show decides;
on a body with edges it is 4/3 at the most, and what the other order would have given is within the estimate.
What is left is estimated by the difference of the extrapolations from the finer and from the coarser pair. Were the true
order p, that would be 2^p - 1 times the error when panels are halved: at least the error itself for every p from 1 on;
below 1 the rest is made up for, and Roache's factor of 1.25 is kept. Two refinements show no order: his factor of 3 on
the correction. Three that do not converge: three times their range (Eca & Hoekstra 2014). It is never taken below a quarter of the correction,
nor below a tenth of the largest of a diagonal entry, each over its size: differences can cross zero by chance. Of two
refinements, which cannot tell, no entry has less than the median.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief

SMOOTH, EDGED, SHEETED = 2.0, 4.0 / 3.0, 1.0
BETWEEN, LOWEST = 1.25, 0.5
LEAST_SHARE, LEAST_OF_WORST, ROUNDING = 0.25, 0.1, 1e-5
SUBSTANTIAL, NOISE = 0.01, 1e-7
SAFETY, TWO_ONLY, RANGES = 1.25, 3.0, 3.0


@brief
@dataclass(frozen=True, slots=True)
class Refinement:
    """What a sequence of panel counts says.

    Attributes
    ----------
    matrix : (6, 6) array
        Extrapolated, or of the most panels where the differences do not shrink.
    error : (6, 6) array
        Estimate for each entry; NaN from a single count.
    observed : float or None
        Order of three counts, over all entries; None from fewer.
    used : float or None
        Order of the extrapolation; None where there is none.
    """

    matrix: Array
    error: Array
    observed: float | None
    used: float | None

    @property
    def void(self) -> NDArray[np.bool_]:
        """(6,) bool: motions whose own entry is below its error.

        So it is with a body of revolution turning about its axis: only the facets move water.
        """
        return np.asarray(np.diag(self.matrix) <= np.nan_to_num(np.diag(self.error)))

    @property
    def settled(self) -> Array:
        """The matrix with zeros in the rows and columns of such motions, and for what is rounding."""
        noise = np.abs(self.matrix) <= NOISE * _scale(self.matrix)
        return np.where(noise | np.logical_or.outer(self.void, self.void), 0.0, self.matrix)


def refined(matrices: Sequence[Array], counts: Sequence[int], edges: bool = False, sheets: bool = False) -> Refinement:
    """Judge one to three matrices.

    Parameters
    ----------
    matrices : sequence of (6, 6) arrays
        About one point, from the most panels to the fewest.
    counts : sequence of int
        Panels of each.
    edges : bool
        Whether the body has sharp edges: the order is not 2 then, whatever three refinements show.
    sheets : bool
        Whether it has plates without thickness: at their rims the jump of the potential grows as the root of the distance,
        and the order is 1.
    """
    most = SHEETED if sheets else EDGED if edges else SMOOTH
    finest = matrices[0]
    if len(matrices) == 1:
        return Refinement(finest, np.full((6, 6), np.nan), None, None)
    scale = _scale(finest)
    # Sizes of panels go with the root of their number.
    ratios = [float(np.sqrt(a / b)) for a, b in pairwise(counts)]
    changes = [a - b for a, b in pairwise(matrices)]
    if len(matrices) == 2:
        used = most
        correction = changes[0] / (ratios[0] ** used - 1.0)
        limit = finest + correction
        return Refinement(limit, _floored(TWO_ONLY * np.abs(correction), limit, scale, like_most=True), None, used)
    # A motion that only facets resist would drown the order of the others.
    live = np.abs(np.diag(changes[0])) < 0.5 * np.diag(finest)
    if not np.any(live):
        return Refinement(finest, _floored(RANGES * np.ptp(matrices, axis=0), finest, scale), None, None)
    shared = np.logical_and.outer(live, live)
    gain = np.linalg.norm((changes[1] / scale)[shared]) / np.linalg.norm((changes[0] / scale)[shared])
    observed = _order(float(gain), ratios)
    if observed < LOWEST:
        return Refinement(finest, _floored(RANGES * np.ptp(matrices, axis=0), finest, scale), observed, None)
    used = min(SMOOTH if observed >= BETWEEN else EDGED, most)
    limit, coarser = (m + c / (r**used - 1.0) for m, c, r in zip(matrices, changes, ratios, strict=False))
    spread = SAFETY * np.abs(limit - coarser) / (2.0 ** min(observed, 1.0) - 1.0)
    error = np.maximum(spread, LEAST_SHARE * np.abs(limit - finest))
    if edges and not sheets:
        error = np.maximum(error, np.abs(limit - finest - changes[0] / (ratios[0] ** SMOOTH - 1.0)))
    return Refinement(limit, _floored(error, limit, scale), observed, used)


def _order(gain: float, ratios: Sequence[float]) -> float:
    """Order at which the coarser of two differences is ``gain`` times the finer; within 12, beyond which it says nothing."""
    from scipy.optimize import brentq

    first, second = np.log(ratios)

    def short(order: float) -> float:
        return float(np.expm1(order * second) / -np.expm1(-order * first)) - gain

    small, large = 1e-9, 12.0
    if short(small) > 0.0:
        return 0.0
    return large if short(large) < 0.0 else float(brentq(short, small, large))


def _floored(error: Array, limit: Array, scale: Array, like_most: bool = False) -> Array:
    """Errors not below a share of the largest relative one of entries that matter, nor below the integrals' own."""
    size = np.abs(np.diag(limit))
    live = (size > SUBSTANTIAL * np.diag(scale)) & (np.diag(error) < size)
    relative = np.diag(error)[live] / size[live]
    least = LEAST_OF_WORST * float(np.max(relative, initial=0.0))
    if like_most and len(relative):
        least = max(least, float(np.median(relative)))
    root = np.sqrt(size)
    return np.maximum(np.maximum(error, least * np.outer(root, root)), ROUNDING * scale)


def _scale(matrix: Array) -> Array:
    """(6, 6) size of an entry of each unit: from the mean of the three masses and that of the three inertias."""
    root = np.sqrt(np.abs(np.repeat([np.trace(matrix[:3, :3]), np.trace(matrix[3:, 3:])], 3)) / 3.0)
    return np.asarray(np.outer(root, root))

"""Whether a primed slope depends on a level of the test that the prime system says it should not: speed, propeller rate, advance ratio.

A prime that holds has one slope at every speed. Behind a propeller at one rate it has not: the flow over a rudder goes with the slip. Rows
of several levels in one sweep then give a slope of none of them. The test is that of Chow (1960): one law with a constant for each level
against a law for each. Arrays only.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array

APART = 0.02  # of the largest level: closer ones are one level as measured
FEWEST, MOST_LEVELS = 3, 10  # settings of a level, levels
SHARE = 0.1  # of the largest slope: a smaller spread is Reynolds number, and no reason to part the rows
SIGNIFICANCE = 0.01
DIGITS = 2e-4  # of the largest force: rounding of printed primes


@dataclass(frozen=True, slots=True)
class LevelSlopes:
    """Slopes of one sweep, level by level.

    Attributes
    ----------
    levels, slopes : tuple of float
    spread : float
        Largest less smallest slope, of the largest.
    probability : float
        Of so large a difference by the scatter of the rows alone.
    offsets : float
        Largest less smallest force at no setting, of the largest force, where scatter alone would not give it; else 0.
    """

    levels: tuple[float, ...]
    slopes: tuple[float, ...]
    spread: float
    probability: float
    offsets: float

    @property
    def depends(self) -> bool:
        """Whether the slope depends on the level, beyond scatter and by a share that matters."""
        return self.probability < SIGNIFICANCE and self.spread > SHARE


def levels_of(values: Array) -> NDArray[np.intp]:
    """A number for every row, (n,), that rows of one level share.

    Examples
    --------
    >>> levels_of(np.array([1.3, 1.301, 0.45, 1.3])).tolist()
    [1, 1, 0, 1]
    """
    order = np.argsort(values, kind="stable")
    ranked = values[order]
    steps = np.diff(ranked) > APART * float(np.max(np.abs(values), initial=0.0))
    out = np.empty(len(values), dtype=np.intp)
    out[order] = np.concatenate([[0], np.cumsum(steps)])[: len(values)]
    return out


def slopes_by_level(x: Array, y: Array, level: Array, most: int = MOST_LEVELS) -> LevelSlopes | None:
    """Slopes of y over x at each level, and whether one would do; None with fewer than two levels of three settings.

    Parameters
    ----------
    x, y, level : (n,) arrays
        Setting, primed force, and what should not matter.
    most : int
        Levels.
    """
    sound = np.isfinite(x) & np.isfinite(y) & np.isfinite(level)
    x, y, level = x[sound], y[sound], level[sound]
    group = levels_of(level)
    selected = [g for g in np.unique(group) if np.unique(np.round(x[group == g], 9)).size >= FEWEST]
    if not 2 <= len(selected) <= most:
        return None
    reaches = sorted((x[group == g].min(), x[group == g].max()) for g in selected)
    if all(low > before for (_, before), (low, _) in pairwise(reaches)):  # levels that follow x are no other setting
        return None
    rows = np.isin(group, selected)
    x, y, level, group = x[rows], y[rows], level[rows], np.searchsorted(selected, group[rows])
    own = np.eye(len(selected))[group]
    reach = float(np.max(np.abs(x)))
    curved = min(np.unique(np.round(x[group == g], 9)).size for g in range(len(selected))) > FEWEST + 1
    shape = [x / reach, x * np.abs(x) / reach**2] if curved else [x / reach]
    each = np.column_stack([own, *(own * s[:, None] for s in shape)])
    one = np.column_stack([own, *shape])
    (full, beta), (common, law), (level_free, _) = (
        _left(a, y) for a in (each, one, np.column_stack([one[:, -len(shape) :], own.sum(1)]))
    )
    k = len(selected)
    slopes = beta[k : 2 * k] / reach
    noise = max(full, len(y) * (DIGITS * float(np.max(np.abs(y)))) ** 2 / 3.0)
    probability = _by_scatter(common - full, each.shape[1] - one.shape[1], noise, len(y) - each.shape[1])
    apart = float(np.ptp(law[:k])) / (float(np.max(np.abs(y))) or 1.0)
    is_apart = _by_scatter(level_free - common, k - 1, max(common, noise), len(y) - one.shape[1]) < SIGNIFICANCE
    largest = float(np.max(np.abs(slopes)))
    spread = float(np.ptp(slopes)) / largest if largest > 0.0 else 0.0
    at = tuple(float(np.mean(level[group == g])) for g in range(k))
    return LevelSlopes(at, tuple(map(float, slopes)), spread, probability, apart * is_apart)


def _by_scatter(gained: float, terms: int, left: float, freedom: int) -> float:
    """The probability that terms of no meaning take so much off the sum of squares that is left."""
    if freedom <= 0 or left <= 0.0:
        return 1.0
    from scipy.special import fdtrc

    return float(fdtrc(terms, freedom, max(gained, 0.0) / terms / (left / freedom)))


def _left(design: Array, y: Array) -> tuple[float, Array]:
    """Sum of squares that a law leaves, and its coefficients."""
    beta = np.linalg.lstsq(design, y, rcond=None)[0]
    rest = y - design @ beta
    return float(rest @ rest), np.asarray(beta)

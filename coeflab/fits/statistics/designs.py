"""Designs of a sweep: the settings that bring U95 of its slopes down, by the estimator itself on simulated readings.

Pairs of settings, one on each side, start at equal spacing; one after the other moves to the level that lowers the weighted
sum of U95^2 of all components most, until none does (coordinate exchange, Meyer & Nachtsheim 1995).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.statistics.slope_mixture import estimate_many, prepare

DRAWS, FINAL, PASSES = 12, 48, 3
SAME = 1e-6  # of the largest setting, within which two settings are one
NEIGHBOURS = (-3, -2, -1, 1, 2, 3)
GAIN = 0.005  # of the sum, below which a move is not worth it: the draws tell no less apart


@dataclass(frozen=True, slots=True, eq=False)
class Response:
    """One component that the runs of a test read.

    Attributes
    ----------
    curve : callable
        Expected reading at settings (m,), (m,).
    noise : float
        Standard deviation of one reading.
    weight : float
        Of its U95^2 in the sum.
    x, y : (n,) array
        Rows that were run.
    odd : bool
        The curve is odd by declaration.
    spread : callable, optional
        Covariance (m, m) of the curve at settings (m,), as far as the rows that were run know it.
    freedom : float
        Degrees of freedom of ``noise``; infinite where it is known.
    """

    curve: Callable[[Array], Array]
    noise: float
    weight: float = 1.0
    x: Array = field(default_factory=lambda: np.zeros(0))
    y: Array = field(default_factory=lambda: np.zeros(0))
    odd: bool = False
    spread: Callable[[Array], Array] | None = None
    freedom: float = np.inf

    def simulated(self, added: Array, draws: int, seed: int, *, known: bool) -> Array:
        """Readings (draws, m) at the added settings, of the expected curve and noise, or of those that the rows allow unless ``known``."""
        rng = np.random.default_rng(seed)
        scatter = rng.normal(0.0, self.noise, (draws, len(added)))
        if known or self.spread is None:
            return np.asarray(self.curve(added) + scatter)
        size, axes = np.linalg.eigh(self.spread(added))
        root = axes * np.sqrt(np.maximum(size, 0.0))
        scatter *= np.sqrt(self.freedom / rng.chisquare(self.freedom, (draws, 1)))
        return np.asarray(self.curve(added) + rng.standard_normal((draws, len(added))) @ root.T + scatter)


def predicted_u95(
    response: Response, added: Array, draws: int = FINAL, seed: int = 1, *, deletions: bool = True
) -> float:
    """U95 of the slope once the added settings are run: the median over simulated readings, of curves and noise that the rows allow.

    Infinite where fewer than three settings differ.

    Parameters
    ----------
    response : Response
    added : (m,) array
    draws, seed : int
        Of the readings' scatter.
    deletions : bool
        Let one row be wrong, as the estimator does, and curve and noise be unknown; without it the search is twice as fast.
    """
    x = np.concatenate([response.x, np.asarray(added, float)])
    if len(np.unique(np.round(x, 12))) < 3:
        return float("inf")
    read = response.simulated(np.asarray(added, float), draws, seed, known=not deletions)
    y = np.hstack([np.tile(response.y, (draws, 1)), read])
    return float(np.median(estimate_many(prepare(x, odd=response.odd), y, deletions=deletions).u95))


def designed(responses: Sequence[Response], count: int, levels: Array, *, distinct: bool = False) -> Array:
    """The settings of ``count`` further runs, in ascending order.

    Parameters
    ----------
    responses : sequence of Response
        What each run reads; of one test, so of the same rows.
    count : int
    levels : (k,) array
        Sizes of settings that can be run, ascending, above zero.
    distinct : bool
        No setting that was run, and none twice, as where a repeat gives the same number again.

    Returns
    -------
    (m,) array
        Fewer than ``count`` where no other level is left. Of an odd count one run is at rest where nothing was run yet, else
        at one of the levels; of a curve that is odd by declaration all lie on one side.
    """
    one_sided, ran = responses[0].odd, np.abs(np.concatenate([r.x for r in responses]))
    if distinct and len(ran):
        levels = levels[~np.any(np.abs(levels[:, None] - ran) <= SAME * levels[-1], axis=1)]
    pairs = count if one_sided else count // 2
    if distinct:
        pairs = min(pairs, len(levels))
    rest = [0.0] if count % 2 and not one_sided and not len(ran) else []

    def settings(at: Sequence[int], single: Sequence[int] = ()) -> Array:
        size = levels[list(at)]
        sides = [size, rest] if one_sided else [-size, size, rest]
        return np.sort(np.concatenate([*sides, levels[list(single)]]))

    def cost(x: Array, draws: int = DRAWS) -> float:
        return sum(r.weight * predicted_u95(r, x, draws, deletions=draws == FINAL) ** 2 for r in responses)

    start = at = [round(float(k)) for k in np.linspace(0.0, len(levels) - 1.0, pairs + 1)[1:]]
    best, tried = cost(settings(at)), {tuple(at)}
    for _ in range(PASSES):
        moved = False
        for k in range(len(at)):
            for step in NEIGHBOURS:
                new = sorted([*at[:k], at[k] + step, *at[k + 1 :]])
                if not 0 <= at[k] + step < len(levels) or tuple(new) in tried or (distinct and len({*new}) < len(new)):
                    continue
                tried.add(tuple(new))
                if (lower := cost(settings(new))) < (1.0 - GAIN) * best:
                    best, at, moved = lower, new, True
                    break
        if not moved:
            break
    at = min((at, start), key=lambda a: cost(settings(a), FINAL))  # few draws may have chosen their own scatter
    if count % 2 == 0 or rest or one_sided or not len(levels):
        return settings(at)
    return settings(at, [min(range(len(levels)), key=lambda k: cost(settings(at, [k])))])

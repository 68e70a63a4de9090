"""Quantiles of mixtures of Student distributions."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

from coeflab.core.types import Array, locked

# Members kept for the quantiles, steps of bisection, and where a distribution is tabulated.
KEPT = 256
HALVINGS = 22
TABLE = np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, 2001)[1:-1])


@lru_cache(32)
def _table(freedom: float) -> Array:
    return locked(special.stdtr(freedom, TABLE * np.sqrt(freedom / (1.0 - TABLE**2))))


def mixture_quantiles(
    log_weight: Array, mean: Array, scale: Array, freedom: Array, tail: Array
) -> tuple[Array, Array, Array]:
    """Of Student mixtures (b, c), by the tail beyond each end (b,).

    Returns
    -------
    ends : (b, 3) array
        Lower, median, upper.
    half : (b,) array
        median +- half has the probability 1 - 2 tail.
    sd : (b,) array
    """
    keep = np.argpartition(-log_weight, min(KEPT, mean.shape[1]) - 1, axis=1)[:, :KEPT]
    log_weight, mean, scale, freedom = (np.take_along_axis(z, keep, 1) for z in (log_weight, mean, scale, freedom))
    w = special.softmax(log_weight, axis=1)
    middle = (w * mean).sum(1)
    sd = np.sqrt((w * (scale**2 + (mean - middle[:, None]) ** 2)).sum(1))
    goal = np.stack([tail, np.full(len(tail), 0.5), 1.0 - tail], 1)
    reach = 12.0 * np.maximum(1.0, special.stdtrit(freedom.min(), 1.0 - tail) / 4.0) * sd
    most = freedom.max()
    kinds = [(some[:, None], _table(float(most - k))) for k, some in enumerate((freedom == most, freedom != most))]

    def below(z: Array) -> Array:
        u = (z[..., None] - mean[:, None]) / scale[:, None]
        u /= np.sqrt(freedom[:, None] + u * u)
        share = np.empty_like(u)
        for some, table in kinds:
            chosen = np.broadcast_to(some, u.shape)
            share[chosen] = np.interp(u[chosen], TABLE, table)
        return np.asarray((w[:, None] * share).sum(2))

    def bisected(short: Callable[[Array], NDArray[np.bool_]], low: Array, high: Array) -> Array:
        for _ in range(HALVINGS):
            z = 0.5 * (low + high)
            right = short(z)
            low, high = np.where(right, z, low), np.where(right, high, z)
        return 0.5 * (low + high)

    start = (np.repeat((middle + side * reach)[:, None], 3, 1) for side in (-1.0, 1.0))
    ends = bisected(lambda z: below(z) < goal, *start)
    value, sides = ends[:, 1:2], np.sort(np.abs(ends[:, ::2] - ends[:, 1:2]), 1)

    def short_half(z: Array) -> NDArray[np.bool_]:
        both = below(np.concatenate([value - z, value + z], 1))
        return both[:, 1:] - both[:, :1] < 1.0 - 2.0 * tail[:, None]

    return ends, bisected(short_half, sides[:, :1], sides[:, 1:])[:, 0], sd

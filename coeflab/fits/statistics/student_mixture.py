"""Quantiles of mixtures of Student distributions."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from scipy import special

from coeflab.core.types import Array, locked

# Members kept for the quantiles, equal parts of the reach that a quantile is told by, and where a distribution is tabulated.
COMPONENTS_USED = 256
PARTS = 2.0**22
CLOSE, STEPS = 0.01, 80  # parts between the last two steps; steps at most
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
    keep = np.argpartition(-log_weight, min(COMPONENTS_USED, mean.shape[1]) - 1, axis=1)[:, :COMPONENTS_USED]
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

    normal = special.ndtri(goal)
    low, high = (np.repeat((middle + side * reach)[:, None], 3, 1) for side in (-1.0, 1.0))
    part = (high - low) / PARTS
    found = root(lambda z: _normal(below(z)) - normal, low, high, middle[:, None] + sd[:, None] * normal, sd[:, None])
    ends = low + (np.floor((found - low) / part) + 0.5) * part
    value, sides = ends[:, 1:2], np.sort(np.abs(ends[:, ::2] - ends[:, 1:2]), 1)

    def excess(z: Array) -> Array:
        both = below(np.concatenate([value - z, value + z], 1))
        return np.asarray(_normal(0.5 + 0.5 * (both[:, 1:] - both[:, :1])) - normal[:, 2:])

    return ends, root(excess, sides[:, :1], sides[:, 1:], sides.mean(1, keepdims=True), sd[:, None])[:, 0], sd


def _normal(p: Array) -> Array:
    """The normal quantile, in which a mixture is nearly straight; finite."""
    return np.asarray(special.ndtri(np.clip(p, 1e-12, 1.0 - 1e-12)))


def root(excess: Callable[[Array], Array], low: Array, high: Array, z: Array, unit: Array) -> Array:
    """Zeros between ``low`` and ``high`` of increasing functions, to a hundredth of 2^-22 of that width.

    Secants from the guess ``z``, the first of slope 1 / ``unit``; the bracket is halved where one leaves it or does not halve the excess.
    """
    close = CLOSE * (high - low) / PARTS
    z = np.clip(z, low, high)
    e = excess(z)
    before, last, size, done = z - unit, e - 1.0, np.full_like(z, np.inf), close <= 0.0
    for _ in range(STEPS):
        low, high = np.where(e < 0.0, z, low), np.where(e < 0.0, high, z)
        with np.errstate(divide="ignore", invalid="ignore"):
            ahead = z - e * (z - before) / (e - last)
        secant = (ahead > low) & (ahead < high) & (2.0 * np.abs(e) < size)
        ahead = np.where(done | (e == 0.0), z, np.where(secant, ahead, 0.5 * (low + high)))
        done |= (np.abs(ahead - z) <= close) | (high - low <= close)
        if done.all():
            break
        before, last, size, z = z, e, np.abs(e), ahead
        e = excess(z)
    return ahead

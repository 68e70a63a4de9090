"""Uncertain inputs carried to results: linear sensitivities and seeded Monte Carlo of the same function.

JCGM 100:2008 (linear), JCGM 101:2008 (Monte Carlo). Half-widths are two standard uncertainties and inputs are normal, so
percentiles are those of two standard deviations, 2.275 and 97.725.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from coeflab.core.types import Array

STEP = 0.01
LOW, HIGH = 2.275013194817921, 97.72498680518208


@dataclass(frozen=True, slots=True)
class Propagated:
    """One result two ways.

    Attributes
    ----------
    value : float
        At the nominal inputs.
    linear : float
        95 % half-width by first-order propagation.
    monte_carlo : float
        Half the distance of the percentiles 2.275 and 97.725.
    low, high : float
        Those percentiles.
    draws : int
    seed : int
    """

    value: float
    linear: float
    monte_carlo: float
    low: float
    high: float
    draws: int
    seed: int


def normal_draws(covariance: Array, draws: int, seed: int) -> Array:
    """Normal deviations with a covariance, shape (draws, k): a Latin hypercube over its principal axes.

    Each axis has one draw in each of ``draws`` slices of equal probability (McKay, Beckman & Conover 1979), which makes
    the percentiles of nearly additive functions several times sharper than independent draws do.

    Raises
    ------
    ValueError
        The matrix has a negative eigenvalue beyond rounding.
    """
    size, vectors = np.linalg.eigh(0.5 * (covariance + covariance.T))
    if np.any(size < -1e-9 * max(float(np.max(np.abs(size), initial=0.0)), 1e-300)):
        raise ValueError("the covariance is not positive semidefinite")
    root = vectors * np.sqrt(np.clip(size, 0.0, None))
    rng = np.random.default_rng(seed)
    slices = rng.permuted(np.tile(np.arange(draws), (len(size), 1)), axis=1)
    places = np.clip((slices + rng.random(slices.shape)) / draws, 1e-12, 1.0 - 1e-12)
    return np.asarray((root @ ndtri(places)).T)


def propagate(
    function: Callable[[Array], Array], gradient: Array, covariance: Array, draws: int, seed: int
) -> Propagated:
    """Linear and Monte Carlo half-widths of one result.

    Parameters
    ----------
    function : callable
        (s, k) deviations of the inputs -> (s,) results.
    gradient : (k,) array
        Derivatives at the nominal inputs.
    covariance : (k, k) array
        Of the inputs' standard uncertainties.
    draws, seed : int
        Of the Monte Carlo.
    """
    k = len(gradient)
    sample = function(normal_draws(covariance, draws, seed))
    return summary_of(sample, float(function(np.zeros((1, k)))[0]), gradient, covariance, seed)


def summary_of(sample: Array, value: float, gradient: Array, covariance: Array, seed: int) -> Propagated:
    """Both half-widths from a sample, (s,), of a result and its gradient."""
    low, high = (float(v) for v in np.percentile(sample, [LOW, HIGH]))
    variance = max(float(gradient @ covariance @ gradient), 0.0)
    return Propagated(value, 2.0 * variance**0.5, 0.5 * (high - low), low, high, len(sample), seed)


def reaches_zero(value: float, half_width: float) -> bool:
    """Whether an interval holds zero, so that a ratio over it has no interval."""
    return bool(abs(value) <= half_width)

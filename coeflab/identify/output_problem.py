"""Parameters as a model's outputs show them: what was measured, how well, and what was known before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief

STEP = 6e-6


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """What is fitted to what.

    Attributes
    ----------
    model : callable
        (k, p) sets of parameters -> (k, n) outputs; NaN where a set gives none.
    measured, errors : (n,) arrays
        Measurements and their standard errors; NaN marks what was not measured.
    start : (p,) array
    sizes : (p,) array
        What counts as a large change of each parameter, such as its magnitude.
    prior_mean, prior_error : (p,) arrays
        Error infinite where there is no prior.
    low, high : (p,) arrays
        Bounds, infinite where there is none.
    jacobian : callable or None
        (p,) -> (n, p) exact derivatives; None for central differences.
    """

    model: Callable[[Array], Array]
    measured: Array
    errors: Array
    start: Array
    sizes: Array
    prior_mean: Array
    prior_error: Array
    low: Array
    high: Array
    jacobian: Callable[[Array], Array] | None = None

    def outputs(self, parameters: Array) -> Array:
        """(n,) outputs of one set."""
        return np.asarray(self.model(parameters[None])[0])

    def slopes(self, parameters: Array) -> Array:
        """(n, p) derivatives of the outputs: exact ones, else central differences of all parameters in one call."""
        if self.jacobian is not None:
            return np.asarray(self.jacobian(parameters))
        step = STEP * np.maximum(self.sizes, np.abs(parameters))
        upper = np.minimum(parameters + step, self.high)
        lower = np.maximum(parameters - step, self.low)
        k = len(parameters)
        sets = np.tile(parameters, (2 * k, 1))
        sets[np.arange(k), np.arange(k)] = upper
        sets[k + np.arange(k), np.arange(k)] = lower
        found = self.model(sets)
        return np.asarray(((found[:k] - found[k:]) / (upper - lower)[:, None]).T)


def problem(
    model: Callable[[Array], Array],
    measured: Array,
    errors: Array | float,
    start: Array,
    *,
    sizes: Array | None = None,
    prior_mean: Array | None = None,
    prior_error: Array | None = None,
    low: Array | None = None,
    high: Array | None = None,
    jacobian: Callable[[Array], Array] | None = None,
) -> Problem:
    """A `Problem` with what is not given filled in: no priors, no bounds, sizes by the start.

    Raises
    ------
    ValueError
        Shapes that do not fit, an error or size not above zero, a start or an order of bounds that cannot be.
    """
    measured, start = np.asarray(measured, dtype=float), np.asarray(start, dtype=float)
    n, p = len(measured), len(start)
    errors = np.broadcast_to(np.asarray(errors, dtype=float), (n,))
    magnitude = np.where(start != 0.0, np.abs(start), 1.0)
    out = Problem(
        model, measured, errors, start,
        magnitude if sizes is None else np.asarray(sizes, dtype=float),
        start if prior_mean is None else np.asarray(prior_mean, dtype=float),
        np.full(p, np.inf) if prior_error is None else np.asarray(prior_error, dtype=float),
        np.full(p, -np.inf) if low is None else np.asarray(low, dtype=float),
        np.full(p, np.inf) if high is None else np.asarray(high, dtype=float),
        jacobian,
    )  # fmt: skip
    if any(len(a) != p for a in (out.sizes, out.prior_mean, out.prior_error, out.low, out.high)):
        raise ValueError(f"sizes, priors and bounds must have {p} entries, one a parameter")
    if not (np.all(np.isfinite(start)) and np.all((start >= out.low) & (start <= out.high))):
        raise ValueError("the start is not finite, or outside of the bounds")
    if not np.all(out.errors[np.isfinite(measured)] > 0.0):
        raise ValueError("every standard error must be above zero")
    if not (np.all(out.sizes > 0.0) and np.all(out.prior_error > 0.0)):
        raise ValueError("every size and every prior error must be above zero")
    if not np.all(out.low < out.high):
        raise ValueError("a lower bound is not below its upper bound")
    if not np.any(np.isfinite(measured)):
        raise ValueError("nothing was measured")
    return out


def weighted(p: Problem, parameters: Array, slopes: bool) -> Array:
    """Residuals, model minus measured, of data and priors in units of their errors; or their derivatives."""
    seen, held = np.isfinite(p.measured), np.isfinite(p.prior_error)
    if slopes:
        top = p.slopes(parameters)[seen] / p.errors[seen, None]
        return np.vstack([top, (np.eye(len(parameters)) / p.prior_error[:, None])[held]])
    top = (p.outputs(parameters)[seen] - p.measured[seen]) / p.errors[seen]
    return np.concatenate([top, ((parameters - p.prior_mean) / p.prior_error)[held]])

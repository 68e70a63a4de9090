"""Profile likelihood: how chi^2 rises with one parameter held, which is honest where a model is curved."""

from __future__ import annotations

import numpy as np

from coeflab.kernels.least_squares import Array
from coeflab.kernels.output_error import Estimate, solved
from coeflab.kernels.output_problem import Problem, weighted

WILKS_95 = 3.841458820694124
FARTHEST = 64.0


def profile(p: Problem, best: Estimate, index: int, values: Array) -> Array:
    """Rise of chi^2 over its minimum with one parameter held at each value and all others fitted anew.

    In units of the squared Birge ratio, so that 3.84 bounds a 95 % interval (Wilks 1938), however curved the model is.

    Parameters
    ----------
    p : Problem
    best : Estimate
        Of that problem.
    index : int
        The parameter.
    values : (k,) array
    """
    out = np.empty(len(values))
    for side in (1.0, -1.0):
        others = np.delete(best.parameters, index)
        away = side * (values - best.parameters[index])
        for i in (i for i in np.argsort(away) if away[i] > 0.0 or (side > 0.0 and away[i] == 0.0)):
            others, chi_square = _held(p, others, index, float(values[i]))
            out[i] = (chi_square - best.chi_square) / best.birge**2
    return out


def _held(p: Problem, others: Array, index: int, value: float) -> tuple[Array, float]:
    """The other parameters fitted with one held, and chi^2 in all."""
    keep = np.arange(len(p.start)) != index

    def whole(sets: Array) -> Array:
        return np.insert(sets, index, value, axis=-1)

    own = ((value - p.prior_mean[index]) / p.prior_error[index]) ** 2
    if not others.size:
        return others, float(np.sum(weighted(p, whole(others), False) ** 2))
    less = Problem(
        lambda sets: p.model(whole(sets)), p.measured, p.errors, others, p.sizes[keep], p.prior_mean[keep],
        p.prior_error[keep], p.low[keep], p.high[keep], lambda x: p.slopes(whole(x))[:, keep],
    )  # fmt: skip
    found = solved(less, others, 500, np.inf)
    return found.x * less.sizes, 2.0 * float(found.cost) + own


def profile_interval(p: Problem, best: Estimate, index: int, rise: float = WILKS_95) -> tuple[float, float]:
    """Interval in which the profile rises by less than ``rise``; an end is infinite where it never does within 64 sizes."""
    from scipy.optimize import brentq

    centre, ends = float(best.parameters[index]), []
    step = best.standard_errors[index]
    first = 2.0 * float(step) if np.isfinite(step) else 0.1 * float(p.sizes[index])

    def over(value: float) -> float:
        return float(profile(p, best, index, np.array([value]))[0]) - rise

    for side in (-1.0, 1.0):
        limit = float(p.low[index] if side < 0 else p.high[index])
        inner, reach = centre, first
        while True:
            outer = centre + side * min(reach, abs(limit - centre))
            if over(outer) > 0.0:
                ends.append(float(brentq(over, inner, outer, xtol=1e-6 * reach)))
                break
            if outer == limit or reach > FARTHEST * p.sizes[index]:
                ends.append(limit if outer == limit else side * np.inf)
                break
            inner, reach = outer, 2.0 * reach
    return ends[0], ends[1]

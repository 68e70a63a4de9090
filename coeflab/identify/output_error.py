"""Output-error least squares: parameters of a model from what it puts out, with priors, bounds and an account of what the
data do and do not determine.

The model's outputs are held against measurements, each divided by its standard error; a prior is one more measurement, of a
parameter itself. Errors that turn out larger than stated widen the covariance (Birge ratio), smaller ones do not narrow it.
Maine & Iliff, NASA RP-1138 (1985); Jategaonkar, Flight Vehicle System Identification (2006), chapter 4.

Parameters as a model's outputs show them: what was measured, how well, and what was known before.

What the rows of a weighted Jacobian determine: covariances, open parameters, and sets that are known only together.

Columns are in units of the parameters' sizes, rows in units of the outputs' standard errors, so that a number below two is a
change of parameters that 95 % of repeated measurements would not show.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief

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


LEASH = 100.0
ROUNDING = 1e-6
AT_BOUND = 1e-5
TIGHT = 1e-11


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """What the data and the priors say.

    Attributes
    ----------
    parameters : (p,) array
    covariance : (p, p) array
        Of standard uncertainties; NaN in rows of parameters that are open or at a bound.
    correlation : (p, p) array
    residuals : (n,) array
        Measured minus model, not weighted; NaN where nothing was measured.
    prior_share : (p,) array
        0: the data alone speak, 1: the prior alone.
    open : (p,) bool array
        Neither data nor prior determine the parameter: its 95 % half-width exceeds its size.
    at_bound : (p,) bool array
    singular : (k,) array
        Singular values of the weighted Jacobian of the data, columns by ``sizes``, largest first.
    directions : (k, p) array
        Right singular vectors, in units of ``sizes``.
    undetermined : tuple of (p,) arrays
        Smallest sets of parameters that the data determine only together, each a change of parameters, in units of
        ``sizes`` and with largest entry 1, that the outputs do not show.
    birge : float
        sqrt(chi^2 / freedom) where above 1, else 1; the covariance holds its square.
    chi_square, freedom : float
    converged : bool
    message : str
    """

    parameters: Array
    covariance: Array
    correlation: Array
    residuals: Array
    prior_share: Array
    open: NDArray[np.bool_]
    at_bound: NDArray[np.bool_]
    singular: Array
    directions: Array
    undetermined: tuple[Array, ...]
    birge: float
    chi_square: float
    freedom: float
    converged: bool = True
    message: str = ""

    @property
    def standard_errors(self) -> Array:
        """(p,) standard uncertainties; NaN where there is none."""
        return np.sqrt(np.diag(self.covariance))


def estimate(p: Problem, first: Array | None = None, most: int = 500) -> Estimate:
    """Solve a problem by trust-region least squares (scipy's trf), then account for it.

    A first pass leashes every parameter to the start by `LEASH` of its sizes, so that none runs away along what the data
    leave open. Where everything is determined a second pass takes the leash off.

    Parameters
    ----------
    p : Problem
    first : (p,) array, optional
        Where to begin; the problem's start by default.
    most : int
        Most evaluations of a pass.

    Raises
    ------
    ArithmeticError
        The model gives no finite outputs at the start.
    """
    found = solved(p, p.start if first is None else first, most, LEASH)
    account = examine(p, found.x * p.sizes)
    if np.any(account.open) or found.status <= 0:
        return _ended(account, found)
    again = solved(p, found.x * p.sizes, most, np.inf)
    return _ended(examine(p, again.x * p.sizes), again)


def _ended(account: Estimate, found: Any) -> Estimate:
    return replace(account, converged=found.status > 0, message=str(found.message))


def by_likelihood(p: Problem, groups: NDArray[np.int_], rounds: int = 50) -> tuple[Estimate, Problem]:
    """The estimate with the standard error of every group of outputs taken from its own residuals (maximum likelihood).

    Parameters
    ----------
    p : Problem
        Its errors are the first guess.
    groups : (n,) int array
        Which quantity an output is.
    rounds : int
        Most repetitions.

    Returns
    -------
    Estimate, Problem
        The former not converged where the errors still change after all rounds, the latter with the errors that were found.
    """
    best, least, still = estimate(p), ROUNDING * p.errors, False
    for _ in range(rounds):
        spread = p.errors.copy()
        for g in np.unique(groups):
            spread[groups == g] = np.sqrt(np.nanmean(best.residuals[groups == g] ** 2))
        still = bool(np.allclose(spread, p.errors, rtol=1e-4))
        p = replace(p, errors=np.maximum(spread, least))
        best = estimate(p, best.parameters)
        if still:
            break
    return replace(best, converged=best.converged and still), p


def solved(p: Problem, start: Array, most: int, leash: float) -> Any:
    """What scipy finds, parameters in units of their sizes."""
    from scipy.optimize import least_squares

    first = weighted(p, start, False)
    if not np.all(np.isfinite(first)):
        raise ArithmeticError("the model gives no finite output at the start of the fit")
    # A set without an output is as bad as one far beyond anything seen, so that a step into it is taken back.
    far = 1e3 * (1.0 + float(np.max(np.abs(first))))
    centre, held = p.start / p.sizes, np.eye(len(start)) / leash

    def wrong(x: Array) -> Array:
        out = np.nan_to_num(weighted(p, x * p.sizes, False), nan=far, posinf=far, neginf=-far)
        return np.concatenate([out, (x - centre) / leash])

    def steep(x: Array) -> Array:
        return np.vstack([np.nan_to_num(weighted(p, x * p.sizes, True) * p.sizes), held])

    return least_squares(
        wrong, _inside(start, p) / p.sizes, steep, bounds=(p.low / p.sizes, p.high / p.sizes), method="trf",
        x_scale="jac", ftol=TIGHT, xtol=TIGHT, gtol=TIGHT, max_nfev=most,
    )  # fmt: skip


def _inside(start: Array, p: Problem) -> Array:
    """The start, moved off its bounds."""
    room = np.where(np.isfinite(p.high - p.low), 1e-6 * (p.high - p.low), 1e-9 * p.sizes)
    return np.clip(start, p.low + room, p.high - room)


def examine(p: Problem, x: Array) -> Estimate:
    """What data and priors determine at given parameters, without a fit.

    Raises
    ------
    ArithmeticError
        The model gives no finite outputs or derivatives there.
    """
    near = AT_BOUND * p.sizes
    at_bound = (x - p.low <= near) | (p.high - x <= near)
    seen = np.isfinite(p.measured)
    rows, k = int(seen.sum()), len(x)
    slopes = weighted(p, x, True) * p.sizes
    wrong = weighted(p, x, False)
    if not (np.all(np.isfinite(slopes)) and np.all(np.isfinite(wrong))):
        raise ArithmeticError("the model gives no finite outputs or derivatives at the parameters that were found")
    free = ~at_bound
    held = np.isfinite(p.prior_error)
    freedom = float(rows + int((held & free).sum()) - int(free.sum()))
    chi_square = float(wrong @ wrong)
    birge = float(np.sqrt(max(1.0, chi_square / freedom))) if freedom > 0 else 1.0
    data = slopes[:rows] / birge
    _, singular, directions = np.linalg.svd(data, full_matrices=True)
    singular = np.concatenate([singular, np.zeros(k - len(singular))]) if len(singular) < k else singular
    covariance, is_open = determined(data[:, free], slopes[rows:, free])
    full = np.full((k, k), np.nan)
    full[np.ix_(free, free)] = covariance * np.outer(p.sizes[free], p.sizes[free])
    opened = np.zeros(k, dtype=bool)
    opened[free] = is_open
    full[opened] = np.nan
    full[:, opened] = np.nan
    errors = np.sqrt(np.diag(full))
    share = np.where(held, np.diag(full) / np.where(held, p.prior_error, 1.0) ** 2, 0.0)
    residuals = np.where(seen, p.measured - p.outputs(x), np.nan)
    return Estimate(
        x, full, full / np.outer(errors, errors), residuals, share, opened, at_bound, singular, directions,
        dependent_sets(data, free), birge, chi_square, freedom,
    )  # fmt: skip

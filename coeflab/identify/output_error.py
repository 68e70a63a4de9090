"""Output-error least squares: parameters of a model from what it puts out, with priors, bounds and an account of what the
data do and do not determine.

The model's outputs are held against measurements, each divided by its standard error; a prior is one more measurement, of a
parameter itself. Errors that turn out larger than stated widen the covariance (Birge ratio), smaller ones do not narrow it.
Maine & Iliff, NASA RP-1138 (1985); Jategaonkar, Flight Vehicle System Identification (2006), chapter 4.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief
from coeflab.identify.determined import dependent_sets, determined
from coeflab.identify.output_problem import Problem, weighted

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

"""Coefficients of nearly dependent powers, with the powers themselves in extended precision.

A design matrix in double precision holds rounded powers, and the coefficients of nearly dependent columns amplify that
rounding by the condition number and, where the residuals are not small, by its square. Refinement of residuals and
coefficients together (Bjorck, Numerical Methods for Least Squares Problems, 1996, section 2.9.3) gets back what the
platform's long double can carry, and his bound of the rounding error (section 1.4.5) says how much that is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import factorise
from coeflab.fits.statistics.linear_model import LinearFit
from coeflab.law.terms import Term, design

WELL_CONDITIONED = 1e2
STEPS = 40
MOST_DIGITS = 15.0


def sharpened(
    fit: LinearFit, terms: tuple[Term, ...], columns: Mapping[str, Array], response: Array, errors: Array | None
) -> LinearFit:
    """The fit with refined coefficients and residuals, and with the digits that can be vouched for.

    Parameters
    ----------
    fit : LinearFit
        Of these terms, without a constraint.
    terms : tuple of Term
    columns : mapping of variable to (n,) array
    response : (n,) array
    errors : (n,) array or None
        Standard errors that the fit was weighted by.

    Notes
    -----
    Rank-deficient and well-conditioned fits are returned as they are.
    """
    if fit.rank < len(terms) or fit.condition < WELL_CONDITIONED:
        return fit
    f = factorise(design(terms, columns), None if errors is None else errors**-2.0)
    root = f.root_weights.astype(np.longdouble)
    exact = root[:, None] * np.column_stack([_power(t, columns, len(response)) for t in terms])
    target = root * response.astype(np.longdouble)
    best = fit.coefficients.astype(np.longdouble)
    left = target - exact @ best
    change = np.inf
    for _ in range(STEPS):
        off = (target - left - exact @ best).astype(np.float64)
        slope = f.back.T @ (-(exact.T @ left)).astype(np.float64)
        along = f.basis.T @ off
        step = f.back @ (along - slope)
        best = best + step
        left = left + (off - f.basis @ (along - slope))
        size = np.maximum(np.abs(best.astype(np.float64)), np.finfo(float).tiny)
        before, change = change, float(np.max(np.abs(step) / size))
        if change < 1e-17 or change > 0.5 * before:
            break
    matrix, remaining = np.abs(exact).astype(np.float64), np.abs(left).astype(np.float64)
    through = np.abs(f.back @ f.back.T) @ (matrix.T @ remaining)
    direct = np.abs(f.estimator) @ (np.abs(target).astype(np.float64) + matrix @ size)
    rounding = float(np.finfo(np.longdouble).eps * np.max((through + direct) / size))
    return replace(
        fit,
        coefficients=best.astype(np.float64),
        residuals=(left / root).astype(np.float64),
        digits=min(MOST_DIGITS, -float(np.log10(max(rounding, change, 1e-300)))),
    )


def _power(term: Term, columns: Mapping[str, Array], n: int) -> np.ndarray[tuple[int], np.dtype[np.longdouble]]:
    out = np.ones(n, dtype=np.longdouble)
    for variable, power, absolute in term.factors:
        base = columns[variable].astype(np.longdouble)
        out = out * (np.abs(base) if absolute else base) ** power
    return out

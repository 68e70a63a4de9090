"""A linear model with everything an expert asks of it: robust errors, influence, prediction, conditioning, open directions.

PRESS: Allen (1974). Cook's distance: Cook (1977). Runs test: Wald & Wolfowitz (1940).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.special import ndtr

from coeflab.core.types import Array, dataclass
from coeflab.fits.statistics.least_squares import Factorised, aicc, factorise, solve
from coeflab.fits.statistics.robust_errors import CONSTANT, EXACT, FULL_LEVERAGE, SILENT, bell_mccaffrey, t_factor

DOUBLE_DIGITS = 15.5


@dataclass(frozen=True, slots=True, eq=False)
class LinearFit:
    """A fitted linear model.

    Attributes
    ----------
    coefficients : (p,) array
        NaN where the rows leave a coefficient open.
    covariance : (p, p) array
        HC2.
    freedom : (p,) array
        Bell-McCaffrey degrees of freedom of every coefficient; zero where its rows repeat each other to the last printed digit.
    half_width : (p,) array
        95 % half-widths, HC2.
    residuals : (n,) array
        Of the response, unweighted.
    leverage : (n,) array
    left_out : (n,) array
        Residual of every point predicted from the others (PRESS residuals).
    cooks_distance : (n,) array
    rms : float
        Root mean square of the residuals.
    press_rms : float
        Root mean square of `left_out`.
    r_squared : float
        Uncentred where the form has no intercept.
    aicc : float
    runs_probability : float
        Probability of so few or so many runs of one sign, residuals in the order given; NaN if not computable.
    condition : float
        Of the column-scaled design.
    digits : float
        Decimal digits that the condition number and the size of the residuals leave sure.
    correlation : (p, p) array
    open_directions : (k, p) array
        Combinations of scaled coefficients that the rows do not determine.
    rank : int
    """

    coefficients: Array
    covariance: Array
    freedom: Array
    half_width: Array
    residuals: Array
    leverage: Array
    left_out: Array
    cooks_distance: Array
    rms: float
    press_rms: float
    r_squared: float
    aicc: float
    runs_probability: float
    condition: float
    digits: float
    correlation: Array
    open_directions: Array
    rank: int


def runs_probability(residuals: Array) -> float:
    """Two-sided probability of the number of runs of sign, normal approximation with continuity correction."""
    signs = residuals[residuals != 0.0] > 0.0
    n, up = len(signs), int(signs.sum())
    down = n - up
    if up < 2 or down < 2:
        return float("nan")
    runs = 1 + int(np.count_nonzero(signs[1:] != signs[:-1]))
    mean = 1.0 + 2.0 * up * down / n
    variance = (mean - 1.0) * (mean - 2.0) / (n - 1.0)
    if variance <= 0.0:
        return float("nan")
    distance = max(abs(runs - mean) - 0.5, 0.0) / variance**0.5
    return float(2.0 * ndtr(-distance))


def variation(f: Factorised, response: Array) -> float:
    """Sum of squares that R^2 refers to: about the mean where the columns span a constant, else about zero.

    A form without an intercept competes with zero, not with the mean: about the mean its R^2 may be anything below one
    (Kvalseth 1985).
    """
    root = f.root_weights
    left = root - f.basis @ (f.basis.T @ root)
    spans = float(left @ left) <= CONSTANT**2 * float(root @ root)
    middle = float(np.average(response, weights=root**2)) if spans else 0.0
    return float(np.sum((root * (response - middle)) ** 2))


def fit_linear(
    design: Array, response: Array, errors: Array | None = None, constraint: tuple[Array, Array] | None = None
) -> LinearFit:
    """Fit a linear model.

    Parameters
    ----------
    design : (n, p) array
    response : (n,) array
    errors : (n,) array, optional
        Standard errors; weights are their inverse squares.
    constraint : ((k, p) array, (k,) array), optional
        C and d of C b = d, kept exactly.

    Raises
    ------
    ValueError
        The constraint cannot hold.
    """
    p = design.shape[1]
    offset: Array = np.zeros(p)
    free: Array = np.eye(p)
    if constraint is not None:
        c, d = constraint
        offset = np.asarray(np.linalg.lstsq(c, d, rcond=None)[0], dtype=np.float64)
        if not np.allclose(c @ offset, d, rtol=0.0, atol=1e-12 * max(1.0, float(np.max(np.abs(d), initial=0.0)))):
            raise ValueError("the constraint cannot hold")
        _, singular, right = np.linalg.svd(c)
        free = right[int(np.sum(singular > 1e-12 * singular.max())) :].T
    reduced = design if constraint is None else design @ free
    centred = response if constraint is None else response - design @ offset
    f = factorise(reduced, None if errors is None else errors**-2.0)
    inner, _ = solve(f, centred)
    coefficients = inner if constraint is None else offset + free @ inner
    residuals = response - design @ coefficients
    weighted = residuals * f.root_weights
    room = np.where(f.leverage < FULL_LEVERAGE, 1.0 - f.leverage, np.nan)
    half_square = np.nan_to_num(weighted / np.sqrt(room))
    moved = f.basis.T * half_square
    spread = f.back @ moved
    covariance = free @ (spread @ spread.T) @ free.T
    freedom = _freedom(f, free, constraint is not None)
    remaining = float(np.sum(weighted**2))
    variance = remaining / f.freedom if f.freedom > 0 else float("nan")
    exact = remaining <= (EXACT * float(np.linalg.norm(response * f.root_weights))) ** 2
    pooled = np.sum((free @ f.back) ** 2, axis=1) * (0.0 if exact else np.nan_to_num(variance))
    freedom = np.where(np.diag(covariance) < SILENT**2 * pooled, 0.0, freedom)
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    open_directions = _open_directions(f, free, np.linalg.norm(design * f.root_weights[:, None], axis=0))
    undetermined = np.any(np.abs(open_directions) > 1e-6, axis=0) if f.null.size else np.zeros(p, dtype=bool)
    coefficients = np.where(undetermined, np.nan, coefficients)
    total = variation(f, response)
    left_out = residuals / room
    size = np.where(deviation > 0, deviation, 1.0)
    return LinearFit(
        coefficients=coefficients,
        covariance=covariance,
        freedom=freedom,
        half_width=np.where(undetermined, np.nan, deviation * t_factor(freedom)),
        residuals=residuals,
        leverage=f.leverage,
        left_out=left_out,
        cooks_distance=weighted**2 * f.leverage / (room**2 * max(f.rank, 1) * variance)
        if variance and variance > 0
        else np.full(len(response), np.nan),
        rms=float(np.sqrt(np.mean(residuals**2))),
        press_rms=float(np.sqrt(np.nanmean(left_out**2))) if np.any(np.isfinite(left_out)) else float("nan"),
        r_squared=1.0 - remaining / total if total > 0.0 else float("nan"),
        aicc=float(aicc(f, weighted)),
        runs_probability=runs_probability(residuals),
        condition=f.condition,
        digits=_digits(f, inner, remaining**0.5),
        correlation=covariance / np.outer(size, size),
        open_directions=open_directions,
        rank=f.rank,
    )


def _digits(f: Factorised, coefficients: Array, remaining: float) -> float:
    """Digits that rounding leaves: lost by the condition number, and by its square times what the fit leaves over.

    Bjorck (1996), section 1.4.3, with columns of unit length.
    """
    size = float(np.linalg.norm(coefficients * np.linalg.norm(f.design, axis=0)))
    loss = f.condition + f.condition**2 * (remaining / size if size > 0.0 else 0.0)
    return DOUBLE_DIGITS - float(np.log10(max(loss, 1.0)))


def _open_directions(f: Factorised, free: Array, scale: Array) -> Array:
    """Directions that no row determines, in coefficients scaled by their columns, unit length, shape (k, p)."""
    inner = np.linalg.norm(f.design, axis=0)
    directions = (free @ (f.null / np.where(inner > 0.0, inner, 1.0)[:, None])) * np.where(scale > 0.0, scale, 1.0)[
        :, None
    ]
    size = np.linalg.norm(directions, axis=0)
    return np.asarray((directions / np.where(size > 0.0, size, 1.0)).T)


def _freedom(f: Factorised, free: Array, constrained: bool) -> Array:
    """Bell-McCaffrey degrees of freedom per coefficient; through the constraint where there is one."""
    if not constrained:
        return bell_mccaffrey(f)
    return bell_mccaffrey(replace(f, back=free @ f.back))

"""Several responses fitted together, so that linear equations between their coefficients hold exactly.

Rows of every response are divided by its own residual scatter (one step of feasible generalised least squares, Zellner
1962, without the correlation). The covariance is a sandwich over runs, so errors of one run may be correlated between
responses: CR2 with the degrees of freedom of Bell & McCaffrey (2002), which is HC2 where a run has one row.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass
from coeflab.fits.statistics import linear_model, robust_errors
from coeflab.fits.statistics.cross_validation import constrained_space
from coeflab.fits.statistics.least_squares import Factorised, Index, factorise

OPEN = 1e-7
ROUNDING = 1e-10


@dataclass(frozen=True, slots=True, eq=False)
class Freed:
    """The fit without its equations, against them.

    Attributes
    ----------
    probability : (k,) array
        Of so large a violation of each equation by noise alone; NaN where the rows do not tell.
    together : float
        The same for the equations that the rows test only in combination, by Bonferroni; NaN where there is none.
    open : (p,) bool array
        Coefficients that the rows alone leave open.
    """

    probability: Array
    together: float
    open: NDArray[np.bool_]


def influence(design: Array, errors: Array | None = None) -> Array:
    """G of b = G y, shape (p, n): how every row moves every coefficient."""
    f = factorise(design, None if errors is None else errors**-2.0)
    return np.asarray(f.estimator * f.root_weights)


def spread_by_run(fit: linear_model.LinearFit, moves: Array, run: Index, n_runs: int) -> Array:
    """S with covariance S S', shape (p, n_runs): what the residuals of every run say about every coefficient.

    Parameters
    ----------
    fit : LinearFit
    moves : (p, n) array
        Of `influence`.
    run : (n,) array
        Run of every row.
    n_runs : int
    """
    room = np.where(fit.leverage < robust_errors.FULL_LEVERAGE, 1.0 - fit.leverage, np.inf)
    rows = moves * (fit.residuals / np.sqrt(room))
    out = np.zeros((len(moves), n_runs))
    np.add.at(out.T, run, rows.T)
    return out


def _by_run(f: Factorised, back: Array, residuals: Array, run: Index, n_runs: int) -> tuple[Array, Array]:
    """CR2 spread S (p, n_runs) with covariance S S', and degrees of freedom (p,).

    Parameters
    ----------
    f : Factorised
    back : (p, rank) array
        Coefficients = back @ basis.T @ weighted response.
    residuals : (n,) array
        Weighted.
    run : (n,) array
    n_runs : int
    """
    p, rank = back.shape
    spread, size, shadow = np.zeros((p, n_runs)), np.zeros((p, n_runs)), np.zeros((p, n_runs, rank))
    undetermined = np.zeros(p, dtype=bool)
    order = np.argsort(run, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(run[order])) + 1):
        basis, g = f.basis[rows], int(run[rows[0]])
        room, turn = np.linalg.eigh(np.eye(len(rows)) - basis @ basis.T)
        free = room > 1.0 - robust_errors.FULL_LEVERAGE
        moves = back @ basis.T
        undetermined |= np.linalg.norm(moves @ turn[:, ~free], axis=1) > 1e-9 * np.linalg.norm(back, axis=1)
        adjusted = moves @ ((turn[:, free] / np.sqrt(room[free])) @ turn[:, free].T)
        spread[:, g] = adjusted @ residuals[rows]
        size[:, g] = np.einsum("pi,pi->p", adjusted, adjusted)
        shadow[:, g] = adjusted @ basis
    norms = np.einsum("pgk,pgk->pg", shadow, shadow)
    first = np.sum(size - norms, axis=1)
    gram = np.einsum("pgk,pgl->pkl", shadow, shadow)
    second = np.sum(size**2 - 2.0 * size * norms, axis=1) + np.sum(gram**2, axis=(1, 2))
    known = (second > 0.0) & ~undetermined
    return spread, np.where(known, first**2 / np.where(known, second, 1.0), 0.0)


def scatter(design: Array, response: Array, errors: Array | None) -> float:
    """Residual standard deviation of one response by itself; the response's own size where nothing is left over.

    1 for a response of zeros, which has no size.
    """
    f = factorise(design, None if errors is None else errors**-2.0)
    weighted = response * f.root_weights
    rest = float(np.linalg.norm(weighted - f.basis @ (f.basis.T @ weighted)))
    size = float(np.linalg.norm(weighted))
    if f.freedom < 1 or rest <= 1e-12 * size:
        return float(size / np.sqrt(len(response))) or 1.0
    return float(rest / np.sqrt(f.freedom))


def stack(designs: Sequence[Array], responses: Sequence[Array], errors: Sequence[Array | None]) -> tuple[Array, Array]:
    """Block design (n, p) of all responses, and the scatter (n,) that weighs its rows.

    Parameters
    ----------
    designs, responses, errors
        Of `fit_stacked`.
    """
    design = np.zeros((sum(map(len, responses)), sum(d.shape[1] for d in designs)))
    noise, row, column = [], 0, 0
    for d, y, e in zip(designs, responses, errors, strict=True):
        design[row : row + len(y), column : column + d.shape[1]] = d
        relative = np.ones(len(y)) if e is None else e * float(np.sqrt(np.mean(e**-2.0)))
        noise.append(relative * scatter(d, y, e))
        row, column = row + len(y), column + d.shape[1]
    return design, np.concatenate(noise)


def freed(
    designs: Sequence[Array],
    responses: Sequence[Array],
    runs: Sequence[Index],
    constraint: tuple[Array, Array],
    errors: Sequence[Array | None],
    n_runs: int,
) -> Freed:
    """Test every equation c b = d by the coefficients of the fit that has none of them.

    A t test of c b - d, its error by run (CR2), degrees of freedom of Bell & McCaffrey (2002) for that contrast; both
    stand unequal noise, and errors of one run that are correlated between responses.

    Parameters
    ----------
    designs, responses, runs, constraint, errors, n_runs
        Of `fit_stacked`.
    """
    design, sigma = stack(designs, responses, errors)
    y, (c, d) = np.concatenate(responses), constraint
    size = np.linalg.norm(design / sigma[:, None], axis=0)
    size = np.where(size > 0.0, size, 1.0)
    f = factorise(design / size, sigma**-2.0)
    norms = np.linalg.norm(f.design, axis=0)
    null = f.null / np.where(norms > 0.0, norms, 1.0)[:, None]
    null = null / np.maximum(np.linalg.norm(null, axis=0), 1e-300)
    lengths = np.linalg.norm(c / size, axis=1)
    contrast, right = c / size / lengths[:, None], d / lengths
    hidden = contrast @ null
    determined = np.linalg.norm(hidden, axis=1) <= OPEN
    probability = np.full(len(d), np.nan)
    stacked_runs = np.concatenate(runs)
    probability[determined] = _violated(f, contrast[determined], right[determined], y, stacked_runs, n_runs)
    left, singular, _ = np.linalg.svd(hidden[~determined])
    mixed = left[:, int(np.sum(singular > OPEN)) :].T
    combined = _violated(f, mixed @ contrast[~determined], mixed @ right[~determined], y, stacked_runs, n_runs)
    known = combined[np.isfinite(combined)]
    together = float(min(1.0, len(known) * known.min())) if len(known) else float("nan")
    return Freed(probability, together, np.any(np.abs(null) > OPEN, axis=1))


def _violated(f: Factorised, contrast: Array, right: Array, y: Array, run: Index, n_runs: int) -> Array:
    """Probability of contrast @ b - right by noise alone, shape (k,); NaN where it hangs on single rows."""
    weighted = f.root_weights * y
    inner = f.back @ (f.basis.T @ weighted)
    spread, freedom = _by_run(f, contrast @ f.back, weighted - f.basis @ (f.basis.T @ weighted), run, n_runs)
    error, violation = np.linalg.norm(spread, axis=1), np.abs(contrast @ inner - right)
    rounding = ROUNDING * (np.abs(contrast) @ np.abs(inner) + np.abs(right))
    by_chance = robust_errors.t_probability(
        violation / np.where(error > rounding, error, 1.0), np.maximum(freedom, 1e-3)
    )
    exact = np.where(violation <= 10.0 * rounding, 1.0, 0.0)
    return np.where(freedom > 0.0, np.where(error > rounding, by_chance, exact), np.nan)


def fit_stacked(
    designs: Sequence[Array],
    responses: Sequence[Array],
    runs: Sequence[Index],
    constraint: tuple[Array, Array],
    errors: Sequence[Array | None],
    n_runs: int,
) -> tuple[linear_model.LinearFit, Array]:
    """One fit of all responses under C b = d, coefficients in the order of the designs.

    Parameters
    ----------
    designs : sequence of (n_i, p_i) arrays
    responses : sequence of (n_i,) arrays
    runs : sequence of (n_i,) arrays
        Run of every row; a run has at most one row in each response.
    constraint : ((k, p) array, (k,) array)
    errors : sequence of (n_i,) arrays or None
        Standard errors as relative weights inside a response.
    n_runs : int

    Returns
    -------
    fit : LinearFit
        Over the stacked rows; covariance by run.
    spread : (p, n_runs) array
        S with covariance S S'.

    Raises
    ------
    ValueError
        The constraint cannot hold.
    """
    design, sigma = stack(designs, responses, errors)
    y = np.concatenate(responses)
    size = np.linalg.norm(design / sigma[:, None], axis=0)
    size = np.where(size > 0.0, size, 1.0)
    scaled = (constraint[0] / size, constraint[1])
    start, free = constrained_space(scaled, design.shape[1])
    fit = linear_model.fit_linear(design / size, y, sigma, scaled if len(scaled[1]) else None)
    f = factorise((design / size) @ free, sigma**-2.0)
    back = free @ f.back / size[:, None]
    at_start = y - design @ (start / size)
    coefficients = start / size + back @ (f.basis.T @ (f.root_weights * at_start))
    open_directions = _open_directions(design / size / sigma[:, None], free)
    known = ~np.any(np.abs(open_directions) > 1e-6, axis=0)
    spread, freedom = _by_run(f, back, f.root_weights * fit.residuals, np.concatenate(runs), n_runs)
    covariance = spread @ spread.T
    deviation = np.sqrt(np.diag(covariance))
    unit = np.where(deviation > 0.0, deviation, 1.0)
    stacked = replace(
        fit,
        coefficients=np.where(known, coefficients, np.nan),
        covariance=covariance,
        freedom=freedom,
        half_width=np.where(known, deviation * robust_errors.t_factor(freedom), np.nan),
        correlation=covariance / np.outer(unit, unit),
        open_directions=open_directions,
    )
    return stacked, spread


def _open_directions(unit: Array, free: Array) -> Array:
    """Combinations of scaled coefficients that change no prediction and break no equation, shape (k, p)."""
    matrix = unit @ free
    _, singular, right = np.linalg.svd(matrix)
    rank = int(np.sum(singular > max(matrix.shape) * np.finfo(float).eps * singular.max(initial=0.0)))
    return np.asarray((free @ right[rank:].T).T)


def part_of(
    fit: linear_model.LinearFit, rows: slice, columns: slice, response: Array, matrix: Array
) -> linear_model.LinearFit:
    """The share of one response, with its own design matrix, in a stacked fit; AICc belongs to the whole and is NaN."""
    residuals, left_out = fit.residuals[rows], fit.left_out[rows]
    total = linear_model.variation(factorise(matrix), response)
    coefficients = fit.coefficients[columns]
    touching = fit.open_directions[:, columns]
    return replace(
        fit,
        coefficients=coefficients,
        covariance=fit.covariance[columns, columns],
        freedom=fit.freedom[columns],
        half_width=fit.half_width[columns],
        residuals=residuals,
        leverage=fit.leverage[rows],
        left_out=left_out,
        cooks_distance=fit.cooks_distance[rows],
        rms=float(np.sqrt(np.mean(residuals**2))),
        press_rms=float(np.sqrt(np.nanmean(left_out**2))) if np.any(np.isfinite(left_out)) else float("nan"),
        r_squared=1.0 - float(np.sum(residuals**2)) / total if total > 0.0 else float("nan"),
        aicc=float("nan"),
        runs_probability=linear_model.runs_probability(residuals),
        correlation=fit.correlation[columns, columns],
        open_directions=touching[np.any(np.abs(touching) > 1e-6, axis=1)],
        rank=int(np.isfinite(coefficients).sum()),
    )

"""Discretisation uncertainty from four or more grids by least squares: Eca & Hoekstra (2014).

Their section 5: the values are fitted by f0 + a h^p; where p lies outside 0.5 to 2, by expansions of fixed order; each
once with equal weights and once with weights 1/h; of the fits that compete, the one with the smallest standard deviation
counts. For schemes of second order on geometrically similar grids.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from coeflab.core.types import Array, dataclass
from coeflab.fits.uncertainty.grid_convergence import (
    OUTSIDE,
    RANGE_OR_ORDER,
    RANGES,
    SAME_SIZE,
    WITHIN,
    Convergence,
    GridConvergence,
)

LOWEST, HIGHEST, RELIABLE = 0.5, 2.0, 2.1
SEARCHED = (0.05, 8.0)
FEWEST = 4


@dataclass(frozen=True, slots=True, eq=False)
class _Fit:
    """One expansion: its value at vanishing cell size, standard deviation, and values on the grids."""

    limit: float
    deviation: float
    on_grids: Array
    order: float | None
    form: str


def fitted_convergence(values: Array, sizes: Array, *, used: int = 0) -> GridConvergence:
    """Uncertainty of the value on one of four or more grids.

    Parameters
    ----------
    values, sizes : (k,) array
        In any order of the grids.
    used : int
        Index of the grid whose value is in use.

    Raises
    ------
    ValueError
        Fewer than four grids, or sizes that are not above zero and different.
    """
    if len(values) < FEWEST:
        raise ValueError("a least-squares fit needs four grids")
    turn = np.argsort(sizes, kind="stable")
    f, h = np.asarray(values, dtype=float)[turn], np.asarray(sizes, dtype=float)[turn]
    if h[0] <= 0.0 or np.any(np.diff(h) <= SAME_SIZE * h[:-1]):
        raise ValueError("cell sizes must be above zero and differ from grid to grid")
    h = h / h[0]
    place = int(np.flatnonzero(turn == used)[0])
    best, observed = _chosen(f, h)
    per_grid = float(np.ptp(f)) / (len(f) - 1)
    error = abs(float(best.on_grids[place]) - best.limit)
    scatter = abs(float(f[place] - best.on_grids[place]))
    good = best.deviation < per_grid
    safety = WITHIN if good and observed is not None and LOWEST <= observed < RELIABLE else OUTSIDE
    if good or per_grid == 0.0:
        half = safety * error + best.deviation + scatter
    else:
        half = OUTSIDE * best.deviation / per_grid * (error + best.deviation + scatter)
    kind = Convergence.FITTED
    slow = observed is not None and observed < LOWEST
    if slow:
        kind = Convergence.SCATTERED
        lowest = _expansion(f, h, np.full(len(h), 1.0 / len(h)), (LOWEST,))
        by_order = WITHIN * abs(float(lowest.on_grids[place]) - lowest.limit)
        by_order += lowest.deviation + abs(float(f[place] - lowest.on_grids[place]))
        half = max(half, RANGES * float(np.ptp(f)), by_order)
    seen = "no order found" if observed in (None, SEARCHED[0]) else f"observed order {observed:.2f}"
    text = f"{len(f)} grids, {seen}, fitted by {best.form}, factor {safety:g}, standard deviation {best.deviation:.3g}"
    if not good and per_grid > 0.0:
        text += f": the values scatter by more than they change from grid to grid, {per_grid:.3g}"
    if slow:
        text += f": {RANGE_OR_ORDER}"
    return GridConvergence(
        kind, tuple(map(float, f)), tuple(map(float, h)), place, observed, best.order, best.limit, safety,
        float(half), text,
    )  # fmt: skip


def _chosen(f: Array, h: Array) -> tuple[_Fit, float | None]:
    """The fit that counts, and the observed order with the smallest standard deviation."""
    weights = (np.full(len(h), 1.0 / len(h)), (1.0 / h) / np.sum(1.0 / h))
    free = [p for w in weights if (p := _free(f, h, w)) is not None]
    inside = [p for p in free if p.order is not None and LOWEST <= p.order <= HIGHEST]
    smallest = min(free, key=lambda p: p.deviation).order if free else None
    if inside:
        best = min(inside, key=lambda p: p.deviation)
        return best, best.order
    fixed = [_expansion(f, h, w, (p,)) for w in weights for p in (1.0, 2.0)]
    if smallest is None or smallest < LOWEST:
        fixed += [_expansion(f, h, w, (1.0, 2.0)) for w in weights]
    return min(fixed, key=lambda p: p.deviation), smallest


def _free(f: Array, h: Array, w: Array) -> _Fit | None:
    """f0 + a h^p with the best p, the lowest where none is; None where it runs to the upper end of the range searched."""

    def misfit(p: float) -> float:
        return _expansion(f, h, w, (p,)).deviation

    grid = np.linspace(*SEARCHED, 60)
    at = int(np.argmin([misfit(float(p)) for p in grid]))
    if at == len(grid) - 1:
        return None
    if at == 0:
        return _expansion(f, h, w, (SEARCHED[0],), free=True)
    found = minimize_scalar(misfit, bounds=(grid[at - 1], grid[at + 1]), method="bounded", options={"xatol": 1e-10})
    return _expansion(f, h, w, (float(found.x),), free=True)


def _expansion(f: Array, h: Array, w: Array, orders: tuple[float, ...], free: bool = False) -> _Fit:
    design = np.column_stack([np.ones(len(h)), *(h**p for p in orders)])
    root = np.sqrt(w)
    coefficients = np.linalg.lstsq(design * root[:, None], f * root, rcond=None)[0]
    on_grids = design @ coefficients
    freedom = len(f) - design.shape[1] - int(free)
    deviation = float(np.sqrt(np.sum(len(f) * w * (f - on_grids) ** 2) / max(freedom, 1)))
    form = " + ".join(["f0", *(f"a h^{p:.3g}" for p in orders)])
    return _Fit(float(coefficients[0]), deviation, on_grids, orders[0] if len(orders) == 1 else None, form)

"""Discretisation uncertainty from computations on several grids.

Richardson extrapolation and the grid convergence index: Roache (1998); observed order for unequal refinement ratios:
Celik et al. (2008), J. Fluids Eng. 130, 078001, equations 3 to 7; ASME V&V 20-2009, section 2-4. Limits of the order
and the factor 3 outside them: Oberkampf & Roy (2010), section 8.7, with the range of Eca & Hoekstra (2014). Oscillatory
values: half their range, ITTC 7.5-03-01-01. The formulas hold where the grids are geometrically similar and fine enough
for the leading term of the error to dominate, which three values cannot prove.

Discretisation uncertainty from four or more grids by least squares: Eca & Hoekstra (2014).

Their section 5: the values are fitted by f0 + a h^p; where p lies outside 0.5 to 2, by expansions of fixed order; each
once with equal weights and once with weights 1/h; of the fits that compete, the one with the smallest standard deviation
counts. For schemes of second order on geometrically similar grids.

Studies inside a force table: rows of one setting, computed on several grids, or with one thing changed at a time.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from coeflab.core.types import Array, brief
from coeflab.law.symbols import LINEAR, MOTIONS
from coeflab.tables.force_table import STUDIES, ForceTable

LOWEST_ORDER, ORDER_SLACK, STEEPEST = 0.5, 0.1, 60.0
WITHIN, OUTSIDE = 1.25, 3.0
SAME_SIZE = 1e-6


class Convergence(StrEnum):
    """How the values behave as the grid is refined."""

    MONOTONIC = "monotonic"
    OSCILLATORY = "oscillatory"
    DIVERGENT = "divergent"
    TWO_GRIDS = "two grids"
    NOISE = "within the iteration noise"
    UNCHANGED = "unchanged"
    ONE_GRID = "one grid"
    FITTED = "fitted"


@brief
@dataclass(frozen=True, slots=True)
class GridConvergence:
    """What a grid study says about the value on one of its grids.

    Attributes
    ----------
    convergence : Convergence
    values : tuple of float
        Finest grid first.
    sizes : tuple of float
        Representative cell sizes, relative to the finest.
    used : int
        Index of the grid whose value is in use.
    order : float or None
        Observed order of accuracy; None where it has no meaning.
    order_used : float or None
        Order of the extrapolation: the observed one, or what replaced it.
    extrapolated : float or None
        Value at vanishing cell size by ``order_used``.
    safety : float or None
        Factor on the error estimate.
    half_width : float or None
        95 % half-width of the value on the grid in use; None where none can be given.
    statement : str
        All of this in words.
    """

    convergence: Convergence
    values: tuple[float, ...]
    sizes: tuple[float, ...]
    used: int
    order: float | None
    order_used: float | None
    extrapolated: float | None
    safety: float | None
    half_width: float | None
    statement: str

    @property
    def relative(self) -> float | None:
        """Half-width over the absolute value on the grid in use."""
        value = abs(self.values[self.used])
        return None if self.half_width is None or value == 0.0 else self.half_width / value


def cell_sizes(cells: Array, dimension: int = 3) -> Array:
    """Representative cell sizes relative to the finest grid: (most cells / cells)^(1/dimension), shape (k,)."""
    return np.asarray((np.max(cells) / cells) ** (1.0 / dimension))


def observed_order(values: Array, sizes: Array) -> float | None:
    """Observed order of accuracy of three grids, finest first; None where no positive order fits.

    The positive root of e32 / e21 = r21^p (r32^p - s) / (r21^p - s), with e21 = f2 - f1, e32 = f3 - f2 and s the sign
    of their ratio: Celik et al. (2008), equation 3, solved by bracketing, as its fixed-point form need not converge.
    That equation takes an absolute value, which gives diverging values a positive order; here they have none.
    """
    e21, e32 = float(values[1] - values[0]), float(values[2] - values[1])
    if e21 == 0.0 or e32 == 0.0:
        return None
    r21, r32 = float(np.log(sizes[1] / sizes[0])), float(np.log(sizes[2] / sizes[1]))
    target = np.log(abs(e32 / e21))
    sign = float(np.sign(e32 / e21))

    def excess(p: float) -> float:
        if sign > 0.0:
            return float(p * r21 + np.log(np.expm1(p * r32)) - np.log(np.expm1(p * r21)) - target)
        return float(p * r21 + np.log1p(np.exp(p * r32)) - np.log1p(np.exp(p * r21)) - target)

    low, high = 1e-9, STEEPEST / max(r21, r32)
    if excess(low) >= 0.0 or excess(high) <= 0.0:
        return None
    return float(brentq(excess, low, high, xtol=1e-13))


def extrapolated(values: Array, sizes: Array, order: float) -> float:
    """Value at vanishing cell size from the two finest grids: Celik et al. (2008), equation 5."""
    growth = np.expm1(order * np.log(sizes[1] / sizes[0]))
    return float(values[0] + (values[0] - values[1]) / growth)


def grid_convergence(
    values: Array, sizes: Array, *, used: int = 0, formal_order: float = 2.0, noise: Array | None = None
) -> GridConvergence:
    """Judge the values of one quantity on several grids.

    Parameters
    ----------
    values : (k,) array
        In any order of the grids; the three finest are judged.
    sizes : (k,) array
        Representative cell sizes in any unit, all different.
    used : int
        Index in ``values`` of the grid whose value is in use.
    formal_order : float
        Order of the numerical scheme.
    noise : (k,) array, optional
        95 % half-widths of the values themselves (iteration noise).

    Returns
    -------
    GridConvergence
        Half-width = factor times the distance of the value in use from the extrapolated one: for the finest grid this
        is the grid convergence index of Roache.

    Raises
    ------
    ValueError
        Two grids of one size, or sizes that are not above zero.
    """
    order_of = np.argsort(sizes, kind="stable")
    value, size = np.asarray(values, dtype=float)[order_of], np.asarray(sizes, dtype=float)[order_of]
    if size[0] <= 0.0 or np.any(np.diff(size) <= SAME_SIZE * size[:-1]):
        raise ValueError("cell sizes must be above zero and differ from grid to grid")
    place = int(np.flatnonzero(order_of == used)[0])
    blur = np.zeros(len(value)) if noise is None else np.asarray(noise, dtype=float)[order_of]
    study = _Study(value, size / size[0], place, formal_order, blur)
    if len(value) == 1:
        return study.without(Convergence.ONE_GRID, None, "one grid only: its discretisation error is unknown")
    gap = float(value[1] - value[0])
    blurred = float(np.hypot(blur[0], blur[1]))
    if abs(gap) < blurred:
        text = (
            f"the two finest grids differ by {abs(gap):.3g}, less than their iteration noise {blurred:.3g}: no order "
            f"can be observed; that noise with order {formal_order:g} and factor {OUTSIDE:g} bounds the error"
        )
        return study.bounded(Convergence.NOISE, None, formal_order, OUTSIDE, text, np.copysign(blurred, gap))
    if len(value) == 2:
        text = f"two grids: order {formal_order:g} assumed, factor {OUTSIDE:g}"
        return study.bounded(Convergence.TWO_GRIDS, None, formal_order, OUTSIDE, text, gap)
    return _three(study, gap)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class _Study:
    """Values and relative sizes, finest first."""

    values: Array
    sizes: Array
    used: int
    formal: float
    noise: Array

    def without(self, kind: Convergence, order: float | None, text: str, half: float | None = None) -> GridConvergence:
        """No extrapolation."""
        return GridConvergence(
            kind, tuple(map(float, self.values)), tuple(map(float, self.sizes)), self.used, order, None, None, None,
            half, text,
        )  # fmt: skip

    def bounded(
        self, kind: Convergence, order: float | None, by: float, safety: float, text: str, gap: float
    ) -> GridConvergence:
        """Extrapolation from the two finest grids that are ``gap`` apart."""
        limit = extrapolated(np.array([self.values[0], self.values[0] + gap]), self.sizes, by)
        error = max(abs(float(self.values[self.used]) - limit), abs(float(self.values[0]) - limit))
        return GridConvergence(
            kind, tuple(map(float, self.values)), tuple(map(float, self.sizes)), self.used, order, by, limit, safety,
            safety * error, text,
        )  # fmt: skip


def _three(study: _Study, gap: float) -> GridConvergence:
    further = float(study.values[2] - study.values[1])
    if gap == 0.0 and further == 0.0:
        return study.without(Convergence.UNCHANGED, None, "the value does not change from grid to grid", 0.0)
    half = 0.5 * float(np.ptp(study.values[:3]))
    if gap == 0.0:
        text = "the two finest grids agree to the last digit, the third does not: half the range of the three"
        return study.without(Convergence.OSCILLATORY, None, text, half)
    if gap * further < 0.0:
        if abs(gap) >= abs(further):
            return study.without(
                Convergence.DIVERGENT, None, "oscillating with growing differences: no uncertainty can be given"
            )
        text = "oscillating with shrinking differences: half the range of the three finest grids, no extrapolation"
        return study.without(Convergence.OSCILLATORY, observed_order(study.values[:3], study.sizes[:3]), text, half)
    order = observed_order(study.values[:3], study.sizes[:3])
    if further / gap <= np.log(study.sizes[2] / study.sizes[1]) / np.log(study.sizes[1] / study.sizes[0]):
        return study.without(
            Convergence.DIVERGENT, None,
            "the differences do not shrink as the cells do: diverging, no uncertainty can be given",
        )  # fmt: skip
    highest = study.formal + ORDER_SLACK
    if order is not None and LOWEST_ORDER <= order <= highest:
        text = f"monotonic, observed order {order:.2f}, factor {WITHIN:g}"
        return study.bounded(Convergence.MONOTONIC, order, order, WITHIN, text, gap)
    by = LOWEST_ORDER if order is not None and order < LOWEST_ORDER else study.formal
    seen = "beyond measure" if order is None else f"{order:.2f}"
    text = (
        f"monotonic, but the observed order {seen} lies outside {LOWEST_ORDER:g} to {highest:g}: not in the asymptotic "
        f"range; order {by:g} and factor {OUTSIDE:g}"
    )
    return study.bounded(Convergence.MONOTONIC, order, by, OUTSIDE, text, gap)


LOWEST, HIGHEST, RELIABLE = 0.5, 2.0, 2.1
SEARCHED = (0.05, 8.0)
FEWEST = 4


@brief
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
    beside = abs(float(f[place] - best.on_grids[place]))
    good = best.deviation < per_grid
    safety = WITHIN if good and observed is not None and LOWEST <= observed < RELIABLE else OUTSIDE
    if good or per_grid == 0.0:
        half = safety * error + best.deviation + beside
    else:
        half = OUTSIDE * best.deviation / per_grid * (error + best.deviation + beside)
    seen = "no order found" if observed is None else f"observed order {observed:.2f}"
    text = f"{len(f)} grids, {seen}, fitted by {best.form}, factor {safety:g}, standard deviation {best.deviation:.3g}"
    if not good and per_grid > 0.0:
        text += f": the values scatter by more than they change from grid to grid, {per_grid:.3g}"
    return GridConvergence(
        Convergence.FITTED, tuple(map(float, f)), tuple(map(float, h)), place, observed, best.order, best.limit, safety,
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
    """f0 + a h^p with the best p; None where it runs to an end of the range searched."""

    def misfit(p: float) -> float:
        return _expansion(f, h, w, (p,)).deviation

    grid = np.linspace(*SEARCHED, 60)
    at = int(np.argmin([misfit(float(p)) for p in grid]))
    if at in (0, len(grid) - 1):
        return None
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


MANY = 3
WITHOUT_PLATEAU = {"too short", "drifting", "unconverged"}
AT_REST = 1e-4  # of the largest motion in the table: rounding of a printed angle, not a motion


@brief
@dataclass(frozen=True, slots=True)
class GridStudy:
    """One force component at one setting on several grids.

    Attributes
    ----------
    table, component : str
    setting : str
        Motion that is not zero, in words.
    moving : tuple of str
        Its variables.
    cells : tuple of int
        Finest grid first.
    cells_used : int
        Of the grid that the fit uses.
    convergence : GridConvergence
    """

    table: str
    component: str
    setting: str
    moving: tuple[str, ...]
    cells: tuple[int, ...]
    cells_used: int
    convergence: GridConvergence


def grid_studies(table: ForceTable, component: str, dimension: int = 3) -> tuple[GridStudy, ...]:
    """Grid studies of a component: settings with two or more cell counts, one of them in use.

    Cell sizes follow from the counts as (1/cells)^(1/dimension), so the grids must be refined alike everywhere.
    """
    cells = table.cells
    if cells is None or component not in table.forces:
        return ()
    found, setting, judged_rows = [], table.setting, table.sound(component)
    for group in (np.flatnonzero(setting == k) for k in range(int(setting.max(initial=-1)) + 1)):
        rows = [int(i) for i in group if np.isfinite(cells[i]) and judged_rows[i] and not _changed(table, int(i))]
        used = [i for i in rows if table.usable[component][i]]
        if len(used) != 1 or len(np.unique(cells[rows])) != len(rows) or len(rows) < 2:
            continue
        noise = 2.0 * table.errors[component][rows] if component in table.errors else None
        values, sizes, place = table.forces[component][rows], cell_sizes(cells[rows], dimension), rows.index(used[0])
        if len(rows) > 3:
            judged = fitted_convergence(values, sizes, used=place)
        else:
            judged = grid_convergence(values, sizes, used=place, noise=noise)
        counts = tuple(sorted((int(cells[i]) for i in rows), reverse=True))
        found.append(
            GridStudy(
                table.name, component, _setting(table, used[0]), _moving(table, used[0]), counts, int(cells[used[0]]), judged
            )
        )  # fmt: skip
    return tuple(found)


def gravest(studies: tuple[GridStudy, ...]) -> GridStudy | None:
    """The study with the largest relative half-width; one without a half-width counts as the gravest."""
    if not studies:
        return None
    return max(studies, key=lambda s: np.inf if s.convergence.relative is None else s.convergence.relative)


@brief
@dataclass(frozen=True, slots=True)
class VariantStudy:
    """One force component at one setting, with one thing changed at a time: the domain, the turbulence model, the iterations.

    Attributes
    ----------
    name : str
        Of the part of a budget: ``domain size``, ``turbulence model`` or ``iterations``.
    table, component : str
    setting : str
        Motion that is not zero, in words.
    moving : tuple of str
        Its variables.
    used : float
        Force of the row that the fit uses.
    changed : tuple of (str, float)
        What was changed, and the force with it.
    half_width : float
        95 % half-width of the force in use.
    statement : str
    """

    name: str
    table: str
    component: str
    setting: str
    moving: tuple[str, ...]
    used: float
    changed: tuple[tuple[str, float], ...]
    half_width: float
    statement: str

    @property
    def relative(self) -> float:
        """Half-width over the absolute force in use; infinite where that is zero."""
        return self.half_width / abs(self.used) if self.used else float("inf")


def variant_studies(table: ForceTable, component: str) -> tuple[VariantStudy, ...]:
    """Studies of a component in which something else than the grid was changed.

    The half-width is that of a rectangular distribution about the value in use that reaches to the farthest of the others,
    JCGM 100:2008, 4.3.7: 2 / sqrt 3 times the largest distance; a distance below the iteration noise of both values counts
    as that noise. Rows of other grids than the row in use, where cells are known and the domain is the same, are not judged.
    Nor are runs that did not converge, but for those that a study of the iterations ended sooner.
    """
    if component not in table.forces or not any(table.variants):
        return ()
    force, sound, setting = table.forces[component], table.sound(component), table.setting
    noise = 2.0 * table.errors[component] if component in table.errors else np.zeros(len(table))
    noise = np.nan_to_num(noise)
    found = []
    for row in (int(i) for i in np.flatnonzero(table.usable[component] & sound)):
        alike = [int(i) for i in np.flatnonzero((setting == setting[row]) & sound)]
        if any(i != row and not _changed(table, i) and table.usable[component][i] for i in alike):
            continue
        sooner = [int(i) for i in np.flatnonzero(setting == setting[row]) if _ended_sooner(table, component, int(i))]
        for name, part in STUDIES.items():
            rows = [
                i
                for i in (*alike, *sooner)
                if _changed(table, i) == name and (name == "domain" or _one_grid(table, row, i))
            ]
            if not rows:
                continue
            apart = np.maximum(np.abs(force[rows] - force[row]), np.hypot(noise[rows], noise[row]))
            half = 2.0 / 3.0**0.5 * float(np.max(apart))
            said = ", ".join(f"{table.variants[i].partition('= ')[2]} {force[i]:.4g}" for i in rows)
            changed = tuple((table.variants[i], float(force[i])) for i in rows)
            text = f"{part}: {force[row]:.4g} in use, {said}"
            own = (part, table.name, component, _setting(table, row), _moving(table, row))
            found.append(VariantStudy(*own, float(force[row]), changed, half, text))
    return tuple(found)


def _changed(table: ForceTable, row: int) -> str:
    """Name of the study that a row belongs to; ``several`` of one with several changes, empty for one of the matrix itself."""
    names = table.variants[row].split(" = ") if table.variants else [""]
    return names[0] if len(names) < MANY else "several"


def _ended_sooner(table: ForceTable, component: str, row: int) -> bool:
    """Whether a row of a study of the iterations has a force, but no plateau."""
    states = {e.status for e in table.exclusions if e.row == row and e.status}
    ended = bool(states) and states <= WITHOUT_PLATEAU
    return ended and _changed(table, row) == "iterations" and bool(np.isfinite(table.forces[component][row]))


def _one_grid(table: ForceTable, a: int, b: int) -> bool:
    cells = table.cells
    return cells is None or not np.all(np.isfinite(cells[[a, b]])) or bool(cells[a] == cells[b])


def _moving(table: ForceTable, row: int) -> tuple[str, ...]:
    scale = {m: table.speed[row] / (table.scaling.length if m in "pqr" else 1.0) for m in MOTIONS}
    names = [m for m in table.varies if m in MOTIONS and abs(table.motion[m][row]) > AT_REST * scale[m]]
    return (*names, *(c for c, a in table.controls.items() if a[row] != 0.0))


def _setting(table: ForceTable, row: int) -> str:
    names = _moving(table, row)
    units = {m: "m/s" if m in LINEAR else "rad/s" for m in MOTIONS}
    parts = [f"{m} = {table.motion[m][row]:.3g} {units[m]}" for m in names if m in units]
    parts += [f"{c} = {np.degrees(table.controls[c][row]):.3g} deg" for c in names if c in table.controls]
    return ", ".join(parts) or "at rest"

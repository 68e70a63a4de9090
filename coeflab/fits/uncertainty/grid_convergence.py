"""Discretisation uncertainty from computations on several grids.

Richardson extrapolation and the grid convergence index: Roache (1998); observed order for unequal refinement ratios:
Celik et al. (2008), J. Fluids Eng. 130, 078001, equations 3 to 7; ASME V&V 20-2009, section 2-4. Limits of the order
and the factor 3 outside them: Oberkampf & Roy (2010), section 8.7, with the range of Eca & Hoekstra (2014). Oscillatory
values: half their range, ITTC 7.5-03-01-01. The formulas hold where the grids are geometrically similar and fine enough
for the leading term of the error to dominate, which three values cannot prove.

Values that do not converge (differences that do not shrink as the cells do, an oscillation that grows, an order below one
half): three times the range of the values, Eca & Hoekstra (2014), and at least what the lowest order that is believed
would give. So a study that gets worse never narrows its half-width.
"""

from __future__ import annotations

from dataclasses import replace
from enum import StrEnum

import numpy as np
from scipy.optimize import brentq

from coeflab.core.types import Array, dataclass

LOWEST_ORDER, ORDER_SLACK, STEEPEST = 0.5, 0.1, 60.0
WITHIN, OUTSIDE = 1.25, 3.0
SAME_SIZE = 1e-6


class Convergence(StrEnum):
    """How the values behave as the grid is refined."""

    MONOTONIC = "monotonic"
    OSCILLATORY = "oscillatory"
    DIVERGENT = "divergent"
    GROWING = "growing oscillation"
    SLOW = "order near zero"
    TWO_GRIDS = "two grids"
    NOISE = "within the iteration noise"
    UNCHANGED = "unchanged"
    ONE_GRID = "one grid"
    FITTED = "fitted"
    SCATTERED = "fitted, without an order"

    @property
    def converges(self) -> bool:
        """Whether the values approach a limit that can be told; a half-width of others is a bound by their range."""
        return self not in (Convergence.DIVERGENT, Convergence.GROWING, Convergence.SLOW, Convergence.SCATTERED)


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
    found = _three(study, gap)
    # A difference hardly above the noise says no more of the error than the noise does.
    least = OUTSIDE * blurred / float(np.expm1(formal_order * np.log(study.sizes[1])))
    return found if found.half_width is None or found.half_width >= least else replace(found, half_width=least)


RANGES = 3.0
RANGE_OR_ORDER = f"{RANGES:g} times the range of the values, at least what order {LOWEST_ORDER:g} would give"
WHY = {
    Convergence.DIVERGENT: "the differences do not shrink as the cells do: diverging",
    Convergence.GROWING: "oscillating with growing differences",
    Convergence.SLOW: f"monotonic, but the observed order lies below {LOWEST_ORDER:g}: not in the asymptotic range",
}


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

    def by_range(self, kind: Convergence, order: float | None, gap: float) -> GridConvergence:
        """Three times the range of the values, at least what the lowest order that is believed makes of ``gap``."""
        lowest = self.bounded(kind, order, LOWEST_ORDER, WITHIN, "", gap)
        half = max(RANGES * float(np.ptp(self.values)), lowest.half_width or 0.0)
        return self.without(kind, order, f"{WHY[kind]}: {RANGE_OR_ORDER}", half)

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
    in_log_size = float(np.log(study.sizes[2] / study.sizes[1]) / np.log(study.sizes[1] / study.sizes[0]))
    if gap * further < 0.0:
        if abs(gap) >= abs(further):
            return study.by_range(Convergence.GROWING, None, max(abs(gap), abs(further) / in_log_size) * np.sign(gap))
        text = "oscillating with shrinking differences: half the range of the three finest grids, no extrapolation"
        return study.without(Convergence.OSCILLATORY, observed_order(study.values[:3], study.sizes[:3]), text, half)
    order = observed_order(study.values[:3], study.sizes[:3])
    if further / gap <= in_log_size:
        return study.by_range(Convergence.DIVERGENT, None, gap)
    highest = study.formal + ORDER_SLACK
    if order is not None and order < LOWEST_ORDER:
        return study.by_range(Convergence.SLOW, order, gap)
    if order is not None and order <= highest:
        text = f"monotonic, observed order {order:.2f}, factor {WITHIN:g}"
        return study.bounded(Convergence.MONOTONIC, order, order, WITHIN, text, gap)
    seen = "beyond measure" if order is None else f"{order:.2f}"
    text = (
        f"monotonic, but the observed order {seen} lies outside {LOWEST_ORDER:g} to {highest:g}: not in the asymptotic "
        f"range; order {study.formal:g} and factor {OUTSIDE:g}"
    )
    return study.bounded(Convergence.MONOTONIC, order, study.formal, OUTSIDE, text, gap)

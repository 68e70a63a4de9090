"""A calibrated slope at the origin, without a choice of form or window: one campaign by the mixture of forms.

A row that does not fit the others is left out and named; the curve comes from the same mixture.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from scipy import special

from coeflab.core.types import Array, remembered
from coeflab.fits.statistics.many_rows import Condensed, Rows, condensed_rows, rows_of
from coeflab.fits.statistics.slope_mixture import Design, estimate_many, joint, prepare

# Posterior probability (flattened by the power of the likelihood) at which a row is left out: 10 of 960 clean campaigns
# lost a row, 97 % of 901 readings that were off by over five standard deviations were named.
REMOVE, FEWEST = 0.1, 5


class Status(StrEnum):
    """What the data say about the slope."""

    OK = "ok"
    WRONG_POINT = "a wrong point was left out"
    OPEN = "the sign is open"
    TOO_FEW = "too few settings"


@dataclass(frozen=True, slots=True, eq=False)
class OriginSlope:
    """The slope of one campaign, with what an expert asks of it.

    Attributes
    ----------
    value, lower, upper, u95, sd : float
        As in `Slopes`, value +- u95 is printed. NaN where the status is `Status.TOO_FEW`.
    status : Status
    reason : str
    notes : tuple of str
        Duplicates, mirror images, one-sided sweep.
    noise : float
        Standard deviation of one reading.
    wrong, without : (n,) array
        Per row: probability that it is wrong; slope without it.
    used : (n,) boolean array
        Rows that carry the value: neither repeated nor left out.
    with_all : float
        Slope with every row, wrong or not.
    with_all_u95 : float
        Of ``with_all`` where rows are left out, else NaN.
    """

    value: float
    lower: float
    upper: float
    u95: float
    sd: float
    status: Status
    reason: str
    notes: tuple[str, ...]
    noise: float
    wrong: Array
    without: Array
    used: NDArray[np.bool_]
    with_all: float
    design: Design | None
    y: Array
    weights: Array
    with_all_u95: float = float("nan")

    @property
    def u95_with_all(self) -> float:
        """95 % half-width with every row, wrong or not."""
        return self.u95 if np.isnan(self.with_all_u95) else self.with_all_u95


@remembered(24)
def estimate(x: Array, y: Array, se: Array | None = None, *, odd: bool = False) -> OriginSlope:
    """Slope of one campaign at x = 0.

    Parameters
    ----------
    x, y : (n,) array
        Regressor and force.
    se : (n,) array, optional
        Stated standard errors; those that are not positive are replaced by the median.
    odd : bool
        The curve is odd by declaration, and not by what rows show: no constant, no even part. Rows at rest say nothing of it
        and should be left out.

    Returns
    -------
    OriginSlope

    Raises
    ------
    ValueError
        Lengths differ or a number is not finite.
    """
    rows = rows_of(x, y, se, odd=odd)
    few = condensed_rows(x, y, se, odd=odd)
    if few is None:
        return _estimate(rows, odd)
    found = estimate_condensed(few, odd=odd)
    used, wrong = few.rows(found.used.astype(float), 0.0) > 0.5, few.rows(found.wrong, 1.0)
    return replace(found, used=used, wrong=wrong, without=np.full(len(rows.x), np.nan))


def estimate_condensed(few: Condensed, *, odd: bool = False) -> OriginSlope:
    """Slope of one campaign of very many rows, every array by the strips."""
    used = np.ones(len(few.x), dtype=bool)
    rows = Rows(few.x, few.y, few.variance, few.stated, used, few.mirrored, few.notes, few.strips)
    return _estimate(rows, odd)


def _estimate(rows: Rows, odd: bool) -> OriginSlope:
    x, y, variance, stated, notes = rows.x, rows.y, rows.variance, rows.stated, rows.notes
    used, mirrored, strips = rows.used.copy(), rows.mirrored, rows.strips
    wrong, without, with_all, reason = np.zeros(len(x)), np.full(len(x), np.nan), np.nan, ""
    left_out: list[int] = []
    all_u95 = float("nan")
    while True:
        selected = np.flatnonzero(used)
        if len(np.unique(x[selected])) < 3 or not np.any(x):
            nan, reason = float("nan"), f"{len(np.unique(x[selected]))} different settings, at least 3 are needed"
            return OriginSlope(
                nan, nan, nan, nan, nan, Status.TOO_FEW, reason, notes, nan, wrong, without, used, nan,
                None, y[selected], np.zeros(0),
            )  # fmt: skip
        design = prepare(
            x[selected], None if variance is None else variance[selected], strips=strips and strips.of(selected), odd=odd
        )  # fmt: skip
        many = estimate_many(design, y[selected], stated)
        wrong[selected], without[selected] = many.wrong[0], many.without[0]
        worst = int(selected[np.argmax(many.wrong[0])])
        if wrong[worst] <= REMOVE or len(left_out) >= max(1, len(x) // 6) or len(selected) <= FEWEST:
            break
        if not left_out:
            every = estimate_many(design, y[selected], stated, deletions=False)
            with_all, all_u95 = float(every.value[0]), float(every.u95[0]) * (np.sqrt(2.0) if mirrored else 1.0)
        used[worst] = False
        left_out.append(worst)
    value, widen = float(many.value[0]), np.sqrt(2.0) if mirrored else 1.0
    without[left_out] = value
    lower, upper = (float(value + widen * (end[0] - value)) for end in (many.lower, many.upper))
    u95 = widen * float(many.u95[0])
    status = Status.WRONG_POINT if left_out else Status.OPEN if abs(value) <= u95 else Status.OK
    if left_out:
        what = "rows" if strips is None else "strips"
        reason = f"{what} {', '.join(map(str, left_out))} (from 0) do not fit the others; with them the value is {with_all:.4g}"
    elif status is Status.OPEN:
        reason = "the 95 % interval contains zero"
    return OriginSlope(
        value, lower, upper, u95, widen * float(many.sd[0]), status, reason, notes,
        float(many.noise[0]), wrong, without, used, with_all if left_out else value,
        design, y[selected], many.weights[0], all_u95,
    )  # fmt: skip


def curve(slope: OriginSlope, at: Array) -> tuple[Array, Array]:
    """The fitted curve at ``at`` and the half-width of its 95 % band, (m,) each; NaN without a value."""
    if slope.design is None:
        return np.full(len(at), np.nan), np.full(len(at), np.nan)
    mean, covariance = joint(slope.design, slope.y, slope.weights, at)
    factor = special.stdtrit(len(slope.y) - slope.design.flat, 0.975)
    return mean[1:], factor * np.sqrt(np.maximum(np.diag(covariance)[1:], 0.0))


def miss_of(slope: OriginSlope, at: Array, readings: Array) -> tuple[float, float]:
    """Squares of other readings about the fitted curve, over the variance of both, and the degrees of freedom of the noise.

    Parameters
    ----------
    slope : OriginSlope
    at, readings : (m,) array

    Returns
    -------
    float, float
        Over m it is F-distributed where the readings are of the curve; zero without a value.
    """
    spread, freedom = curve_spread(slope)
    if spread is None or not len(at):
        return 0.0, freedom
    miss = readings - curve(slope, at)[0]
    return float(miss @ np.linalg.solve(spread(at) + slope.noise**2 * np.eye(len(at)), miss)), freedom


def curve_spread(slope: OriginSlope) -> tuple[Callable[[Array], Array] | None, float]:
    """Covariance (m, m) of the fitted curve as a function of settings (m,), and the degrees of freedom of the noise; None without a value."""
    design = slope.design
    if design is None:
        return None, np.inf
    return lambda at: joint(design, slope.y, slope.weights, at)[1][1:, 1:], float(len(slope.y) - design.flat)

"""What the uncertainty of the coefficients makes of a figure: its interval with the error of a finite sample, and whose share it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import betainc

from coeflab.core.types import Array, dataclass
from coeflab.fits.uncertainty.propagation import HIGH, LOW
from coeflab.motion.manoeuvre import Figure
from coeflab.motion.uncertainty.sobol import SobolIndices


def quantile_error(sample: Array, level: float) -> float:
    """Standard error of a percentile, from the order statistics alone.

    J. S. Maritz, R. G. Jarrett, J. American Statistical Association 73 (1978): the moments of the order statistic under the
    sample itself, whose weights are differences of the incomplete beta function. No shape of the distribution is assumed.

    Parameters
    ----------
    sample : (n,) array
        Independent draws, two at least.
    level : float
        Per cent.
    """
    n = len(sample)
    rank = np.clip(np.floor(level / 100.0 * n + 0.5), 1, n)
    edges = betainc(rank, n - rank + 1.0, np.arange(n + 1) / n)
    weights, ordered = np.diff(edges), np.sort(sample) - np.mean(sample)
    mean = float(weights @ ordered)
    return float(np.sqrt(max(float(weights @ ordered**2) - mean**2, 0.0)))


# With more than 5 % of the members without the figure a 95 % interval of the others would speak of a part only; its ends
# lie between the two outermost of 20 members.
MOST_LACKING = 0.05
FEWEST = 20
EXTRAPOLATED = "extrapolated"


@dataclass(frozen=True, slots=True)
class Spread:
    """One figure over all members.

    Attributes
    ----------
    figure : Figure
        At the values of the file; without value where these do not give one.
    median, low, high : float or None
        Percentiles 50, 2.275 and 97.725 of the members, as two standard uncertainties to both sides; None where the status
        is not ok.
    low_error, high_error : float or None
        Standard errors of ``low`` and ``high`` because the members are finitely many.
    having : float
        Share of members that have the figure.
    extrapolated : float
        Share of members whose figure leans on motions that no data cover.
    status : str
        ``ok`` or ``no interval``.
    why : str
    """

    figure: Figure
    median: float | None
    low: float | None
    high: float | None
    low_error: float | None
    high_error: float | None
    having: float
    extrapolated: float
    status: str
    why: str = ""


@dataclass(frozen=True, slots=True)
class Share:
    """What one group of inputs does to one figure.

    Attributes
    ----------
    symbols : tuple of str
        Correlated among themselves, independent of all others.
    source : str
        Campaigns or works behind them.
    first, total : float
        Sobol indices.
    first_bounds, total_bounds : (float, float)
        95 % intervals.
    """

    symbols: tuple[str, ...]
    source: str
    first: float
    total: float
    first_bounds: tuple[float, float]
    total_bounds: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Importance:
    """Where the variance of one figure comes from.

    Attributes
    ----------
    figure : str
    known : mapping of symbol to share, as pairs, largest first
        Share of the variance that would go if that one coefficient were known, whatever it is correlated with.
    shares : tuple of Share
        Of independent groups, largest first-order index first; empty where they were not asked for or are not determined.
    rows : int
        Rows of the design that all have the figure.
    why : str
        Why there are no shares.
    tests : tuple of (str, float)
        Share of the variance that would go if a test gave all its coefficients exactly, largest first.
    """

    figure: str
    known: tuple[tuple[str, float], ...]
    shares: tuple[Share, ...] = ()
    rows: int = 0
    why: str = ""
    tests: tuple[tuple[str, float], ...] = ()


def spread(figure: Figure, values: Array, statuses: Sequence[str], why: str = "") -> Spread:
    """The interval of a figure, where it has one.

    Parameters
    ----------
    figure : Figure
        At the values of the file.
    values : (n,) array
        Not a number where a member does not have it.
    statuses : sequence of str
    why : str
        A reason of one's own to give no interval.
    """
    found = np.isfinite(values)
    having = float(np.mean(found))
    beyond = float(np.mean([s == EXTRAPOLATED for s in statuses])) if len(statuses) else 0.0
    if not why and figure.value is None:
        why = f"{figure.status} at the values of the file" + (f": {figure.why}" if figure.why else "")
    if not why and 1.0 - having > MOST_LACKING:
        why = f"{100.0 * (1.0 - having):.3g} % of the members do not have it ({_reasons_carried(statuses, found)})"
    if not why and np.count_nonzero(found) < FEWEST:
        why = f"only {np.count_nonzero(found)} members"
    if why:
        return Spread(figure, None, None, None, None, None, having, beyond, "no interval", why)
    sample = values[found]
    low, median, high = (float(v) for v in np.percentile(sample, [LOW, 50.0, HIGH]))
    words = "" if having == 1.0 else f"of the {100.0 * having:.3g} % of the members that have it"
    errors = quantile_error(sample, LOW), quantile_error(sample, HIGH)
    return Spread(figure, median, low, high, *errors, having, beyond, "ok", words)


def _reasons_carried(statuses: Sequence[str], found: NDArray[np.bool_]) -> str:
    lacking = [s for s, f in zip(statuses, found, strict=True) if not f]
    return ", ".join(f"{s} {lacking.count(s)}" for s in sorted(set(lacking)))


def shares(indices: SobolIndices, groups: Sequence[tuple[str, ...]], sources: Sequence[str]) -> tuple[Share, ...]:
    """Shares of groups, largest first-order index first.

    Parameters
    ----------
    indices : SobolIndices
    groups : sequence of tuple of str
        Names of the inputs of each group.
    sources : sequence of str
        Where each group comes from.
    """
    result = [
        Share(
            g, source, float(indices.first[k]), float(indices.total[k]),
            (float(indices.first_bounds[0, k]), float(indices.first_bounds[1, k])),
            (float(indices.total_bounds[0, k]), float(indices.total_bounds[1, k])),
        )
        for k, (g, source) in enumerate(zip(groups, sources, strict=True))
    ]  # fmt: skip
    return tuple(sorted(result, key=lambda s: (-s.first, -s.total)))

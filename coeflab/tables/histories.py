"""Histories of a steady run: where the plateau begins, its mean and standard error, and whether it still drifts. Arrays only.

The plateau begins where MSER-5 says (White 1997; White, Cobb & Spratt 2000), and as much again is left out: MSER weighs bias
against scatter, so a transient at its own start is still about as large as the standard error of the mean.

The standard error is the larger of two: batch means over batches of at least four autocorrelation times (Conway 1963;
Flegal & Jones 2010), and Geyer's initial monotone sequence (Geyer 1992) without the bias of an estimated mean (Wolff 2004).
The autocorrelation time is the larger of Geyer's and that of a first-order autoregression (Kendall 1954), for a short window
shows too little of a long correlation. Where fewer than eight batches fit, the history is too short, unless all of the window
lies within a drift that does not matter; the error is then that of a rectangular distribution over the range of the window
(JCGM 100, 4.3.7). A solver that is known to be steady ends in a cycle of two values, and one that was interrupted in another
one. Its error is no smaller than half of the range, the standard deviation of such a cycle, however many batches fit; no mean
makes it smaller (Stern et al. 2001).

A drift is a slope through the batch means that is significant, at 3 % for all components of a run together, and moves the
value by more than a share of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from coeflab.core.types import Array
from coeflab.law.symbols import FORCES, MOMENTS

CITATIONS = ("white1997", "conway1963", "flegal2010", "geyer1992", "wolff2004", "kendall1954", "jcgm100", "stern2001")
BATCH = 5  # of MSER-5
LATEST = 0.5  # share of a history that may be left out
NO_PLATEAU = 0.48  # MSER-5 at its own limit, half of the history
JUMPS, RETURNS = 0.5, 0.1  # of the range of a cycle: medians of its steps, and of what is left of them after a period
LONGEST_CYCLE = 4  # iterations
LEAST_ROWS, LEAST_BATCHES, MOST_BATCHES = 40, 8, 30
# On the plateau: the least for which docs/data_in_runs.md has the coverage of too short histories.
CALIBRATED_ROWS = 100
TIMES_A_BATCH = 4.0  # autocorrelation times
SHARE = 0.01  # of a value: a drift below it, or a whole window within it, does not matter
OF_THE_WHOLE = 0.05  # a component counts as at least this share of the whole force, or moment: see `scales`
MOST_NAMED = 6  # forces that a sentence names; the rest by their number
SIGNIFICANCE = 0.03
LONGEST = 20_000  # rows; longer histories are first averaged in blocks, which changes no mean over whole blocks
DIGITS = 1e-6  # no error is below half a unit of the sixth digit of the whole force: histories are written to as many
DIVERGED_BY = 1e3  # times the median of the first half: above what a start from rest or a gust does, far below overflow


class Convergence(StrEnum):
    """What a history says of its run, the best first."""

    CONVERGED = "converged"
    FINAL = "final value"  # a result without a history, which nothing here can judge
    SHORT = "short but used"  # what a folder of runs says of a history that is too short by itself
    TOO_SHORT = "too short"
    DRIFTING = "drifting"
    DIVERGED = "diverged"
    CRASHED = "crashed"
    EMPTY = "empty"
    UNREADABLE = "unreadable"

    @property
    def has_numbers(self) -> bool:
        """Whether a run that ended so has a mean."""
        return self in WITH_NUMBERS


ORDER = tuple(Convergence)
WITH_NUMBERS = ORDER[: ORDER.index(Convergence.DRIFTING) + 1]


@dataclass(frozen=True, slots=True)
class Mean:
    """A mean over a plateau.

    Attributes
    ----------
    value : float
    error : float
        Standard error; NaN for a single row.
    freedom : float
        Degrees of freedom of the error; 0 where it comes from the range.
    correlation : float
        Integrated autocorrelation time, in rows.
    trend, trend_error : float
        Change over the window by a straight line, and its standard error.
    status : Convergence
    half_range : float
        Half of the range of the window: the standard deviation of a cycle of two values.
    """

    value: float
    error: float
    freedom: float
    correlation: float
    trend: float
    trend_error: float
    status: Convergence
    half_range: float = 0.0

    @property
    def steady_error(self) -> float:
        """Of the mean of a steady solver's iterations: no smaller than their range allows."""
        return max(self.error, self.half_range)


@dataclass(frozen=True, slots=True)
class Plateau:
    """The part of a history that counts.

    Attributes
    ----------
    start : int
        First row of the window; -1 where there is none.
    rows : int
        Of the window.
    means : mapping of str to Mean
        By component.
    status : Convergence
        The worst of the components.
    why : str
        What shows it; empty for a converged one.
    unsure : mapping of str to bool
        Components that are too short, where this is all that is wrong: whether their error is calibrated all the same, as that
        of at least `CALIBRATED_ROWS` rows is.
    """

    start: int
    rows: int
    means: Mapping[str, Mean]
    status: Convergence
    why: str = ""
    unsure: Mapping[str, bool] = field(default_factory=dict)


def plateau_start(values: Array) -> tuple[int, bool]:
    """First row of the plateau by MSER-5, as much again left out, and whether there is one.

    Parameters
    ----------
    values : (n,) array
        In equal steps.

    Returns
    -------
    start : int
        At most half of the rows.
    found : bool
        False where MSER-5 runs into its limit, the middle of the history.
    """
    n = len(values)
    k = n // BATCH
    if k < 2:
        return 0, True
    head = n - k * BATCH
    means = values[head:].reshape(k, BATCH).mean(axis=1)[::-1]
    means = means - means.mean()
    count = np.arange(1.0, k + 1.0)
    spread = np.cumsum(means**2) - np.cumsum(means) ** 2 / count
    statistic = (spread / count**2)[::-1]
    first = int(np.argmin(statistic[: max(k // 2, 1)]))
    truncated = head * (first > 0) + first * BATCH
    return min(2 * truncated, int(LATEST * n)), truncated < NO_PLATEAU * n


def long_run_variance(values: Array, estimated: int = 1) -> tuple[float, float]:
    """Variance of the mean times the rows, by Geyer's initial monotone sequence, and the integrated autocorrelation time.

    Parameters
    ----------
    values : (n,) array
    estimated : int
        1 for a mean, 2 where a line was taken out of them.

    Returns
    -------
    variance : float
        Its bias by what was estimated is taken out (Wolff 2004).
    time : float
        Rows; 1 for independent ones.
    """
    n = len(values)
    length = 1 << (2 * n - 1).bit_length()
    spectrum = np.fft.rfft(values - values.mean(), length)
    covariance = np.fft.irfft(spectrum * spectrum.conj(), length)[:n] / n
    if n < 4 or not covariance[0] > 0.0:
        return max(float(covariance[0]), 0.0), 1.0
    half = n // 2
    pairs = covariance[: 2 * half : 2] + covariance[1 : 2 * half : 2]
    ends = np.flatnonzero(pairs <= 0.0)
    pairs = np.minimum.accumulate(pairs[: ends[0] if ends.size else half])
    total = max(2.0 * float(pairs.sum()) - float(covariance[0]), 0.0) / max(1.0 - 2.0 * estimated * len(pairs) / n, 0.2)
    return total, total / float(covariance[0])


def autoregressive_time(values: Array) -> float:
    """Integrated autocorrelation time of a first-order autoregression, of what a line leaves.

    Its bias, (1 + 4 phi)/n for a mean (Kendall 1954) and (2 + 5 phi)/n for a line, is taken out.
    """
    n = len(values)
    size = float(values @ values)
    if n < 4 or size == 0.0:
        return 1.0
    phi = float(values[1:] @ values[:-1]) / size
    phi = min(phi + (2.0 + 5.0 * phi) / n, 1.0 - 1.0 / n)
    return max((1.0 + phi) / (1.0 - phi), 1.0)


def mean_of(values: Array, tolerance: float, floor: float, significance: float = SIGNIFICANCE) -> Mean:
    """Mean of a window, its standard error, and whether it drifts.

    Parameters
    ----------
    values : (m,) array
        In equal steps; all of them count.
    tolerance : float
        Change of the value that does not matter.
    floor : float
        Least standard error.
    significance : float
        Of a drift.
    """
    m = len(values)
    value = float(values.mean()) if m else np.nan
    if m < 2:
        return Mean(value, np.nan, 0.0, np.nan, np.nan, np.nan, Convergence.TOO_SHORT)
    within = float(np.ptp(values))
    by_range = within / np.sqrt(12.0)
    at = (np.arange(m) + 0.5) / m - 0.5
    line = float(at @ values) / float(at @ at)
    around = values - value - line * at
    noise, time = long_run_variance(around, 2)
    time = max(time, autoregressive_time(around))
    batches = int(min(MOST_BATCHES, m // _least_batch(time)))
    if m < LEAST_ROWS or batches < LEAST_BATCHES:
        steady = within <= tolerance and m >= LEAST_ROWS
        status = Convergence.CONVERGED if steady else Convergence.TOO_SHORT
        return Mean(value, max(by_range, floor), 0.0, time, line, np.nan, status, within / 2.0)
    from scipy.special import stdtrit

    size = m // batches
    means = values[m - batches * size :].reshape(batches, size).mean(axis=1)
    at = (np.arange(batches) - (batches - 1) / 2.0) / batches
    trend = float(at @ means) / float(at @ at)
    left = means - means.mean() - trend * at
    scatter = max(float(left @ left) / (batches - 2), noise / size)
    trend_error = float(np.sqrt(scatter / float(at @ at)))
    limit = float(stdtrit(batches - 2, 1.0 - significance / 2.0)) * trend_error
    drifts = abs(trend) > max(limit, tolerance)
    error = float(np.sqrt(max(float(means.var(ddof=1)) / batches, long_run_variance(values)[0] / m)))
    # A mean of a value that still moves is uncertain by the range of the line as well.
    error = float(np.hypot(error, trend / np.sqrt(12.0))) if drifts else error
    status = Convergence.DRIFTING if drifts else Convergence.CONVERGED
    return Mean(value, max(error, floor), batches - 1.0, time, trend, trend_error, status, within / 2.0)


def is_cycle(values: Array) -> bool:
    """Whether iterations end in a cycle of a few: every so many the value comes back, and between it jumps.

    Batch means of such a history are exact, and say nothing of where a solver that did converge would have ended.

    Parameters
    ----------
    values : (m,) array
        Of successive iterations.
    """
    within = float(np.ptp(values)) if len(values) >= LEAST_ROWS else 0.0
    if not within > 0.0 or np.median(np.abs(np.diff(values))) < JUMPS * within:
        return False
    return any(np.median(np.abs(values[n:] - values[:-n])) <= RETURNS * within for n in range(2, LONGEST_CYCLE + 1))


def scales(sizes: Mapping[str, float], groups: Mapping[str, str], length: float = 0.0) -> dict[str, float]:
    """The whole force, or moment, that each column belongs to: a component that is zero by symmetry is judged by that.

    Parameters
    ----------
    sizes : mapping of str to float
        Of each column.
    groups : mapping of str to str
        Columns of one vector have one text.
    length : float
        Of the body, m. Where it is given, and columns begin with X Y Z K M N, the whole moment is at least that of the whole
        force on an arm of this length: of a body that symmetry leaves without any moment, the moment's own size is rounding.
        A hundredth of a twentieth of it moves the line of action of the force by a two-thousandth of the length.
    """
    whole = {g: float(np.hypot.reduce([sizes[c] for c in sizes if groups[c] == g])) for g in set(groups.values())}
    force = max((whole[groups[c]] for c in sizes if c[:1] in FORCES), default=0.0) if length else 0.0
    return {c: max(whole[groups[c]], length * force * (c[:1] in MOMENTS)) for c in sizes}


def plateau(
    forces: Mapping[str, Array], at: Array | None = None, groups: Mapping[str, str] | None = None, length: float = 0.0
) -> Plateau:
    """The plateau that all forces and moments of a run share.

    Parameters
    ----------
    forces : mapping of str to (n,) array
        X Y Z K M N, as far as there are, or columns of any other name.
    at : (n,) array, optional
        Time of every row; forces at unequal steps are interpolated to equal ones.
    groups : mapping of str to str, optional
        Columns of one vector have one text; by default forces, and moments.
    length : float
        Of the body, m, where it is known: see `scales`.

    Returns
    -------
    Plateau
        A history that is not finite behind its beginning, or grew a thousandfold, diverged; one of no rows is empty, and one of
        zeros is what it says: zero. ``start`` counts the rows as they came.
    """
    names = list(forces)
    group = groups or {c: FORCES[0] if c in FORCES else MOMENTS[0] for c in names}
    columns = np.array([forces[c] for c in names], dtype=float).reshape(len(names), -1)
    finite = np.all(np.isfinite(columns), axis=0)
    skipped = int(np.argmax(finite)) if finite.any() else columns.shape[1]
    if not columns.shape[1]:
        return _none(Convergence.EMPTY, "no rows of forces")
    if not finite[skipped:].all() or skipped == columns.shape[1]:
        row = skipped + int(np.argmin(finite[skipped:])) if skipped < columns.shape[1] else 0
        return _none(Convergence.DIVERGED, f"row {row + 1} of the history is not a number")
    columns = columns[:, skipped:]
    n = columns.shape[1]
    grown = _grown(columns)
    if grown:
        return _none(Convergence.DIVERGED, grown)
    steps = _in_equal_steps(columns, None if at is None else np.asarray(at, dtype=float)[skipped:])
    block = -(-n // LONGEST)
    steps = _block_means(steps, block)
    late = steps[:, steps.shape[1] // 2 :]
    size = dict(zip(names, np.abs(late.mean(axis=1)), strict=True))
    whole = scales(size, group, length)
    tolerance = {c: SHARE * max(size[c], OF_THE_WHOLE * whole[c]) for c in names}
    starts = [
        plateau_start(row) if float(np.ptp(row)) > tolerance[c] else (0, True)
        for c, row in zip(names, steps, strict=True)
    ]
    start = max(first for first, _ in starts)
    window = steps[:, start:]
    floor = {c: 0.5 * DIGITS * whole[c] / np.sqrt(3.0) for c in names}
    means = {
        c: mean_of(row, tolerance[c], floor[c], SIGNIFICANCE / len(names)) for c, row in zip(names, window, strict=True)
    }
    unsettled = [
        c
        for c, (_, found), row in zip(names, starts, window, strict=True)
        if not found and np.ptp(row) > tolerance[c] and _is_a_line(row)
    ]
    status = max((m.status for m in means.values()), key=ORDER.index)
    why = _why(means, status, window.shape[1], block)
    if unsettled and status is not Convergence.DRIFTING:
        status, why = (
            Convergence.DRIFTING,
            f"{', '.join(unsettled)} still settling at the end: no plateau in the second half",
        )
    enough = window.shape[1] >= CALIBRATED_ROWS
    short = [c for c, m in means.items() if m.status is Convergence.TOO_SHORT]
    unsure = dict.fromkeys(short, enough) if status is Convergence.TOO_SHORT else {}
    first = skipped + n % block * (start > 0) + start * block
    return Plateau(first, window.shape[1] * block, means, status, why, unsure)


def _is_a_line(values: Array) -> bool:
    """Whether a line explains nine tenths of the variance."""
    at = np.arange(len(values)) - (len(values) - 1) / 2.0
    off = values - values.mean()
    return float(at @ off) ** 2 > 0.9 * float(at @ at) * float(off @ off)


def _none(status: Convergence, why: str) -> Plateau:
    return Plateau(-1, 0, {}, status, why)


def _grown(columns: Array) -> str:
    """How often more the forces are at the end than in the first half, in words; empty below a thousandfold."""
    n = columns.shape[1]
    size = np.sqrt(np.sum(columns**2, axis=0))
    before, last = float(np.median(size[: max(n // 2, 1)])), float(np.median(size[-max(n // 20, 1) :]))
    return f"the forces grew {last / before:.2g}-fold" if before > 0.0 and last > DIVERGED_BY * before else ""


def _block_means(columns: Array, block: int) -> Array:
    """Means of so many rows each, the last ones whole."""
    return (
        columns if block == 1 else columns[:, columns.shape[1] % block :].reshape(len(columns), -1, block).mean(axis=2)
    )


def _in_equal_steps(columns: Array, at: Array | None) -> Array:
    """The columns in equal steps of time."""
    if at is None or len(at) < 3 or not np.all(np.isfinite(at)):
        return columns
    steps = np.diff(at)
    if not np.all(steps > 0.0) or float(steps.max()) <= 1.01 * float(steps.min()):
        return columns
    even = np.linspace(at[0], at[-1], len(at))
    return np.array([np.interp(even, at, row) for row in columns])


def _why(means: Mapping[str, Mean], status: Convergence, rows: int, block: int) -> str:
    if status is Convergence.CONVERGED:
        return ""
    of = {c: m for c, m in means.items() if m.status is status}
    if status is Convergence.DRIFTING:
        worst = ", ".join(f"{c} by {m.trend:+.2g}" for c, m in of.items())
        return f"still moves over the plateau: {worst}"
    names = [*of][:MOST_NAMED] + [f"{len(of) - MOST_NAMED} more"] * (len(of) > MOST_NAMED)
    longest = max((m.correlation for m in of.values() if np.isfinite(m.correlation)), default=np.nan)
    if rows < LEAST_ROWS or not np.isfinite(longest):
        return f"{rows} row{'s' * (rows != 1)} on the plateau, {LEAST_ROWS} needed"
    needed = LEAST_BATCHES * _least_batch(longest) * block
    one = len(of) == 1
    return (
        f"{', '.join(names)} span{'s' * one} more than {100 * SHARE:g} % and {'is' if one else 'are'} correlated over "
        f"{longest * block:.3g} rows: {rows * block} on the plateau, {needed} needed"
    )


def _least_batch(time: float) -> int:
    """Rows of a batch, whole, for an autocorrelation time in rows."""
    return int(np.ceil(TIMES_A_BATCH * time))

"""Straight runs of a table: rows in which nothing varies but the speed, and the X0' that they give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.results.straight_runs import SYMBOL, StraightRuns
from coeflab.fits.statistics.linear_model import fit_linear
from coeflab.fits.statistics.robust_errors import t_probability
from coeflab.law.coefficient import Coefficient, Parts, Status
from coeflab.tables.force_table import FEWEST_SPEEDS, ForceTable

SAME_SPEED = 1e-3  # of the largest
ROUNDING = 1e-9  # of the value: scatter below it is that of the arithmetic


def _speeds(speed: Array) -> int:
    """How many of them differ."""
    found: list[float] = []
    for one in np.sort(speed).tolist():  # from the last that counts: many close ones are no single speed
        found += [one] if not found or one - found[-1] > SAME_SPEED * float(np.max(speed)) else []
    return len(found)


def straight_runs(table: ForceTable, length: float) -> StraightRuns | None:
    """The resistance of a table without any motion or control but the speed ahead; None of others, or of less than three speeds.

    The mean of X' = X / (1/2 rho U^2 L^2), every run weighed alike, stands unequal noise (HC2, Bell & McCaffrey 2002), and so does the
    slope of X' over log U that is its trend.

    Parameters
    ----------
    table : ForceTable
    length : float
        Of the primes, m.
    """
    if table.varies or table.by_symmetry or "X" not in table.forces:
        return None
    used = table.usable["X"] & (table.motion["u"] > 0.0)
    speed = np.asarray(table.speed[used])
    if _speeds(speed) < FEWEST_SPEEDS:
        return None
    primes = np.asarray(table.primed_force("X", length)[used])
    over = np.log(speed) - float(np.mean(np.log(speed)))
    ones = np.ones(len(over))
    flat, sloped = fit_linear(ones[:, None], primes), fit_linear(np.column_stack([ones, over]), primes)
    slope, error = float(sloped.coefficients[1]), float(np.sqrt(sloped.covariance[1, 1]))
    exact = flat.rms <= ROUNDING * float(np.max(np.abs(primes)))
    probability = 1.0 if exact else float(t_probability(slope / error, float(sloped.freedom[1]))) if error else 0.0
    reynolds = table.reynolds(length) if table.conditions.viscosity is not None else None
    result = StraightRuns(
        table.name, table.campaign, table.body, tuple(t for t, k in zip(table.labels, used, strict=True) if k), speed,
        np.asarray(table.forces["X"][used]), primes, None if reynolds is None else np.asarray(reynolds[used]),
        float(flat.coefficients[0]), float(flat.half_width[0]), slope * float(np.ptp(over)),
        max(abs(slope) * float(np.max(np.abs(over))), float(np.max(np.abs(flat.residuals)))), probability,
    )  # fmt: skip
    return replace(result, random=float(sloped.half_width[0])) if result.has_trend else result


def resistance(
    tables: Sequence[ForceTable], length: float, citation: str
) -> tuple[tuple[StraightRuns, ...], Coefficient | None]:
    """Every table of straight runs, and X0' of the one with the most runs; none where a table has no such runs.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign.
    length : float
        Of the primes, m.
    citation : str
    """
    found = tuple(r for t in tables if (r := straight_runs(t, length)) is not None)
    if not found:
        return (), None
    r = max(found, key=lambda one: len(one.speed))
    return found, Coefficient(
        symbol=SYMBOL,
        value=r.value,
        u95=r.u95 or None,
        status=Status.SIGN_OPEN if abs(r.value) <= r.u95 else Status.OK,
        body=r.body,
        parts=Parts(random=r.random, model_form=r.form),
        origin="fit",
        table=r.table,
        campaign=r.campaign,
        estimator=f"mean of {r.runs}" + f"; {r.changes}" * r.has_trend,
        n_points=len(r.speed),
        citation=citation,
    )

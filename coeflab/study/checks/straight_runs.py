"""Straight runs over the speed: X0', and whether it changes with the Reynolds number beyond the scatter of the runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.fits.results.straight_runs import DOUBTFUL, StraightRuns
from coeflab.fits.rows.straight_runs import straight_runs
from coeflab.fits.statistics.linear_model import fit_linear
from coeflab.law.friction_line import friction_line

if TYPE_CHECKING:
    from coeflab.study.study import Study
    from coeflab.tables.force_table import ForceTable

summary = "X0' of straight runs: its trend with speed against the scatter"
citations = ("mackinnon1985", "bell2002", "ittc1957")
FEWEST_RUNS = 4


def check(study: Study) -> Sequence[Check]:
    """One finding a table of straight runs: a warning where X0' changes with the speed."""
    inside = {r.table for f in study.fits for r in f.straight}
    found = [r for t in study.tables if (r := straight_runs(t, t.scaling.length)) is not None]
    return [_finding(r, held=r.table in inside) for r in found] + [
        as_check("straight_runs", f)
        for r in found
        for f in friction(r, next(t for t in study.tables if t.name == r.table))
    ]


def friction(r: StraightRuns, table: ForceTable) -> Iterator[Finding]:
    """X0' over the friction line of ITTC 1957: the form factor, of runs whose wave resistance goes with Fn^4 (Prohaska 1966).

    Parameters
    ----------
    r : StraightRuns
    table : ForceTable
        Of the runs.
    """
    if r.reynolds is None or len(r.speed) < FEWEST_RUNS:
        return
    line = np.array([friction_line(float(re)) for re in r.reynolds])
    froude = np.asarray(r.speed) / np.sqrt(STANDARD_GRAVITY * table.scaling.length)
    design = np.column_stack([np.ones(len(line)), froude**4 / line])
    flat, waves = fit_linear(design[:, :1], -r.primes / line), fit_linear(design, -r.primes / line)
    has_waves = bool(waves.half_width[1] < abs(waves.coefficients[1]))
    fit = waves if has_waves else flat
    factor, half = float(fit.coefficients[0]), float(fit.half_width[0])
    yield Finding.of(
        "resistance.form_factor", r.table, Severity.NOTE, statistic=factor, u95=half, waves="some" if has_waves else "none",
        per=float(waves.coefficients[1]), low=float(froude.min()), high=float(froude.max()), left=float(fit.rms) / factor,
    )  # fmt: skip


def _finding(r: StraightRuns, *, held: bool) -> Check:
    trend = "none" if not r.has_trend else "held" if held else "left_out"
    severity = Severity.WARN if r.has_trend else Severity.NOTE
    return Check.of(
        "straight_runs.speeds", r.table, severity, runs=r.runs, changes=r.changes, doubtful=DOUBTFUL, trend=trend
    )

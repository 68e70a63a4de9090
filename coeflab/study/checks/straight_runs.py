"""Straight runs over the speed: X0', and whether it changes with the Reynolds number beyond the scatter of the runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.fits.results.straight_runs import DOUBTFUL
from coeflab.fits.rows.straight_runs import straight_runs

if TYPE_CHECKING:
    from coeflab.fits.results.straight_runs import StraightRuns
    from coeflab.study.study import Study

summary = "X0' of straight runs: its trend with speed against the scatter"
citations = ("mackinnon1985", "bell2002")


def check(study: Study) -> Sequence[Check]:
    """One finding a table of straight runs: a warning where X0' changes with the speed."""
    inside = {r.table for f in study.fits for r in f.straight}
    found = [r for t in study.tables if (r := straight_runs(t, t.scaling.length)) is not None]
    return [_finding(r, held=r.table in inside) for r in found]


def _finding(r: StraightRuns, *, held: bool) -> Check:
    if not r.has_trend:
        comment = "Nothing varies but the speed: X0' follows, and no slope."
    elif held:
        comment = (
            "One X0' does not hold for all speeds, as friction depends on the Reynolds number. U95 holds the change over these speeds; "
            "at others X0' may lie outside it. Fit the runs near your speed alone for a closer one."
        )
    else:
        comment = "U95 of X0' leaves the change out. slope_at_origin, the default fit, has it in U95."
    severity = Severity.WARN if r.has_trend else Severity.NOTE
    return Check("straight_runs", r.table, severity, f"{r.runs}: {r.changes}", f"p of a trend >= {DOUBTFUL:g}", comment)

"""The estimator of the steady-CFD study of SUBOFF: one straight line, with its intercept, through all points of a sweep.

It is shown beside the recommended slope, as that study's numbers come from it. A line follows the curve of a force over the range
that was run: it has no U95 here, and is no slope at the origin.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.law.symbols import ANGULAR, LINEAR, derivative
from coeflab.tables.force_table import AT_REST, ForceTable

LARGEST_ANGLE = 6.0  # deg, of that study's drifts and attacks
SLACK = 1e-3
NAME = "our line"
MEANING = f"Our line: one straight line through all points to {LARGEST_ANGLE:g} deg and all rates; no U95."


def line(tables: Sequence[ForceTable], symbol: str, length: float) -> float | None:
    """Primed slope of the line through the rows that move in one variable or rest, of the table that has the most of them.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign.
    symbol : str
        Without prime, of one factor: ``Yv``.
    length : float
        Of the primes, m.

    Returns
    -------
    float or None
        None where no table has two settings besides rest.
    """
    component, factors = symbol[:1], tuple(derivative(symbol).factors)
    if len(factors) != 1:
        return None
    (variable,) = factors
    limit = np.sin(np.radians(LARGEST_ANGLE)) * (1.0 + SLACK) if variable in LINEAR else np.inf
    others = [m for m in (*LINEAR[1:], *ANGULAR) if m != variable]
    best: tuple[int, float] | None = None
    for t in tables:
        if component not in t.forces:
            continue
        x, y = t.primed_motion(variable, length), t.primed_force(component, length)
        rests = [np.abs(t.primed_motion(m, length)) <= AT_REST for m in (*others, *t.controls)]
        ahead = t.motion["u"] > 0.0
        rows = t.usable[component] & np.isfinite(y) & (np.abs(x) <= limit) & ahead & np.all(rests, axis=0)
        moving = np.abs(x[rows]) > AT_REST
        if len(np.unique(np.round(x[rows][moving], 9))) < 2:
            continue
        if best is None or moving.sum() > best[0]:
            best = int(moving.sum()), float(np.polyfit(x[rows], y[rows], 1)[0])
    return None if best is None else best[1]

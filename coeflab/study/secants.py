"""A derivative of which too few runs count for a slope at the origin: the secant through what was run, with a wide U95."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import derivative
from coeflab.study.single_motion import commanded
from coeflab.tables.force_table import ForceTable

# Of the secant, that covers the slope at the origin: of the 19 odd sweeps of drift, attack and turning in the shipped SUBOFF
# campaigns whose slope is known within half of it, every secant from .6 to 12 deg or up to r' = .5 lies that near (.59 at most).
OF_SECANT = 0.6


def secant(tables: Sequence[ForceTable], symbol: str, scaling: Scaling) -> Coefficient | None:
    """The secant of the smallest setting that counts.

    U95 is `OF_SECANT` of it, together with half the range of all secants, those of unconverged runs among them.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign.
    symbol : str
        Without prime, of one factor: ``Yv``.
    scaling : Scaling
        Of the primes.

    Returns
    -------
    Coefficient or None
        None where no run of this motion counts.
    """
    component, factors = symbol[:1], tuple(derivative(symbol).factors)
    rows = [(t, r) for t in tables if len(factors) == 1 for r in commanded(t, component, factors[0], scaling.length)]
    counted = [r for _, r in rows if r.counts]
    if not counted:
        return None
    first, least = rows[0][0], min(counted, key=lambda r: r.size)
    value = least.y / least.x
    spread = float(np.ptp([r.y / r.x for _, r in rows])) / 2.0
    u95 = float(np.hypot(OF_SECANT * abs(value), spread))
    return Coefficient(
        symbol, value, u95, Status.SIGN_OPEN if abs(value) <= u95 else Status.OK, first.body, origin="fit", table=first.name,
        campaign=first.campaign, n_points=len(counted), citation=first.source.citation,
        estimator=f"secant of one setting, U95 {OF_SECANT:.0%} of it: too few runs count for a slope",
    )  # fmt: skip

"""A derivative of which too few runs count for a slope at the origin: the secant through what was run, with a wide U95."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import ANGULAR, LINEAR, derivative
from coeflab.tables.force_table import AT_REST, ForceTable

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
    component, (variable,) = symbol[:1], tuple(derivative(symbol).factors) or ("",)
    found: list[tuple[bool, float, float]] = []  # whether it counts, size of the setting, secant
    names = [m for m in (*LINEAR[1:], *ANGULAR) if m != variable]
    first: ForceTable | None = None
    for t in tables:
        if component not in t.forces or not variable:
            continue
        x, y = t.primed_motion(variable, scaling.length), t.primed_force(component, scaling.length)
        rests = [np.abs(t.primed_motion(m, scaling.length)) <= AT_REST for m in (*names, *t.controls)]
        states = {e.row for e in t.exclusions if e.status and e.component in ("", component)}
        apart = {e.row for e in t.exclusions if not e.status and e.component in ("", component)}
        for i in np.flatnonzero((np.abs(x) > AT_REST) & np.isfinite(y) & np.all(rests, axis=0)).tolist():
            counts = bool(t.usable[component][i])
            if i in apart or (t.variants and t.variants[i]) or not (counts or i in states):
                continue
            found.append((counts, float(abs(x[i])), float(y[i] / x[i])))
            first = first or t
    counted = [f for f in found if f[0]]
    if not counted or first is None:
        return None
    value = min(counted, key=lambda f: f[1])[2]
    spread = float(np.ptp([f[2] for f in found])) / 2.0
    u95 = float(np.hypot(OF_SECANT * abs(value), spread))
    return Coefficient(
        symbol, value, u95, Status.SIGN_OPEN if abs(value) <= u95 else Status.OK, first.body, origin="fit", table=first.name,
        campaign=first.campaign, n_points=len(counted), citation=first.source.citation,
        estimator=f"secant of one setting, U95 {OF_SECANT:.0%} of it: too few runs count for a slope",
    )  # fmt: skip

"""Port-starboard symmetry: a symmetric body has no side force, roll or yaw at zero drift."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from coeflab.core.table import Check, Severity
from coeflab.fits.results.fit_result import Sweep
from coeflab.fits.statistics.linear_model import bell_mccaffrey, hc_variance, t_factor
from coeflab.law.symbols import primed
from coeflab.study.study import Study

summary = "intercepts of Y, K, N at zero drift and yaw rate against their own error"
citations = ("bell2002",)
NOTHING, LARGE = 1e-3, 0.05
RULE = (
    f"passes where its 95 % interval holds zero or it is below {100 * NOTHING:g} % of the largest; noted below {100 * LARGE:g} %, "
    "else a warning"
)
WHICH = "Of the member with the most points; Data quality shows the median of all members."


def _intercept(sweep: Sweep) -> Check | None:
    if sweep.component not in "YKN" or sweep.variable not in ("v", "r") or not sweep.recommendation.members:
        return None
    e = max(sweep.recommendation.members, key=lambda m: len(m.rows))
    value = float(e.coefficients[e.terms.index("1")])
    at = e.terms.index("1")
    error = float(hc_variance(e.factorised, e.residuals, 2)[at] ** 0.5 * t_factor(bell_mccaffrey(e.factorised)[at]))
    if not isfinite(error):
        return None
    reach = float(abs(sweep.y).max())
    share = abs(value) / reach if reach else 0.0
    if abs(value) <= error:
        severity, comment = Severity.PASS, "The force at rest angle is within its error of zero."
    elif share < NOTHING:
        severity, comment = Severity.PASS, "The force at rest angle is next to nothing."
    elif share < LARGE:
        severity, comment = Severity.NOTE, "Model or rig bias; the intercept takes it up."
    else:
        severity, comment = Severity.WARN, "A large bias: look for a misaligned model, tare or angle offset."
    return Check(
        "symmetry",
        f"{sweep.campaign} {primed(sweep.symbol)}",
        severity,
        f"{sweep.component}'(0) = {value:.3g} +- {error:.2g}, {100 * share:.1f} % of the largest {sweep.component}'",
        RULE,
        f"{comment} {WHICH}",
    )


def check(study: Study) -> Sequence[Check]:
    """One finding per odd sweep of a port-starboard component."""
    return [c for f in study.fits for s in f.sweeps if s.parity == "odd" and (c := _intercept(s)) is not None]

"""Port-starboard symmetry: a symmetric body has no side force, roll or yaw at zero drift."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.core.table import Check, Severity, plus_minus
from coeflab.fits.results.fit_result import Sweep
from coeflab.study.study import Study

summary = "intercepts of Y, K, N at zero drift and yaw rate against their own error"
citations = ("wahba1990",)
ZEROS = 1e-9  # of the largest primed force or moment of the campaign: below it a component holds numerical zeros
NOTHING, LARGE = 1e-3, 0.05
RULE = f"zero within U95; a note from {100 * NOTHING:g} % of the largest, a warning from {100 * LARGE:g} %"


def _intercept(sweep: Sweep) -> Check | None:
    if sweep.component not in "YKN" or sweep.variable not in ("v", "r") or sweep.value is None or sweep.symmetry:
        return None
    value, error = sweep.at_rest
    reach = float(abs(sweep.y).max())
    share = abs(value) / reach if reach else 0.0
    if abs(value) <= error:
        severity, comment = Severity.PASS, "The force at zero angle is within its error of zero."
    elif share < NOTHING:
        severity, comment = Severity.PASS, "The force at zero angle is negligible."
    elif share < LARGE:
        severity, comment = Severity.NOTE, "Model or rig bias; the intercept absorbs it."
    else:
        severity, comment = Severity.WARN, "A large bias: look for a misaligned model, tare or angle offset."
    return Check(
        "symmetry",
        f"{sweep.campaign} {sweep.component}0'",
        severity,
        f"{sweep.component}' at zero {_motion(sweep)} = {plus_minus(value, error)}, should be zero by symmetry; it is {100 * share:.1f} % of "
        f"the largest {sweep.component}'",
        RULE,
        comment,
    )


def _motion(sweep: Sweep) -> str:
    return "drift" if sweep.variable == "v" else "yaw rate"


def check(study: Study) -> Sequence[Check]:
    """One finding per odd sweep of a port-starboard component."""
    sweeps = [s for f in study.fits for s in f.sweeps]
    largest: dict[str, float] = {}
    for s in sweeps:
        largest[s.campaign] = max(largest.get(s.campaign, 0.0), float(np.abs(s.y).max(initial=0.0)))
    odd = [s for s in sweeps if s.parity == "odd" and np.abs(s.y).max(initial=0.0) >= ZEROS * largest[s.campaign]]
    return [c for s in odd if (c := _intercept(s)) is not None]

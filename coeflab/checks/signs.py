"""Signs that every ordinary hull has: the quickest way to catch a wrong axis or angle."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.symbols import primed
from coeflab.model.check import Check, Severity
from coeflab.model.study import Study

summary = "Yv', Zw', Nr', Mq', X0' negative"
citations = ("gertler1967",)

NEGATIVE = {
    "Yv": "side force opposes side velocity",
    "Zw": "normal force opposes normal velocity",
    "Nr": "yaw moment opposes yaw rate",
    "Mq": "pitch moment opposes pitch rate",
    "X0": "drag points aft",
}


def check(study: Study) -> Sequence[Check]:
    """One finding per coefficient whose sign is known."""
    out = []
    for c in study.coefficients:
        if c.symbol not in NEGATIVE or c.value is None:
            continue
        good = c.value < 0.0
        sure = c.u95 is not None and abs(c.value) > c.u95
        severity = Severity.PASS if good else Severity.FAIL if sure else Severity.WARN
        comment = (
            f"As it must be: {NEGATIVE[c.symbol]}."
            if good
            else "Check the declared axes and the sign of the angle; for Nr' and Mq' whether the force contains inertia."
        )
        found = f"{primed(c.symbol)} = {c.value:.3g}"
        out.append(Check("signs", f"{c.campaign} {primed(c.symbol)}", severity, found, "below zero", comment))
    return out

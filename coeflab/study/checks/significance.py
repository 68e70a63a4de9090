"""Coefficients that cannot be told from zero, so that nobody takes their sign for a result."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.finding import Severity
from coeflab.core.table import Check, plus_minus
from coeflab.law.coefficient import Status
from coeflab.law.symbols import primed
from coeflab.study.study import Study

summary = "values smaller than their U95"
citations = ("ittc_uncertainty",)


def check(study: Study) -> Sequence[Check]:
    """One finding per fitted coefficient whose interval holds zero: a warning where the plan wants it."""
    return [
        Check(
            "significance",
            f"{c.campaign} {primed(c.symbol)}",
            Severity.WARN if c.status is Status.SIGN_OPEN and c.symbol in study.plan.wanted else Severity.NOTE,
            f"{primed(c.symbol)} = {plus_minus(c.value, c.u95)}",
            "|value| above U95",
            c.status.advice
            if c.status is Status.SIGN_OPEN
            else "Not distinguishable from zero: neither size nor sign is a result.",
        )
        for c in study.coefficients
        if c.origin == "fit" and c.value is not None and c.u95 is not None and abs(c.value) <= c.u95
    ]

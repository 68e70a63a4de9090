"""Coefficients that cannot be told from zero, so that nobody takes their sign for a result."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.table import Check, Severity
from coeflab.law.symbols import primed
from coeflab.study.study import Study

summary = "values smaller than their U95"
citations = ("ittc_uncertainty",)


def check(study: Study) -> Sequence[Check]:
    """One note per fitted coefficient whose interval holds zero."""
    return [
        Check(
            "significance",
            f"{c.campaign} {primed(c.symbol)}",
            Severity.NOTE,
            f"{primed(c.symbol)} = {c.value:.2g}, U95 {c.u95:.2g}",
            "|value| above U95",
            "Not distinguishable from zero: neither size nor sign is a result.",
        )
        for c in study.coefficients
        if c.origin == "fit" and c.value is not None and c.u95 is not None and abs(c.value) <= c.u95
    ]

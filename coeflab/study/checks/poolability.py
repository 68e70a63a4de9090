"""Whether one law serves all campaigns of a joint fit, and what sets them apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "campaigns of a joint fit against one common law"
citations = ("chow1960", "tipton2015")


def check(study: Study) -> Sequence[Check]:
    """One finding per component that several campaigns hold, and a note on their differences."""
    out = []
    for fit in study.fits:
        if fit.differences:
            out.append(
                Check("poolability", fit.campaign, Severity.NOTE, " ".join(fit.differences), "campaigns of one kind",
                      "The joint fit assumes one law for these campaigns.")
            )  # fmt: skip
        for p in fit.poolings:
            if len(p.shares) < 2:
                continue
            severity, words = {
                None: (Severity.NOTE, "The rows cannot show whether one law fits all campaigns."),
                False: (Severity.PASS, "The campaigns do not contradict one law."),
                True: (
                    Severity.WARN,
                    f"The campaigns disagree. {p.values_alone} U95 does not include their difference.",
                ),
            }[p.rejected]
            if p.doubtful:
                severity, words = Severity.WARN, f"One law is neither contradicted nor shown. {p.values_alone}"
            out.append(
                Check("poolability", f"{fit.campaign} {p.response}'", severity, p.statistic, "p of 0.1 or more", words)
            )
    return out

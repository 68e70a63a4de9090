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
                Check.of("poolability.kinds", fit.campaign, Severity.NOTE, differences=" ".join(fit.differences))
            )
        for p in fit.poolings:
            if len(p.shares) < 2:
                continue
            severity, case = {
                None: (Severity.NOTE, "unknown"), False: (Severity.PASS, "one"), True: (Severity.WARN, "several"),
            }[p.rejected]  # fmt: skip
            if p.doubtful:
                severity, case = Severity.WARN, "doubtful"
            out.append(Check.of(
                "poolability.law", f"{fit.campaign} {p.response}'", severity, found=p.statistic, case=case, alone=p.values_alone
            ))  # fmt: skip
    return out

"""What the printed U95 does not contain, so that nobody takes it for more than it is."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.study.study import Study

summary = "uncertainties that no part of U95 covers"
citations = ("ittc_uncertainty",)


def check(study: Study) -> Sequence[Check]:
    """One note per campaign that has budgets: what none of them assessed."""
    out = []
    for t in {t.campaign: t for t in study.tables}.values():
        open_parts = dict.fromkeys(
            u for b in study.budgets if t.campaign in b.campaign.split(", ") for u in b.unassessed
        )
        if not open_parts:
            continue
        stated = t.source.stated_uncertainty
        out.append(
            Check(
                "unassessed",
                t.campaign,
                Severity.NOTE,
                f"not in U95 of every coefficient: {', '.join(open_parts)}",
                "a full budget",
                f"The source states: {stated}." if stated else "The source states no uncertainty.",
            )
        )
    return out

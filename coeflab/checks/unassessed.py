"""What the printed U95 does not contain, so that nobody takes it for more than it is."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.model.check import Check, Severity
from coeflab.model.study import Study

summary = "uncertainties that no part of U95 covers"
citations = ("ittc_uncertainty",)

LACKING = {
    "cfd": "grid, turbulence model and domain errors",
    "experiment": "angle, speed, force calibration and rig interference",
    "literature": "whatever the source left out",
    "synthetic": "nothing: the data are synthetic",
}


def check(study: Study) -> Sequence[Check]:
    """One note per campaign."""
    out = []
    for t in {t.campaign: t for t in study.tables}.values():
        stated = t.source.stated_uncertainty
        out.append(
            Check(
                "unassessed",
                t.campaign,
                Severity.NOTE,
                f"U95 holds the scatter of the points and the model form, not {LACKING[t.source.kind]}",
                "a full budget",
                f"The source states: {stated}." if stated else "The source states no uncertainty.",
            )
        )
    return out

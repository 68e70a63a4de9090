"""Coefficients that cannot be told from zero, so that nobody takes their sign for a result."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check, plus_minus
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.symbols import primed

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "values smaller than their U95"
citations = ("ittc_uncertainty",)


def check(study: Study) -> Sequence[Check]:
    """Fitted coefficients whose interval holds zero: a warning a campaign for those that the plan wants, a note for each other."""
    found = [
        c
        for c in study.coefficients
        if c.origin == "fit" and c.value is not None and c.u95 is not None and abs(c.value) <= c.u95
    ]
    wanted: dict[str | None, list[Coefficient]] = {}
    for c in found:
        if c.status is Status.SIGN_OPEN and c.symbol in study.plan.wanted:
            wanted.setdefault(c.campaign, []).append(c)
    warned = {id(c) for those in wanted.values() for c in those}
    return [
        *(_row(those, Severity.WARN) for those in wanted.values()),
        *(_row([c], Severity.NOTE) for c in found if id(c) not in warned),
    ]


def _row(those: Sequence[Coefficient], severity: Severity) -> Check:
    """Coefficients of one campaign and one status."""
    is_open = those[0].status is Status.SIGN_OPEN
    return Check.of(
        "significance.zero", f"{those[0].campaign} {', '.join(primed(c.symbol) for c in those)}", severity,
        values=", ".join(f"{primed(c.symbol)} = {plus_minus(c.value, c.u95)}" for c in those),
        sign="open" if is_open else "unknown", advice=those[0].status.advice,
    )  # fmt: skip

"""The first page of a study: what came out, in one sentence, six rows and four chips."""

from __future__ import annotations

from coeflab.core.table import Severity
from coeflab.law.coefficient import Status
from coeflab.report.document import Answer, AnswerRow, Chip
from coeflab.study.study import Study
from coeflab.vehicle.reference import Relation


def answer(study: Study) -> Answer:
    """What a reader of a study wants first."""
    rows = tuple(_row(study, symbol) for symbol in study.plan.wanted)
    return Answer(_sentence(study), rows=rows, chips=_chips(study))


def _row(study: Study, symbol: str) -> AnswerRow:
    found = [c for c in study.coefficients if c.symbol == symbol]
    c = next((c for c in found if c.value is not None), None)
    if c is None:
        return AnswerRow(symbol, None, None, "no data")
    judged = next((x for x in study.comparisons if x.relation is Relation.RE_ANALYSIS and x.coefficient == c), None)
    rejected = c.status is Status.FORM_REJECTED
    return AnswerRow(
        symbol, c.value, None if rejected else c.u95, "form rejected" if rejected else "", c.campaign or "",
        difference=judged.difference if judged else None, agrees=judged.passed if judged else None,
    )  # fmt: skip


def _sentence(study: Study) -> str:
    judged = [c.passed for c in study.comparisons if c.passed is not None]
    if not judged:
        return f"{study.plan.title or study.plan.name}: no published evaluation of these data to compare with."
    return f"{study.plan.title or study.plan.name}: {sum(judged)} of {len(judged)} published values lie within U95."


def _chips(study: Study) -> tuple[Chip, ...]:
    warned = sum(c.severity is Severity.WARN for c in study.checks)
    return (Chip("Warnings", f"{warned}", Severity.WARN if warned else Severity.PASS, "checks"),)

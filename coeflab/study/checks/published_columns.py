"""Published columns that no coefficient of the study stands beside: which key of theirs is missing or names something else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.vehicle.published_values import Reference, Relation

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "published columns that are compared with nothing, and by which key"
citations = ()


def check(study: Study) -> Sequence[Check]:
    """One finding a column that holds derivatives and is compared with none of ours."""
    compared = {c.reference for c in study.comparisons}
    towed = {name for asked in study.plan.tows for name in (*asked.experiment, *asked.columns)}
    found = [r for r in study.references if r.values and r.name not in compared | towed]
    return [as_check("published_columns", f) for r in found if (f := _why(study, r)) is not None]


def _why(study: Study, r: Reference) -> Finding | None:
    """Which key keeps a column from every coefficient; none where the study has no coefficient of its symbols."""
    ours = [f for f in study.fits if any(v.symbol in f.coefficients and v.value is not None for v in r.values)]
    if not ours:
        return None
    if r.relation is Relation.RE_ANALYSIS and not {f.campaign for f in ours} & set(r.campaigns):
        key, printed, known = "campaigns", r.campaigns, tuple(dict.fromkeys(f.campaign for f in ours))
    elif r.datum is not None and all(f.coefficients.datum != r.datum for f in ours):
        key, printed, known = "datum", (r.datum.id,), tuple(dict.fromkeys(f.coefficients.datum.id for f in ours))
    else:
        key, printed, known = "body", (r.body,), tuple(dict.fromkeys(f.body for f in ours))
    advice = f"{key} = {list(known) if key == 'campaigns' else known[0]!r}".replace("'", '"')
    return Finding.of("published.unused", r.name, Severity.WARN, advice=advice, key=key, stands=printed, known=known)

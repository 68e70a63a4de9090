"""A report on one page: the answer alone."""

from __future__ import annotations

from dataclasses import replace

from coeflab.report.acceptance import Acceptance
from coeflab.report.answer import answer
from coeflab.report.document import Answer, Document, digest_of
from coeflab.report.notation import keeping, users_texts
from coeflab.study.study import Study

SUBTITLE = "Summary on one page; the report holds every number, check and source"


def study_summary(study: Study) -> Document:
    """One page on a study."""
    verbatim = users_texts(study)
    with keeping(verbatim):
        made = answer(study)
    return Document(
        study.plan.title or study.plan.name, SUBTITLE, (), study.plan.name, digest_of(study.inputs), verbatim=verbatim,
        answer=_unlinked(made),
    )  # fmt: skip


def acceptance_summary(found: Acceptance, whole: Document) -> Document:
    """One page on a publication reproduced, of whose whole report it takes name and inputs."""
    return replace(whole, subtitle=SUBTITLE, sections=(), works=(), answer=_unlinked(whole.answer or answer(found)))


def _unlinked(made: Answer) -> Answer:
    """Without links to sections, of which a summary has none."""
    rows = tuple(replace(r, anchor="") for r in made.rows)
    return replace(made, rows=rows, chips=tuple(replace(c, anchor="") for c in made.chips))

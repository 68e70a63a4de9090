"""What a reviewer asks for beside the core of a report: from files to points, and the curve of every derivative, two a page."""

from __future__ import annotations

from functools import partial

from coeflab.report.document import Section
from coeflab.report.figures.sweep import sweep_figure
from coeflab.report.sections.campaign import anchor, filled
from coeflab.report.tables import results as tables
from coeflab.report.tables.traceability import traceability
from coeflab.report.texts import texts_of
from coeflab.report.workers import begun
from coeflab.study.study import Study
from coeflab.study.symmetry import zeros


def review_sections(study: Study) -> tuple[Section, ...]:
    """Two sections; of a study without tables none."""
    files = filled(traceability(study))
    out = (
        [Section("traceability", "From files to points", texts_of("review.files"), files, appendix=True)]
        if files
        else []
    )
    out += [Section("all-checks", "All checks", tables=filled(tables.checks(study.checks)), appendix=True)] * bool(
        study.checks
    )
    taken: set[str] = set()
    drawn = []
    for f in study.fits:
        zero = {c.symbol for c in zeros(study, f.campaign, f.coefficients.coefficients)}
        drawn += [
            (s, anchor(f"curve {f.campaign} {s.symbol}", taken))
            for s in f.sweeps
            if len(s.x) and not s.by_symmetry and s.symbol not in zero
        ]
    with begun([partial(sweep_figure, s, name) for s, name in drawn]) as finished:
        curves = tuple(finished())
    if curves:
        out.append(
            Section(
                "every-curve",
                "Every derivative's curve",
                texts_of("review.curves"),
                figures=curves,
                appendix=True,
                plates=True,
            )
        )
    return tuple(out)

"""What a reviewer asks for beside the core of a report: from files to points, and the curve of every derivative, two a page."""

from __future__ import annotations

from functools import partial

from coeflab.report.document import Section
from coeflab.report.figures.sweep import sweep_figure
from coeflab.report.sections.campaign import anchor, filled
from coeflab.report.tables import results as tables
from coeflab.report.tables.traceability import traceability
from coeflab.report.workers import begun
from coeflab.study.study import Study
from coeflab.study.symmetry import zeros

FILES = (
    "Every input with its sha256. Rows are those of the table as the file names them; what a fit leaves aside of itself is named with "
    "its derivative. Converted: how the file's axes, signs and point became those of this report.",
)
CURVES = ("Points, curve and what the curve leaves over, derivative by derivative; crosses are left out.",)


def review_sections(study: Study) -> tuple[Section, ...]:
    """Two sections; of a study without tables none."""
    files = filled(traceability(study))
    out = [Section("traceability", "From files to points", FILES, files, appendix=True)] if files else []
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
            Section("every-curve", "Every derivative's curve", CURVES, figures=curves, appendix=True, plates=True)
        )
    return tuple(out)

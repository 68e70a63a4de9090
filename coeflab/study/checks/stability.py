"""Directional stability: G_h and G_v with intervals, from every parameter file that has what they need."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.law.coefficient import Coefficient
from coeflab.study.study import Study
from coeflab.study.validation import PrintedIndex, printed_indices
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import INDICES, sense, stability, without_restoring

summary = "stability indices G_h and G_v with U95 and verdict"
citations = ("feldman1979", "roddy1990")


def _indices(parameters: ParameterFile) -> list[Check]:
    given = {d.name: d for d in stability(parameters)}
    out = []
    for name, (*symbols, _) in INDICES.items():
        found = [parameters.coefficient(str(s)) for s in symbols]
        lacking = [str(s) for s, c in zip(symbols, found, strict=True) if c is None or c.value is None]
        if len(lacking) == len(symbols):
            continue
        if name not in given:
            lacking += ["m'"] if parameters.mass is None else []
            statistic, comment = "no value", f"Missing: {', '.join(lacking)}."
        else:
            d = given[name]
            verdict = sense(d)
            statistic = f"{name} = {d.value:.3f}" if d.result is None else f"{name} = {d.in_words}"
            statistic += f": {verdict}"
            literature = [c.symbol for c in found if c is not None and c.origin == "literature"]
            comment = (
                f"Directionally {verdict} with controls fixed."
                if d.decided
                else f"Stability with controls fixed: {verdict}."
            )
            if d.driven:
                comment += f" {d.driven} is not negative: it drives the motion instead of damping it, and the index does not apply."
            else:
                comment += "" if d.decided else " The interval contains zero."
            comment += f" {without_restoring(parameters)}" if name == "G_v" else ""
            comment += f" {', '.join(literature)} from literature ({', '.join(_methods(found))})." if literature else ""
            comment += f" {d.statement}." if d.result is None else " U95 leaves out the mass."
        subject = f"{parameters.name} {name}"
        out.append(Check("stability", subject, Severity.NOTE, statistic, "above zero is stable", comment))
    return out


def _methods(found: Sequence[Coefficient | None]) -> list[str]:
    """How the published ones of these were found; their ``estimator`` begins with method and kind."""
    printed = (c for c in found if c is not None and c.origin == "literature")
    return list(dict.fromkeys(c.estimator.partition(",")[0].rpartition(" ")[0] or "no method stated" for c in printed))


def check(study: Study) -> Sequence[Check]:
    """Indices of every parameter file; an unstable vehicle is a finding, not a failure. A printed one must come out again."""
    return [*(c for p in study.parameter_files.values() for c in _indices(p)), *map(_printed, printed_indices(study))]


def _printed(i: PrintedIndex) -> Check:
    return Check.of(
        "printed_index.value", f"{i.reference} {i.name}", Severity.PASS if i.holds else Severity.FAIL, index=i.name, found=i.found,
        file=i.parameter_file, printed=i.printed, allowed=i.allowed, match="good" if i.holds else "bad",
    )  # fmt: skip

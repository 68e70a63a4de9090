"""Whether the parameter files that a study writes pass ``coeflab params check``, by the same rules."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.vehicle.not_in_law import NOT_IN_LAW
from coeflab.vehicle.plausibility import plausibility
from coeflab.vehicle.plausible_added_mass import LAW

if TYPE_CHECKING:
    from coeflab.study.study import Study
    from coeflab.vehicle.parameter_file import ParameterFile

summary = "what coeflab params check finds in the files that are written"
citations = ("fossen2011",)
OF_THE_LAW = ("law.driving_term_at_zero", NOT_IN_LAW)


def check(study: Study) -> Sequence[Check]:
    """Every failure of a file; one row for its warnings; a term that was written as zero."""
    return [c for name, p in study.parameter_files.items() for c in _of_file(name, p)]


def _of_file(name: str, p: ParameterFile) -> Iterator[Check]:
    """Its law at the points is a check of its own."""
    found = [c for c in plausibility(p) if c.name != LAW]
    yield from (as_check("plausibility", f) for f in p.findings if f.code in OF_THE_LAW)
    failed = [c for c in found if c.severity is Severity.FAIL]
    yield from (replace(c, subject=f"{name} {c.subject}") for c in failed)
    warned = tuple(dict.fromkeys(c.subject for c in found if c.severity is Severity.WARN))
    if warned:
        yield as_check(
            "plausibility",
            Finding.of("parameter_file.warnings", name, Severity.NOTE, statistic=float(len(warned)), threshold=0.0,
                       advice=f"coeflab params check {name}.parameters.json", subjects=warned),
        )  # fmt: skip
    elif not failed:
        yield as_check(
            "plausibility", Finding.of("parameter_file.passes", name, Severity.PASS, statistic=float(len(found)))
        )

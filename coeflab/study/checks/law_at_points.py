"""The law of every parameter file against the measured points that it was fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from coeflab.core.table import Check
from coeflab.study.study import Study
from coeflab.vehicle.plausibility import law_findings

summary = "distance of a parameter file's law from its measured points, and where the law holds"
citations = ("roddy1990",)


def check(study: Study) -> Sequence[Check]:
    """One finding per parameter file, table and component, from the law as the file has it now."""
    return [
        replace(c, subject=f"{name} {c.subject}")
        for name, parameters in study.parameter_files.items()
        for c in law_findings(parameters)
    ]

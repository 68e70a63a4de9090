"""What each parameter file itself holds: assumptions, what is left out, what was not assessed."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.table import Check, as_check
from coeflab.core.texts import known
from coeflab.study.study import Study

summary = "findings that travel in the parameter files"
citations = ()


def check(study: Study) -> Sequence[Check]:
    """One row a finding of a file."""
    return [as_check("parameter file", f) for p in study.parameter_files.values() for f in p.findings if known(f)]

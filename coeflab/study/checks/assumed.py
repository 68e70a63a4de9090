"""What coefficients rest on that no source states: keys that an import accepted, and points and signs that are taken by default."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.table import Check, as_check
from coeflab.study.study import Study
from coeflab.tables.assumptions import CODE

summary = "keys of campaigns that were accepted and that no source states, with the coefficients that hang on them"
citations = ("sname1950",)


def check(study: Study) -> Sequence[Check]:
    """One finding per accepted key of a table on which a coefficient hangs."""
    found = dict.fromkeys(f for fit in study.fits for f in fit.findings if f.code == CODE)
    return [as_check("assumed", f) for f in found]

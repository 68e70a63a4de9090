"""Whether the added mass of a parameter file is by a method that is good for its body."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check, as_check

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "added mass that is a rough guide, or not by the panel method"
citations = ("lamb1932",)


def check(study: Study) -> Sequence[Check]:
    """A warning for each finding of an added mass; else that there is none."""
    out = []
    for name, found in study.hulls.items():
        words = [as_check("added_mass", f) for f in found.findings]
        out += words or [
            Check("added_mass", name, Severity.PASS, f"by {found.recommended.method}", "good for the body", "")
        ]
    return out

"""What the printed U95 does not contain, or only as a bound, so that nobody takes it for more than it is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.table import Check, as_check
from coeflab.fits.uncertainty.budget import open_parts

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "uncertainties that no part of U95 covers, and grid studies that do not converge"
citations = ("ittc_uncertainty", "eca2014")


def check(study: Study) -> Sequence[Check]:
    """One note per campaign that has budgets: what none of them assessed; one warning per grid study without a limit."""
    return [as_check("unassessed", found) for found in open_parts(study.budgets)]

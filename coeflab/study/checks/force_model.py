"""The law of each parameter file against the force model that it was made from, over the motions of its manoeuvres."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.table import Check, as_check
from coeflab.vehicle.held_to_model import OF_A_MODEL

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "the law of a file against the force model that it was made from"
citations = ()


def check(study: Study) -> Sequence[Check]:
    """One row a component that the law does not meet, and one for the others."""
    found = [f for p in study.parameter_files.values() for f in p.findings if f.code in OF_A_MODEL]
    return [as_check("force_model", f) for f in found]

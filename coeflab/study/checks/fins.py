"""Whether the fins of a vehicle from its shape stand astern."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "where the fins of a vehicle from its shape stand along its hull"
citations = ("sname1950",)


def check(study: Study) -> Sequence[Check]:
    """A warning where all fins stand ahead of the middle of the hull."""
    if study.shape is None or (seen := study.shape.weighed.body.outline) is None:
        return []
    from coeflab.bodies.outlining import fins_along

    if (found := fins_along(seen)) is None:
        return []
    severity = Severity.WARN if found.ahead else Severity.PASS
    place = "ahead" if found.ahead else "aft"
    return [Check.of("fins.place", study.shape.weighed.body.name, severity, words=found.words, place=place)]

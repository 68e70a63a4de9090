"""Whether a mesh lies as its axes say: longest along x, its sail up, its tail aft."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check, as_check

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "whether a vehicle's mesh lies as its axes say: longest ahead, sail up, tail aft"
citations = ("sname1950",)


def check(study: Study) -> Sequence[Check]:
    """What contradicts axes that were stated one by one; a frame by its name would not have come so far."""
    body = study.shape.weighed.body if study.shape is not None else None
    if body is None:
        return []
    from coeflab.bodies.mesh.mesh import TriangleMesh
    from coeflab.bodies.orientation import doubt

    if not isinstance(body.shape, TriangleMesh):
        return []
    found = doubt(body)
    if found is not None:
        return [as_check("longest_axis", found)]
    size = " x ".join(f"{v:.4g}" for v in body.shape.extents)
    statistic = f"{size} m along x, y, z"
    return [Check("longest_axis", body.name, Severity.PASS, statistic, "longest along x", "")]

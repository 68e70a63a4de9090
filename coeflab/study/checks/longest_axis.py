"""Whether a mesh lies as its axes and its datum say: longest along x, its sail up, its tail aft, its origin at the datum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check, as_check
from coeflab.law.scaling import ENDS

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.study.study import Study

summary = "whether a vehicle's mesh lies as its axes and its datum say: longest ahead, sail up, tail aft"
citations = ("sname1950",)

OFF = 0.1  # of the length, from where the name of the datum puts its front end


def check(study: Study) -> Sequence[Check]:
    """What contradicts axes that were stated one by one; a frame by its name would not have come so far.

    The datum is held against the meshes of added masses too, whose points count from it.
    """
    body = study.shape.weighed.body if study.shape is not None else None
    bodies = {b.name: b for b in (*(h.body for h in study.hulls.values()), *((body,) if body is not None else ()))}
    out = [c for b in bodies.values() for c in _datum(b)]
    if body is None:
        return out
    from coeflab.bodies.mesh.mesh import TriangleMesh
    from coeflab.bodies.orientation import doubt

    if not isinstance(body.shape, TriangleMesh):
        return out
    found = doubt(body)
    if found is not None:
        return [*out, as_check("longest_axis", found)]
    size = " x ".join(f"{v:.4g}" for v in body.shape.extents)
    statistic = f"{size} m along x, y, z"
    return [*out, Check("longest_axis", body.name, Severity.PASS, statistic, "longest along x", "")]


def _datum(body: Body) -> list[Check]:
    """A mesh whose origin is not where the datum's name says: points of tables that count from there would move with it."""
    from coeflab.bodies.mesh.mesh import TriangleMesh

    if not isinstance(body.shape, TriangleMesh) or body.datum.id not in ENDS:
        return []
    x = body.shape.vertices[:, 0]
    back, front = float(x.min()), float(x.max())
    ahead = ENDS[body.datum.id][0] * (front - back)
    if abs(front - ahead) <= OFF * (front - back):
        return []
    return [
        Check.of("longest_axis.datum", f"{body.name} {body.datum.id}", Severity.WARN, back=back, front=front, behind=ahead - (front - back), ahead=ahead)
    ]  # fmt: skip

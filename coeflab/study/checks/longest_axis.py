"""Whether a mesh is longest along x, as a vehicle is that moves ahead."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.study.study import Study

summary = "along which axis the volume of a vehicle's mesh is longest"
citations = ("sname1950",)

LONGER = 2.0  # a wide frame or a disc may be a little longer across than along
SIDE = "Is x of the mesh forward? --axes, or axes in its body.toml, names where x, y and z of the mesh point: aft,starboard,up."


def check(study: Study) -> Sequence[Check]:
    """A warning where the volume spreads more than twice as far across as along x; thin wings have too little volume for that."""
    shape = study.shape.weighed.body.shape if study.shape is not None else None
    if study.shape is None or not isinstance(shape, TriangleMesh):
        return []
    spread = np.sqrt(np.diag(shape.integrals.second_moments))
    widest = int(np.argmax(spread))
    across = bool(spread[widest] > LONGER * spread[0])
    size = " x ".join(f"{v:.4g}" for v in shape.extents)
    statistic = f"{size} m along x, y, z" + (f": longest along {'xyz'[widest]}" if across else "")
    severity = Severity.WARN if across else Severity.PASS
    return [
        Check(
            "longest_axis",
            study.shape.weighed.body.name,
            severity,
            statistic,
            "longest along x",
            SIDE if across else "",
        )
    ]

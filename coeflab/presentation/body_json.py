"""A body's particulars for machines."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.model.body import Body
from coeflab.model.mesh import TriangleMesh


def body_json(body: Body, density: float) -> dict[str, Any]:
    """Volumes, centres, areas and inertia of the displaced water by configuration, SI, FRD; None where not known."""
    out: dict[str, Any] = {"body": body.name, "datum": str(body.datum), "density": density}
    if isinstance(body.shape, TriangleMesh):
        out |= {"faces": len(body.shape.faces), "extents": body.shape.extents.tolist()}
    out["configurations"] = [
        {
            "name": c.name,
            "title": c.title,
            "volume": c.volume,
            "wetted_surface": c.wetted_surface,
            "centre_of_buoyancy": _listed(c.centre_of_buoyancy),
            "projected_areas": _listed(c.projected_areas),
            "displaced_inertia": _listed(c.displaced_inertia(density)),
        }
        for c in body.configurations
    ]
    return out


def _listed(values: NDArray[np.float64] | None) -> list[Any] | None:
    return None if values is None else list(values.tolist())

"""A body, its simplification, and a vehicle estimated from its shape, for machines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.particulars import mesh_statements
from coeflab.bodies.simplify.part_file import form_keys
from coeflab.bodies.simplify.simplification import RULES, Simplification
from coeflab.formats.loss_tables import in_short
from coeflab.law.symbols import MOTIONS
from coeflab.report.as_json.motions import carried

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.law.added_mass import AddedMass
    from coeflab.study.study import Study


def body(found: Body, density: float) -> dict[str, Any]:
    """Volumes, centres, areas and inertia of the displaced water by configuration, SI, FRD; None where not known."""
    out: dict[str, Any] = {"body": found.name, "datum": str(found.datum), "density": density}
    if isinstance(found.shape, TriangleMesh):
        out |= {"faces": len(found.shape.faces), "extents": found.shape.extents.tolist()}
    out["configurations"] = [
        {
            "name": c.name, "title": c.title, "volume": c.volume, "wetted_surface": c.wetted_surface,
            "centre_of_buoyancy": _listed(c.centre_of_buoyancy), "projected_areas": _listed(c.projected_areas),
            "displaced_inertia": _listed(c.displaced_inertia(density)),
        }
        for c in found.configurations
    ]  # fmt: skip
    return out


def _listed(values: NDArray[np.float64] | None) -> list[Any] | None:
    return None if values is None else list(values.tolist())


def added_mass(found: AddedMass, density: float, recommended: str) -> dict[str, object]:
    """Everything that a method says of its matrix, which is in kg, kg m, kg m^2 about the point, FRD."""
    return {
        "matrix": found.matrix.tolist(), "error": None if found.error is None else found.error.tolist(),
        "point": found.reference_point.tolist(), "datum": found.datum.id, "density": density, "rough": found.rough,
        "recommended": found.method == recommended, "statements": list(found.statements),
    }  # fmt: skip


def from_shape(study: Study) -> dict[str, Any]:
    """Particulars, estimates with what they are made of, manoeuvres, what is assumed and what is missing; SI and radians."""
    shape, (name, parameters) = study.shape, next(iter(study.parameter_files.items()))
    if shape is None:
        return {}
    c = shape.weighed.configuration
    hull, rest = parameters.added_mass, shape.weighed.at_rest
    return {
        "name": name, "displacement": shape.conditions.density * (c.volume or 0.0), "volume": c.volume,
        "mass": None if c.mass is None else c.mass.mass,
        "centre_of_buoyancy": None if c.centre_of_buoyancy is None else c.centre_of_buoyancy.tolist(),
        "centre_of_gravity": None if c.mass is None else (c.mass.centre_of_gravity + shape.weighed.body.reference_point).tolist(),
        "inertia_matrix": None if c.mass is None or c.mass.inertia_matrix is None else c.mass.inertia_matrix.tolist(),
        "wetted_surface": c.wetted_surface, "projected_areas": None if c.projected_areas is None else c.projected_areas.tolist(),
        "reference_point": shape.weighed.body.reference_point.tolist(),
        "added_mass": None if hull is None else {
            "method": hull.method, "matrix": hull.matrix.tolist(),
            "walls": [{"wall": w.wall, "distance": w.distance, "matrix": w.matrix.tolist()} for w in hull.walls],
        },
        "at_rest": None if rest is None else {"pitch": rest[0], "roll": rest[1]}, "mesh": list(mesh_statements(shape.weighed.body)),
        "assumed": list(shape.weighed.assumed), "said": list(shape.statements), "missing": list(shape.missing),
        "estimates": [
            {
                "symbol": k.symbol, "value": k.value, "u95": k.u95, "value_si": k.value_si, "unit_si": k.unit_si,
                "status": str(k.status), "estimator": k.estimator,
                "made_of": dict(shape.estimates.shares.get(k.symbol.removesuffix("'"), {})),
            }
            for k in parameters.coefficients
        ],
        "contributions": [
            {
                "part": k.part, "kind": k.kind, "method": k.method, "share": k.share, "citation": k.citation,
                "place": k.place, "outside": k.outside or None,
            }
            for k in shape.estimates.contributions
        ],
        "notes": list(shape.estimates.notes),
        "manoeuvres": [
            {
                "name": m.manoeuvre.name,
                "figures": [{"name": f.name, "value": f.value, "unit": f.unit, "status": f.status} for f in m.figures],
                "statements": list(m.statements),
            }
            for m in study.manoeuvres
        ],
        "uncertainty": [carried(k) for k in shape.carried],
        "exports": [
            {
                "target": e.target, "parameters": e.parameters, "lossless": e.lossless,
                "loss": None if e.loss is None or e.lossless else in_short(e.loss),
                "worse_than_nothing": [] if e.loss is None else list(e.loss.worse_than_nothing),
            }
            for e in study.exports
        ],
        "refused": [str(r.why) for r in study.refused],
    }  # fmt: skip


def simplification(found: Simplification) -> dict[str, Any]:
    """Everything that the tables show, in SI."""
    parts = [
        {
            "name": p.part.name, "form": form_keys(p.part.form)[0], "sizes": form_keys(p.part.form)[1],
            "centre": p.part.centre.tolist(), "rotation": p.part.rotation.tolist(),
            "mesh_volume": p.volume, "misfit": p.likeness.misfit, "shared": p.likeness.shared, "volume": p.part.form.volume, "volume_error": p.volume_error,
            "projected_area_errors": p.projected_errors.tolist(), "length_error": p.length_error,
            "class": p.likeness.kind, "stand_in": not p.likeness.clear, "look_at": list(p.poor),
            "remarks": list(p.remarks),
        }
        for p in found.parts
    ]  # fmt: skip
    return {
        "body": found.body.name,
        "parts": parts,
        "mesh_volume": sum(p.volume for p in found.parts) + found.unassigned,
        "volume": found.shape.volume,
        "unassigned": found.unassigned,
        "mesh_centre_of_volume": found.mesh.centre_of_volume.tolist(),
        "centre_of_volume": found.shape.centre_of_volume.tolist(),
        "mesh_projected_areas": found.mesh.integrals.projected.tolist(),
        "projected_areas": found.projected.tolist(),
        "against_mesh": None
        if found.shape.agreement is None
        else dict(zip(MOTIONS, found.shape.agreement.entries, strict=True)),
        "mesh_error": None if found.shape.agreement is None else found.shape.agreement.error,
        "recommended": found.recommended,
        "advice": found.advice,
        "failures": list(found.failures),
        "status": "failed" if found.failures else "ok",
        "rules": list(RULES),
        "statements": list(found.statements),
    }

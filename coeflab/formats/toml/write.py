"""Coefficients, added mass and look-up tables in one TOML file, for simulators that read tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from coeflab.core.text.toml import toml_text
from coeflab.core.wording import file_stem
from coeflab.formats.lacking_law import found_in
from coeflab.formats.look_up import LookUp, look_up
from coeflab.vehicle.parameter_file import ParameterFile

summary = "tables.toml: every coefficient, added mass, hydrostatics, thrusters, and each fitted model on a grid within its data"
citations = ("sname1950",)

_LAYOUT = 1
_OF_COEFFICIENT = {
    "symbol", "value", "u95", "unit", "value_si", "unit_si", "status", "origin", "law", "potential", "citation",
}  # fmt: skip


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One TOML file; axes FRD, angles in radians, nothing changed in sign.

    ``[[table]]`` holds ``axes`` by variable and nested ``values``, the last variable innermost; nan where the model may
    not be read. A key that has no value in the parameter file is absent.
    """
    p = parameters.model_dump(mode="json", exclude_none=True)
    content: dict[str, Any] = {
        "layout": _LAYOUT,
        "name": parameters.name,
        "body": parameters.body,
        "found": list(found_in(parameters)) or None,
        **{k: p[k] for k in ("scaling", "reference_point", "conditions", "mass") if k in p},
        "added_mass": {k: p["added_mass"][k] for k in ("body", "method", "density", "matrix")}
        if "added_mass" in p
        else None,
        "hydrostatics": p.get("hydrostatics"),
        "thruster": p["thrusters"] or None,
        "surface": p["surfaces"] or None,
        "covered": p["covered"],
        "coefficient": [{k: v for k, v in c.items() if k in _OF_COEFFICIENT} for c in p["coefficients"]],
        "table": [_table(look_up(m)) for m in parameters.models],
    }
    return {f"{file_stem(parameters.name)}.tables.toml": toml_text(content).encode()}


def _table(of: LookUp) -> dict[str, Any]:
    m = of.model
    return {
        "response": m.response,
        "unit": m.unit,
        "form": m.form,
        "variables": list(m.names),
        "variable_units": [v.unit for v in m.variables],
        "axes": [a.tolist() for a in of.axes],
        "extrapolation": m.domain.extrapolation,
        "area": None if m.area is None else m.area.model_dump(mode="json"),
        "campaign": m.campaign,
        "values": of.values.tolist(),
        "half_widths_95": of.half_widths.tolist(),
        "inside": of.inside.tolist(),
    }

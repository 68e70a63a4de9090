"""Published vehicles as parameter files, built from tests/data/vehicles.toml without any importer."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.formats.stated_file import Stated, stated_file
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import LINEAR, MOMENTS, derivative
from coeflab.vehicle.parameter_file import ParameterFile

FACTS: dict[str, dict[str, Any]] = tomllib.loads(
    (Path(__file__).parents[1] / "data" / "vehicles.toml").read_text(encoding="utf-8")
)
SLUG, FOOT = 14.593902937206, 0.3048


@cache
def vehicle(name: str) -> ParameterFile:
    """SI and FRD; primes by the length that the source states, else by 1 m, at 1 m/s."""
    facts = FACTS[name]
    mass_unit, length_unit = (SLUG, FOOT) if "units" in facts else (1.0, 1.0)
    scaling = Scaling(facts.get("length", 1.0), "L" if "length" in facts else "1 m")
    at = Conditions(facts["density"] * mass_unit / length_unit**3, 1.0)
    values = {s: (v, "motion") for s, v in facts.get("prime", {}).items()}
    for law in ("rest", "motion"):
        for s, v in facts.get(law, {}).items():
            d = derivative(s)
            power = 1 + (d.component in MOMENTS) - sum(f.removesuffix("dot") in LINEAR for f in d.factors)
            values[s] = (v * mass_unit * length_unit**power / scaling.unit(s, at.density, at.speed), law)
    kilograms, centre = facts["mass"] * mass_unit, np.array(facts.get("centre", (0.0, 0.0, 0.0))) * length_unit
    inertia = (np.diag(facts["inertia"]) + facts.get("products", 0.0) * (1.0 - np.eye(3))) * mass_unit * length_unit**2
    return stated_file(
        Stated(
            name=name,
            body=name,
            scaling=scaling,
            conditions=at,
            coefficients=values,
            matrix=np.diag(facts["added_mass"]) if "added_mass" in facts else None,
            mass=MassProperties(kilograms, kilograms * float(centre[0]), None, centre, inertia),
            notes=(facts["source"],),
        ),
        [],
        (),
    )

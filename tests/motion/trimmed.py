"""Parameter files of invented vehicles, and of the TJ-FlyingFish as its paper gives it."""

from __future__ import annotations

from typing import Any

import numpy as np

from coeflab.law.scaling import powers_of
from coeflab.law.symbols import derivative
from coeflab.published.flyingfish.model import FlyingFish, thrusters
from coeflab.vehicle.parameter_file import ParameterFile

DENSITY, LENGTH, SPEED = 1000.0, 1.0, 1.0


def parameter_file(
    si: dict[str, float], mass: float, inertia: tuple[float, float, float], **more: Any
) -> ParameterFile:
    """Derivatives in SI at the speed above, centre of gravity at the reference point."""
    coefficients = []
    for symbol, value in si.items():
        speed, length, half = powers_of(symbol)
        prime = value / ((0.5 * DENSITY) ** half * SPEED**speed * LENGTH**length)
        coefficients.append(
            {
                "symbol": symbol + "'", "value": prime, "u95": None, "unit": "1", "value_si": value, "unit_si": derivative(symbol).unit,
                "status": "stated", "origin": "literature", "parts": {}, "law": "motion",
            }
        )  # fmt: skip
    return ParameterFile.model_validate(
        {
            "name": "invented", "body": "invented", "scaling": {"length": LENGTH, "length_name": "L"},
            "reference_point": {"point": [0.0, 0.0, 0.0], "datum": "centre of gravity"},
            "conditions": {"density": DENSITY, "speed": SPEED},
            "mass": {
                "mass": mass, "mass_moment": 0.0, "inertia": inertia[2], "mass_prime": mass / (0.5 * DENSITY * LENGTH**3),
                "mass_moment_prime": 0.0, "centre": [0.0, 0.0, 0.0], "inertia_matrix": np.diag(inertia).tolist(),
            },
            "coefficients": coefficients, "covariance": {"symbols": [], "matrix": []}, "covered": [],
            "provenance": {"coeflab_version": "test", "study": "test", "inputs": [], "citations": []},
            **more,
        }
    )  # fmt: skip


def flyingfish_file(fish: FlyingFish, constants: dict[str, float]) -> ParameterFile:
    """The quadratic damping (a derivative with V would not be linear at rest), weight and centre of buoyancy calibrated."""
    si = {f"{c}{m}|{m}|": -float(d) for c, m, d in zip("XYZKMN", "uvwpqr", fish.rotors.quadratic, strict=True)}
    gravity = 9.8
    volume = (constants["mass"] - constants["net_weight"] / gravity) / DENSITY
    lever = constants["buoyancy_moment"] / (DENSITY * gravity * volume)
    return parameter_file(
        si, constants["mass"], (0.02, 0.02, 0.02),
        hydrostatics={"volume": volume, "centre_of_buoyancy": [0.0, 0.0, lever], "gravity": gravity},
        thrusters=[t.model_dump() for t in thrusters(fish)],
    )  # fmt: skip

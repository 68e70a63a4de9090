"""Vehicles whose manoeuvres have closed forms: neutrally buoyant, no added mass beyond a diagonal, symmetric."""

from __future__ import annotations

import numpy as np

from coeflab.formats.stated_file import Stated, stated_file
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.vehicle.parameter_file import CoveredRange, ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics, ParameterSurface

LENGTH, DENSITY, SPEED, MASS = 2.0, 1000.0, 1.5, 60.0
SCALING, AT = Scaling(LENGTH, "LOA"), Conditions(DENSITY, SPEED)
INERTIA = np.diag([0.9, 14.0, 14.0])
STABLE = {
    "X0": -4e-3, "Yv": -4e-2, "Yr": 4e-3, "Nv": -2e-3, "Nr": -1e-2, "Ydr": 1e-2, "Ndr": -5e-3,
    "Zw": -4e-2, "Zq": -4e-3, "Mw": 2e-3, "Mq": -1e-2, "Zds": -1e-2, "Mds": -5e-3, "Kp": -2e-3,
}  # fmt: skip
UNSTABLE = {**STABLE, "Nv": -6e-2}


def made(values: dict[str, float] = STABLE, metacentric: float = 0.0) -> ParameterFile:
    """A parameter file of these primes; ``metacentric``: centre of buoyancy above that of gravity, m."""
    mass = MassProperties(MASS, 0.0, None, np.zeros(3), INERTIA)
    primes = {s: (v, "motion") for s, v in values.items()}
    file = stated_file(Stated("synthetic", "synthetic body", SCALING, AT, primes, matrix=None, mass=mass), [], ())
    hydrostatics = ParameterHydrostatics(
        volume=MASS / DENSITY, centre_of_buoyancy=(0.0, 0.0, -metacentric), gravity=9.81
    )
    return file.model_copy(update={"hydrostatics": hydrostatics, "schema_version": "1.3"})


def rudder_covered(rudder: float, rate: float = 0.0) -> ParameterFile:
    """An unstable vehicle whose rudder was tested up to an angle, rad, and its turning up to a rate r', if at all."""
    limits = {"dr": (rudder, "rad"), "r'": (rate, "1")}
    tested = tuple(
        CoveredRange(variable=name, low=-limit, high=limit, unit=unit, campaign="synthetic")
        for name, (limit, unit) in limits.items()
        if limit
    )
    return made(UNSTABLE).model_copy(update={"covered": tested})


def with_limits(file: ParameterFile, limit: float, rate: float | None) -> ParameterFile:
    """The file with a rudder of such a limit and rate, rad and rad/s."""
    return file.model_copy(update={"surfaces": (ParameterSurface(control="dr", limit=limit, rate=rate),)})

"""The HUUV as a parameter file: tables over incidence, yaw damping, and two thrusters with a dead zone."""

from __future__ import annotations

from typing import Any

import numpy as np

from coeflab.core.files import shipped
from coeflab.core.provenance import sha256_of
from coeflab.core.version import VERSION
from coeflab.model.huuv import Huuv
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.parameter_versions import SCHEMA_VERSION
from coeflab.model.stated_file import stated_table

SPLIT = "Only the sum of rigid-body and added moment of inertia counts in a steady turn; its parts are chosen."
LEVEL = "Only surge, sway and yaw are described: hold w, p and q."
MADE: dict[str, Any] = {
    "form": "polynomial of a tuned model",
    "table": "turns.csv",
    "campaign": "HUUV Fig. 17",
    "statements": (
        "Tuned to steady turns; no forces were measured, so that it has no points and no residuals of its own.",
    ),
}
SOURCES = ("vehicle.toml", "turns.csv")


def parameter_file(huuv: Huuv) -> ParameterFile:
    """The constants of acceptance A as a parameter file of schema 1.3.

    Axes are FRD already; the side force, which the paper counts against the sway, changes its sign here, where C_S is to
    starboard.
    """
    c, chosen = huuv.constants, huuv.chosen
    pressure = 0.5 * chosen["density"] * chosen["length"] ** 2
    drift, rate = chosen["largest_drift"], chosen["largest_rate"]
    body: dict[str, Any] = {
        "schema_version": SCHEMA_VERSION,
        "name": "huuv",
        "body": "HUUV, horizontal plane",
        "scaling": {"length": chosen["length"], "length_name": "characteristic length of Table 1"},
        "reference_point": {"point": (0.0, 0.0, 0.0), "datum": "cb"},
        "conditions": {"density": chosen["density"], "speed": chosen["speed"]},
        "mass": _mass(huuv),
        "coefficients": (),
        "covariance": {"symbols": (), "matrix": ()},
        "covered": (
            {"variable": "v'", "low": -drift, "high": drift, "unit": "rad", "campaign": "HUUV Fig. 17"},
        ),
        "models": (
            stated_table("C_D", {"beta": ("rad", -drift, drift)}, {"1": ((), c["d0"]), "beta^2": ((("beta", 2, False),), c["d2"])}, pressure, **MADE),
            stated_table(
                "C_S", {"beta": ("rad", -drift, drift)},
                {"beta": ((("beta", 1, False),), -c["s1"]), "beta^3": ((("beta", 3, False),), -c["s3"])}, pressure, **MADE,
            ),
            stated_table(
                "C_n", {"beta": ("rad", -drift, drift)},
                {"beta": ((("beta", 1, False),), c["n1"]), "beta^3": ((("beta", 3, False),), c["n3"])},
                pressure * chosen["length"], **MADE,
            ),
            stated_table(
                "N", {"r": ("rad/s", -rate, rate)}, {"r|r|": ((("r", 1, False), ("r", 1, True)), -c["nrr"])}, 1.0,
                unit="N*m", **MADE,
            ),
        ),
        "added_mass": _added_mass(huuv),
        "thrusters": tuple(_thruster(huuv, name, side) for name, side in (("left", -1.0), ("right", 1.0))),
        "provenance": _provenance(),
    }  # fmt: skip
    return ParameterFile.model_validate(body)


def _mass(huuv: Huuv) -> dict[str, Any]:
    mass, half, length = huuv.constants["m"], 0.5 * huuv.chosen["density"], huuv.chosen["length"]
    return {
        "mass": mass, "mass_moment": 0.0, "inertia": huuv.chosen["rigid_inertia"],
        "mass_prime": mass / (half * length**3), "mass_moment_prime": 0.0,
    }  # fmt: skip


def _added_mass(huuv: Huuv) -> dict[str, Any]:
    c, matrix = huuv.constants, np.zeros((6, 6))
    matrix[0, 0], matrix[1, 1], matrix[1, 5], matrix[5, 1] = c["mx"], c["my"], c["myr"], c["myr"]
    matrix[5, 5] = c["inertia"] - huuv.chosen["rigid_inertia"]
    return {
        "body": "HUUV", "method": "stated", "density": huuv.chosen["density"],
        "matrix": tuple(tuple(row) for row in matrix.tolist()), "statements": (SPLIT, LEVEL),
    }  # fmt: skip


def _thruster(huuv: Huuv, name: str, side: float) -> dict[str, Any]:
    slope, intercept = huuv.constants["slope"], huuv.constants["intercept"]
    reverse_intercept, reverse_slope = huuv.reverse
    return {
        "name": name, "position": (0.0, side * huuv.constants["arm"], 0.0), "direction": (1.0, 0.0, 0.0),
        "curve": {
            "command": "part of the largest thrust", "unit": "%",
            "segments": (
                {"low": -100.0, "high": -huuv.dead_zone, "coefficients": (reverse_intercept, reverse_slope)},
                {"low": -intercept / slope, "high": 100.0, "coefficients": (intercept, slope)},
            ),
        },
    }  # fmt: skip


def _provenance() -> dict[str, Any]:
    folder = shipped("cfd_data") / "huuv"
    return {
        "coeflab_version": VERSION, "study": "huuv",
        "inputs": tuple({"name": name, "sha256": sha256_of(folder / name)} for name in SOURCES),
        "citations": ("huuv2025",),
        "notes": (
            "Constants of vehicle.toml: tuned to the MATLAB half of Fig. 17, what the turns do not determine is chosen.",
            "The thrusters lie on the level of the centre of buoyancy; where along the hull has no effect.",
            SPLIT, LEVEL,
        ),
    }  # fmt: skip

"""The HUUV in the horizontal plane as its paper gives it: constants, thrusters, printed turns and errata.

The HUUV as a parameter file: tables over incidence, yaw damping, and two thrusters with a dead zone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core import declarations as takes
from coeflab.core.files import shipped
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.text.delimited import read_cells
from coeflab.core.text.toml import read_toml
from coeflab.core.types import Array, brief, locking
from coeflab.core.version import VERSION
from coeflab.formats.stated_table import stated_table
from coeflab.law.added_mass import AddedMass
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.motion.steady_turns import COEFFICIENTS
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.schema_versions import SCHEMA_VERSION

KINDS: Mapping[str, Any] = {"m": takes.Mass, "mx": takes.Mass, "my": takes.Mass, "inertia": takes.Inertia}
CHOSEN: Mapping[str, Any] = {
    "length": takes.Length,
    "density": takes.Density,
    "speed": takes.Speed,
    "rigid_inertia": takes.Inertia,
    "largest_drift": takes.Angle,
    "largest_rate": takes.Rate,
}
MATLAB, TRACKER = "matlab", "tracker"


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("left right figures")
class Turns:
    """Printed turns, one row a pair of commands.

    Attributes
    ----------
    left, right : (n,) arrays
        Thruster commands, per cent.
    figures : (n, 3) array
        u in m/s, |beta| in rad, radius in m; NaN where nothing is printed.
    """

    left: Array
    right: Array
    figures: Array


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("accepted_rate")
class Huuv:
    """Published data, SI and rad, FRD; commands in per cent.

    Attributes
    ----------
    constants : mapping
        Those of `coeflab.motion.steady_turns.COEFFICIENTS`, then ``slope``, ``intercept`` and ``arm`` of the thrusters.
    printed_intercept, dead_zone : float
    reverse : (float, float)
        Intercept and slope of the thrust astern.
    turns : mapping of source to Turns
    accepted : Turns
        Operating points of the constants.
    accepted_rate : (n,) array
        Yaw rate, rad/s; NaN where none is stated.
    chosen : mapping
        What only the parameter file needs.
    errata : tuple of str
    """

    constants: Mapping[str, float]
    printed_intercept: float
    dead_zone: float
    reverse: tuple[float, float]
    turns: Mapping[str, Turns]
    accepted: Turns
    accepted_rate: Array
    chosen: Mapping[str, float]
    errata: tuple[str, ...]

    @property
    def theta(self) -> Array:
        """(13,) coefficients in the order of the kernel."""
        return np.array([self.constants[name] for name in COEFFICIENTS])


def read_huuv(folder: Path | None = None) -> Huuv:
    """The shipped data.

    Parameters
    ----------
    folder : Path, optional
        With vehicle.toml, turns.csv and operating_points.csv; the shipped one where None.

    Raises
    ------
    InputError
        A file that is missing or does not say what it must.
    """
    folder = shipped("cfd_data") / "huuv" if folder is None else folder
    file = read_toml(folder / "vehicle.toml")
    constants = {
        name: takes.declared_key(file, f"steady_turn.{name}", KINDS.get(name, takes.Pure)) for name in COEFFICIENTS
    }
    constants |= {name: takes.declared_key(file, f"thruster.{name}", takes.Pure) for name in ("slope", "intercept")}
    constants["arm"] = takes.declared_key(file, "thruster.arm", Annotated[takes.Length, takes.ABOVE_ZERO])
    accepted, rate = _operating_points(folder / "operating_points.csv")
    return Huuv(
        constants,
        takes.declared_key(file, "thruster.printed_intercept", takes.Pure),
        takes.declared_key(file, "thruster.dead_zone", takes.Pure),
        (
            takes.declared_key(file, "thruster.reverse_intercept", takes.Pure),
            takes.declared_key(file, "thruster.reverse_slope", takes.Pure),
        ),
        _turns(folder / "turns.csv"),
        accepted,
        rate,
        {
            name: takes.declared_key(file, f"parameter_file.{name}", Annotated[kind, takes.ABOVE_ZERO])
            for name, kind in CHOSEN.items()
        },
        takes.declared_key(file, "errata.texts", takes.Texts),
    )


def _turns(path: Path) -> dict[str, Turns]:
    cells = read_cells(path)
    source = np.array(cells.texts("source"))
    columns = [cells.numbers(name) for name in ("left", "right", "u", "beta", "radius")]
    return {str(name): _rows(columns, source == name) for name in dict.fromkeys(source.tolist())}


def _operating_points(path: Path) -> tuple[Turns, Array]:
    cells = read_cells(path)
    columns = [cells.numbers(name) for name in ("left", "right", "u", "beta", "radius")]
    return _rows(columns, np.ones(len(cells), dtype=bool)), cells.numbers("r")


def _rows(columns: list[Array], wanted: NDArray[np.bool_]) -> Turns:
    left, right, u, beta, radius = (c[wanted] for c in columns)
    return Turns(left, right, np.column_stack([u, np.radians(beta), radius]))


LIMIT = 100.0  # per cent, either way


def commands(total: Array, difference: Array) -> tuple[Array, Array]:
    """Commands (n,) of the left and the right thruster, per cent, from their mean and half their difference (equations 35 and 36).

    A positive difference turns to port. Beyond 100 % a thruster stays at its largest, so that a turn near full thrust slows down.
    """
    left, right = (np.clip(c, -LIMIT, LIMIT) for c in (total - difference, total + difference))
    return left, right


def thrust(left: Array, right: Array, slope: float, intercept: float, arm: float, dead_zone: float) -> Array:
    """(n, 3) X, Y and N of both thrusters ahead, FRD, and nothing within the dead zone (equations 34, 37 and 38)."""
    unit = thrust_rates(left, right, slope, intercept, arm, dead_zone)
    return np.asarray(unit[:, :, 0] * slope + unit[:, :, 1] * intercept)


def thrust_rates(left: Array, right: Array, slope: float, intercept: float, arm: float, dead_zone: float) -> Array:
    """(n, 3, 3) derivatives of X, Y and N by slope, intercept and arm."""
    port, starboard = left > dead_zone, right > dead_zone
    force = [np.where(on, slope * c + intercept, 0.0) for on, c in ((port, left), (starboard, right))]
    by_slope = [np.where(on, c, 0.0) for on, c in ((port, left), (starboard, right))]
    by_intercept = [port.astype(float), starboard.astype(float)]
    out = np.zeros((len(left), 3, 3))
    # FRD: a force ahead on the port side turns the bow to starboard, r > 0; equation 38 has the sign of FLU.
    for k, (a, b) in enumerate((by_slope, by_intercept)):
        out[:, 0, k], out[:, 2, k] = a + b, arm * (a - b)
    out[:, 2, 2] = force[0] - force[1]
    return out


SPLIT = "Only the sum of rigid-body and added moment of inertia counts in a steady turn; its parts are chosen."
LEVEL = "Only surge, sway and yaw are described: hold w, p and q."
COMMON: dict[str, Any] = {
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
    primes = Scaling(chosen["length"], "characteristic length of Table 1")
    force, moment = (primes.unit(component, chosen["density"]) for component in "XN")
    drift, rate = chosen["largest_drift"], chosen["largest_rate"]
    body: dict[str, Any] = {
        "schema_version": SCHEMA_VERSION,
        "name": "huuv",
        "body": "HUUV",
        "scaling": primes,
        "reference_point": {"point": (0.0, 0.0, 0.0), "datum": "cb"},
        "conditions": Conditions(chosen["density"], chosen["speed"]),
        "mass": MassProperties(c["m"], 0.0, chosen["rigid_inertia"]).primed(primes, chosen["density"]),
        "coefficients": (),
        "covariance": {"symbols": (), "matrix": ()},
        "covered": (
            {"variable": "v'", "low": -drift, "high": drift, "unit": "rad", "campaign": "HUUV Fig. 17"},
        ),
        "models": (
            stated_table("C_D", {"beta": ("rad", -drift, drift)}, {"1": ((), c["d0"]), "beta^2": ((("beta", 2, False),), c["d2"])}, force, **COMMON),
            stated_table(
                "C_S", {"beta": ("rad", -drift, drift)},
                {"beta": ((("beta", 1, False),), -c["s1"]), "beta^3": ((("beta", 3, False),), -c["s3"])}, force, **COMMON,
            ),
            stated_table(
                "C_n", {"beta": ("rad", -drift, drift)},
                {"beta": ((("beta", 1, False),), c["n1"]), "beta^3": ((("beta", 3, False),), c["n3"])},
                moment, **COMMON,
            ),
            stated_table(
                "N", {"r": ("rad/s", -rate, rate)}, {"r|r|": ((("r", 1, False), ("r", 1, True)), -c["nrr"])}, 1.0,
                unit="N*m", **COMMON,
            ),
        ),
        "added_mass": _added_mass(huuv),
        "thrusters": tuple(_thruster(huuv, name, side) for name, side in (("left", -1.0), ("right", 1.0))),
        "provenance": _provenance(),
    }  # fmt: skip
    return ParameterFile.model_validate(body)


def _added_mass(huuv: Huuv) -> AddedMass:
    c, matrix = huuv.constants, np.zeros((6, 6))
    matrix[0, 0], matrix[1, 1], matrix[1, 5], matrix[5, 1] = c["mx"], c["my"], c["myr"], c["myr"]
    matrix[5, 5] = c["inertia"] - huuv.chosen["rigid_inertia"]
    return AddedMass(matrix, body="HUUV", method="stated", statements=(SPLIT, LEVEL), density=huuv.chosen["density"])


def _thruster(huuv: Huuv, name: str, side: float) -> dict[str, Any]:
    slope, intercept = huuv.constants["slope"], huuv.constants["intercept"]
    reverse_intercept, reverse_slope = huuv.reverse
    return {
        "name": name, "position": (0.0, side * huuv.constants["arm"], 0.0), "direction": (1.0, 0.0, 0.0),
        "curve": {
            "command": "part of the largest thrust", "unit": "%",
            "segments": (
                {"low": -LIMIT, "high": -huuv.dead_zone, "coefficients": (reverse_intercept, reverse_slope)},
                {"low": -intercept / slope, "high": LIMIT, "coefficients": (intercept, slope)},
            ),
        },
    }  # fmt: skip


def _provenance() -> dict[str, Any]:
    folder = shipped("cfd_data") / "huuv"
    return {
        "coeflab_version": VERSION, "study": "huuv",
        "inputs": tuple(InputFile(name, sha256_of(folder / name)) for name in SOURCES),
        "citations": ("huuv2025",),
        "notes": (
            "Constants of vehicle.toml: tuned to the MATLAB half of Fig. 17, what the turns do not determine is chosen.",
            "The thrusters lie on the level of the centre of buoyancy; where along the hull has no effect.",
            SPLIT, LEVEL,
        ),
    }  # fmt: skip

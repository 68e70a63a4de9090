"""The HUUV in the horizontal plane as its paper gives it: constants, thrusters, printed turns and errata."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.delimited import read_cells
from coeflab.core.files import shipped
from coeflab.core.toml import Section, read_toml
from coeflab.kernels.brief import brief
from coeflab.kernels.least_squares import Array
from coeflab.kernels.steady_turn import COEFFICIENTS
from coeflab.model.frozen import locked

DIMENSIONS = {"m": "mass", "mx": "mass", "my": "mass", "inertia": "inertia"}
MATLAB, TRACKER = "matlab", "tracker"


@brief
@dataclass(frozen=True, slots=True, eq=False)
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

    def __post_init__(self) -> None:
        for name in ("left", "right", "figures"):
            object.__setattr__(self, name, locked(getattr(self, name)))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Huuv:
    """Published data, SI and rad, FRD; commands in per cent.

    Attributes
    ----------
    constants : mapping
        Those of `coeflab.kernels.steady_turn.COEFFICIENTS`, then ``slope``, ``intercept`` and ``arm`` of the thrusters.
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

    def __post_init__(self) -> None:
        object.__setattr__(self, "accepted_rate", locked(self.accepted_rate))

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
    turn, thruster, chosen = (file.section(name) for name in ("steady_turn", "thruster", "parameter_file"))
    constants = {name: turn.quantity(name, DIMENSIONS.get(name, "none")) for name in COEFFICIENTS}
    constants |= {name: _plain(thruster, name) for name in ("slope", "intercept")}
    constants["arm"] = thruster.positive("arm", "length")
    accepted, rate = _operating_points(folder / "operating_points.csv")
    return Huuv(
        constants,
        _plain(thruster, "printed_intercept"),
        _plain(thruster, "dead_zone"),
        (_plain(thruster, "reverse_intercept"), _plain(thruster, "reverse_slope")),
        _turns(folder / "turns.csv"),
        accepted,
        rate,
        {
            "length": chosen.positive("length", "length"),
            "density": chosen.positive("density", "density"),
            "speed": chosen.positive("speed", "speed"),
            "rigid_inertia": chosen.positive("rigid_inertia", "inertia"),
            "largest_drift": chosen.positive("largest_drift", "angle"),
            "largest_rate": chosen.positive("largest_rate", "rate"),
        },
        file.section("errata").texts("texts"),
    )


def _plain(section: Section, key: str) -> float:
    return section.quantity(key, "none")


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

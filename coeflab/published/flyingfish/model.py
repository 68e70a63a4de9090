"""The TJ-FlyingFish as its paper gives it: rotors, damping, constants worked out from Table 1, and Table 1."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.files import shipped
from coeflab.core.text.delimited import read_cells
from coeflab.core.text.toml import TomlFile, read_toml
from coeflab.core.types import Array, brief, locked, locking
from coeflab.published.flyingfish.rotors import Rotors, steady_residuals
from coeflab.vehicle.parameter_parts import CurveSegment, ParameterCurve, ParameterThruster

CONSTANTS = ("net_weight", "mass", "buoyancy_moment", "arm_length", "rotor_height")


def calibrated(rotors: Rotors, motion: Array, angles: Array, speeds: Array) -> Array:
    """The five constants that leave the least squares of the residuals, N and N m alike; they enter linearly."""

    def residuals(constants: Array) -> Array:
        return steady_residuals(rotors, constants, motion, angles, speeds).ravel()

    alone = residuals(np.zeros(5))
    design = np.column_stack([residuals(one) - alone for one in np.eye(5)])
    return np.asarray(np.linalg.lstsq(design, -alone, rcond=None)[0])


Hand = Literal[-1, 1]
ROTORS = ("1", "2", "3", "4")


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("air rotor_air arms motion angles speeds")
class FlyingFish:
    """Published data, SI and rad, rotor speeds in rpm.

    Attributes
    ----------
    rotors : Rotors
    constants : dict of str to float
        The calibrated constants as the shipped file states them.
    air : (2, 6) array
        Linear and quadratic damping in air, as in water.
    rotor_air : (2, 2) array
        Thrust and torque in air, as those of ``rotors``.
    largest_speed, largest_speed_air : float
        Of a rotor, rpm; chosen, not printed.
    arms : (4, 3) array
        Unit vectors out to the rotors, FRD.
    handedness : tuple of int
    motion : (10, 5) array
        u w r phi theta of Table 1, row 3 in body velocities.
    angles, speeds : (10, 4) array
        beta and omega of Table 1.
    errata : tuple of str
    """

    rotors: Rotors
    constants: dict[str, float]
    air: Array
    rotor_air: Array
    largest_speed: float
    largest_speed_air: float
    arms: Array
    handedness: tuple[Hand, ...]
    motion: Array
    angles: Array
    speeds: Array
    errata: tuple[str, ...] = field(default=())


def read_flyingfish(folder: Path | None = None) -> FlyingFish:
    """The shipped data.

    Parameters
    ----------
    folder : Path, optional
        With vehicle.toml and operating_points.csv; the shipped one where None.

    Raises
    ------
    InputError
        A file that is missing or does not say what it must.
    """
    folder = shipped("cfd_data") / "flyingfish" if folder is None else folder
    file = read_toml(folder / "vehicle.toml")
    at = range(len(file.content.get("thruster", ())))
    cells = read_cells(folder / "operating_points.csv")
    motion = np.column_stack([cells.numbers(n) for n in ("u", "w", "r", "phi", "theta")])
    motion[:, 2:] = np.radians(motion[:, 2:])
    motion[cells.texts("motion").index("3"), :2] = [
        takes.declared_key(file, f"row3.{name}", takes.Speed) for name in "uw"
    ]
    return FlyingFish(
        Rotors(*(_numbers(file, f"damping.{k}", 6) for k in ("linear", "quadratic")),
               *(_numbers(file, f"rotor.{k}", 2) for k in ("thrust", "torque"))),
        {name: takes.declared_key(file, f"calibrated.{name}", takes.Pure) for name in CONSTANTS},
        np.array([_numbers(file, f"damping_air.{k}", 6) for k in ("linear", "quadratic")]),
        np.array([_numbers(file, f"rotor_air.{k}", 2) for k in ("thrust", "torque")]),
        takes.declared_key(file, "rotor.largest_speed", Annotated[takes.Pure, takes.ABOVE_ZERO]),
        takes.declared_key(file, "rotor_air.largest_speed", Annotated[takes.Pure, takes.ABOVE_ZERO]),
        np.array([_numbers(file, f"thruster[{i}].arm", 3) for i in at]),
        tuple(1 if takes.declared_key(file, f"thruster[{i}].handedness", takes.Pure) > 0 else -1 for i in at),
        motion,
        np.radians(np.column_stack([cells.numbers(f"beta{i}") for i in ROTORS])),
        np.column_stack([cells.numbers(f"omega{i}") for i in ROTORS]),
        takes.declared_key(file, "errata.texts", takes.Texts),
    )  # fmt: skip


Medium = Literal["water", "air"]
MEDIA: tuple[Medium, ...] = ("water", "air")


def thrusters(fish: FlyingFish, medium: Medium = "water") -> tuple[ParameterThruster, ...]:
    """The rotors where equations 38 and 39 have them, from the centre of gravity, commands in rpm.

    In water they point down at no tilt and turn about their arms; in air they point up and are fixed, with the reaction torques
    of equation 34.
    """
    length, height = fish.constants["arm_length"], fish.constants["rotor_height"]
    wet = medium == "water"
    laws, high = (
        ((fish.rotors.thrust, fish.rotors.torque), fish.largest_speed)
        if wet
        else (fish.rotor_air, fish.largest_speed_air)
    )
    thrust, torque = (
        ParameterCurve(
            command="speed", unit="rpm", segments=(CurveSegment(low=0.0, high=high, coefficients=(0.0, *map(float, factors))),),
        )
        for factors in laws
    )  # fmt: skip
    return tuple(
        ParameterThruster(
            name=f"rotor{name}", position=(x * length, y * length, -height), direction=(0.0, 0.0, 1.0 if wet else -1.0),
            curve=thrust, torque_curve=torque, handedness=hand if wet else -hand,
            **({"tilt_axis": (x, y, z), "tilt_low": -np.pi, "tilt_high": np.pi} if wet else {}),
        )
        for name, (x, y, z), hand in zip(ROTORS, fish.arms.tolist(), fish.handedness, strict=True)
    )  # fmt: skip


def _numbers(file: TomlFile, key: str, count: int) -> Array:
    return locked(
        takes.declared_key(file, key, Annotated[tuple[float, ...], takes.numbers(count, "none", f"{count} numbers")])
    )

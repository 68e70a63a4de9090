"""The TJ-FlyingFish as its paper gives it: rotors, damping, constants worked out from Table 1, and Table 1."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.core.delimited import read_cells
from coeflab.core.errors import shown
from coeflab.core.files import shipped
from coeflab.core.toml import Section, read_toml
from coeflab.kernels.brief import brief
from coeflab.kernels.tilting_rotors import CONSTANTS, Rotors
from coeflab.model.frozen import locked
from coeflab.model.parameter_vehicle import CurveSegment, ParameterCurve, ParameterThruster

Array = NDArray[np.float64]
Hand = Literal[-1, 1]
ROTORS = ("1", "2", "3", "4")


@brief
@dataclass(frozen=True, slots=True, eq=False)
class FlyingFish:
    """Published data, SI and rad, rotor speeds in rpm.

    Attributes
    ----------
    rotors : Rotors
    constants : dict of str to float
        The calibrated constants as the shipped file states them.
    largest_speed : float
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
    largest_speed: float
    arms: Array
    handedness: tuple[Hand, ...]
    motion: Array
    angles: Array
    speeds: Array
    errata: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        for name in ("arms", "motion", "angles", "speeds"):
            object.__setattr__(self, name, locked(getattr(self, name)))


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
    damping, rotor, constants = file.section("damping"), file.section("rotor"), file.section("calibrated")
    thrusters = file.sections("thruster")
    cells = read_cells(folder / "operating_points.csv")
    motion = np.column_stack([cells.numbers(n) for n in ("u", "w", "r", "phi", "theta")])
    motion[:, 2:] = np.radians(motion[:, 2:])
    third = file.section("row3")
    motion[cells.texts("motion").index("3"), :2] = third.quantity("u", "speed"), third.quantity("w", "speed")
    return FlyingFish(
        Rotors(*(_numbers(damping, k, 6) for k in ("linear", "quadratic")),
               *(_numbers(rotor, k, 2) for k in ("thrust", "torque"))),
        {name: constants.quantity(name, "none") for name in CONSTANTS},
        rotor.positive("largest_speed", "none"),
        np.array([t.triple("arm", "none") for t in thrusters]),
        tuple(1 if t.integer("handedness", 1, -1, 1) > 0 else -1 for t in thrusters),
        motion,
        np.radians(np.column_stack([cells.numbers(f"beta{i}") for i in ROTORS])),
        np.column_stack([cells.numbers(f"omega{i}") for i in ROTORS]),
        file.section("errata").texts("texts"),
    )  # fmt: skip


def thrusters(fish: FlyingFish) -> tuple[ParameterThruster, ...]:
    """The rotors where equations 38 and 39 have them, from the centre of gravity; down at no tilt, commands in rpm."""
    length, height = fish.constants["arm_length"], fish.constants["rotor_height"]
    thrust, torque = (
        ParameterCurve(
            command="speed",
            unit="rpm",
            segments=(CurveSegment(low=0.0, high=fish.largest_speed, coefficients=(0.0, *map(float, factors))),),
        )
        for factors in (fish.rotors.thrust, fish.rotors.torque)
    )
    return tuple(
        ParameterThruster(
            name=f"rotor{name}", position=(x * length, y * length, -height), direction=(0.0, 0.0, 1.0), curve=thrust,
            torque_curve=torque, handedness=hand, tilt_axis=(x, y, z), tilt_low=-np.pi, tilt_high=np.pi,
        )
        for name, (x, y, z), hand in zip(ROTORS, fish.arms.tolist(), fish.handedness, strict=True)
    )  # fmt: skip


def _numbers(section: Section, key: str, count: int) -> Array:
    found = section.raw(key)
    if not isinstance(found, list) or len(found) != count or not all(isinstance(x, float) for x in found):
        raise section.fail(key, shown(found), f"{count} numbers")
    return locked(found)

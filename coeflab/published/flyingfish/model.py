"""The TJ-FlyingFish as its paper gives it: rotors, damping, constants worked out from Table 1, and Table 1.

Steady motion of a vehicle with four rotors that tilt about their arms, as the TJ-FlyingFish paper prints it.

Equations 35-40 (rotors), 47 and 48 (thrust and torque), 25-30 (damping) and 51-56 (steady motion) with v = p = q = 0.
Rotors 1 and 2 stand to starboard and port, 3 and 4 ahead and astern. Errata: equation 47 prints 0.0006 for 6.0355e-4;
equation 40 prints + for its lever term, where the rotor positions of equations 38 and 39 give -: ``lever`` is that sign.

Trims of the TJ-FlyingFish by the equations of its paper.
"""

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
from coeflab.motion.trim.operating_point import Equation, OperatingPoint, Unknown, operating_point
from coeflab.vehicle.parameter_parts import CurveSegment, ParameterCurve, ParameterThruster

CONSTANTS = ("net_weight", "mass", "buoyancy_moment", "arm_length", "rotor_height")


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Rotors:
    """What the paper prints of the vehicle in water.

    Attributes
    ----------
    linear, quadratic : (6,) array
        Damping of u v w p q r; the force is -(linear + quadratic |u|) u.
    thrust, torque : (2,) array
        Factors of the speed and of its square, N and N m per rpm and rpm^2.
    """

    linear: Array
    quadratic: Array
    thrust: Array
    torque: Array


def rotor_wrench(angles: Array, thrust: Array, torque: Array, arm: float, height: float, lever: float = 1.0) -> Array:
    """X Y Z K M N of the rotors, shape (n, 6); equations 35-40.

    Parameters
    ----------
    angles : (n, 4) array
        beta, rad.
    thrust, torque : (n, 4) array
        N and N m.
    arm, height : float
        L and z_t, m.
    lever : float
        1 as equation 40 is printed, -1 as the rotor positions give.
    """
    across, along = thrust * np.sin(angles), thrust * np.cos(angles)
    spun, turned = torque * np.sin(angles), torque * np.cos(angles)
    ahead, aside = across[:, 0] - across[:, 1], across[:, 3] - across[:, 2]
    return np.column_stack(
        [
            ahead,
            aside,
            np.sum(along, axis=1),
            (along[:, 0] - along[:, 1]) * arm + aside * height + spun[:, 0] - spun[:, 1],
            (along[:, 3] - along[:, 2]) * arm - ahead * height + spun[:, 2] - spun[:, 3],
            lever * np.sum(across, axis=1) * arm + turned @ np.array([1.0, 1.0, -1.0, -1.0]),
        ]
    )


def steady_residuals(
    rotors: Rotors, constants: Array, motion: Array, angles: Array, speeds: Array, lever: float = 1.0
) -> Array:
    """Left minus right side of equations 51-56, shape (n, 6), N and N m.

    Parameters
    ----------
    rotors : Rotors
    constants : (5,) array
        In the order of `CONSTANTS`: (m - rho V) g in N, m in kg, rho g V z_B in N m, L and z_t in m.
    motion : (n, 5) array
        u w r phi theta, SI and rad.
    angles, speeds : (n, 4) array
        beta in rad, rotor speeds in rpm.
    lever : float
        See `rotor_wrench`.
    """
    u, w, r, roll, pitch = motion.T
    weight, mass, righting, arm, height = constants
    zero = np.zeros(len(motion))
    nu = np.column_stack([u, zero, w, zero, zero, r])
    thrust = rotors.thrust[0] * speeds + rotors.thrust[1] * speeds**2
    torque = rotors.torque[0] * speeds + rotors.torque[1] * speeds**2
    needed = (rotors.linear + rotors.quadratic * np.abs(nu)) * nu
    needed[:, 0] += weight * np.sin(pitch)
    needed[:, 1] += mass * u * r - weight * np.cos(pitch) * np.sin(roll)
    needed[:, 2] -= weight * np.cos(pitch) * np.cos(roll)
    needed[:, 3] -= righting * np.cos(pitch) * np.sin(roll)
    needed[:, 4] -= righting * np.sin(pitch)
    return np.asarray(rotor_wrench(angles, thrust, torque, arm, height, lever) - needed)


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


DEGREE, RPM = 1.0, 20.0
UNKNOWNS = ("beta1", "beta2", "beta3", "beta4", "omega1", "omega2", "omega3", "omega4")
EQUATIONS = (
    Equation("surge force X, equation 51", "N", 1.0),
    Equation("sway force Y, equation 52", "N", 1.0),
    Equation("heave force Z, equation 53", "N", 1.0),
    Equation("roll moment K, equation 54", "N m", 0.1),
    Equation("pitch moment M, equation 55", "N m", 0.1),
    Equation("yaw moment N, equation 56", "N m", 0.1),
)


def unknowns_of(
    fish: FlyingFish, row: int, *, near: bool = True, given: tuple[int, ...] = (), fastest: float | None = None
) -> list[Unknown]:
    """Tilts and rotor speeds with their bounds and the rule of selection; parameters as of `trim`."""
    printed = np.concatenate([fish.angles[row], fish.speeds[row]])
    limit = fish.largest_speed if fastest is None else fastest
    turn = np.radians(DEGREE)
    unknowns = []
    for i, name in enumerate(UNKNOWNS):
        u = Unknown(name, "rad", -np.pi, np.pi, turn, weight=0.0) if i < 4 else Unknown(name, "rpm", 0.0, limit, RPM)
        if near:
            u = Unknown(name, u.unit, u.low, u.high, u.scale, target=float(printed[i]))
        unknowns.append(u.at(float(printed[i])) if i in given else u)
    return unknowns


def trim(
    fish: FlyingFish,
    constants: Array,
    row: int,
    *,
    near: bool = False,
    given: tuple[int, ...] = (),
    starts: int = 12,
    lever: float = 1.0,
    fastest: float | None = None,
) -> OperatingPoint:
    """Tilts and rotor speeds of one motion of Table 1.

    Parameters
    ----------
    fish : FlyingFish
    constants : (5,) array
    row : int
        Of Table 1, from zero.
    near : bool
        Whether the search starts at the printed values and the rule is nearest to them in scales of 1 deg and 20 rpm;
        otherwise it starts cold and the rule is the least sum of squared rotor speeds.
    given : tuple of int
        Unknowns that keep their printed values.
    starts : int
        Seeded starts.
    lever : float
        1 for equation 40 as printed, -1 corrected.
    fastest : float, optional
        Largest rotor speed, rpm; that of the data where None.
    """
    unknowns = unknowns_of(fish, row, near=near, given=given, fastest=fastest)

    def residuals(x: Array) -> Array:
        motion = fish.motion[row : row + 1]
        return steady_residuals(fish.rotors, constants, motion, x[None, :4], x[None, 4:], lever).ravel()

    return operating_point(unknowns, EQUATIONS, residuals, starts=starts)

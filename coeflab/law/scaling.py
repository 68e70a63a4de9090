"""Conditions of a test and the prime system of nondimensional coefficients."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, ClassVar, overload

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.declarations import number_in
from coeflab.core.errors import InputError, ScalingMismatchError
from coeflab.core.limits import positive_number
from coeflab.core.stored import Means
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import GRAMS
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROLS, LINEAR, MOMENTS, derivative


def powers_of(symbol: str) -> tuple[int, int, int]:
    """Powers of U, of L and of 1/2 rho that make one primed unit of a derivative dimensional, such as (1, 2, 1) of Yv.

    Parameters
    ----------
    symbol : str
        With or without prime.
    """
    d = derivative(symbol)
    speed, length = 2, 3 if d.component in MOMENTS else 2
    for factor in d.factors:
        if factor in LINEAR:
            speed -= 1
        elif factor in ANGULAR:
            speed, length = speed - 1, length + 1
        elif factor.endswith("dot"):
            speed -= 2
            length += 1 if factor[0] in LINEAR else 2
    return speed, length, 1


# Powers of U, of L and of 1/2 rho in one unit of what is no derivative.
QUANTITIES: dict[str, tuple[int, int, int]] = {
    **{component: powers_of(f"{component}0") for component in COMPONENTS},
    **dict.fromkeys(LINEAR, (1, 0, 0)),
    **dict.fromkeys(ANGULAR, (1, -1, 0)),
    **dict.fromkeys([f"{v}dot" for v in LINEAR], (2, -1, 0)),
    **dict.fromkeys([f"{v}dot" for v in ANGULAR], (2, -2, 0)),
    **dict.fromkeys(CONTROLS, (0, 0, 0)),
    "m": (0, 3, 1),
    **dict.fromkeys(["I", "Ix", "Iy", "Iz", "Ixy", "Iyz", "Izx"], (0, 5, 1)),
}

LENGTHS = (0.05, 400.0)  # m, of models and ships
WATERS = (950.0, 1060.0)  # kg/m^3, hot and fresh to cold and salt
NU_OF_WATER = (0.7e-6, 2e-6)  # m^2/s: 37 deg C fresh to 0 deg C at sea (ITTC 7.5-02-01-03)
NOBODYS = ("1 m", "unit length")  # names of lengths that are no body's
MASSES = (1e-3, 10.0)  # of 1/2 rho L^3: a rod of water of 40 diameters, a box twice as broad and high as long
FASTEST = 60.0  # m/s in water
_AIR = re.compile(
    r"\b(?:air|airship|aircraft|luft|wind)\b|wind.?tunnel|windkanal|kinematic|rhoinf|openfoam", re.IGNORECASE
)


def speaks_of_air(texts: Iterable[object]) -> bool:
    """Whether a title, a body or a source names air, a wind tunnel or forces of a solver by density 1."""
    return any(_AIR.search(str(text)) for text in texts)


def doubtful_size(key: str, number: float, in_air: bool = False) -> str:
    """Why a number in SI is probably one in another unit; empty where it is a usual one.

    Parameters
    ----------
    key : str
        conditions.density, conditions.speed or scaling.length; of others nothing is said.
    number : float
        kg/m^3, m/s or m.
    in_air : bool
        The test was run in air.
    """
    if key == "conditions.density" and GRAMS[0] <= number <= GRAMS[1] and not in_air:
        return f'{number:g} kg/m^3 is thin air: is it g/cm^3? Then write "{number:g} g/cm^3"'
    if key == "scaling.length" and not LENGTHS[0] <= number <= LENGTHS[1]:
        unit = "mm" if number > LENGTHS[1] else "km"
        no_hull = f"{number:g} m is the length of no hull or model ({LENGTHS[0]:g} to {LENGTHS[1]:g} m)"
        return f'{no_hull}: is it in {unit}? Then write "{number:g} {unit}"'
    if key == "conditions.speed" and number > FASTEST and not in_air:
        return f'{number:g} m/s is no speed in water: is it in mm/s? Then write "{number:g} mm/s"'
    return ""


def doubtful_mass(mass: float, density: float, scaling: Scaling) -> str:
    """Why a mass in kg is probably one in another unit; empty where a body of that length in this fluid can have it.

    Parameters
    ----------
    mass, density : float
        kg, kg/m^3. In a fluid lighter than water a body may be as heavy as it likes.
    scaling : Scaling
        Of a length that is no body's nothing is said.
    """
    if any(name in scaling.length_name for name in NOBODYS):
        return ""
    prime, (low, high) = mass / scaling.unit("m", density), MASSES
    if prime >= low and (prime <= high or density < WATERS[0]):
        return ""
    no_body = f"m' = {prime:.2g} of 1/2 rho L^3 at {scaling.length_name} {scaling.length:g} m is that of no body ({low:g} to {high:g})"
    unit = "t" if prime < low else "g"
    return f'{no_body}: kg? If it is in {unit}, write "{mass:g} {unit}"'


def require_hull(value: Any, key: str | None = None) -> None:
    """Refuse a bare number that is the length of no hull or model in m, such as mm without their unit; with its unit it counts.

    Parameters
    ----------
    value : object
        As it was written.
    key : str, optional
        For the error.

    Raises
    ------
    InputError
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        return  # with its unit, or none that is read
    if not isfinite(number) or number < LENGTHS[0] / 1000.0:
        return  # no hull in km either: its own bounds say what is wrong
    if doubt := doubtful_size("scaling.length", number):
        raise input_error(
            "law.length_without_unit", column=key, number=number, lengths=LENGTHS[0], lengths_2=LENGTHS[1], doubt=doubt,
        )  # fmt: skip


def _of_a_hull(value: Any, file: Path) -> float:
    found: float = number_in("length").read(value, file)
    if file.suffix != ".json":  # JSON is written by programs, in SI
        require_hull(value)
    return found


HullLength = Annotated[float, replace(number_in("length"), read=_of_a_hull)]


def doubtful_viscosity(viscosity: float, density: float) -> str:
    """Why a kinematic viscosity is probably a dynamic one; empty for that of water, and beside a density of no water.

    Parameters
    ----------
    viscosity : float
        m^2/s.
    density : float
        kg/m^3.
    """
    if not WATERS[0] <= density <= WATERS[1] or NU_OF_WATER[0] <= viscosity <= NU_OF_WATER[1]:
        return ""
    return (
        f"{viscosity:g} m^2/s is not the kinematic viscosity of water ({NU_OF_WATER[0]:g} to {NU_OF_WATER[1]:g}): is it mu in Pa s, "
        f"which over {density:g} kg/m^3 is {viscosity / density:.3g} m^2/s?"
    )


ENDS = {
    "nose": (0.0, 1.0),
    "bow": (0.0, 1.0),
    "midship": (0.5, 0.5),
    "centre": (0.5, 0.5),
    "tail": (1.0, 0.0),
    "stern": (1.0, 0.0),
}
LONGER = 1.1  # a body over the length of its primes, where that is between perpendiculars


def beyond_ends(datum: str, x: float, length: float | None = None) -> str:
    """How far a point is ahead of the nose or behind the tail; empty where it is neither, or the datum is at no known place.

    Parameters
    ----------
    datum : str
        Id of the point that x counts from.
    x : float
        m, forward.
    length : float, optional
        Of the primes, m; without it, or of a doubtful one, only a point ahead of the nose, from the nose, or behind the tail, from the tail, is seen.
    """
    if datum not in ENDS:
        return ""
    length = None if length is not None and doubtful_size("scaling.length", length) else length
    ahead, behind = ENDS[datum]
    size = np.inf if length is None else LONGER * length
    front, back = x - (ahead * size if ahead else 0.0), -x - (behind * size if behind else 0.0)
    if front > 0.0:
        return f"{front + (LONGER - 1.0) * ahead * (length or 0.0):.2f} m ahead of the nose; aft is negative"
    if back > 0.0:
        return f"{back + (LONGER - 1.0) * behind * (length or 0.0):.2f} m behind the tail; forward is positive"
    return ""


@dataclass(frozen=True, slots=True)
class Conditions(takes.Declaration):
    """Conditions of the dimensional values.

    Nothing is assumed.

    Attributes
    ----------
    density : float
        Of the water, kg/m^3.
    speed : float
        m/s, at the reference point.
    viscosity : float, optional
        Kinematic, m^2/s.
    reynolds : float, optional
        As the source states it; no file holds it.
    """

    __stored__: ClassVar = ("density", "speed", "viscosity?")
    density: Annotated[takes.Density, takes.ABOVE_ZERO, Means("density rho of the water", "kg/m^3")]
    speed: Annotated[takes.Speed, takes.ABOVE_ZERO, Means("speed U at the reference point", "m/s")]
    viscosity: Annotated[Annotated[takes.Viscosity, takes.ABOVE_ZERO] | None, Means("kinematic", "m^2/s")] = None
    reynolds: Annotated[takes.Pure, takes.ABOVE_ZERO] | None = None

    def __post_init__(self) -> None:
        for name in ("density", "speed", "viscosity", "reynolds"):
            value = getattr(self, name)
            if value is not None and (expected := positive_number(value)):
                raise InputError(f"{name} = {value:g}", expected, column=f"conditions.{name}")

    def reynolds_on(self, length: float) -> float | None:
        """Reynolds number on a length, or the one that the source states where the viscosity is not known."""
        return self.reynolds if self.viscosity is None else self.speed * length / self.viscosity


@dataclass(frozen=True, slots=True)
class Scaling(takes.Declaration):
    """Length of the primes.

    The prime system on it: Y' = Y / (1/2 rho U^2 L^2), N' with L^3, v' = v/U, r' = r L/U.

    Attributes
    ----------
    length : float
        L, m.
    length_name : str
        What that length is, for example ``LBP``.
    """

    __stored__: ClassVar = ("length", "length_name")
    length: Annotated[HullLength, takes.ABOVE_ZERO, Means("length L of the primes", "m")]
    length_name: Annotated[takes.Text, Means("which length it is, for example LBP or LOA")]

    def __post_init__(self) -> None:
        if expected := positive_number(self.length):
            raise InputError(
                f"length = {self.length:g} m", expected.replace("value", "length"), column="scaling.length"
            )

    def __str__(self) -> str:
        return f"{self.length_name} {self.length:.6g} m"

    @overload
    def unit(self, symbol: str, density: float, speed: float = 1.0) -> float: ...

    @overload
    def unit(self, symbol: str, density: float | Array, speed: Array) -> Array: ...

    def unit(self, symbol: str, density: float | Array, speed: float | Array = 1.0) -> float | Array:
        """SI value of one unit of the prime system (SNAME 1950): 1/2 rho U^a L^b.

        Parameters
        ----------
        symbol : str
            With or without prime: a derivative (``Yv``, ``Nrdot``), a force or moment (``Y``, ``N``), a velocity, rate or
            acceleration (``v``, ``r``, ``vdot``), a control angle (``dr``), the mass ``m``, a moment of inertia (``I``,
            ``Iz``). A product m x_G has the unit of the mass times the length.
        density : float or (n,) array
            kg/m^3. Motions and angles do not depend on it.
        speed : float or (n,) array
            m/s. At the default of 1 m/s the unit of a derivative is 1/2 rho L^b, which stands before the velocities and the
            power of U of a term.

        Raises
        ------
        InputError
            No such symbol.
        """
        known = QUANTITIES.get(symbol.removesuffix("'"))
        of_speed, of_length, of_pressure = known or powers_of(symbol)
        out = (0.5 * density if of_pressure else 1.0) * speed**of_speed
        out = out * self.length**of_length if of_length >= 0 else out / self.length**-of_length
        return out if isinstance(out, np.ndarray) else float(out)

    def ratio(self, symbol: str, other: Scaling) -> float:
        """Multiply a value primed by this length with this to prime it by ``other``."""
        power = powers_of(symbol)[1]
        return float((self.length / other.length) ** power)

    def require(self, other: Scaling) -> None:
        """Raise unless ``other`` is the same length under the same name.

        Raises
        ------
        ScalingMismatchError
        """
        if self.length_name != other.length_name or abs(self.length / other.length - 1.0) > 1e-9:
            raise ScalingMismatchError(
                f"coefficients primed by {self} and by {other} do not mix. Two lengths of one hull: to_length rescales one of them. "
                "Two sizes of a hull: each in a plan of its own, with its own length; where they are geometrically similar the primes of one "
                'are those of the other but for the Reynolds number: coeflab merge ONE.parameters.json --set "Yr\'=VALUE".'
            )

"""What exports to simulators of second order in the velocities share: the law, its form, an added mass that they can carry."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.kernels.brief import brief
from coeflab.kernels.composition import definiteness
from coeflab.kernels.transforms import skew
from coeflab.model.force_law import ForceLaw, force_law
from coeflab.model.inertia import water_inertia
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.second_order import SecondOrder, resists, second_order, slot

Array = NDArray[np.float64]


def number(value: float) -> str:
    """All digits, and no minus before a zero."""
    return repr(float(value) + 0.0)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ExportedLaw:
    """A law as simulators of second order take it, in FRD about the file's reference point.

    Attributes
    ----------
    law : ForceLaw
    form : SecondOrder
        The law's terms that have a place in it.
    matrix : (6, 6) array
        Added mass that the vehicle moves with, see `coeflab.model.inertia`; zeros where nothing is known.
    statements : tuple of str
        Where it comes from, then what was done to it.
    """

    law: ForceLaw
    form: SecondOrder
    matrix: Array
    statements: tuple[str, ...]

    @property
    def inert(self) -> bool:
        """Whether there is no added mass."""
        return not np.any(self.matrix)


def exported_law(parameters: ParameterFile) -> ExportedLaw:
    """The law of a file and the added mass that a physics engine integrates, the same that `coeflab simulate` does.

    A file without mass cannot be simulated, and engines take a default mass: there an added mass that is not positive by itself
    keeps its diagonal alone.
    """
    law, water = force_law(parameters), water_inertia(parameters)
    matrix, statements = water.matrix, water.statements
    if parameters.mass is None and not definiteness(matrix).holds:
        matrix = np.diag(np.maximum(np.diag(matrix), 0.0))
        said = "added mass: only its diagonal, because the whole is not positive and no mass is known: entries are missing or wrong"
        statements = (*statements, said)
    return ExportedLaw(law, second_order(law), matrix, statements)


def centre_of_gravity(parameters: ParameterFile) -> Array:
    """(3,) from the reference point, m, FRD; zero where the file has no mass."""
    mass = parameters.mass
    if mass is None:
        return np.zeros(3)
    return np.array(mass.centre if mass.centre is not None else (mass.mass_moment / mass.mass, 0.0, 0.0))


def central_inertia(parameters: ParameterFile) -> Array | None:
    """(3, 3) about the centre of gravity, kg m^2, FRD; None where it is not known.

    Where only the transverse moment is known it stands for the roll inertia too.

    Raises
    ------
    InputError
        It would not be positive.
    """
    mass = parameters.mass
    if mass is None or (mass.inertia is None and mass.inertia_matrix is None):
        return None
    arm = skew(centre_of_gravity(parameters))
    if mass.inertia_matrix is not None:
        return np.array(mass.inertia_matrix) + mass.mass * arm @ arm
    central = float(mass.inertia or 0.0) + mass.mass * float((arm @ arm)[1, 1])
    if central <= 0.0:
        raise InputError(
            f"{central:g} kg m^2 through the centre of gravity", "an inertia above zero", column="mass.inertia"
        )
    return central * np.eye(3)


@dataclass(frozen=True, slots=True, eq=False)
class Afloat:
    """Weight and buoyancy as an export writes them, those that `coeflab.model.vehicle.vehicle` moves the file with.

    Attributes
    ----------
    mass : float
        kg.
    centre, centre_of_buoyancy : (3,) arrays
        From the reference point, m, FRD.
    volume : float
        Displaced, m^3.
    gravity : float
        m/s^2.
    length : float
        m, of a cylinder of that volume, no shorter than thick.
    said : str
        Where volume and centre come from.
    """

    mass: float
    centre: Array
    volume: float
    centre_of_buoyancy: Array
    gravity: float
    length: float
    said: str

    @property
    def radius(self) -> float:
        """Of the cylinder, m."""
        return float(np.sqrt(self.volume / (np.pi * self.length)))


def afloat(parameters: ParameterFile, otherwise: float) -> Afloat:
    """Mass, displaced volume and their centres: what the file has not is neutral, with both centres in one point.

    Parameters
    ----------
    parameters : ParameterFile
    otherwise : float
        kg, the mass that the target takes where the file states neither mass nor buoyancy.
    """
    h, density, length = parameters.hydrostatics, parameters.conditions.density, parameters.scaling.length
    centre = centre_of_gravity(parameters)
    mass = parameters.mass.mass if parameters.mass is not None else otherwise if h is None else density * h.volume
    if h is None:
        volume, at, gravity = mass / density, centre, STANDARD_GRAVITY
        said = "neutrally buoyant, the centre of buoyancy in the centre of gravity: the file states no buoyancy"
        if parameters.mass is None:
            said = f"neutrally buoyant at {mass:g} kg: the file states neither weight nor buoyancy; write mass and volume together"
    else:
        volume, at, gravity = h.volume, np.array(h.centre_of_buoyancy), h.gravity
        x, y, z = (f"{v:g}" for v in at)
        said = f"displaced volume {volume:g} m^3 at ({x}, {y}, {z}) m, FRD from the reference point, of the file"
        if parameters.mass is None:
            centre = at
            said += f"; the file states no mass: {mass:.6g} kg, neutral, with its centre in that of buoyancy"
    return Afloat(mass, centre, volume, at, gravity, max(length, (4.0 * volume / np.pi) ** (1.0 / 3.0)), said)


def states_buoyancy(parameters: ParameterFile, otherwise: str) -> str:
    """Why an export has no weight and buoyancy, or not the file's: the file states none, or the target does not take them."""
    return "the file's hydrostatics are not in it" if parameters.hydrostatics is not None else otherwise


def common_changes(parameters: ParameterFile, law: ExportedLaw, *, whole: bool) -> tuple[str, ...]:
    """What any such export changes, in words; `whole` says whether the target takes v^2 and w^2 of the resistance."""
    out = [f"numbers are SI: primes times 1/2 rho L^k at {parameters.conditions.density:g} kg/m^3", *law.statements[1:]]
    terms = [t for t in law.law.terms if t.coefficient]
    if whole and any(resists(t) for t in terms):
        out.append(
            "X0 U^2 is written as u|u| + v^2 + w^2, alike on every course ahead; <coeflab_x0> repeats it for our reader, the target passes it over"
        )
    speed = [t.symbol for t in terms if t.speed_power and slot(t) is not None and not (whole and resists(t))]
    if speed:
        out.append(
            f"u stands for U in {', '.join(speed)} (u v for U v, u|u| or u^2 for U^2): alike on a straight course ahead, in drift "
            "less by 1 - cos(beta) of a term in U, 1 - cos^2(beta) of one in U^2"
        )
    return tuple(out)

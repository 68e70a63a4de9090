"""What exports to simulators of second order in the velocities share: the law, its form, an added mass that they can carry."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.brief import brief
from coeflab.kernels.composition import definiteness
from coeflab.kernels.transforms import skew
from coeflab.model.force_law import ForceLaw, force_law
from coeflab.model.inertia import added_mass_of
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
        Added mass, symmetric and at least semidefinite; zeros where nothing is known.
    statements : tuple of str
        Where the added mass comes from and what was done to it.
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
    """The law and an added mass that a physics engine can integrate.

    An asymmetric matrix is replaced by the mean of it and its mirror image; where that is no kinetic energy, because
    diagonal entries are unknown or too small, only what stands on the diagonal is kept.
    """
    law = force_law(parameters)
    stated, source = added_mass_of(parameters)
    matrix = (stated + stated.T) / 2.0
    statements = [source]
    apart = 2.0 * float(np.max(np.abs(stated - matrix)))
    if apart:
        statements.append(f"added mass: mean of the matrix and its mirror image, which differ by up to {apart:.3g}")
    if not definiteness(matrix).holds:
        matrix = np.diag(np.maximum(np.diag(stated), 0.0))
        statements.append(
            "added mass: only its diagonal, because the whole is not positive: entries are missing or wrong"
        )
    return ExportedLaw(law, second_order(law), matrix, tuple(statements))


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

"""Inertia of the water about a vehicle, chosen once for simulation, trim, uncertainty and export alike.

A parameter file may state the added mass twice: as a matrix computed from a shape, and as acceleration derivatives that
somebody measured. The measured ones are taken where they leave an inertia, and the matrix completes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass, locking
from coeflab.law.added_mass import AddedMass
from coeflab.law.definiteness import ROUNDING, definiteness
from coeflab.law.rigid_body import rigid_body_inertia
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative, primed
from coeflab.law.transforms import skew

if TYPE_CHECKING:
    from coeflab.vehicle.parameter_file import ParameterFile

SAME = 1e-9
APART = 0.1  # of a stated entry: more than sources state for it
MEASURED, COMPUTED, NONE = "measured", "computed", "none"
STATED = "stated"  # method of an added mass that was read from somebody's model
ACCELERATIONS = (MEASURED, COMPUTED)
Entry = tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False)
@locking("matrix")
class WaterInertia:
    """The added mass that a motion has, and where its entries come from.

    Attributes
    ----------
    matrix : (6, 6) array
        M_A, kg, kg m, kg m^2, FRD, about the file's reference point, at its density; symmetric. Zero where nothing is known.
    asked : {"measured", "computed"}
    used : {"measured", "computed", "none"}
        Measured where at least one entry is.
    source : str
        The choice and where the entries come from, in words.
    warnings : tuple of str
        Where the choice is not what was asked for, and what was done to the derivatives, in words.
    """

    matrix: Array
    asked: str
    used: str
    source: str
    warnings: tuple[str, ...] = ()

    @property
    def statements(self) -> tuple[str, ...]:
        """Source and warnings."""
        return (self.source, *self.warnings)

    def as_noun(self, parameters: ParameterFile) -> AddedMass:
        """The same as `AddedMass`, for potential parts."""
        at = parameters.reference_point
        return AddedMass(self.matrix, np.array(at.point), at.origin, parameters.body, self.source)


def _method(hull: AddedMass) -> str:
    return ", as stated" if hull.method == STATED else f" by {hull.method}"


def water_inertia(parameters: ParameterFile, accelerations: str = MEASURED) -> WaterInertia:
    """The added mass of a parameter file by the stated choice.

    Measured: the derivatives of the file, an off-diagonal one for its mirror image too, or the mean of both where the file
    states both; every other entry computed. Where a diagonal entry of that is negative, or M + M_A is not positive definite, all
    entries are computed. Without a computed matrix the derivatives stand alone, those off the diagonal only where M + M_A is
    positive definite, which a file without mass leaves open.

    Parameters
    ----------
    parameters : ParameterFile
    accelerations : {"measured", "computed"}

    Raises
    ------
    InputError
        Another choice, or derivatives alone that are no inertia: an added mass below zero.
    """
    if accelerations not in ACCELERATIONS:
        raise InputError(shown(accelerations), f"one of {', '.join(ACCELERATIONS)}", column="--accelerations")
    computed, stated = _computed(parameters), stated_accelerations(parameters)
    hull = parameters.added_mass
    by = "" if hull is None else f"the added mass of {hull.body}{_method(hull)}"
    names = ", ".join(primed(name) for name, _ in stated.values())
    if not stated or (accelerations == COMPUTED and computed is not None):
        if computed is None:
            return WaterInertia(np.zeros((6, 6)), accelerations, NONE, "no added mass is known")
        how = "from" if hull is not None and hull.method == STATED else f"{COMPUTED},"
        return WaterInertia(computed, accelerations, COMPUTED, f"accelerations {how} {by}")
    matrix, apart = _completed(np.zeros((6, 6)) if computed is None else computed, stated)
    refused = _no_inertia(parameters, matrix)
    if computed is not None:
        if refused:
            why = f"accelerations {COMPUTED}, not those of the file: with {names} {refused}"
            return WaterInertia(computed, accelerations, COMPUTED, f"accelerations {COMPUTED}, {by}", (why,))
        source = f"{whence(parameters)}; all other entries from {by}"
        return WaterInertia(matrix, accelerations, MEASURED, source, apart)
    warnings = list(apart)
    if accelerations == COMPUTED:
        warnings.append(f"accelerations of the file, not {COMPUTED} ones: it has no computed added mass")
    source = f"{whence(parameters)}; all other entries are unknown and zero"
    if refused and parameters.mass is not None:
        matrix = np.diag(np.diag(matrix))
        warnings.append(
            f"added mass: only its diagonal, because {refused}: entries are missing or wrong, and no computed ones complete them"
        )
        if below := _no_inertia(parameters, matrix):
            raise input_error("vehicle.mass_not_definite", column="coefficients", below=below)
    return WaterInertia(matrix, accelerations, MEASURED, source, tuple(warnings))


def whence(parameters: ParameterFile) -> str:
    """Where the acceleration derivatives of a file come from, in words: measured by whom, or printed where."""
    works = parameters.provenance.citations
    groups: dict[str, list[str]] = {}
    for c in parameters.coefficients:
        if c.value is None or entry_of(c.symbol) is None:
            continue
        named = c.campaign if c.origin == "fit" else c.citation or (works[0] if len(works) == 1 else "")
        place = f"{c.origin}, {named}" if named else c.origin
        groups.setdefault(place, []).append(primed(derivative(c.symbol).text))
    return "accelerations: " + "; ".join(f"{', '.join(names)} ({place})" for place, names in groups.items())


def with_accelerations(parameters: ParameterFile, accelerations: str) -> ParameterFile:
    """The file as everything that moves reads it: computed accelerations are those of a file that states no measured ones.

    Parameters
    ----------
    parameters : ParameterFile
    accelerations : {"measured", "computed"}

    Raises
    ------
    InputError
        As `water_inertia`.
    """
    if water_inertia(parameters, accelerations).used == MEASURED or accelerations == MEASURED:
        return parameters
    return parameters.model_copy(
        update={"coefficients": tuple(c for c in parameters.coefficients if entry_of(c.symbol) is None)}
    )


def stated_accelerations(parameters: ParameterFile) -> dict[Entry, tuple[str, float]]:
    """Symbol and entry of the added mass of every acceleration derivative with a value, by row and column."""
    density, primes = parameters.conditions.density, parameters.scaling
    out = {}
    for c in parameters.coefficients:
        at = entry_of(c.symbol)
        if c.value is not None and at is not None:
            d = derivative(c.symbol)
            out[at] = d.text, -c.value * primes.unit(d.text, density)
    return out


def entry_of(symbol: str) -> Entry | None:
    """Row and column of an acceleration derivative in the added mass; None for anything else."""
    if " " in symbol:
        return None
    d = derivative(symbol)
    if len(d.factors) != 1 or not d.factors[0].endswith("dot"):
        return None
    return COMPONENTS.index(d.component), MOTIONS.index(d.factors[0].removesuffix("dot"))


def known_mass(parameters: ParameterFile) -> tuple[Array, tuple[int, ...]]:
    """(6, 6) M_RB about the reference point, zero in the rows and columns of motions whose inertia the file does not state, and
    the columns of the others among u v w p q r.
    """
    mass = parameters.mass
    if mass is None:
        return np.zeros((6, 6)), ()
    inertia = np.zeros((3, 3))
    known: tuple[int, ...] = (0, 1, 2)
    if mass.inertia_matrix is not None:
        inertia, known = np.array(mass.inertia_matrix), (0, 1, 2, 3, 4, 5)
    elif mass.inertia is not None:
        inertia, known = np.diag([0.0, mass.inertia, mass.inertia]), (0, 1, 2, 4, 5)
    at, out = np.ix_(known, known), np.zeros((6, 6))
    out[at] = rigid_body_inertia(mass.mass, mass.centre_of_gravity, inertia)[at]
    return out, known


def _computed(parameters: ParameterFile) -> Array | None:
    given = parameters.added_mass
    if given is None:
        return None
    matrix = np.array(given.matrix) * (parameters.conditions.density / given.density)
    return np.asarray((matrix + matrix.T) / 2.0)


def _completed(matrix: Array, stated: dict[Entry, tuple[str, float]]) -> tuple[Array, tuple[str, ...]]:
    """The matrix with the stated entries on both sides of the diagonal, and which pairs of them were averaged."""
    out, words = matrix.copy(), []
    for (i, j), (name, value) in stated.items():
        mirror, other = stated.get((j, i), (name, value))
        out[i, j] = out[j, i] = (value + other) / 2.0
        if i < j and other != value:
            unit = "kg m^2" if i > 2 else "kg m" if j > 2 else "kg"
            across = (stated[k, k][1] if (k, k) in stated else float(matrix[k, k]) for k in (i, j))
            size = float(np.sqrt(abs(np.prod(list(across)))))
            first, second = (f"{COMPONENTS[k]}{MOTIONS[k]}dot" for k in (i, j))
            apart = f", {100.0 * abs(value - other) / size:.2g} % of sqrt({first} {second}) apart" if size > 0.0 else ""
            words.append(
                f"{name} and {mirror} are equal in theory, but {-value:.4g} and {-other:.4g} {unit} in the file{apart}; their mean is used"
            )
    return out, tuple(words)


def against_computed(parameters: ParameterFile) -> str:
    """Diagonal entries that the computed added mass and the file's derivatives give differently, in one sentence; else empty."""
    computed, stated = _computed(parameters), stated_accelerations(parameters)
    if computed is None or parameters.added_mass is None:
        return ""
    how = (
        "stated as added mass"
        if parameters.added_mass.method == STATED
        else f"computed by the {parameters.added_mass.method} method"
    )
    apart = [
        f"{primed(name)} {100.0 * (computed[i, i] / value - 1.0):+.0f} %"
        for (i, j), (name, value) in stated.items()
        if i == j and value > 0.0 and abs(computed[i, i] / value - 1.0) > APART
    ]
    return (
        f"diagonal entries {how} differ by over {100.0 * APART:.0f} % from the file's acceleration derivatives: {', '.join(apart)}"
        if apart
        else ""
    )


def _no_inertia(parameters: ParameterFile, matrix: Array) -> str:
    """Why no vehicle has this added mass, in words; empty where one can."""
    rigid, known = known_mass(parameters)
    whole, at = rigid + matrix, np.ix_(known, known)
    if definiteness(whole).smallest < -ROUNDING or (known and not np.linalg.eigvalsh(whole[at])[0] > 0.0):
        return f"{'M + M_A' if known else 'M_A, without a known mass,'} is not positive definite"
    low = int(np.argmin(np.diag(matrix)))
    return f"the added mass of {MOTIONS[low]} is {matrix[low, low]:.4g}, below zero" if matrix[low, low] < 0.0 else ""


def converted(parameters: ParameterFile) -> tuple[str, ...]:
    """What was done to an added mass that holds for another density than the file's; in words, empty where nothing was."""
    hull, density = parameters.added_mass, parameters.conditions.density
    if hull is None or abs(hull.density - density) <= SAME * density:
        return ()
    return (
        f"the added mass of {hull.body} is stated for {hull.density:.6g} kg/m^3 and multiplied by {density / hull.density:.6g} for "
        f"the file's {density:.6g} kg/m^3, here and in the potential parts",
    )


def centre_of_gravity(parameters: ParameterFile) -> Array:
    """(3,) from the reference point, m, FRD; zero where the file has no mass."""
    return np.zeros(3) if parameters.mass is None else parameters.mass.centre_of_gravity


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
        raise input_error("vehicle.inertia_not_positive", column="mass.inertia", central=central)
    return central * np.eye(3)
